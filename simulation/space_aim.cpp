#include "downwash/simulation/space_aim.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/space_tool.hpp"

namespace downwash::simulation {
namespace {

constexpr double pi = std::numbers::pi;
constexpr Vector3 up{0, 0, 1};

double sine_of(double angle_rad) {
    return lane::sin_cos(angle_rad).sine;
}

/// @param x 0 to 1
double arc_sine(double x) {
    return lane::atan2(x, lane::sqrt((1 - x) * (1 + x)));
}

/// Some ways to turn the arm so that it aims, from what it is.
std::vector<JointAngles> arms_near(const Aim& aim, const SpaceArmAngles& arm, const JointAngles& from) {
    std::vector<JointAngles> found;
    const auto add = [&found](const std::optional<JointAngles>& one) {
        if (one) {
            found.push_back(*one);
        }
    };
    const AngleRange elevation = aim.elevation();
    const double now_rad = arm.elevation_rad(from, aim.of_hand);
    const double wanted_rad = std::clamp(now_rad, elevation.low_rad, elevation.high_rad);
    if (now_rad == wanted_rad) {
        found.push_back(from);
    }
    for (std::size_t i = 0; i < arm.joints(); ++i) {
        add(arm.turned(from, i, aim.of_hand, elevation));
        add(arm.turned_in_turn(from, i, aim.of_hand, elevation));
    }
    const auto [sine, cosine] = lane::sin_cos(wanted_rad);
    const Vector3 up_now = arm.inward(from, up);
    const Vector3 beside = up_now - dot(up_now, aim.of_hand) * aim.of_hand;
    const Vector3 way = length_of(beside) > 0 ? unit(beside) : across(aim.of_hand);
    const Vector3 up_then = sine * aim.of_hand + cosine * way;
    for (std::size_t outer = 1; outer < arm.joints(); ++outer) {
        for (std::size_t inner = 0; inner < outer; ++inner) {
            add(arm.turned(from, inner, outer, up_then));
        }
    }
    return found;
}

}  // namespace

Vector3 yawed(double yaw_rad, const Vector3& v) noexcept {
    const auto [sine, cosine] = lane::sin_cos(yaw_rad);
    return {cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]};
}

AngleRange Aim::elevation() const noexcept {
    const double middle = lane::atan2(to[2], lane::sqrt(to[0] * to[0] + to[1] * to[1]));
    return {std::max(middle - cone_rad, -pi / 2), std::min(middle + cone_rad, pi / 2)};
}

double YawRange::nearest_to(double yaw_rad) const noexcept {
    const double off_rad = lane::wrap_angle(yaw_rad - middle_rad);
    return yaw_rad + std::clamp(off_rad, -half_rad, half_rad) - off_rad;
}

YawRange yaws_of(const Aim& aim, const SpaceArmAngles& arm, const JointAngles& at) noexcept {
    const Vector3 v = arm.outward(at, aim.of_hand);
    const double v_level = lane::sqrt(v[0] * v[0] + v[1] * v[1]);
    const double cone = sine_of(0.5 * std::min(aim.cone_rad, pi));
    if (aim.attitude != nullptr) {
        // The turn to the attitude is a swing s of the vertical and a twist t about it:
        // cos(turn / 2) = cos(s / 2) cos(t / 2).
        const Vector3 x = arm.outward(at, {1, 0, 0}), y = arm.outward(at, {0, 1, 0});
        const Matrix3 wanted = rotation_of(*aim.attitude);
        // Rz(yaw) A is next to R where the trace of (Rz A)^T R is greatest.
        const Vector3 z = cross(x, y);
        double along = 0, beside = 0;
        const Vector3 columns[] = {x, y, z};
        for (std::size_t i = 0; i < 3; ++i) {
            along += columns[i][0] * wanted[0][i] + columns[i][1] * wanted[1][i];
            beside += columns[i][0] * wanted[1][i] - columns[i][1] * wanted[0][i];
        }
        const double swing = sine_of(0.5 * lane::atan2(v_level, v[2]));
        const double room = (cone - swing) * (cone + swing), left = 1 - swing * swing;
        const double half = room >= left ? 1 : std::max(0.0, room / left);
        return {lane::atan2(beside, along), 2 * arc_sine(lane::sqrt(half))};
    }
    const double to_level = lane::sqrt(aim.to[0] * aim.to[0] + aim.to[1] * aim.to[1]) / length_of(aim.to);
    const double apart =
        sine_of(0.5 * (lane::atan2(v[2], v_level) - lane::atan2(aim.to[2], to_level * length_of(aim.to))));
    const double room = (cone - apart) * (cone + apart), level = v_level * to_level;
    constexpr double upright = 1e-24;
    if (level <= upright || room >= level) {
        return {lane::atan2(aim.to[1], aim.to[0]) - lane::atan2(v[1], v[0]), pi};
    }
    return {lane::atan2(aim.to[1], aim.to[0]) - lane::atan2(v[1], v[0]),
            2 * arc_sine(lane::sqrt(std::max(0.0, room / level)))};
}

std::optional<Heading> drawn_heading(const Aim& aim, const SpaceArmAngles& arm, Random& random) {
    const std::optional<JointAngles> joints = arm.drawn_with(aim.of_hand, aim.elevation(), random);
    if (!joints) {
        return std::nullopt;
    }
    const YawRange yaws = yaws_of(aim, arm, *joints);
    return Heading{*joints, lane::wrap_angle(yaws.middle_rad + random.uniform(-yaws.half_rad, yaws.half_rad))};
}

std::vector<Heading> headings_near(const Aim& aim, const SpaceArmAngles& arm, const Heading& from) {
    std::vector<Heading> headings;
    for (const JointAngles& joints : arms_near(aim, arm, from.joints)) {
        headings.push_back({joints, yaws_of(aim, arm, joints).nearest_to(from.yaw_rad)});
    }
    return headings;
}

}  // namespace downwash::simulation

#include "downwash/simulation/space_touch_flight.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <variant>

#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/space_body.hpp"
#include "downwash/simulation/space_configuration.hpp"
#include "downwash/simulation/space_tool.hpp"
#include "downwash/simulation/space_touch_place.hpp"
#include "downwash/simulation/space_world.hpp"

namespace downwash {

std::string_view name_of(SpaceTouchEnd end) noexcept {
    constexpr std::string_view names[] = {"met",     "missed", "wrong_place", "wrong_force",
                                          "slipped", "stuck",  "too_deep",    "cut_short"};
    return names[static_cast<std::size_t>(end)];
}

namespace simulation {
namespace {

dynamics::LaneVector<double> lane_vector(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

/// A vector of the nominal scene as the world has it.
Vector3 turned(const Vector3& v, double yaw_rad) {
    const auto [sine, cosine] = lane::sin_cos(yaw_rad);
    return {cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]};
}

dynamics::SpaceContact contact_of(const SpaceTouch& touch, const SpaceWorld& world) {
    dynamics::SpaceContact contact;
    contact.surface_m = lane_vector(world.scene_m + turned(touch.surface_m, world.scene_yaw_rad));
    contact.normal = lane_vector(turned(touch.normal, world.scene_yaw_rad));
    for (const SpaceTouchPoint& point : touch.points) {
        contact.point[contact.point_count++] = {point.link, lane_vector(point.at_m)};
    }
    return contact;
}

/// What a law answers to a metre along a vector of length 1 [1/s2].
double stiffness_1_s2(const SpaceLaw& law, const Vector3& along) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double share = along[static_cast<std::size_t>(axis)];
        sum += share * share * std::visit([axis](const auto& own) { return own.position_stiffness_1_s2(axis); }, law);
    }
    return sum;
}

/// The attitude in which the thrust carries the weight and stands up to a force on the vehicle, with the first axis in
/// the vertical plane of a heading: where a law takes it.
std::array<double, 4> attitude_under(double mass_kg, const Vector3& force_n, double yaw_rad) {
    const auto [sine, cosine] = lane::sin_cos(yaw_rad);
    const double ahead_n = -(cosine * force_n[0] + sine * force_n[1]);
    const double left_n = -(cosine * force_n[1] - sine * force_n[0]);
    const double up_n = mass_kg * standard_gravity_m_s2 - force_n[2];
    return attitude_of(
        {-lane::atan2(left_n, lane::sqrt(ahead_n * ahead_n + up_n * up_n)), lane::atan2(ahead_n, up_n), yaw_rad});
}

/// Steps of damped least squares towards the joints of a trim, and their damping.
constexpr int leaning_steps = 8;
constexpr double leaning_damping = 0.01;

/// One of these steps: turns the joints of a pose by J^T (J J^T + damping)^-1 e, where J is what they do to where the
/// end effector points and e what that lacks, and keeps them within their limits.
/// @param wanted where it should point, of length 1
void turn_tool(const SpaceRobot& robot, const Vector3& wanted, SpacePose& pose) {
    using dynamics::LaneVector;
    const Vector3 points = tool_at(robot, pose).direction;
    std::array<LaneVector<double>, max_joints> turns{};
    dynamics::LaneSymmetric<double> squares{leaning_damping, 0, 0, leaning_damping, 0, leaning_damping};
    const auto joints = static_cast<std::size_t>(robot.joints());
    for (std::size_t i = 0; i < joints; ++i) {
        const Matrix3 axes = rotation_of(link_at(robot, pose, static_cast<int>(i)).attitude);
        turns[i] = lane_vector(cross(axes * unit(robot.plant.links[i].axis), points));
        squares = squares + dynamics::outer_square(turns[i], turns[i]);
    }
    const LaneVector<double> share = dynamics::solve_positive(squares, lane_vector(wanted - points));
    for (std::size_t i = 0; i < joints; ++i) {
        const SpaceLinkLimits& limits = robot.links[i];
        double& joint_rad = pose.joints_rad[i];
        joint_rad += dot(turns[i], share);
        if (limits.is_limited) {
            joint_rad = std::clamp(joint_rad, limits.lower_limit_rad, limits.upper_limit_rad);
        }
    }
}

/// How long a vector is without its part along another one of length 1.
double length_across(const Vector3& v, const Vector3& normal) {
    const Vector3 across = v - dot(v, normal) * normal;
    return lane::sqrt(dot(across, across));
}

}  // namespace

SpacePoint leaning(const SpaceRobot& robot, const SpaceTouch& touch, const SpacePoint& base, double force_n) {
    if (touch.part == TouchingPart::frame || force_n == 0) {
        return base;
    }
    const SpacePose level = level_at(configuration_of(base));
    const Vector3 wanted = tool_at(robot, level).direction;
    SpacePose pose = level;
    pose.attitude = attitude_under(robot.mass_kg(), force_n * touch.normal, base.position[space::yaw]);
    for (int step = 0; step < leaning_steps; ++step) {
        turn_tool(robot, wanted, pose);
    }
    const Vector3 moved_m = middle_of(touch, robot, level) - middle_of(touch, robot, pose);
    SpacePoint point = base;
    for (int axis = 0; axis < 3; ++axis) {
        point.position[axis] += moved_m[static_cast<std::size_t>(axis)];
    }
    std::copy_n(pose.joints_rad.begin(), robot.joints(), point.position + space::first_joint);
    return point;
}

SpaceTouchFlight::SpaceTouchFlight(const SpaceRobot& robot, const SpaceTouch& touch, const SpaceWorld& world,
                                   const SpacePoint& base, bool is_led)
    : robot_(robot),
      touch_(touch),
      world_(world),
      base_(rest_at(base)),
      is_led_(is_led),
      is_told_(is_led && std::holds_alternative<SpaceInversion>(robot.controller.law)),
      force_per_m_(robot.mass_kg() * stiffness_1_s2(robot.controller.law, touch.normal)),
      contact_(contact_of(touch, world)),
      course_(touch, robot.mass_kg(), stiffness_1_s2(robot.controller.law, touch.normal), 1 / robot.controller.rate_hz),
      force_(touch, 1 / robot.controller.rate_hz),
      depth_m_(-touch.standoff_m) {}

SpacePoint SpaceTouchFlight::reference() const {
    SpacePoint point = is_led_ ? leaning(robot_, touch_, base_, asked_n()) : base_;
    // A law that is told of the force needs no error of the position to press.
    const bool stays = is_told_ && course_.beyond_m() > 0;
    const double ahead_m = course_.ahead_m() - (stays ? course_.beyond_m() : 0);
    const double along_m_s = stays ? 0 : course_.along_m_s();
    for (int axis = 0; axis < 3; ++axis) {
        const double normal = touch_.normal[static_cast<std::size_t>(axis)];
        point.position[axis] -= ahead_m * normal;
        point.velocity[axis] = -along_m_s * normal;
    }
    return point;
}

std::optional<controllers::ToldPush> SpaceTouchFlight::push() const {
    if (!is_told_ || course_.beyond_m() == 0) {
        return std::nullopt;
    }
    controllers::ToldPush push;
    push.is_on_end_effector = touch_.part == TouchingPart::end_effector;
    Vector3 sum_m{};
    for (const SpaceTouchPoint& point : touch_.points) {
        sum_m = sum_m + point.at_m;
    }
    push.at_m = lane_vector((1 / static_cast<double>(touch_.points.size())) * sum_m);
    push.force_n = lane_vector(asked_n() * touch_.normal);
    return push;
}

void SpaceTouchFlight::saw(const dynamics::SpaceContactRecord& seen, const SpaceMotion& motion, double end_s,
                           double energy_j) {
    depth_m_ = seen.depth_m;
    const bool is_holding = course_.is_holding();
    force_.saw(seen.normal_impulse_n_s, seen.depth_m, end_s, energy_j, is_holding);
    if (is_holding) {
        const SpacePose pose{motion.position_m, motion.attitude, motion.joints_rad};
        const Vector3 place_m = among_obstacles(middle_of(touch_, robot_, pose), world_);
        held_m_ = held_m_.value_or(place_m);
        slip_m_ = std::max(slip_m_, length_across(place_m - *held_m_, touch_.normal));
    }
    course_.next(seen.normal_impulse_n_s * robot_.controller.rate_hz);
}

SpacePose SpaceTouchFlight::off_surface(SpacePose pose) const {
    constexpr double air_m = 5e-4;
    pose.position_m = pose.position_m + std::max(0.0, depth_m_ + air_m) * touch_.normal;
    return pose;
}

SpaceTouchRecord SpaceTouchFlight::record(bool is_at_end) const {
    SpaceTouchRecord record;
    static_cast<TouchRecord&>(record) = force_.record(is_at_end);
    record.place_m = held_m_.value_or(Vector3{});
    record.slip_m = slip_m_;
    record.end = end_of(record, is_at_end);
    record.is_met = record.end == SpaceTouchEnd::met;
    return record;
}

SpaceTouchEnd SpaceTouchFlight::end_of(const SpaceTouchRecord& record, bool is_at_end) const {
    if (!is_at_end) {
        return is_too_deep() ? SpaceTouchEnd::too_deep : SpaceTouchEnd::cut_short;
    }
    if (course_.is_stuck() || depth_m_ >= 0) {
        return SpaceTouchEnd::stuck;
    }
    if (record.touched_s == 0) {
        return SpaceTouchEnd::missed;
    }
    if (touch_.wanted_m && held_m_ && length_across(*held_m_ - *touch_.wanted_m, touch_.normal) > touch_.tolerance_m) {
        return SpaceTouchEnd::wrong_place;
    }
    if (slip_m_ > touch_.tolerance_m) {
        return SpaceTouchEnd::slipped;
    }
    return record.is_met ? SpaceTouchEnd::met : SpaceTouchEnd::wrong_force;
}

}  // namespace simulation
}  // namespace downwash

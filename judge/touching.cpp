#include "downwash/judge/touching.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "downwash/judge/position_loop.hpp"

namespace downwash::judge {
namespace {

// docs/model.md 2.6.
constexpr double stiffness_n_m = 1e5;
constexpr double dissipation_s_m = 10;
constexpr double friction = 0.5;
constexpr double slip_speed_m_s = 0.02;

// docs/model.md 7.5.
constexpr double settling_constants = 5;
constexpr double hover_s = 8;
constexpr double overshoot_m = 0.5;
constexpr double free_s = 0.1;
constexpr double pull_m = 2;
constexpr double force_loop_share = 0.4;

double dot(PlaneVector a, Planar b) {
    return a.x * b.x + a.z * b.z;
}

}  // namespace

std::vector<TouchSurface::Place> TouchSurface::places(const Vehicle& vehicle, const Motion& motion) const {
    std::vector<Place> all;
    for (const PlaneVector& point : touch_->frame_points_m) {
        const Planar lever = from_body(Planar{point.x, point.z} - vehicle.center_of_mass_m, motion.pitch_rad);
        all.push_back({motion.position_m + lever, motion.velocity_m_s + turned(motion.pitch_rate_rad_s, lever), lever});
    }
    if (all.empty()) {
        const Planar joint = from_body(vehicle.joint_m, motion.pitch_rad);
        const Planar arm = arm_direction(motion.pitch_rad, motion.arm_rad);
        const Planar tip = vehicle.arm_length_m * arm;
        all.push_back({motion.position_m + joint + tip,
                       motion.velocity_m_s + turned(motion.pitch_rate_rad_s, joint) +
                           turned(motion.pitch_rate_rad_s + motion.arm_rate_rad_s, tip),
                       (vehicle.arm_length_m - vehicle.arm_center_of_mass_m) * arm});
    }
    return all;
}

double TouchSurface::depth_m(const Place& place) const {
    const Planar surface = Planar{touch_->surface_m.x, touch_->surface_m.z} + shift_;
    return dot(touch_->normal, surface - place.position_m);
}

double TouchSurface::depth_m(const Vehicle& vehicle, const Motion& motion) const {
    double deepest = -std::numeric_limits<double>::infinity();
    for (const Place& place : places(vehicle, motion)) {
        deepest = std::max(deepest, depth_m(place));
    }
    return deepest;
}

double TouchSurface::push(const Vehicle& vehicle, const Motion& motion, Loads& loads) const {
    double sum_n = 0;
    for (const Place& place : places(vehicle, motion)) {
        const double depth = depth_m(place);
        if (depth <= 0) {
            continue;
        }
        const Planar out{touch_->normal.x, touch_->normal.z};
        const double leaving_m_s = dot(touch_->normal, place.velocity_m_s);
        const double normal_n = std::max(0.0, stiffness_n_m * depth * (1 - dissipation_s_m * leaving_m_s));
        const Planar slip = place.velocity_m_s - leaving_m_s * out;
        const double speed = std::hypot(slip.x, slip.z, slip_speed_m_s);
        const Planar force = normal_n * out + (-friction * normal_n / speed) * slip;
        if (touch_->frame_points_m.empty()) {
            loads.arm_force_n = loads.arm_force_n + force;
            loads.arm_moment_nm += moment_of(place.lever_m, force);
        } else {
            loads.body_force_n = loads.body_force_n + force;
            loads.body_moment_nm += moment_of(place.lever_m, force);
        }
        sum_n += normal_n;
    }
    return sum_n;
}

TouchCourse::TouchCourse(const Touch& touch, const ReferencePoint& from, const Robot& robot)
    : touch_(touch), from_(from), tick_s_(1 / robot.controller.rate_hz) {
    const double mass_kg = robot.multirotor.mass_kg + robot.arm.mass_kg;
    const double answer = answer_1_s2(robot.controller.law, touch.normal.x == 0);
    const double rate_1_s = force_loop_share * std::sqrt(answer);
    metres_per_newton_ = rate_1_s / (mass_kg * answer) * tick_s_;
    settling_s_ = settling_constants / rate_1_s;
}

ReferencePoint TouchCourse::reference() const {
    ReferencePoint point = from_;
    const double speed = stage_ == Stage::coming    ? touch_.speed_m_s
                         : stage_ == Stage::pulling ? -touch_.speed_m_s
                         : stage_ == Stage::going   ? beyond_m_ > 0 ? -touch_.speed_m_s : touch_.speed_m_s
                                                    : 0.0;
    const double out[] = {touch_.normal.x, touch_.normal.z};
    for (int axis = 0; axis < 2; ++axis) {
        point.position[axis] -= beyond_m_ * out[axis];
        point.velocity[axis] = -speed * out[axis];
    }
    return point;
}

void TouchCourse::enter(Stage stage) {
    stage_ = stage;
    since_ = 0;
}

void TouchCourse::next(double force_n) {
    ++since_;
    const double way_m = touch_.speed_m_s * tick_s_;
    const auto lasts = [&](double duration_s) { return static_cast<double>(since_) * tick_s_ < duration_s - 1e-9; };
    if (stage_ == Stage::holding) {
        held_n_.push_back(force_n);
    }
    switch (stage_) {
        case Stage::coming:
            if (force_n > 0) {
                enter(Stage::settling);
            } else if (beyond_m_ > touch_.standoff_m + overshoot_m) {
                enter(Stage::pulling);
            } else {
                beyond_m_ += way_m;
            }
            break;
        case Stage::settling:
        case Stage::holding:
            beyond_m_ += std::clamp(metres_per_newton_ * (touch_.force_n - force_n), -way_m, way_m);
            if (!lasts(stage_ == Stage::settling ? settling_s_ : touch_.hold_s)) {
                enter(stage_ == Stage::settling ? Stage::holding : Stage::pulling);
            }
            break;
        case Stage::pulling:
            beyond_m_ -= way_m;
            free_ = force_n > 0 ? 0 : free_ + 1;
            if (static_cast<double>(free_) * tick_s_ >= free_s) {
                enter(Stage::going);
            } else if (beyond_m_ < -pull_m) {
                enter(Stage::over);
            }
            break;
        case Stage::going:
            beyond_m_ -= std::clamp(beyond_m_, -way_m, way_m);
            if (beyond_m_ == 0) {
                enter(Stage::hovering);
            }
            break;
        case Stage::hovering:
            if (!lasts(hover_s)) {
                enter(Stage::over);
            }
            break;
        case Stage::over:
            break;
    }
}

std::optional<TouchCourse::Hold> TouchCourse::hold() const {
    const auto second = static_cast<std::size_t>(std::llround(1 / tick_s_));
    if (held_n_.size() < second) {
        return std::nullopt;
    }
    Hold hold{std::accumulate(held_n_.begin(), held_n_.end(), 0.0) / static_cast<double>(held_n_.size()), 0};
    for (auto first = held_n_.begin(); held_n_.end() - first >= static_cast<std::ptrdiff_t>(second); ++first) {
        const double mean_n =
            std::accumulate(first, first + static_cast<std::ptrdiff_t>(second), 0.0) / static_cast<double>(second);
        hold.worst_second_n = std::max(hold.worst_second_n, std::abs(mean_n - touch_.force_n));
    }
    return hold;
}

}  // namespace downwash::judge

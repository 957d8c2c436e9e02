#include "downwash/simulation/space_flight.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>

#include "downwash/base/infinity.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/flight_rules.hpp"
#include "downwash/simulation/goal.hpp"

namespace downwash {
namespace {

using simulation::SpaceLoop;

/// Few: among thousands of obstacles a tick takes milliseconds.
constexpr std::int64_t ticks_between_questions = 8;

double length_of(const Vector3& v) {
    return std::sqrt(dot(v, v));
}

double tracking_error_m(const SpaceMotion& motion, const SpacePoint& reference) {
    return length_of(Vector3{reference.position[0], reference.position[1], reference.position[2]} - motion.position_m);
}

/// Cosine of the angle between the body's z axis and the vertical.
double cosine_of_tilt(const SpaceMotion& motion) {
    const auto& q = motion.attitude;
    return 1 - 2 * (q[1] * q[1] + q[2] * q[2]) / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
}

/// Whether a vehicle is lost.
class Stability {
 public:
    [[nodiscard]] bool is_lost(const SpaceLoop& loop, const SpaceMotion& motion, const SpacePoint& reference) {
        const bool is_upright = cosine_of_tilt(motion) > lane::sin_cos(unstable_pitch_rad).cosine;
        const bool falls_over = was_upright_ && !is_upright;
        was_upright_ = was_upright_ || is_upright;
        // A number that is not finite is beyond every limit.
        return falls_over || !loop.is_within(max_state) || !(tracking_error_m(motion, reference) <= unstable_error_m);
    }

 private:
    bool was_upright_ = false;
};

/// Rules, rows and figures of one flight.
class Recorder {
 public:
    Recorder(SpaceLoop& loop, const SpaceFlightSettings& settings, double tick_s, SpaceFlight& flight)
        : loop_(loop), settings_(settings), tick_s_(tick_s), flight_(flight) {}

    /// Looks at a new state.
    Rejection judge(const SpacePoint& reference) {
        const SpaceMotion motion = loop_.motion();
        flight_.max_tracking_error_m = std::max(flight_.max_tracking_error_m, tracking_error_m(motion, reference));
        if (stability_.is_lost(loop_, motion, reference)) {
            return Rejection::unstable;
        }
        if (settings_.checker != nullptr) {
            const SpacePose pose = among_obstacles(motion, settings_.world);
            clearance_m_ = settings_.checker->clearance_m(pose);
            flight_.min_clearance_m = std::min(flight_.min_clearance_m, clearance_m_);
            const bool touches =
                clearance_m_ <= 0 || (before_ && settings_.checker->comes_nearer_between(*before_, pose, 0));
            before_ = pose;
            if (touches) {
                flight_.min_clearance_m = std::min(flight_.min_clearance_m, 0.0);
                return Rejection::collision;
            }
        }
        return loop_.is_flyable() ? Rejection::none : Rejection::flyable_area;
    }

    /// Adds the row of a state. @param row with the commands of the tick that begins there
    Rejection add(SpaceFlightRow row) {
        row.t_s = static_cast<double>(flight_.rows.size()) * tick_s_;
        row.clearance_m = clearance_m_;
        const bool is_usable = is_in_range(row);
        if (!is_usable) {
            std::fill(std::begin(row.rotor_command_n), std::end(row.rotor_command_n), 0.0);
            std::fill(std::begin(row.joint_torque_nm), std::end(row.joint_torque_nm), 0.0);
            row.saturation = max_result;
            row.power_w = 0;
        }
        flight_.max_saturation = std::max(flight_.max_saturation, row.saturation);
        flight_.rows.push_back(row);
        return is_usable ? Rejection::none : Rejection::unstable;
    }

 private:
    static bool is_in_range(SpaceFlightRow row) {
        row.clearance_m = std::isinf(row.clearance_m) ? 0 : row.clearance_m;
        return are_within(row, max_result);
    }

    SpaceLoop& loop_;
    const SpaceFlightSettings& settings_;
    double tick_s_;
    SpaceFlight& flight_;
    Stability stability_;
    double clearance_m_ = infinity;
    std::optional<SpacePose> before_;
};

/// @return false if the vehicle does not stay stable
bool settle(const SpaceRobot& robot, SpaceLoop& loop, const SpaceMotion& start) {
    SpacePoint here;
    std::copy(start.position_m.begin(), start.position_m.end(), here.position);
    const auto& q = start.attitude;
    here.position[space::yaw] = lane::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
    std::copy(start.joints_rad.begin(), start.joints_rad.end(), here.position + space::first_joint);
    Stability stability;
    const std::int64_t ticks = std::llround(settling_before_start_s * robot.controller.rate_hz);
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
        SpaceFlightRow row;
        loop.quiet_tick(here, row);
        if (stability.is_lost(loop, loop.motion(), here)) {
            return false;
        }
    }
    loop.forget();
    return true;
}

/// Whether the goal is met throughout the last second.
bool meets_goal(const SpaceFlight& flight, const SpaceFlightSettings& settings, double tick_s) {
    const auto last = static_cast<std::int64_t>(flight.rows.size()) - 1;
    const std::int64_t first = std::max<std::int64_t>(0, last - std::llround(goal_settling_s / tick_s));
    for (std::int64_t i = first; i <= last; ++i) {
        const SpaceFlightRow& row = flight.rows[static_cast<std::size_t>(i)];
        if (!settings.meets_goal(row.motion, row.end_effector_m) ||
            length_of(row.motion.velocity_m_s) >= goal_max_speed_m_s) {
            return false;
        }
    }
    return true;
}

}  // namespace

SpacePose among_obstacles(const SpaceMotion& motion, const SpaceWorld& world) noexcept {
    SpacePose pose;
    pose.position_m = among_obstacles(motion.position_m, world);
    const lane::SinCos half = lane::sin_cos(-0.5 * world.scene_yaw_rad);
    const auto& q = motion.attitude;
    pose.attitude = {half.cosine * q[0] - half.sine * q[3], half.cosine * q[1] - half.sine * q[2],
                     half.cosine * q[2] + half.sine * q[1], half.cosine * q[3] + half.sine * q[0]};
    std::copy(motion.joints_rad.begin(), motion.joints_rad.end(), pose.joints_rad.begin());
    return pose;
}

SpaceFlight fly(const SpaceRobot& robot, const SpacePlan& plan, const SpaceMotion& start,
                const SpaceFlightSettings& settings) {
    assert(!plan.reference.empty() && plan.joints == robot.joints());
    SpaceFlight flight;
    flight.joints = robot.joints();
    flight.rotor_count = static_cast<int>(robot.plant.rotors.size());
    flight.has_rotor_lag = robot.plant.time_constant_s > 0;
    flight.min_clearance_m = infinity;
    simulation::NoEffectInSpace none;
    simulation::SpaceEffect& effect = settings.effect != nullptr ? *settings.effect : none;
    const auto loop = simulation::make_space_loop({robot, settings.world, effect, settings.aero, settings.is_refined});
    loop->start(start);
    const double tick_s = 1 / robot.controller.rate_hz;
    const std::int64_t ticks = plan.reference.back().tick + settings.hold_ticks;
    Recorder recorder(*loop, settings, tick_s, flight);
    SpacePoint reference = plan.at(0);
    Rejection rejection = settings.settles && !settle(robot, *loop, start) ? Rejection::unstable : Rejection::none;
    if (rejection == Rejection::none) {
        rejection = recorder.judge(reference);
    }
    for (std::int64_t tick = 0; tick < ticks && rejection == Rejection::none; ++tick) {
        if (tick % ticks_between_questions == 0) {
            throw_if_over(settings.is_over);
        }
        SpaceFlightRow row;
        row.reference = reference;
        loop->describe(row);
        loop->tick(settings.first_tick + tick, reference, row);
        rejection = recorder.add(row);
        if (rejection == Rejection::none && settings.after_tick) {
            rejection = settings.after_tick(flight.rows.back());
        }
        reference = plan.at(tick + 1);
        if (rejection == Rejection::none) {
            rejection = recorder.judge(reference);
        }
    }
    // What the controller commands at the end is part of the last row; nothing is flown with it.
    if (flight.rows.empty() || loop->is_within(max_state)) {
        SpaceFlightRow row;
        row.reference = reference;
        loop->look(reference, row);
        loop->describe(row);
        static_cast<void>(recorder.add(row));
    }
    flight.rejection = rejection;
    flight.outcome = outcome_of(rejection);
    flight.energy_j = flight.rows.back().energy_j;
    flight.duration_s = flight.rows.back().t_s;
    if (flight.outcome == Outcome::ok && settings.meets_goal && !meets_goal(flight, settings, tick_s)) {
        flight.outcome = Outcome::goal_missed;
    }
    if (flight.outcome == Outcome::ok && settings.energy_budget_j && flight.energy_j > *settings.energy_budget_j) {
        flight.outcome = Outcome::over_budget;
    }
    return flight;
}

}  // namespace downwash

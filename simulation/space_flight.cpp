#include "downwash/simulation/space_flight.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "downwash/base/direction.hpp"
#include "downwash/base/infinity.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/flight_rules.hpp"
#include "downwash/simulation/goal.hpp"
#include "downwash/simulation/space_rules.hpp"
#include "downwash/simulation/space_touch_flight.hpp"

namespace downwash {
namespace {

using simulation::SpaceLoop;

/// Few: among thousands of obstacles a tick takes milliseconds.
constexpr std::int64_t ticks_between_questions = 8;

double tracking_error_m(const SpaceMotion& motion, const SpacePoint& reference) {
    return simulation::space_tracking_error_m(motion.position_m.data(), reference.position);
}

/// Whether a vehicle is lost.
class Stability {
 public:
    [[nodiscard]] bool is_lost(const SpaceLoop& loop, const SpaceMotion& motion, const SpacePoint& reference) {
        const bool is_upright =
            simulation::cosine_of_tilt(motion.attitude.data()) > lane::sin_cos(unstable_pitch_rad).cosine;
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

    /// From here on the vehicle is in a touch: obstacles see it a little off the surface. nullptr: no longer.
    void expect(const simulation::SpaceTouchFlight* touch) { touch_ = touch; }

    /// Looks at a new state.
    Rejection judge(const SpacePoint& reference) {
        const SpaceMotion motion = loop_.motion();
        flight_.max_tracking_error_m = std::max(flight_.max_tracking_error_m, tracking_error_m(motion, reference));
        if (stability_.is_lost(loop_, motion, reference)) {
            return Rejection::unstable;
        }
        if (settings_.checker != nullptr) {
            SpacePose pose = among_obstacles(motion, settings_.world);
            clearance_m_ = settings_.checker->clearance_m(pose);
            double checked_m = clearance_m_;
            if (touch_ != nullptr) {
                pose = touch_->off_surface(pose);
                checked_m = settings_.checker->clearance_m(pose);
            } else {
                flight_.min_clearance_m = std::min(flight_.min_clearance_m, clearance_m_);
            }
            const bool touches =
                checked_m <= 0 || (before_ && settings_.checker->comes_nearer_between(*before_, pose, 0));
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
    const simulation::SpaceTouchFlight* touch_ = nullptr;
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

/// Whether a further goal is met throughout the last second.
bool meets_further_goal(const SpaceFlight& flight, const SpaceFlightSettings& settings, double tick_s) {
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

/// A hover that was flown, or that the flight was to come to.
struct FlownHover {
    SpaceGoalHover hover;
    std::int64_t row = -1;        ///< at its end; -1: not reached
    std::int64_t after_row = -1;  ///< at the end of its touch; -1: none
    std::optional<SpaceTouchRecord> touch;
};

/// Adds the errors of rows up to one to a visit. @param settling ticks before it that count, too
void add_rows(const SpaceGoalRule& rule, const SpaceGoalHover& hover, const SpaceWorld& world,
              const SpaceFlight& flight, std::int64_t last, std::int64_t settling, SpaceGoalVisit& visit) {
    for (std::int64_t i = std::max<std::int64_t>(0, last - settling); i <= last; ++i) {
        const SpaceMotion& motion = flight.rows[static_cast<std::size_t>(i)].motion;
        const SpaceGoalError error = rule.error(hover, motion, world);
        visit.error_m = std::max(visit.error_m, error.distance_m);
        visit.angle_rad = std::max(visit.angle_rad, error.angle_rad);
        visit.is_hidden = visit.is_hidden || error.is_hidden;
        visit.is_met = visit.is_met && meets_goal(error, motion);
    }
}

/// What became of the goals.
void judge_goals(const SpaceGoalRule& rule, const SpaceWorld& world, double tick_s,
                 const std::vector<FlownHover>& hovers, SpaceFlight& flight) {
    const std::int64_t settling = std::llround(goal_settling_s / tick_s);
    flight.goals.resize(rule.goals().size());
    std::vector<bool> has_hover(rule.goals().size());
    const auto judge = [&](const FlownHover& flown) {
        SpaceGoalVisit& visit = flight.goals[flown.hover.goal];
        has_hover[flown.hover.goal] = true;
        visit.is_reached = visit.is_met = flown.row >= 0;
        visit.touch = flown.touch;
        if (flown.row >= 0) {
            add_rows(rule, flown.hover, world, flight, flown.row, settling, visit);
        } else {
            add_rows(rule, flown.hover, world, flight, static_cast<std::int64_t>(flight.rows.size()) - 1, 0, visit);
        }
        if (flown.touch) {
            visit.is_met = visit.is_met && flown.touch->is_met && flown.after_row >= 0;
            if (flown.after_row >= 0) {
                add_rows(rule, flown.hover, world, flight, flown.after_row, settling, visit);
            }
        }
    };
    for (const FlownHover& flown : hovers) {
        judge(flown);
    }
    for (std::size_t goal = 0; goal < has_hover.size(); ++goal) {
        if (!has_hover[goal]) {
            judge({{goal, 0, {}, {}}, -1, -1, {}});
        }
        if (flight.outcome == Outcome::ok && !flight.goals[goal].is_met) {
            flight.outcome = Outcome::goal_missed;
        }
    }
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
    std::vector<FlownHover> hovers;
    if (settings.goals != nullptr) {
        for (SpaceGoalHover& hover : settings.goals->hovers(plan)) {
            hovers.push_back({std::move(hover), -1, -1, {}});
        }
    }
    const std::int64_t ticks =
        hovers.empty() ? plan.reference.back().tick + settings.hold_ticks : hovers.back().hover.end_tick;
    Recorder recorder(*loop, settings, tick_s, flight);
    SpacePoint reference = plan.at(0);
    Rejection rejection = settings.settles && !settle(robot, *loop, start) ? Rejection::unstable : Rejection::none;
    if (rejection == Rejection::none) {
        rejection = recorder.judge(reference);
    }
    // One tick: `move` takes the vehicle on, and says the reference at its end.
    double contact_force_n = 0;
    const auto fly_tick = [&](const auto& move) {
        const auto flown = static_cast<std::int64_t>(flight.rows.size());
        if (flown % ticks_between_questions == 0) {
            throw_if_over(settings.is_over);
        }
        SpaceFlightRow row;
        row.reference = reference;
        row.contact_force_n = contact_force_n;
        loop->describe(row);
        const SpacePoint next = move(settings.first_tick + flown, row);
        rejection = recorder.add(row);
        if (rejection == Rejection::none && settings.after_tick) {
            rejection = settings.after_tick(flight.rows.back());
        }
        reference = next;
        if (rejection == Rejection::none) {
            rejection = recorder.judge(reference);
        }
    };
    const auto fly_touch = [&](FlownHover& flown) {
        simulation::SpaceTouchFlight touch(robot, *flown.hover.touch, settings.world, reference);
        recorder.expect(&touch);
        reference = touch.reference();
        while (!touch.is_over() && rejection == Rejection::none) {
            fly_tick([&](std::int64_t number, SpaceFlightRow& row) {
                dynamics::SpaceContactRecord seen;
                const double before_j = loop->energy_j();
                loop->touching_tick(number, reference, touch.contact(), touch.is_at_surface(), row, seen);
                const double end_s = static_cast<double>(flight.rows.size() + 1) * tick_s;
                touch.saw(seen, loop->motion(), end_s, loop->energy_j() - before_j);
                contact_force_n = seen.normal_impulse_n_s / tick_s;
                return touch.reference();
            });
            if (rejection == Rejection::none && touch.is_too_deep()) {
                rejection = Rejection::collision;
            }
        }
        recorder.expect(nullptr);
        contact_force_n = 0;
        flown.touch = touch.record(rejection == Rejection::none);
        if (rejection == Rejection::none) {
            flown.after_row = static_cast<std::int64_t>(flight.rows.size());
            rejection = flown.touch->is_met ? Rejection::none : Rejection::goal_missed;
        }
    };
    auto next_hover = hovers.begin();
    for (std::int64_t tick = 0; tick < ticks && rejection == Rejection::none; ++tick) {
        fly_tick([&](std::int64_t number, SpaceFlightRow& row) {
            loop->tick(number, reference, row);
            return plan.at(tick + 1);
        });
        if (rejection == Rejection::none && next_hover != hovers.end() && next_hover->hover.end_tick == tick + 1) {
            next_hover->row = static_cast<std::int64_t>(flight.rows.size());
            if (next_hover->hover.touch) {
                fly_touch(*next_hover);
            }
            ++next_hover;
        }
    }
    // What the controller commands at the end is part of the last row; nothing is flown with it.
    if (flight.rows.empty() || loop->is_within(max_state)) {
        SpaceFlightRow row;
        row.reference = reference;
        row.contact_force_n = contact_force_n;
        loop->look(reference, row);
        loop->describe(row);
        static_cast<void>(recorder.add(row));
    }
    flight.rejection = rejection;
    flight.outcome = outcome_of(rejection);
    flight.energy_j = flight.rows.back().energy_j;
    flight.duration_s = flight.rows.back().t_s;
    if (settings.goals != nullptr) {
        judge_goals(*settings.goals, settings.world, tick_s, hovers, flight);
    }
    if (flight.outcome == Outcome::ok && settings.meets_goal && !meets_further_goal(flight, settings, tick_s)) {
        flight.outcome = Outcome::goal_missed;
    }
    if (flight.outcome == Outcome::ok && settings.energy_budget_j && flight.energy_j > *settings.energy_budget_j) {
        flight.outcome = Outcome::over_budget;
    }
    return flight;
}

}  // namespace downwash

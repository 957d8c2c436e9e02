#include "downwash/simulation/space_flight.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/flight_rules.hpp"
#include "downwash/simulation/goal.hpp"
#include "downwash/simulation/space_flying.hpp"

namespace downwash {
namespace {

using simulation::SpaceLoop;

/// @param none what acts where the settings say nothing; outlives the loop
std::unique_ptr<SpaceLoop> made_loop(const SpaceRobot& robot, const SpaceFlightSettings& settings,
                                     simulation::NoEffectInSpace& none) {
    simulation::SpaceEffect& effect = settings.effect != nullptr ? *settings.effect : none;
    return simulation::make_space_loop({robot, settings.world, effect, settings.aero, settings.is_refined});
}

/// Whether a touch came to its end, as it should or not.
bool is_over(const SpaceTouchRecord& touch) {
    return touch.end != SpaceTouchEnd::cut_short && touch.end != SpaceTouchEnd::too_deep;
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

SpaceFlight fly(const SpaceRobot& robot, const SpacePlan& plan, const SpaceMotion& start,
                const SpaceFlightSettings& settings) {
    assert(!plan.reference.empty() && plan.joints == robot.joints());
    SpaceFlight flight;
    simulation::NoEffectInSpace none;
    const auto loop = made_loop(robot, settings, none);
    loop->start(start, settings.carry);
    const double tick_s = 1 / robot.controller.rate_hz;
    std::vector<FlownHover> hovers;
    if (settings.goals != nullptr) {
        for (SpaceGoalHover& hover : settings.goals->hovers(plan)) {
            hovers.push_back({std::move(hover), -1, -1, {}});
        }
    }
    const std::int64_t ticks =
        hovers.empty() ? plan.reference.back().tick + settings.hold_ticks : hovers.back().hover.end_tick;
    simulation::SpaceFlying flying(robot, settings, *loop, plan.at(0), flight);
    if (settings.settles) {
        flying.settle(start);
    }
    flying.begin();
    const auto goes_on = [&flying] { return flying.rejection() == Rejection::none; };
    auto next_hover = hovers.begin();
    for (std::int64_t tick = 0; tick < ticks && goes_on(); ++tick) {
        flying.tick(plan.at(tick + 1));
        if (!goes_on() || next_hover == hovers.end() || next_hover->hover.end_tick != tick + 1) {
            continue;
        }
        FlownHover& flown = *next_hover++;
        flown.row = flying.ticks();
        if (flown.hover.touch) {
            flown.touch = flying.touch(*flown.hover.touch);
            flown.after_row = is_over(*flown.touch) ? flying.ticks() : -1;
        }
    }
    flying.end();
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

SpaceTouchFlown fly_touch(const SpaceRobot& robot, const SpaceGoalRule& rule, const SpaceGoalHover& hover,
                          const SpacePoint& at, AnySpaceState& vehicle, const SpaceFlightSettings& settings) {
    assert(hover.touch);
    SpaceFlight flight;
    simulation::NoEffectInSpace none;
    const auto loop = made_loop(robot, settings, none);
    loop->take_over(vehicle);
    simulation::SpaceFlying flying(robot, settings, *loop, at, flight);
    flying.begin();
    if (flying.rejection() == Rejection::none) {
        static_cast<void>(flying.touch(*hover.touch));
    }
    const std::int64_t ticks = flying.ticks();
    flying.end();
    vehicle = loop->state();
    if (flight.rejection == Rejection::none) {
        SpaceGoalVisit after;
        after.is_met = true;
        const std::int64_t settling = std::llround(goal_settling_s * robot.controller.rate_hz);
        add_rows(rule, hover, settings.world, flight, ticks, settling, after);
        flight.rejection = after.is_met ? Rejection::none : Rejection::goal_missed;
    }
    return {flight.rejection, ticks};
}

}  // namespace downwash

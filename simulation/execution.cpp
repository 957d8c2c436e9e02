#include "downwash/simulation/execution.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "downwash/base/infinity.hpp"
#include "downwash/base/numbers.hpp"
#include "downwash/dynamics/flight_step.hpp"
#include "downwash/simulation/between_ticks.hpp"
#include "downwash/simulation/direct_field.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "downwash/simulation/flight_recorder.hpp"
#include "downwash/simulation/touch_flight.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

namespace downwash {
namespace {

using simulation::FlightRecorder;
using Given = FlightRecorder::Given;

/// Few: among thousands of obstacles a tick takes milliseconds.
constexpr std::int64_t ticks_between_questions = 8;

constexpr std::string_view outcome_names[] = {"ok",          "collision",  "unstable", "left_flyable_area",
                                              "goal_missed", "over_budget"};

std::vector<ReferenceSegment> segments_with_hold(const std::vector<ReferenceKnot>& knots, std::int64_t hold,
                                                 double tick_s) {
    std::vector<ReferenceSegment> segments;
    for (std::size_t i = 1; i < knots.size(); ++i) {
        segments.emplace_back(knots[i - 1].point, knots[i].point, knots[i].tick - knots[i - 1].tick, tick_s);
    }
    segments.emplace_back(knots.back().point, knots.back().point, hold, tick_s);
    return segments;
}

/// The ticks at which the hovers at the goals end, in their order; fewer when the reference does not come to all of
/// them. The last one is that of the hover after the last knot.
std::vector<std::int64_t> end_ticks(const FlightModel& model, const std::vector<ReferenceKnot>& knots,
                                    std::span<const Goal> goals) {
    std::vector<std::int64_t> ends;
    for (const std::size_t knot : hover_ends(model, knots, goals)) {
        ends.push_back(knots[knot].tick);
    }
    ends.push_back(knots.back().tick + hold_ticks(goals[ends.size()], model, knots.back().point));
    return ends;
}

/// See touches_of(). @param ends see end_ticks()
std::vector<PlannedTouch> touches_after(const FlightModel& model, const std::vector<ReferenceKnot>& knots,
                                        std::span<const Goal> goals, const std::vector<std::int64_t>& ends) {
    std::vector<PlannedTouch> touches;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const bool is_last = i + 1 == ends.size();
        if (is_last && ends.size() < goals.size()) {
            break;  // no hover at a goal
        }
        const ReferencePoint& at =
            (is_last ? knots.back() : *std::ranges::find(knots, ends[i], &ReferenceKnot::tick)).point;
        if (const Touch* const touch = touch_at(goals[i], model.tick().plant, level_at(configuration_of(at)))) {
            touches.push_back({ends[i], i, *touch, at});
        }
    }
    return touches;
}

/// What became of a goal that was held up to a tick; of one that was not, where the flight ended.
/// @param end beyond all rows: it was not
GoalVisit visit_of(const Goal& goal, std::int64_t end, const FlightModel& model, const std::vector<FlightRow>& rows) {
    GoalVisit visit;
    visit.is_met = end < static_cast<std::int64_t>(rows.size());
    const std::int64_t last = visit.is_met ? end : static_cast<std::int64_t>(rows.size()) - 1;
    const std::int64_t settling = visit.is_met ? std::llround(goal_settling_s / model.tick().tick_s) : 0;
    for (std::int64_t i = std::max<std::int64_t>(0, last - settling); i <= last; ++i) {
        const FlightRow& row = rows[static_cast<std::size_t>(i)];
        const GoalError error = goal_error(goal, model.tick().plant, pose_of(row.q));
        const bool is_slow = std::sqrt(row.u[0] * row.u[0] + row.u[1] * row.u[1]) < goal_max_speed_m_s;
        visit.error_m = std::max(visit.error_m, error.distance_m);
        visit.is_met = visit.is_met && is_met(error) && is_slow;
    }
    return visit;
}

/// A touch that was flown.
struct FlownTouch {
    std::size_t goal = 0;
    std::int64_t ticks = 0;
    TouchRecord record;
};

/// @param ends see end_ticks(); touches let the rows of later ones come later
void judge_goals(const FlightModel& model, std::span<const Goal> goals, const std::vector<std::int64_t>& ends,
                 const std::vector<FlownTouch>& touches, Execution& execution) {
    std::int64_t touched = 0;  // ticks
    for (std::size_t i = 0; i < goals.size(); ++i) {
        const std::int64_t end = i < ends.size() ? ends[i] + touched : std::numeric_limits<std::int64_t>::max();
        GoalVisit visit = visit_of(goals[i], end, model, execution.rows);
        const auto touch = std::ranges::find(touches, i, &FlownTouch::goal);
        if (touch != touches.end()) {  // back where it touched from
            touched += touch->ticks;
            const auto last = static_cast<std::int64_t>(execution.rows.size()) - 1;
            const GoalVisit after = visit_of(goals[i], std::min(end + touch->ticks, last), model, execution.rows);
            visit.is_met = visit.is_met && after.is_met && touch->record.is_met;
            visit.error_m = std::max(visit.error_m, after.error_m);
            visit.touch = touch->record;
        }
        execution.goal_error_m = std::max(execution.goal_error_m, visit.error_m);
        if (execution.outcome == Outcome::ok && !visit.is_met) {
            execution.outcome = Outcome::goal_missed;
        }
        execution.goals.push_back(visit);
    }
}

/// One flight with direct aerodynamics, tick by tick, with a row for each.
struct DirectFlight {
    const FlightModel& model;
    const FlownWorld* world;
    std::int64_t first_tick;
    simulation::FlightEffect& effect;
    const StopCondition& is_over;
    FlightRecorder& recorder;
    FlightState state;         ///< vehicle now
    ReferencePoint reference;  ///< now
    std::vector<FlownTouch> touches{};

    /// Flies segments, and the touches that follow at ends of them. @param after see execute_part()
    Rejection fly(std::span<const ReferenceSegment> segments, std::span<const PlannedTouch> after) {
        Rejection rejection = Rejection::none;
        std::int64_t tick = 0;
        for (const ReferenceSegment& segment : segments) {
            rejection = fly(segment);
            tick += segment.ticks();
            const auto touch = std::ranges::find(after, tick, &PlannedTouch::tick);
            if (rejection == Rejection::none && touch != after.end()) {
                rejection = fly(*touch);
            }
            if (rejection != Rejection::none) {
                break;
            }
        }
        return rejection;
    }

 private:
    void ask() const {
        if (recorder.ticks() % ticks_between_questions == 0) {
            throw_if_over(is_over);
        }
    }

    Rejection fly(const ReferenceSegment& segment) {
        const auto after = [&](const FlightState& before, const ReferencePoint& at, const Given& given,
                               const FlightState& next, const ReferencePoint& next_reference) {
            ask();
            reference = next_reference;
            return recorder.after_tick(before, at, given, next, next_reference);
        };
        return simulation::FlightLoop(model.tick(), world, effect)
            .fly(first_tick + recorder.ticks(), segment, state, after, dynamics::RefinedStep{});
    }

    Rejection fly(const PlannedTouch& planned) {
        const auto after = [&](const FlightState& before, const ReferencePoint& at, const Given& given,
                               const FlightState& next, const ReferencePoint& next_reference,
                               const dynamics::ContactTickRecord& contact) {
            ask();
            reference = next_reference;
            return recorder.after_touching_tick(before, at, given, next, next_reference, contact);
        };
        FlownTouch& touch = touches.emplace_back(FlownTouch{planned.goal, -recorder.ticks(), {}});
        recorder.expect(&planned.touch);
        const Rejection rejection =
            simulation::fly_touch_ticks(model, world, first_tick + recorder.ticks(), planned.touch, planned.base,
                                        effect, state, touch.record, after);
        recorder.expect(nullptr);
        touch.ticks += recorder.ticks();
        return rejection;
    }
};

Execution execute_with(const FlightModel& model, const FlightState& start, const std::vector<ReferenceKnot>& knots,
                       std::span<const Goal> goals, bool aero, const FlightWorld& in, const StopCondition& is_over,
                       simulation::FlightEffect& effect) {
    const FlownWorld* const world = flown_world(model, in.world);
    Execution execution;
    execution.aero = aero;
    execution.lateral_m = world != nullptr ? world->lateral_m : 0;
    execution.rotor_count = model.tick().plant.rotor_count;
    execution.has_rotor_lag = model.tick().plant.rotor_time_constant_s > 0;
    execution.min_clearance_m = std::numeric_limits<double>::infinity();

    FlightRecorder recorder(model, world, effect, execution);
    recorder.count_unseen();
    DirectFlight flight{model, world, in.first_tick, effect, is_over, recorder, start, knots.front().point};
    Rejection rejection = recorder.judge(start, knots.front().point, true);
    const std::vector<std::int64_t> ends = end_ticks(model, knots, goals);
    if (rejection == Rejection::none) {
        const std::int64_t hold = ends.back() - knots.back().tick;
        rejection =
            flight.fly(segments_with_hold(knots, hold, model.tick().tick_s), touches_after(model, knots, goals, ends));
    }
    // What the controller commands at the end is part of the last row; nothing is flown with it.
    if (execution.rows.empty() || are_within(flight.state.plant, max_state)) {
        Given given{};
        const simulation::FlightLoop loop(model.tick(), world, effect);
        static_cast<void>(loop.quiet_tick(flight.state, flight.reference, given));
        recorder.add_row(flight.state, flight.reference, given);
    }

    execution.outcome = outcome_of(rejection);
    execution.energy_j = execution.rows.back().energy_j;
    execution.duration_s = execution.rows.back().t_s;
    execution.unseen_share = recorder.unseen_share();
    judge_goals(model, goals, ends, flight.touches, execution);
    return execution;
}

/// What acts on the rotors.
std::unique_ptr<simulation::FlightEffect> effect_of(const FlightModel& model, bool aero) {
    using namespace simulation;
    if (aero && model.has_effects()) {
        return std::make_unique<FlightEffectOf<DirectField>>(DirectField(model));
    }
    return std::make_unique<FlightEffectOf<NoEffect>>(NoEffect{});
}

}  // namespace

std::string_view name_of(Outcome outcome) {
    return outcome_names[static_cast<std::size_t>(outcome)];
}

FlightRules rules_of_execution() {
    FlightRules rules;
    rules.margin_m = 0;
    rules.bounds = {-infinity, infinity, -infinity, infinity};
    rules.max_tracking_error_m = infinity;
    rules.max_arm_error_rad = infinity;
    rules.max_saturation = infinity;
    return rules;
}

Outcome outcome_of(Rejection rejection) {
    switch (rejection) {
        case Rejection::collision:
            return Outcome::collision;
        case Rejection::flyable_area:
            return Outcome::left_flyable_area;
        case Rejection::goal_missed:
            return Outcome::goal_missed;
        case Rejection::over_budget:
            return Outcome::over_budget;
        case Rejection::none:
            return Outcome::ok;
        default:
            return Outcome::unstable;
    }
}

std::int64_t hold_ticks(const Goal& goal, const FlightModel& model, const ReferencePoint& at) {
    const double hold_s = nearest_goal(goal, model.tick().plant, level_at(configuration_of(at))).hold_s;
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(hold_s / model.tick().tick_s - 1e-9)));
}

std::vector<PlannedTouch> touches_of(const FlightModel& model, const std::vector<ReferenceKnot>& knots,
                                     std::span<const Goal> goals) {
    return touches_after(model, knots, goals, end_ticks(model, knots, goals));
}

bool has_touch(const Execution& execution) noexcept {
    return std::ranges::any_of(execution.goals, [](const GoalVisit& visit) { return visit.touch.has_value(); });
}

std::vector<std::size_t> hover_ends(const FlightModel& model, const std::vector<ReferenceKnot>& knots,
                                    std::span<const Goal> goals) {
    std::vector<std::size_t> ends;
    for (std::size_t i = 1; i < knots.size() && ends.size() + 1 < goals.size(); ++i) {
        const Goal& goal = goals[ends.size()];
        const ReferencePoint& point = knots[i].point;
        if (point == knots[i - 1].point && is_at_rest(point) &&
            knots[i].tick - knots[i - 1].tick >= hold_ticks(goal, model, point) &&
            is_met(goal_error(goal, model.tick().plant, level_at(configuration_of(point))))) {
            ends.push_back(i);
        }
    }
    return ends;
}

bool meets_goal(const Goal& goal, const PlantModel& plant, const FlightState& state) {
    const double* u = state.plant.u;
    return is_met(goal_error(goal, plant, pose_of(state))) && std::sqrt(u[0] * u[0] + u[1] * u[1]) < goal_max_speed_m_s;
}

Execution execute(const FlightModel& model, const FlightState& start, const std::vector<ReferenceKnot>& knots,
                  std::span<const Goal> goals, bool aero, const FlightWorld& in, const StopCondition& is_over,
                  std::optional<double> energy_budget_j) {
    assert(!knots.empty() && knots.front().tick == 0 && !goals.empty());
    Execution execution =
        execute_with(model, start, knots, goals, aero && model.has_effects(), in, is_over, *effect_of(model, aero));
    if (execution.outcome == Outcome::ok && energy_budget_j && execution.energy_j > *energy_budget_j) {
        execution.outcome = Outcome::over_budget;
    }
    return execution;
}

FlightPart execute_part(const FlightModel& model, const FlightState& start, std::span<const ReferenceSegment> segments,
                        bool aero, const FlightWorld& in, const StopCondition& is_over,
                        std::span<const PlannedTouch> touches) {
    assert(!segments.empty());
    const FlownWorld* const world = flown_world(model, in.world);
    const std::unique_ptr<simulation::FlightEffect> effect = effect_of(model, aero);
    Execution part;
    part.aero = aero && model.has_effects();
    part.min_clearance_m = std::numeric_limits<double>::infinity();
    FlightRecorder recorder(model, world, *effect, part);
    DirectFlight flight{model, world, in.first_tick, *effect, is_over, recorder, start, segments.front().from()};
    Rejection rejection = recorder.judge(start, segments.front().from(), true);
    if (rejection == Rejection::none) {
        rejection = flight.fly(segments, touches);
    }
    return {rejection, part.min_clearance_m, std::move(flight.state)};
}

std::optional<FlightState> hovering_start(const FlightModel& model, const FlightState& start, bool aero,
                                          const FlightWorld& in) {
    const double* q = start.plant.q;
    const ReferencePoint here = at_rest({q[0], q[1], q[3]});
    const double tick_s = model.tick().tick_s;
    const ReferenceSegment hover(here, here, std::llround(settling_before_start_s / tick_s), tick_s);
    const FlownWorld& world = in.world != nullptr ? *in.world : model.nominal_world();
    const FlownWorld quiet = without_noise(world);
    FlightState state = start;
    state.world = memory_at_start(quiet, start.plant);
    const std::unique_ptr<simulation::FlightEffect> effect = effect_of(model, aero);
    const Rejection rejection = simulation::FlightLoop(model.tick(), &quiet, *effect)
                                    .fly(0, hover, state,
                                         [&](const FlightState&, const ReferencePoint&, const Given&,
                                             const FlightState& next, const ReferencePoint& reference) {
                                             return is_stable(next, reference) ? Rejection::none : Rejection::unstable;
                                         });
    if (rejection != Rejection::none) {
        return std::nullopt;
    }
    state.plant.energy_j = start.plant.energy_j;
    state.world = memory_at_start(world, state.plant);
    return state;
}

}  // namespace downwash

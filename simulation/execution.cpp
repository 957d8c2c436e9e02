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
#include "downwash/simulation/rule_checks.hpp"
#include "downwash/simulation/surroundings.hpp"
#include "downwash/simulation/touch_flight.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

namespace downwash {
namespace {

using Given = controllers::Actuation<double>;

/// Few: among thousands of obstacles a tick takes milliseconds.
constexpr std::int64_t ticks_between_questions = 8;

constexpr std::string_view outcome_names[] = {"ok",          "collision",  "unstable", "left_flyable_area",
                                              "goal_missed", "over_budget"};

/// Writes the log of one flight while it is flown.
class Recorder {
 public:
    /// @param world nullptr: the plain tick
    Recorder(const FlightModel& model, const FlownWorld* world, simulation::FlightEffect& effect, Execution& execution)
        : model_(model),
          plant_(model.tick().plant),
          world_(world),
          surroundings_(world != nullptr ? world->numbers : model.nominal_world().numbers, {}, effect,
                        model.tick().tilt_loss),
          execution_(execution) {}

    /// From here on the vehicle may touch a surface: rows tell the force, and obstacles see the vehicle a little off
    /// it.
    void expect(const Touch& touch) { touch_ = &touch; }

    /// From here on counts the states at which the robot is in unseen space, if the scene has any.
    void count_unseen() {
        if (const std::shared_ptr<const Scene> unseen = model_.scene().unseen_space()) {
            unseen_.emplace(unseen, model_.plane(), model_.robot().shape());
        }
    }
    /// The share of those states in all that were counted; empty without unseen space.
    [[nodiscard]] std::optional<double> unseen_share() const {
        return unseen_ ? std::optional(static_cast<double>(unseen_states_) / static_cast<double>(states_))
                       : std::nullopt;
    }

    /// Flown so far.
    [[nodiscard]] std::int64_t ticks() const noexcept { return tick_; }

    /// @return false if the commands are beyond max_result, and the row holds none
    bool add_row(const FlightState& state, const ReferencePoint& reference, const Given& given) {
        FlightRow row = row_of(state, reference, given);
        const bool is_usable = is_in_range(row) && given.saturation <= max_result;
        if (!is_usable) {
            row = row_of(state, reference, Given{});
        }
        ++tick_;
        execution_.rows.push_back(row);
        execution_.max_saturation = std::max(execution_.max_saturation, is_usable ? given.saturation : max_result);
        return is_usable;
    }

    /// Looks at a new state: what it means for the flight, and for the figures of the whole.
    Rejection judge(const FlightState& state, const ReferencePoint& reference, bool is_first = false) {
        const PlanarPose pose = among_obstacles(pose_of(state), world_);
        clearance_m_ = model_.executed_clearance_m(pose);
        if (unseen_) {
            ++states_;
            unseen_states_ += unseen_->is_nearer_than(pose, 0) ? 1 : 0;
        }
        const PlanarPose checked = touch_ != nullptr ? simulation::off_surface(pose, *touch_, depth_m_) : pose;
        const double checked_m = touch_ != nullptr ? model_.executed_clearance_m(checked) : clearance_m_;
        const PlanarPose checked_before = std::exchange(checked_, checked);
        const double checked_before_m = std::exchange(checked_m_, checked_m);
        if (touch_ == nullptr) {
            execution_.min_clearance_m = std::min(execution_.min_clearance_m, clearance_m_);
        }
        execution_.max_tracking_error_m = std::max(execution_.max_tracking_error_m, tracking_error_m(state, reference));
        if (!is_stable(state, reference)) {
            return Rejection::unstable;
        }
        if (checked_m <= 0) {
            execution_.min_clearance_m = std::min(execution_.min_clearance_m, checked_m);
            return Rejection::collision;
        }
        if (!is_first) {
            const double between_m = simulation::least_clearance_between_m(
                model_, checked_before, checked_before_m, checked, checked_m, simulation::executed_clearance_m);
            if (between_m <= 0) {
                execution_.min_clearance_m = std::min(execution_.min_clearance_m, between_m);
                return Rejection::collision;
            }
        }
        if (execution_.aero && !is_flyable(model_, pose)) {
            return Rejection::flyable_area;
        }
        return Rejection::none;
    }

    /// The same of a tick beside the surface that is touched.
    Rejection after_touching_tick(const FlightState& before, const ReferencePoint& reference, const Given& given,
                                  const FlightState& next, const ReferencePoint& next_reference,
                                  const dynamics::ContactTickRecord& contact) {
        // The row is that of the state before, and of the tick that led to it.
        depth_m_ = contact.depth_m;
        const Rejection rejection = after_tick(before, reference, given, next, next_reference);
        contact_force_n_ = contact.normal_impulse_n_s / model_.tick().tick_s;
        return rejection;
    }

    Rejection after_tick(const FlightState& before, const ReferencePoint& reference, const Given& given,
                         const FlightState& next, const ReferencePoint& next_reference) {
        if (!add_row(before, reference, given) || !are_within(next.plant, max_state)) {
            return Rejection::unstable;
        }
        simulation::add_tick(execution_, plant_, before, next);
        const Rejection rejection = judge(next, next_reference);
        execution_.clearance_integral += model_.tick().tick_s * clearance_density(clearance_m_);
        return rejection;
    }

 private:
    static bool is_in_range(FlightRow row) {
        row.clearance_m = std::isinf(row.clearance_m) ? 0 : row.clearance_m;
        return are_within(row, max_result);
    }

    [[nodiscard]] FlightRow row_of(const FlightState& state, const ReferencePoint& reference, const Given& given) {
        FlightRow row;
        row.t_s = static_cast<double>(tick_) * model_.tick().tick_s;
        row.reference = reference;
        std::copy(std::begin(state.plant.q), std::end(state.plant.q), row.q);
        std::copy(std::begin(state.plant.u), std::end(state.plant.u), row.u);
        const auto attitude = dynamics::attitude(plant_, row.q[2], row.q[3]);
        const bool has_lag = plant_.rotor_time_constant_s > 0;
        const double* thrust_n = has_lag ? state.plant.thrust_n : given.command.thrust_n;
        for (int i = 0; i < plant_.rotor_count; ++i) {
            const auto hub = dynamics::rotor_position(plant_, attitude, row.q[0], row.q[1], i);
            row.rotor_command_n[i] = given.command.thrust_n[i];
            row.rotor_lag_n[i] = state.plant.thrust_n[i];
            row.rotor_factor[i] = surroundings_.thrust_ratio(i, hub, attitude.sin_pitch);
            row.thrust_command_n += row.rotor_command_n[i];
            row.pitch_torque_command_nm -= plant_.rotor_x_m[i] * row.rotor_command_n[i];
            const double free_air_n = surroundings_.thrust_scale(i) * thrust_n[i];
            row.thrust_n += row.rotor_factor[i] * free_air_n;
            row.pitch_torque_nm -= plant_.rotor_x_m[i] * row.rotor_factor[i] * free_air_n;
        }
        row.arm_torque_nm = given.command.joint_torque_nm;
        row.clearance_m = clearance_m_;
        const auto tip = dynamics::end_effector_position(plant_, attitude, row.q[0], row.q[1]);
        row.end_effector_x_m = tip.x;
        row.end_effector_z_m = tip.z;
        row.power_w = dynamics::rotor_power(plant_, thrust_n) + std::abs(row.arm_torque_nm * row.u[3]);
        row.energy_j = state.plant.energy_j;
        row.contact_force_n = contact_force_n_;
        return row;
    }

    const FlightModel& model_;
    const PlantModel& plant_;
    const FlownWorld* world_;
    simulation::WorldSurroundings<double, simulation::FlightEffect> surroundings_;
    Execution& execution_;
    std::optional<CollisionChecker> unseen_;  ///< the robot in unseen space
    std::int64_t states_ = 0, unseen_states_ = 0;
    std::int64_t tick_ = 0;
    double clearance_m_ = std::numeric_limits<double>::infinity();
    PlanarPose checked_;    ///< for collisions, at the last state
    double checked_m_ = 0;  ///< its clearance
    const Touch* touch_ = nullptr;
    double depth_m_ = 0;          ///< of the deepest point in the surface that is touched, at the last state
    double contact_force_n_ = 0;  ///< over the last tick
};

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

/// @param ends see end_ticks()
void judge_goals(const FlightModel& model, std::span<const Goal> goals, const std::vector<std::int64_t>& ends,
                 Execution& execution) {
    for (std::size_t i = 0; i < goals.size(); ++i) {
        const std::int64_t end = i < ends.size() ? ends[i] : std::numeric_limits<std::int64_t>::max();
        GoalVisit visit = visit_of(goals[i], end, model, execution.rows);
        if (execution.touch && i + 1 == goals.size()) {  // back where it touched from
            const auto last = static_cast<std::int64_t>(execution.rows.size()) - 1;
            const GoalVisit after = visit_of(goals[i], last, model, execution.rows);
            visit.is_met = visit.is_met && after.is_met && execution.touch->is_met;
            visit.error_m = std::max(visit.error_m, after.error_m);
        }
        execution.goal_error_m = std::max(execution.goal_error_m, visit.error_m);
        if (execution.outcome == Outcome::ok && !visit.is_met) {
            execution.outcome = Outcome::goal_missed;
        }
        execution.goals.push_back(visit);
    }
}

/// Flies a segment tick by tick, with a row for each.
/// @param state at its beginning, replaced by that at its end
Rejection fly_directly(const FlightModel& model, const FlownWorld* world, std::int64_t first_tick,
                       const ReferenceSegment& segment, simulation::FlightEffect& effect, const StopCondition& is_over,
                       FlightState& state, Recorder& recorder) {
    const auto after = [&](const FlightState& before, const ReferencePoint& at, const Given& given,
                           const FlightState& next, const ReferencePoint& next_reference) {
        if (recorder.ticks() % ticks_between_questions == 0) {
            throw_if_over(is_over);
        }
        return recorder.after_tick(before, at, given, next, next_reference);
    };
    return simulation::FlightLoop(model.tick(), world, effect)
        .fly(first_tick + recorder.ticks(), segment, state, after, dynamics::RefinedStep{});
}

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

    Recorder recorder(model, world, effect, execution);
    recorder.count_unseen();
    const simulation::FlightLoop loop(model.tick(), world, effect);
    FlightState state = start;
    ReferencePoint reference = knots.front().point;
    Rejection rejection = recorder.judge(state, reference, true);
    const std::vector<std::int64_t> ends = end_ticks(model, knots, goals);
    const std::int64_t hold = ends.back() - knots.back().tick;
    for (const ReferenceSegment& segment : segments_with_hold(knots, hold, model.tick().tick_s)) {
        if (rejection != Rejection::none) {
            break;
        }
        const std::int64_t begin = recorder.ticks();
        rejection = fly_directly(model, world, in.first_tick, segment, effect, is_over, state, recorder);
        reference = segment.at_tick(recorder.ticks() - begin);
    }
    const Touch* const touch = ends.size() == goals.size()
                                   ? touch_at(goals.back(), model.tick().plant, level_at(configuration_of(reference)))
                                   : nullptr;
    if (touch != nullptr && rejection == Rejection::none) {
        recorder.expect(*touch);
        execution.touch.emplace();
        rejection = simulation::fly_touch_ticks(
            model, world, in.first_tick + recorder.ticks(), *touch, reference, effect, state, *execution.touch,
            [&](const FlightState& before, const ReferencePoint& at, const Given& given, const FlightState& next,
                const ReferencePoint& next_reference, const dynamics::ContactTickRecord& contact) {
                if (recorder.ticks() % ticks_between_questions == 0) {
                    throw_if_over(is_over);
                }
                reference = next_reference;
                return recorder.after_touching_tick(before, at, given, next, next_reference, contact);
            });
    }
    // What the controller commands at the end is part of the last row; nothing is flown with it.
    if (execution.rows.empty() || are_within(state.plant, max_state)) {
        Given given{};
        static_cast<void>(loop.quiet_tick(state, reference, given));
        recorder.add_row(state, reference, given);
    }

    execution.outcome = outcome_of(rejection);
    execution.energy_j = execution.rows.back().energy_j;
    execution.duration_s = execution.rows.back().t_s;
    execution.unseen_share = recorder.unseen_share();
    judge_goals(model, goals, ends, execution);
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
                        bool aero, const FlightWorld& in, const StopCondition& is_over) {
    assert(!segments.empty());
    const FlownWorld* const world = flown_world(model, in.world);
    const std::unique_ptr<simulation::FlightEffect> effect = effect_of(model, aero);
    Execution part;
    part.aero = aero && model.has_effects();
    part.min_clearance_m = std::numeric_limits<double>::infinity();
    Recorder recorder(model, world, *effect, part);
    FlightState state = start;
    Rejection rejection = recorder.judge(state, segments.front().from(), true);
    for (const ReferenceSegment& segment : segments) {
        if (rejection != Rejection::none) {
            break;
        }
        rejection = fly_directly(model, world, in.first_tick, segment, *effect, is_over, state, recorder);
    }
    return {rejection, part.min_clearance_m, std::move(state)};
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

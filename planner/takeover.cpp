#include "downwash/planner/takeover.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/controllers/space_segment.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash {
namespace {

bool is_same_contact(const ContactGoal& a, const ContactGoal& b) {
    return a.obstacle == b.obstacle && a.force_n == b.force_n && a.part == b.part && a.x_m == b.x_m && a.z_m == b.z_m;
}

/// Whether two goals ask for the same, of whatever kind: they are as far from any vehicle, and allow as much. Of a
/// contact the places to make it from belong to the scene.
bool is_same_goal(const Goal& a, const Goal& b, const PlantModel& plant) {
    if (asks_for_contact(a) && asks_for_contact(b)) {
        return is_same_contact(std::get<ContactGoal>(a.kind), std::get<ContactGoal>(b.kind));
    }
    if (a.kind.index() != b.kind.index() || a.any_of.size() != b.any_of.size()) {
        return false;
    }
    if (!a.any_of.empty()) {
        return std::ranges::equal(a.any_of, b.any_of,
                                  [&](const Goal& one, const Goal& other) { return is_same_goal(one, other, plant); });
    }
    const auto is_as_far = [&](const PlanarPose& pose) {
        const GoalDeviation one = goal_deviation(a, plant, pose), other = goal_deviation(b, plant, pose);
        return one.x_m == other.x_m && one.z_m == other.z_m && one.angle_rad == other.angle_rad;
    };
    const GoalTolerance one = tolerance_of(a), other = tolerance_of(b);
    return a.hold_s == b.hold_s && one.x_m == other.x_m && one.z_m == other.z_m && one.is_disc == other.is_disc &&
           one.angle_rad == other.angle_rad && is_as_far({0, 0, 0, 0}) && is_as_far({10, 7, 0, 1});
}

[[noreturn]] void throw_failed_before() {
    throw_input_error(
        "fails before the moment from which to plan again: expected a plan that flies so far; `downwash execute` shows "
        "how its flight ends",
        "plan");
}

/// Only the rate of the controller that flies makes the same ticks.
void require_same_rate(double rate_hz, double tick_s) {
    const double flown_hz = 1 / tick_s;
    if (std::abs(rate_hz - flown_hz) > 1e-6 * flown_hz) {
        throw_input_error(
            "is " + to_text(rate_hz) + ": expected " + to_text(flown_hz, 6) + ", that of the robot that flies",
            "robot.controller.rate_hz");
    }
}

void spend(std::optional<double>& budget_j, double energy_j) {
    if (!budget_j) {
        return;
    }
    *budget_j -= energy_j;
    if (!(*budget_j > 0)) {
        throw_input_error(
            "is spent before this moment: the plan has taken " + to_text(energy_j, 6) + " J by then: expected more",
            "goal.energy_budget_j");
    }
}

/// The goal that is left where no target is.
template <class AnyGoal>
AnyGoal what_targets_leave(const std::optional<AnyGoal>& return_to) {
    if (!return_to) {
        throw_input_error("has no target that was not visited before: nothing is left to plan", "goal");
    }
    return *return_to;
}

template <class AnyPlan>
double same_reference(const AnyPlan& plan, const AnyPlan& other) {
    if (plan.reference.empty() || other.reference.empty()) {
        return 0;
    }
    const std::int64_t end = std::max(plan.reference.back().tick, other.reference.back().tick);
    std::int64_t tick = 0;
    while (tick <= end && plan.at(tick) == other.at(tick)) {
        ++tick;
    }
    return static_cast<double>(std::max<std::int64_t>(0, tick - 1)) * plan.tick_s;
}

}  // namespace

Takeover take_over(const Problem& flown, const Plan& plan, const std::optional<VisitOrder>& order, std::int64_t tick) {
    const auto model = make_flight_model(flown);
    Takeover from;
    from.tick = tick;
    from.start = flown.start;
    from.rest = plan.rest_after(tick);
    const std::vector<Goal> goals = goals_of(in_order(flown, order));
    if (tick > 0) {
        std::vector<PlannedTouch> touches = touches_of(*model, plan.reference, goals);
        std::erase_if(touches, [tick](const PlannedTouch& touch) { return touch.tick > tick; });
        const FlightPart part = execute_part(*model, start_state(*model, flown.start), plan.beginning(tick).segments(),
                                             flown.aero.enabled, {}, {}, touches);
        if (part.rejection != Rejection::none) {
            throw_failed_before();
        }
        from.start = start_of(*model, part.end, plan.at(tick));
        from.energy_j = part.end.plant.energy_j;
    }
    for (const std::size_t knot : hover_ends(*model, plan.reference, goals)) {
        if (plan.reference[knot].tick <= tick && from.visited.size() + 1 < goals.size()) {
            const std::size_t next = from.visited.size();
            const bool is_target = order && !flown.targets.empty() && next < order->visits.size();
            from.visited.push_back(is_target ? flown.targets[order->visits[next].target] : goals[next]);
        }
    }
    from.left.assign(goals.begin() + static_cast<std::ptrdiff_t>(from.visited.size()), goals.end());
    return from;
}

Problem remaining(const Takeover& from, Problem changed) {
    require_same_rate(changed.robot.controller.rate_hz, from.rest.tick_s);
    changed.start = from.start;
    const bool had_targets = !changed.targets.empty();
    spend(changed.energy_budget_j, from.energy_j);
    const PlantModel plant = make_plant_model(changed.robot.multirotor, changed.robot.arm, changed.robot.rotors);
    for (const Goal& visited : from.visited) {
        const auto is_it = [&](const Goal& goal) { return is_same_goal(goal, visited, plant); };
        if (const auto target = std::ranges::find_if(changed.targets, is_it); target != changed.targets.end()) {
            changed.targets.erase(target);
        } else if (!changed.goals_before.empty() && is_it(changed.goals_before.front())) {
            changed.goals_before.erase(changed.goals_before.begin());
        }
    }
    if (had_targets && changed.targets.empty()) {
        changed.goal = what_targets_leave(changed.return_to);
        changed.return_to.reset();
        changed.energy_budget_j.reset();  // of targets only
    }
    return changed;
}

TakeoverOf<planning::Space> take_over(const SpaceProblem& flown, const SpacePlan& plan,
                                      const std::optional<VisitOrder>& order, std::int64_t tick) {
    const SpaceProblemModel model(in_order(flown, order));
    TakeoverOf<planning::Space> from;
    from.tick = tick;
    from.start = flown.start;
    from.rest = plan.rest_after(tick);
    if (tick > 0) {
        const SpaceFlight flight = model.execute_part(plan.beginning(tick));
        if (flight.rejection != Rejection::none) {
            throw_failed_before();
        }
        from.start = start_of(model, flight.end, plan.at(tick));
        from.energy_j = flight.energy_j;
    }
    const std::vector<SpaceGoal> goals = goals_of(model.problem());
    std::vector<bool> is_visited(goals.size());
    for (const SpaceGoalHover& hover : model.goals().hovers(plan)) {
        if (hover.end_tick > tick || from.visited.size() + 1 == goals.size()) {
            continue;
        }
        const std::size_t next = from.visited.size();
        const bool is_target = order && !targets_of(flown).empty() && next < order->visits.size();
        is_visited[hover.goal] = true;
        from.visited.push_back(is_target ? flown.goals[order->visits[next].target] : goals[hover.goal]);
    }
    for (std::size_t goal = 0; goal < goals.size(); ++goal) {
        if (!is_visited[goal]) {
            from.left.push_back(goals[goal]);
        }
    }
    return from;
}

SpaceProblem remaining(const TakeoverOf<planning::Space>& from, SpaceProblem changed) {
    require_same_rate(changed.robot.controller.rate_hz, from.rest.tick_s);
    changed.start = from.start;
    spend(changed.energy_budget_j, from.energy_j);
    const bool are_targets = changed.in_any_order;
    for (const SpaceGoal& visited : from.visited) {
        std::vector<SpaceGoal>& goals = changed.goals;
        const auto end = are_targets || goals.empty() ? goals.end() : goals.begin() + 1;
        const auto goal = std::find(goals.begin(), end, visited);
        if (goal != end && (are_targets || goals.size() > 1)) {
            goals.erase(goal);
        }
    }
    if (are_targets && changed.goals.empty()) {
        changed.goals = {what_targets_leave(changed.return_to)};
        changed.in_any_order = false;
        changed.return_to.reset();
        changed.energy_budget_j.reset();  // of targets only
    }
    return changed;
}

double same_reference_s(const Plan& plan, const Plan& other) {
    return same_reference(plan, other);
}
double same_reference_s(const SpacePlan& plan, const SpacePlan& other) {
    return same_reference(plan, other);
}

}  // namespace downwash

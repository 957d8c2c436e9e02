#include "downwash/planner/family_parts.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "downwash/planner/found.hpp"
#include "downwash/planner/stopwatch.hpp"
#include "downwash/search/obstacle_labels.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/space_pool.hpp"
#include "downwash/simulation/touch.hpp"

namespace downwash::planning {
namespace {

constexpr const char* flies_otherwise = "a part of a plan does not fly as it was planned";

}  // namespace

Problem part_of(const Problem& problem, const Goal& goal, const Plan& before) {
    Problem part = problem;
    part.targets.clear();
    part.return_to.reset();
    part.goals_before.clear();
    part.goal = goal;
    if (!before.reference.empty()) {
        part.start = Start::resting_at(before.last());
    }
    return part;
}

SpaceProblem part_of(const SpaceProblem& problem, const SpaceGoal& goal, const SpacePlan& before) {
    SpaceProblem part = problem;
    part.goals = {goal};
    part.in_any_order = false;
    part.return_to.reset();
    if (!before.reference.empty()) {
        part.start = start_at(problem, end_of(before));
    }
    return part;
}

SpaceStart start_at(const SpaceProblem& problem, const SpaceConfiguration& at) {
    SpaceStart start;
    std::copy_n(at.coordinate.begin(), 3, start.position_m.begin());
    start.yaw_rad = at[space::yaw];
    const auto first = at.coordinate.begin() + space::first_joint;
    start.joints_rad.assign(first, first + problem.robot.joints());
    return start;
}

SpacePlan with_hover(const SpacePlan& plan, const SpaceGoal& goal, const SpaceProblemModel& model) {
    const SpaceGoalRule rule(model.problem().robot, model.shared_scene(), {goal});
    return plan.held_for(rule.hovers(plan).front().end_tick - plan.reference.back().tick);
}

FlightState flown_on(const PlannerModel& model, const Plan& plan, std::size_t first, const Goal& goal,
                     FlightState vehicle) {
    for (std::size_t knot = first + 1; knot < plan.reference.size(); ++knot) {
        const SegmentFlight flight =
            fly(*model.flight, model.own_map.get(), rules_of_execution(), plan.segment_to(knot), vehicle);
        if (flight.rejection != Rejection::none) {
            throw std::logic_error(flies_otherwise);
        }
    }
    const ReferencePoint& last = plan.reference.back().point;
    const Touch* const touch = touch_at(goal, model.flight->tick().plant, level_at(configuration_of(last)));
    if (touch == nullptr) {
        return vehicle;
    }
    FlightState after = vehicle;
    const TouchFlight flown = downwash::fly_touch(*model.flight, model.own_map.get(), *touch, last, after);
    return flown.rejection == Rejection::none ? after : vehicle;
}

SpaceTouchFlown fly_touch(const SpaceProblemModel& model, const SurfaceVolumes* map, const SpaceGoalRule& rule,
                          const SpaceGoalHover& hover, const SpacePoint& at, const SpaceWorld* world,
                          std::int64_t first_tick, AnySpaceState& vehicle, const StopCondition& is_over) {
    const SpaceProblem& problem = model.problem();
    SpaceFlightSettings settings;
    std::optional<simulation::VolumeSpaceEffect> effect;
    if (map != nullptr) {
        settings.effect = &effect.emplace(*map, problem.robot);
        settings.aero = simulation::space_aero(problem.aero, problem.robot.rotor_radius_m);
    }
    settings.checker = &model.collisions();
    settings.world = world != nullptr ? *world : SpaceWorld{};
    settings.first_tick = first_tick;
    settings.measures_clearance = false;
    settings.is_refined = false;
    settings.is_over = is_over;
    return downwash::fly_touch(problem.robot, rule, hover, at, vehicle, settings);
}

AnySpaceState flown_on(const PlannerModelOf<Space>& model, const SpacePlan& plan, std::size_t first,
                       const SpaceGoal& goal, const AnySpaceState& vehicle) {
    const SpaceProblem& problem = model.flight->problem();
    SpacePoolSetup setup{problem.robot};
    if (model.own_map != nullptr) {
        setup.aero = simulation::space_aero(problem.aero, problem.robot.rotor_radius_m);
        setup.volumes = model.own_map.get();
    }
    setup.checker = &model.flight->collisions();
    SpaceFlightJob job{vehicle, {}};
    for (std::size_t knot = first + 1; knot < plan.reference.size(); ++knot) {
        job.legs.push_back({plan.segment_to(knot)});
    }
    if (job.legs.empty()) {
        return vehicle;
    }
    SpacePool(setup).fly(std::span(&job, 1));
    if (job.rejection() != Rejection::none) {
        throw std::logic_error(flies_otherwise);
    }
    const SpaceGoalRule rule(problem.robot, model.flight->shared_scene(), {goal});
    const SpaceKnot& last = plan.reference.back();
    const SpaceGoalHover hover = rule.hover_at(0, last.point);
    if (!hover.touch) {
        return job.end();
    }
    AnySpaceState after = job.end();
    const SpaceTouchFlown touch =
        fly_touch(*model.flight, model.own_map.get(), rule, hover, last.point, nullptr, last.tick, after);
    return touch.rejection == Rejection::none ? after : job.end();
}

DirectFlightOf<Space> fly_directly(const SpaceProblemModel& model, const AnySpaceState& start, const SpacePlan& plan,
                                   const std::vector<SpaceGoal>& goals, std::optional<double> /*energy_budget_j*/,
                                   const StopCondition& is_over) {
    const Stopwatch clock;
    const SpaceGoalRule rule(model.problem().robot, model.shared_scene(), goals);
    SpaceExecutionSettings settings;
    settings.goals = &rule;
    settings.start = start;
    settings.is_over = is_over;
    SpaceFlight execution = model.execute(plan, settings);
    return {std::move(execution), clock.seconds()};
}

bool is_good(const SpaceFlight& flight, double safety_margin_m) {
    return flight.outcome == Outcome::ok && flight.min_clearance_m >= safety_margin_m;
}

double cost_when_executed(const Execution& flight, const CostFunction& objective) {
    return cost_of(flight, objective);
}

double cost_when_executed(const SpaceFlight& flight, const CostFunction& objective) {
    return cost_of(flight, objective);
}

Obstruction obstruction_of(const Execution& flight, const SearchTask& task) {
    if (flight.outcome == Outcome::over_budget) {
        return {std::string(name_of(flight.outcome)), configuration_of(flight.rows.back().q), 0};
    }
    const auto nearest =
        std::min_element(flight.rows.begin(), flight.rows.end(),
                         [](const FlightRow& a, const FlightRow& b) { return a.clearance_m < b.clearance_m; });
    const bool is_too_near = flight.outcome == Outcome::ok || flight.outcome == Outcome::collision;
    const double(&q)[4] = (is_too_near ? *nearest : flight.rows.back()).q;
    const bool is_by_obstacle = is_too_near || flight.outcome == Outcome::left_flyable_area;
    return {"direct_flight", configuration_of(q), task.space.goal_distance_m(configuration_of(q)),
            is_by_obstacle ? obstacles_near(task.model, pose_of(q)) : std::vector<std::string>()};
}

SpaceObstruction obstruction_of(const SpaceFlight& flight, const SearchTaskOf<Space>& task) {
    if (flight.outcome == Outcome::over_budget) {
        return {std::string(name_of(flight.outcome)), configuration_of(flight.rows.back().motion), 0};
    }
    const auto nearest = std::ranges::min_element(flight.rows, {}, &SpaceFlightRow::clearance_m);
    const bool is_too_near = flight.outcome == Outcome::ok || flight.outcome == Outcome::collision;
    const SpaceMotion& motion = (is_too_near ? *nearest : flight.rows.back()).motion;
    const bool is_by_obstacle = is_too_near || flight.outcome == Outcome::left_flyable_area;
    const SpaceConfiguration at = configuration_of(motion);
    return {"direct_flight", at, task.space.goal_distance_m(at),
            is_by_obstacle ? obstacles_near(task.model, among_obstacles(motion, {})) : std::vector<std::string>()};
}

}  // namespace downwash::planning

#include "downwash/planner/planner_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/aeromap/map_cache.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/planner/space_worlds.hpp"
#include "downwash/planner/world_flights.hpp"
#include "downwash/problems/space_problem_parameters.hpp"
#include "downwash/problems/touch_places.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::planning {

CheckedOf<Plane> checked(const Problem& problem) {
    PlannableProblem plan = plannable(problem);
    return {std::move(plan.problem), std::move(plan.model)};
}

CheckedOf<Space> checked(const SpaceProblem& problem) {
    throw_if_any(errors_of(problem));
    return {problem, std::make_shared<const SpaceProblemModel>(problem)};
}

std::vector<KeyError> errors_of(const Problem& problem) {
    return problem_errors(problem);
}

std::vector<KeyError> errors_of(const SpaceProblem& problem) {
    std::vector<KeyError> errors = space_problem_errors(problem);
    return errors.empty() ? space_planning_errors(problem) : errors;
}

namespace {

std::vector<KeyError> without_start(std::vector<KeyError> errors) {
    std::erase_if(errors, [](const KeyError& error) { return error.key.starts_with("start"); });
    return errors;
}

}  // namespace

std::vector<KeyError> errors_beside_start(const Problem& problem) {
    return without_start(problem_errors(problem));
}

std::vector<KeyError> errors_beside_start(const SpaceProblem& problem) {
    WrongKeys start;  // what depends on it is not looked at: that takes milliseconds
    start.add("start");
    std::vector<KeyError> errors = without_start(further_space_problem_errors(problem, std::move(start)));
    return errors.empty() ? space_planning_errors(problem) : errors;
}

std::shared_ptr<const FlightModel> model_of(const Problem& problem, const std::shared_ptr<const FlightModel>& same) {
    return same != nullptr ? same : make_flight_model(problem);
}

std::shared_ptr<const SpaceProblemModel> model_of(const SpaceProblem& problem,
                                                  const std::shared_ptr<const SpaceProblemModel>& same) {
    return same != nullptr ? std::make_shared<const SpaceProblemModel>(problem, *same)
                           : std::make_shared<const SpaceProblemModel>(problem);
}

Solution solved(const Problem& problem, const std::shared_ptr<const FlightModel>& model, const SolveOptions& options) {
    return downwash::solve(PlannableProblem{problem, model}, options);
}

SpaceSearchResult solved(const SpaceProblem& problem, const std::shared_ptr<const SpaceProblemModel>& model,
                         const SpaceSolveOptions& options) {
    return downwash::solve(model_of(problem, model), options);
}

void take_order(Problem& problem, const Solution& solution) {
    problem = in_order(std::move(problem), solution.order);
    problem.energy_budget_j.reset();  // how much of it a vehicle has left, it knows itself
}

void take_order(SpaceProblem& problem, const SpaceSearchResult& solution) {
    problem = in_order(std::move(problem), solution.order);
    problem.energy_budget_j.reset();
}

void set_goal(Problem& problem, const Goal& goal) {
    problem.goals_before.clear();
    problem.targets.clear();
    problem.return_to.reset();
    problem.energy_budget_j.reset();
    problem.goal = goal;
}

void set_goal(SpaceProblem& problem, const SpaceGoal& goal) {
    problem.goals = {goal};
    problem.in_any_order = false;
    problem.return_to.reset();
    problem.energy_budget_j.reset();
}

Problem with_places(Problem problem) {
    return with_touches(std::move(problem));
}

void drop_visited(Problem& problem, const FlightModel& model, const Plan& plan, std::int64_t tick) {
    if (problem.goals_before.empty()) {
        return;
    }
    const std::vector<std::size_t> ends = hover_ends(model, plan.reference, goals_of(problem));
    const auto visited =
        std::count_if(ends.begin(), ends.end(), [&](std::size_t knot) { return plan.reference[knot].tick <= tick; });
    problem.goals_before.erase(
        problem.goals_before.begin(),
        problem.goals_before.begin() + std::min<std::ptrdiff_t>(visited, std::ssize(problem.goals_before)));
}

void drop_visited(SpaceProblem& problem, const SpaceProblemModel& model, const SpacePlan& plan, std::int64_t tick) {
    if (problem.goals.size() == 1) {
        return;
    }
    const std::vector<SpaceGoalHover> hovers = model.goals().hovers(plan);
    const auto visited =
        std::ranges::count_if(hovers, [&](const SpaceGoalHover& hover) { return hover.end_tick <= tick; });
    problem.goals.erase(problem.goals.begin(),
                        problem.goals.begin() + std::min<std::ptrdiff_t>(visited, std::ssize(problem.goals) - 1));
}

bool is_finite(const Start& start) {
    const ReferencePoint reference = start.reference.value_or(ReferencePoint{});
    double sum = start.pitch_rad + start.pitch_rate_rad_s;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        sum += start.at[axis] + start.velocity[axis];
        sum += reference.position[axis] + reference.velocity[axis] + reference.acceleration[axis];
    }
    return std::isfinite(sum);
}

bool is_finite(const SpaceStart& start) {
    const SpaceMotion motion = start_motion(start);
    double sum = start.yaw_rad;
    const auto add = [&sum](const auto& numbers) {
        for (const double number : numbers) {
            sum += number;
        }
    };
    add(motion.position_m);
    add(motion.attitude);
    add(motion.joints_rad);
    add(motion.velocity_m_s);
    add(motion.body_rates_rad_s);
    add(motion.joint_rates_rad_s);
    return std::isfinite(sum);
}

Execution executed(const Problem& problem, const FlightModel& model, const Plan& plan) {
    return execute(model, start_state(model, problem.start), plan.reference, goals_of(problem), problem.aero.enabled);
}

SpaceFlight executed(const SpaceProblem& /*problem*/, const SpaceProblemModel& model, const SpacePlan& plan) {
    return model.execute(plan);
}

bool survives(const Problem& problem, const PlannerModelOf<Plane>& model, int threads, const Plan& plan,
              std::span<const FlownWorld> worlds, const StopCondition& is_over) {
    WorldFlights flights(problem, model.flight, model.true_map, threads);
    return std::ranges::all_of(flights.fly(plan, goals_of(problem).size(), worlds, is_over),
                               [](const WorldFlight& each) { return each.rejection == Rejection::none; });
}

bool survives(const SpaceProblem& problem, const PlannerModelOf<Space>& model, int threads, const SpacePlan& plan,
              std::span<const SpaceWorld> worlds, const StopCondition& is_over) {
    return std::ranges::all_of(SpaceProblemWorlds(problem, model, threads).fly(plan, worlds, is_over),
                               [](const WorldSample& each) { return each.outcome == Outcome::ok; });
}

std::shared_ptr<const AeroMap> map_after(const Problem& problem, const FlightModel& model,
                                         const std::shared_ptr<const AeroMap>& map,
                                         const std::vector<BoundingBox>& unmapped, const std::filesystem::path& cache) {
    return map ? model.remake_map(*map, unmapped) : model.make_map(problem.bounds, cache);
}

std::shared_ptr<const SurfaceVolumes> map_after(const SpaceProblem& /*problem*/, const SpaceProblemModel& model,
                                                const std::shared_ptr<const SurfaceVolumes>& volumes,
                                                const std::vector<BoundingBox>& /*unmapped*/,
                                                const std::filesystem::path& cache) {
    return make_volumes(model, volumes ? std::filesystem::path() : cache);
}

BrakingPartsOf<Plane>::MapAround map_around(const Problem& problem, const FlightModel& model,
                                            const std::shared_ptr<const AeroMap>& map,
                                            const std::vector<BoundingBox>& unmapped) {
    return [&](const Bounds& places) -> std::shared_ptr<const AeroMap> {
        if (!problem.aero.enabled) {
            return nullptr;
        }
        if (map && !map->is_touched(unmapped, rotor_extent(problem.robot.rotors, places))) {
            return map;
        }
        return model.make_map(places);
    };
}

BrakingPartsOf<Space>::MapAround map_around(const SpaceProblem& problem, const SpaceProblemModel& model,
                                            const std::shared_ptr<const SurfaceVolumes>& volumes,
                                            const std::vector<BoundingBox>& unmapped) {
    return [&]() -> std::shared_ptr<const SurfaceVolumes> {
        if (!has_surface_effects(problem)) {
            return nullptr;
        }
        return volumes && unmapped.empty() ? volumes : make_volumes(model);
    };
}

void keep(const std::filesystem::path& cache, const AeroMap& map) {
    keep_map(cache, map);
}

void keep(const std::filesystem::path& cache, const SurfaceVolumes& volumes) {
    volumes.keep(cache);
}

}  // namespace downwash::planning

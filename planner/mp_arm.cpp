#include "downwash/planner/mp_arm.hpp"

#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>

#include <algorithm>
#include <cmath>

#include "downwash/planner/free_air_cost.hpp"
#include "downwash/planner/ompl_space.hpp"
#include "downwash/planner/quiet_ompl.hpp"

namespace downwash::planning {
namespace {

namespace ob = ompl::base;

/// OMPL's RRT* with a generator of its own seed, and an exact neighbour search that draws no random numbers.
class SeededRrtStar : public ompl::geometric::RRTstar {
 public:
    SeededRrtStar(const ob::SpaceInformationPtr& information, std::uint32_t seed)
        : ompl::geometric::RRTstar(information) {
        rng_.setLocalSeed(seed);
        setNearestNeighbors<ompl::NearestNeighborsLinear>();
    }

    [[nodiscard]] std::size_t nodes() const { return nn_ ? nn_->size() : 0; }
};

/// Straight motions, and the hold as part of every motion that arrives at the goal.
class GeometricObjective : public ob::OptimizationObjective {
 public:
    GeometricObjective(const ob::SpaceInformationPtr& information, const FreeAirCost& cost, const SearchSpace& space,
                       double hold_s)
        : ob::OptimizationObjective(information), free_air_cost_(cost), space_(space), hold_s_(hold_s) {}

    bool isSymmetric() const override { return false; }
    ob::Cost stateCost(const ob::State*) const override { return identityCost(); }
    ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
        const Configuration end = read(to, space_);
        const double hold = space_.is_near_goal(end) ? free_air_cost_.of_hold(end, hold_s_) : 0;
        return ob::Cost(free_air_cost_.of_motion(read(from, space_), end) + hold);
    }

 private:
    const FreeAirCost& free_air_cost_;
    const SearchSpace& space_;
    double hold_s_;
};

std::vector<Waypoint> unwrapped(const ompl::geometric::PathGeometric& path, const SearchSpace& space,
                                const Configuration& start) {
    std::vector<Waypoint> waypoints;
    Configuration last = start;
    for (std::size_t i = 0; i < path.getStateCount(); ++i) {
        last = i == 0 ? start : space.seen_from(last, read(path.getState(static_cast<unsigned int>(i)), space));
        waypoints.push_back({last.x_m, last.z_m, last.arm_rad});
    }
    return waypoints;
}

double cost_of(const std::vector<Waypoint>& waypoints, const FreeAirCost& cost, double hold_s) {
    double sum = 0;
    const auto at = [&](std::size_t i) {
        return Configuration{waypoints[i].x_m, waypoints[i].z_m, waypoints[i].arm_rad};
    };
    for (std::size_t i = 1; i < waypoints.size(); ++i) {
        sum += cost.of_motion(at(i - 1), at(i));
    }
    return sum + cost.of_hold(at(waypoints.size() - 1), hold_s);
}

}  // namespace

Plan timed_plan(const std::vector<Waypoint>& waypoints, const ReferencePoint& start, const ReferenceLimits& limits,
                double tick_s) {
    Plan plan;
    plan.tick_s = tick_s;
    plan.waypoints = waypoints;
    plan.reference.push_back({0, start});
    for (std::size_t i = 1; i < waypoints.size(); ++i) {
        ReferencePoint next;
        next.position[0] = waypoints[i].x_m;
        next.position[1] = waypoints[i].z_m;
        next.position[2] = waypoints[i].arm_rad;
        const ReferenceKnot& last = plan.reference.back();
        plan.reference.push_back({last.tick + shortest_ticks(last.point, next, limits, tick_s), next});
    }
    return plan;
}

GeometricResult plan_geometrically(const Problem& problem, const FlightModel& model, const SearchSpace& space,
                                   Random& random, const GeometricHooks& hooks) {
    const QuietOmpl quiet;
    QueryCounts counts;
    // A motion is checked so densely that the margin covers what happens between two checks; without a margin a corner
    // may be cut by 2.5 mm.
    const double step_m = std::clamp(2 * problem.planner.safety_margin_m, 0.005, 0.1);
    const auto information = make_space_information(space, random, step_m, counts);
    const FreeAirCost free_air_cost(problem, model, space);
    const Configuration start{problem.start.x_m, problem.start.z_m, problem.start.arm_rad};
    const double hold_s = problem.goal.hold_s;

    const auto definition = std::make_shared<ob::ProblemDefinition>(information);
    ob::ScopedState<> start_state(information);
    write(start, start_state.get(), space);
    definition->addStartState(start_state);
    definition->setGoal(make_goal_region(information, space, random));
    definition->setOptimizationObjective(
        std::make_shared<GeometricObjective>(information, free_air_cost, space, hold_s));

    const auto planner = std::make_shared<SeededRrtStar>(information, problem.planner.seed);
    planner->setProblemDefinition(definition);
    planner->setup();
    definition->setIntermediateSolutionCallback(
        [&](const ob::Planner*, const std::vector<const ob::State*>&, const ob::Cost) {
            hooks.on_improvement(planner->bestCost().value(), planner->numIterations());
        });
    planner->solve(ob::PlannerTerminationCondition([&] {
        return hooks.is_over({planner->numIterations(), planner->nodes(), counts.refused()});
    }));

    GeometricResult result;
    result.iterations = planner->numIterations();
    result.states_checked = counts.states;
    result.refused_collision = counts.refused_collision;
    result.refused_bounds = counts.refused_bounds;
    if (definition->getSolutionPath() != nullptr) {
        const auto* path = definition->getSolutionPath()->as<ompl::geometric::PathGeometric>();
        const std::vector<Waypoint> waypoints = unwrapped(*path, space, start);
        const bool is_exact = definition->hasExactSolution();
        if (is_exact || waypoints.size() > 1) {
            result.status = is_exact ? Status::solved : Status::approximate;
            result.plan = timed_plan(waypoints, reference_at(problem.start), reference_limits(problem.motion),
                                     model.tick().tick_s);
            result.cost = is_exact ? planner->bestCost().value() : cost_of(waypoints, free_air_cost, hold_s);
        }
    }
    return result;
}

}  // namespace downwash::planning

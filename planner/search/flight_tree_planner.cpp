#include "downwash/search/flight_tree_planner.hpp"

#include <ompl/base/PlannerData.h>
#include <ompl/base/ScopedState.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <map>
#include <utility>

#include "downwash/base/text.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/search/flight_space.hpp"

namespace downwash::planning {
FlightTreePlanner::FlightTreePlanner(const ompl::base::SpaceInformationPtr& information, const SearchTask& task,
                                     int threads)
    : ompl::base::Planner(information, "FlightTree"), task_(task), search_(task, threads) {
    specs_.recognizedGoal = ompl::base::GOAL_SAMPLEABLE_REGION;
    specs_.approximateSolutions = true;
    specs_.optimizingPaths = true;
    specs_.multithreaded = threads > 1;
    specs_.canReportIntermediateSolutions = true;
    for (const FlightTreeParameters::Member& member : FlightTreeParameters::members()) {
        params_.declareParam<double>(
            std::string(member.name),
            [this, value = member.value](double given) { search_.parameters().*value = given; },
            [this, value = member.value] { return search_.parameters().*value; });
    }
    addPlannerProgressProperty("iterations INTEGER", [this] { return std::to_string(search_.iterations()); });
    addPlannerProgressProperty("best cost REAL",
                               [this] { return search_.best() ? to_text(search_.best()->cost) : std::string("inf"); });
}

void FlightTreePlanner::setup() {
    Planner::setup();
    for (const FlightTreeParameters::Member& member : FlightTreeParameters::members()) {
        const AlgorithmParameter& known = FlightTreeParameters::info(member.name);
        const double value = search_.parameters().*member.value;
        if (!(value >= known.low && value <= known.high)) {
            setup_ = false;
            throw ompl::Exception(name_, std::string(member.name) + " is " + to_text(value) +
                                             ": expected a number from " + to_text(known.low) + " to " +
                                             to_text(known.high));
        }
    }
}

void FlightTreePlanner::clear() {
    Planner::clear();
    search_.clear();
}

/// Takes on the goal of the problem definition.
bool FlightTreePlanner::adopt_goal() {
    const auto* goal = dynamic_cast<const ompl::base::GoalSampleableRegion*>(pdef_->getGoal().get());
    const auto* flight_goal = dynamic_cast<const FlightGoal*>(goal);
    if (goal == nullptr || (flight_goal != nullptr && &flight_goal->task() != &task_)) {
        OMPL_ERROR("%s: the goal is no GoalSampleableRegion, or that of another task", getName().c_str());
        return false;
    }
    users_goal_ = flight_goal == nullptr ? std::make_unique<OmplGoal>(si_, task_, *goal) : nullptr;
    search_.lead_to(users_goal_.get());
    return true;
}

/// Takes on the objective of the problem definition, if there is one.
bool FlightTreePlanner::adopt_objective() {
    const auto objective = pdef_->getOptimizationObjective();
    const bool is_users = objective != nullptr && !is_flight_objective(*objective);
    if (is_users && !is_additive(*objective)) {
        OMPL_ERROR("%s: costs of the objective do not add up, or more of them is better", getName().c_str());
        return false;
    }
    users_objective_ = is_users ? std::make_unique<OmplObjective>(si_, task_, *objective, *pdef_->getGoal()) : nullptr;
    search_.pay_by(users_objective_.get());
    constexpr unsigned int tries = 100;
    sampler_ = std::make_unique<OmplSampler>(si_, task_,
                                             is_users ? objective->allocInformedStateSampler(pdef_, tries) : nullptr);
    return true;
}

ompl::base::PlannerStatus FlightTreePlanner::solve(const ompl::base::PlannerTerminationCondition& terminated) {
    checkValidity();
    if (!search_.has_begun()) {
        if (!adopt_goal()) {
            return ompl::base::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
        }
        const ompl::base::State* start = pis_.nextStart();
        if (start == nullptr) {
            OMPL_ERROR("%s: there is no valid start", getName().c_str());
            return ompl::base::PlannerStatus::INVALID_START;
        }
        if (!adopt_objective()) {
            return ompl::base::PlannerStatus::ABORT;
        }
        search_.begin(point_of(start), random_of(*si_->getStateSpace()), *sampler_);
    }
    search_.go_on([&terminated] { return static_cast<bool>(terminated); },
                  [this](double cost) {
                      return users_objective_ != nullptr &&
                             pdef_->getOptimizationObjective()->isSatisfied(ompl::base::Cost(cost));
                  });
    return report_solution();
}

ompl::base::PathPtr FlightTreePlanner::make_path(const std::vector<FlightPoint>& moments) const {
    const auto path = std::make_shared<ompl::geometric::PathGeometric>(si_);
    for (const FlightPoint& moment : moments) {
        ompl::base::ScopedState<> state(si_);
        point_of(state.get()) = moment;
        path->append(state.get());
    }
    return path;
}

/// Adds what there is to the problem definition.
ompl::base::PlannerStatus FlightTreePlanner::report_solution() {
    const bool is_exact = search_.best().has_value();
    const FlightNode& nearest = search_.growth().nearest_to_goal();
    if (!is_exact && nearest.parent == nullptr) {
        return ompl::base::PlannerStatus::TIMEOUT;
    }
    ompl::base::PlannerSolution solution(
        make_path(is_exact ? search_.best()->moments : FlightTree::moments_to(nearest)));
    solution.setPlannerName(getName());
    if (is_exact) {
        const auto objective =
            pdef_->hasOptimizationObjective() ? pdef_->getOptimizationObjective() : make_flight_objective(si_);
        const ompl::base::Cost cost(search_.best()->cost);
        solution.setOptimized(objective, cost, objective->isSatisfied(cost));
    } else {
        solution.setApproximate(search_.growth().nearest_distance_m());
    }
    pdef_->addSolutionPath(solution);
    return is_exact ? ompl::base::PlannerStatus::EXACT_SOLUTION : ompl::base::PlannerStatus::APPROXIMATE_SOLUTION;
}

void FlightTreePlanner::getPlannerData(ompl::base::PlannerData& data) const {
    Planner::getPlannerData(data);
    if (!search_.has_begun()) {
        return;
    }
    const FlightTree& tree = search_.growth().tree();
    std::vector<ompl::base::ScopedState<>> states;  // one per node, in the order of the tree
    std::map<const FlightNode*, std::size_t> index;
    const auto vertex_of = [&](const FlightNode* node) {
        return ompl::base::PlannerDataVertex(states[index.at(node)].get());
    };
    for (const FlightNode* node : tree.nodes()) {
        index[node] = states.size();
        point_of(states.emplace_back(si_).get()) = moment_at(*node);
    }
    for (const FlightNode* node : tree.nodes()) {
        if (node->parent == nullptr) {
            data.addStartVertex(vertex_of(node));
        } else {
            data.addEdge(vertex_of(node->parent), vertex_of(node), ompl::base::PlannerDataEdge(),
                         ompl::base::Cost(node->cost - node->parent->cost));
        }
    }
    for (const FlightNode* hold : tree.holds()) {
        data.addGoalVertex(vertex_of(hold->parent));
    }
    data.decoupleFromPlanner();  // the states above end here
}

}  // namespace downwash::planning

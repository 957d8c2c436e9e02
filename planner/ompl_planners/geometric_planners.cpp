#include "downwash/ompl_planners/geometric_planners.hpp"

#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/samplers/InformedStateSampler.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "downwash/controllers/space_duration.hpp"
#include "downwash/ompl_planners/ompl_parameters.hpp"
#include "downwash/search/free_air_cost.hpp"
#include "downwash/search/ompl_space.hpp"
#include "downwash/search/quiet_ompl.hpp"
#include "downwash/search/seeded.hpp"
#include "downwash/search/tree_record.hpp"
#include "downwash/simulation/flight.hpp"

namespace downwash::planning {
namespace {

namespace ob = ompl::base;

namespace og = ompl::geometric;

struct PreparedPlanner {
    ob::PlannerPtr planner;
    std::function<std::size_t()> nodes;
    bool is_anytime = true;
};

template <class Planner>
PreparedPlanner prepared(const ob::SpaceInformationPtr& information, const ob::ProblemDefinitionPtr& definition,
                         std::uint32_t seed) {
    const auto planner = with_linear_neighbours(std::make_shared<Seeded<Planner>>(information, seed), definition);
    return {planner, [planner] { return planner->nodes(); }};
}

PreparedPlanner prepared_planner(const PlannerSettings& settings, const ob::SpaceInformationPtr& information,
                                 const ob::ProblemDefinitionPtr& definition) {
    if (settings.algorithm == "ompl-rrt-star") {
        return prepared<og::RRTstar>(information, definition, settings.seed);
    }
    if (settings.algorithm == "rrt-connect") {
        PreparedPlanner connect = prepared<og::RRTConnect>(information, definition, settings.seed);
        connect.is_anytime = false;
        return connect;
    }
    if (settings.algorithm == "informed-rrt-star") {
        return prepared<og::InformedRRTstar>(information, definition, settings.seed);
    }
    if (settings.algorithm == "bit-star") {
        // All its random numbers come from our samplers: it draws its own only for just-in-time sampling.
        const auto planner = std::make_shared<og::BITstar>(information);
        planner->setProblemDefinition(definition);
        planner->setConsiderApproximateSolutions(true);
        return {planner, [planner] { return std::size_t{0}; }};
    }
    throw std::logic_error("no geometric planner has this name");
}

/// Samples where a path may be cheaper than the best, by rejection. OMPL's own sampler of this kind draws from the
/// generator of the state space's default sampler, and where next to nothing is left to gain goes on for minutes.
class InformedSampler : public ob::InformedSampler {
 public:
    explicit InformedSampler(const ob::ProblemDefinitionPtr& definition)
        : ob::InformedSampler(definition, max_tries), sampler_(space_->allocStateSampler()) {}

    bool sampleUniform(ob::State* state, const ob::Cost& most) override {
        return sampleUniform(state, opt_->identityCost(), most);
    }
    bool sampleUniform(ob::State* state, const ob::Cost& least, const ob::Cost& most) override {
        for (unsigned int i = 0; i < max_tries; ++i) {
            sampler_->sampleUniform(state);
            const ob::Cost cost = heuristicSolnCost(state);
            if (opt_->isCostBetterThan(cost, most) && !opt_->isCostBetterThan(cost, least)) {
                return true;
            }
        }
        return false;
    }
    bool hasInformedMeasure() const override { return false; }
    double getInformedMeasure(const ob::Cost&) const override { return space_->getMeasure(); }

 private:
    static constexpr unsigned int max_tries = 100;

    ob::StateSamplerPtr sampler_;
};

/// Straight motions, and the hold as part of every motion that arrives at the goal.
template <class Family>
class GeometricObjective : public ob::OptimizationObjective {
 public:
    using Configuration = typename Family::Configuration;
    using SearchSpace = typename Family::SearchSpace;
    using FreeAirCost = FreeAirCostOf<Family>;

    GeometricObjective(const ob::SpaceInformationPtr& information, const FreeAirCost& cost, const SearchSpace& space)
        : ob::OptimizationObjective(information), free_air_cost_(cost), space_(space) {
        setCostToGoHeuristic([this](const ob::State* from, const ob::Goal*) {
            return ob::Cost(free_air_cost_.min_cost_to_goal(read(from, space_)));
        });
    }

    bool isSymmetric() const override { return false; }
    ob::Cost stateCost(const ob::State*) const override { return identityCost(); }
    ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
        const Configuration end = read(to, space_);
        const double hold = space_.is_near_goal(end) ? free_air_cost_.of_hold(end, space_.hold_s(end)) : 0;
        return ob::Cost(free_air_cost_.of_motion(read(from, space_), end) + hold);
    }
    ob::Cost motionCostHeuristic(const ob::State* from, const ob::State* to) const override {
        return ob::Cost(free_air_cost_.min_cost_of_motion(read(from, space_), read(to, space_)));
    }
    ob::InformedSamplerPtr allocInformedStateSampler(const ob::ProblemDefinitionPtr& definition,
                                                     unsigned int) const override {
        return std::make_shared<InformedSampler>(definition);
    }

 private:
    const FreeAirCost& free_air_cost_;
    const SearchSpace& space_;
};

/// The search for a path and then for better ones, one OMPL solution at a time.
template <class Family>
class LineSearch {
 public:
    using Configuration = typename Family::Configuration;
    using ReferencePoint = typename Family::ReferencePoint;
    using SearchSpace = typename Family::SearchSpace;
    using Plan = typename Family::Plan;
    using SearchTask = SearchTaskOf<Family>;
    using FreeAirCost = FreeAirCostOf<Family>;
    using OmplHooks = OmplHooksOf<Family>;
    using OmplResult = OmplResultOf<Family>;

    LineSearch(const SearchTask& task, const FreeAirCost& cost, const OmplHooks& hooks, const QueryCounts& counts)
        : task_(task), space_(task.space), free_air_cost_(cost), hooks_(hooks), counts_(counts) {
        result_.nearest_approach_m = space_.goal_distance_m(place_of(task.problem.start));
    }

    void run(const PreparedPlanner& prepared, const ob::ProblemDefinitionPtr& definition) {
        nodes_ = prepared.nodes;
        definition->setIntermediateSolutionCallback([this](const ob::Planner*, const std::vector<const ob::State*>&,
                                                           const ob::Cost cost) { better_cost_ = cost.value(); });
        while (!is_over_ && (prepared.is_anytime || !has_plan())) {
            const std::uint64_t before = result_.iterations;
            prepared.planner->solve(
                ob::PlannerTerminationCondition([this] { return better_cost_.has_value() || ask(); }));
            const bool is_better = better_cost_.has_value() || !prepared.is_anytime || is_over_;
            if (is_better && definition->getSolutionPath() != nullptr) {
                review(*definition);
            }
            better_cost_.reset();
            definition->clearSolutionPaths();
            if (!prepared.is_anytime && !has_plan()) {
                prepared.planner->clear();
            }
            if (result_.iterations == before && !is_better) {
                break;  // the planner will not go on
            }
        }
    }

    [[nodiscard]] OmplResult result() const {
        OmplResult result = result_;
        if (has_plan()) {
            result.nearest_approach_m.reset();
        }
        return result;
    }
    [[nodiscard]] std::uint64_t discarded() const noexcept { return discarded_; }

 private:
    [[nodiscard]] bool has_plan() const noexcept { return result_.status == Status::solved; }

    bool ask() {
        is_over_ = is_over_ || hooks_.is_over({result_.iterations, nodes_(), counts_.rejected()});
        result_.iterations += is_over_ ? 0 : 1;
        return is_over_;
    }

    [[nodiscard]] std::vector<Configuration> unwrapped(og::PathGeometric& path) const {
        std::vector<Configuration> waypoints{place_of(task_.problem.start)};
        for (unsigned int i = 1; i < path.getStateCount(); ++i) {
            waypoints.push_back(space_.seen_from(waypoints.back(), read(path.getState(i), space_)));
        }
        return waypoints;
    }
    [[nodiscard]] double cost_of(const std::vector<Configuration>& waypoints) const {
        double sum = 0;
        for (std::size_t i = 1; i < waypoints.size(); ++i) {
            sum += free_air_cost_.of_motion(waypoints[i - 1], waypoints[i]);
        }
        return sum + free_air_cost_.of_hold(waypoints.back(), space_.hold_s(waypoints.back()));
    }
    /// The rest-to-rest reference through waypoints with unwrapped angles, the first at the start's motion.
    [[nodiscard]] Plan timed_plan(const std::vector<Configuration>& waypoints) const {
        Plan plan = task_.blank_plan;
        plan.reference.push_back({0, reference_at(task_.problem.start)});
        for (std::size_t i = 1; i < waypoints.size(); ++i) {
            const ReferencePoint next = at_rest(waypoints[i]);
            const auto& last = plan.reference.back();
            plan.reference.push_back(
                {last.tick + shortest_ticks(last.point, next, motion_limits_of(task_.problem), task_.tick_s), next});
        }
        return plan;
    }

    /// Offers an exact path; of others, and of those that do not count, the one that leads nearest to the goal is kept.
    void review(const ob::ProblemDefinition& definition) {
        auto& path = *definition.getSolutionPath()->as<og::PathGeometric>();
        const std::vector<Configuration> waypoints = unwrapped(path);
        // The planner's status counts an approximate solution as one.
        const bool is_exact =
            definition.hasExactSolution() && definition.getGoal()->isSatisfied(path.getStates().back());
        const double cost = is_exact && better_cost_ ? *better_cost_ : cost_of(waypoints);
        if (has_plan() && (!is_exact || cost >= result_.cost)) {
            return;
        }
        Plan plan = timed_plan(waypoints);
        const bool is_too_long = plan.reference.back().tick > max_plan_ticks;
        if (is_exact && !is_too_long && hooks_.accept(plan, cost, result_.iterations)) {
            result_.status = Status::solved;
            result_.plan = std::move(plan);
            result_.cost = cost;
            return;
        }
        discarded_ += is_exact ? 1 : 0;
        const double off_m = space_.goal_distance_m(waypoints.back());
        if (!has_plan() && !is_too_long && waypoints.size() > 1 &&
            (result_.status == Status::none || off_m < result_.nearest_approach_m)) {
            result_.status = Status::approximate;
            result_.plan = std::move(plan);
            result_.cost = cost;
            result_.nearest_approach_m = std::min(*result_.nearest_approach_m, off_m);
        }
    }

    const SearchTask& task_;
    const SearchSpace& space_;
    const FreeAirCost& free_air_cost_;
    const OmplHooks& hooks_;
    const QueryCounts& counts_;
    std::function<std::size_t()> nodes_;
    std::optional<double> better_cost_;  ///< the planner has just found a path of this cost
    OmplResult result_;
    std::uint64_t discarded_ = 0;
    bool is_over_ = false;
};

}  // namespace

template <class Family>
GeometricResultOf<Family> plan_geometrically(const SearchTaskOf<Family>& task, Random& random,
                                             const OmplHooksOf<Family>& hooks) {
    using Configuration = typename Family::Configuration;
    const auto& problem = task.problem;
    const typename Family::SearchSpace& space = task.space;
    const QuietOmpl quiet;
    QueryCounts counts;
    // A motion is checked so densely that the margin covers what happens between two checks.
    const double step_m = std::min(max_unseen_motion_m(problem.planner.safety_margin_m), 0.1);
    const auto information = make_space_information(space, random, step_m, counts);
    const FreeAirCostOf<Family> free_air_cost(task);
    const Configuration start = place_of(problem.start);

    const auto definition = std::make_shared<ob::ProblemDefinition>(information);
    ob::ScopedState<> start_state(information);
    write(start, start_state.get(), space);
    definition->addStartState(start_state);
    // BIT* collects goals before it searches, as many as there are.
    constexpr unsigned int collected_goals = 32;
    definition->setGoal(problem.planner.algorithm == "bit-star"
                            ? make_goal_region(information, space, random, collected_goals)
                            : make_goal_region(information, space, random));
    definition->setOptimizationObjective(
        std::make_shared<GeometricObjective<Family>>(information, free_air_cost, space));

    const PreparedPlanner prepared = prepared_planner(problem.planner, information, definition);
    set_parameters(*prepared.planner, problem.planner);
    prepared.planner->setup();
    LineSearch<Family> search(task, free_air_cost, hooks, counts);
    search.run(prepared, definition);
    GeometricResultOf<Family> result{search.result(), counts, search.discarded()};
    if (hooks.keep_tree) {
        result.tree =
            tree_of<Configuration>(*prepared.planner, [&space](const ob::State* state) { return read(state, space); });
    }
    return result;
}

template GeometricResultOf<Plane> plan_geometrically(const SearchTask&, Random&, const OmplHooks&);
template GeometricResultOf<Space> plan_geometrically(const SearchTaskOf<Space>&, Random&, const OmplHooksOf<Space>&);

}  // namespace downwash::planning

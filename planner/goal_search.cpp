#include "downwash/planner/goal_search.hpp"

#include <cmath>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "downwash/ompl_planners/control_planners.hpp"
#include "downwash/ompl_planners/geometric_planners.hpp"
#include "downwash/search/flight_tree_search.hpp"
#include "downwash/search/place_sampler.hpp"

namespace downwash::planning {
namespace {

/// The hooks of a search by one of OMPL's planners.
template <class Family>
OmplHooksOf<Family> hooks_of(CandidateCheckOf<Family>& check, const SolveOptionsOf<Family>& options) {
    OmplHooksOf<Family> hooks;
    hooks.keep_tree = options.keep_tree;
    hooks.is_over = [&check](const OmplProgress& progress) {
        check.clock().note(progress.iteration, progress.nodes, progress.rejected);
        const std::optional<std::uint64_t>& most = check.task().problem.planner.max_iterations;
        return check.is_over() || (most && progress.iteration >= *most);
    };
    hooks.accept = [&check](const typename Family::Plan& plan, double cost, std::uint64_t iteration) {
        const bool counts = check.counts(plan, cost);
        if (counts) {
            check.accept(plan, cost, iteration);
        }
        return counts;
    };
    return hooks;
}

template <class Family>
SearchResultOf<Family> result_of(CandidateCheckOf<Family>& check, OmplResultOf<Family> found,
                                 const FlightStatisticsOf<Family>& statistics) {
    return check.result(found.iterations, statistics, std::move(found.tree),
                        {found.status, std::move(found.plan), found.cost, found.nearest_approach_m});
}

/// OMPL's planners on straight lines.
template <class Family>
SearchResultOf<Family> search_lines(CandidateCheckOf<Family>& check, const SolveOptionsOf<Family>& options) {
    Random random(check.task().problem.planner.seed);
    GeometricResultOf<Family> found = plan_geometrically(check.task(), random, hooks_of(check, options));
    FlightStatisticsOf<Family> statistics;
    statistics.states_checked = found.counts.states;
    statistics.rejected = no_rejections();
    statistics.rejected["collision"] = found.counts.rejected_collision;
    statistics.stopped_by = found.counts.stopped_by;
    statistics.rejected["bounds"] = found.counts.rejected_bounds;
    statistics.rejected["arm_limits"] = found.counts.rejected_arm_limits;
    statistics.rejected["direct_flight"] = found.discarded;
    return result_of<Family>(check, std::move(found), statistics);
}

/// OMPL's planners over controls.
template <class Family>
SearchResultOf<Family> search_controls(CandidateCheckOf<Family>& check, const SolveOptionsOf<Family>& options) {
    Random random(check.task().problem.planner.seed);
    PlannedFlightsOf<Family> planned(
        check.task(), [&check] { return check.is_over(); }, options.threads);
    const SteeredFlightsOf<Family> flights(planned);
    OmplResultOf<Family> found = plan_by_controls(flights, random, hooks_of(check, options));
    return result_of<Family>(check, std::move(found), planned.statistics());
}

/// Draws places with the numbers of a search, all over its space and beside others.
template <class Family>
class Places final : public PlaceSamplerOf<Family> {
 public:
    using Configuration = typename Family::Configuration;

    /// @pre both outlive it
    Places(const typename Family::SearchSpace& space, Random& random) : space_(space), random_(random) {}

    std::optional<Configuration> anywhere(double most) override {
        if constexpr (std::is_same_v<Family, Space>) {
            // An arm in its pose of transport seldom is in the way; until there is a plan half of the samples have it.
            if (!std::isfinite(most) && random_.chance(0.5)) {
                return space_.sample_in_transport(random_);
            }
        }
        return space_.sample(random_);
    }
    Configuration near(const Configuration& place, double radius_m) override {
        return space_.sample_near(place, radius_m, random_);
    }

 private:
    const typename Family::SearchSpace& space_;
    Random& random_;
};

/// The nodes of a tree, parents by their numbers.
template <class Family>
std::vector<typename Family::TreeNode> nodes_of(const FlightTreeOf<Family>& tree) {
    using Node = FlightNodeOf<Family>;
    std::vector<const Node*> order;
    std::unordered_map<const Node*, int> number;
    const auto add = [&](const Node* node) {
        if (number.emplace(node, static_cast<int>(order.size())).second) {
            order.push_back(node);
        }
    };
    for (const Node* node : tree.nodes()) {
        if (node->parent != nullptr) {
            add(node->parent);  // after a rewiring it may come later in the tree
        }
        add(node);
    }
    std::vector<typename Family::TreeNode> nodes;
    nodes.reserve(order.size());
    for (const Node* node : order) {
        nodes.push_back({configuration_of(node->reference),
                         node->parent != nullptr ? number.at(node->parent) : Family::TreeNode::no_parent});
    }
    return nodes;
}

/// Our own planner, the same for all levels of awareness.
template <class Family>
SearchResultOf<Family> search_tree(CandidateCheckOf<Family>& check, const SolveOptionsOf<Family>& options) {
    using Candidate = CandidateOf<Family>;
    const SearchTaskOf<Family>& task = check.task();
    const PlannerSettings& settings = task.problem.planner;
    Random random(settings.seed);
    Places<Family> places(task.space, random);
    FlightTreeSearchOf<Family> search(task, options.threads);
    search.set_hooks({[&](const Candidate& candidate) {
                          return check.counts(plan_through(candidate.moments, task.blank_plan), candidate.cost);
                      },
                      [&] { return check.new_counterexamples(); },
                      [&](const Candidate& candidate) {
                          check.accept(plan_through(candidate.moments, task.blank_plan), candidate.cost,
                                       candidate.iteration);
                      }});
    search.set_max_iterations(settings.max_iterations);
    search.set_stops_at_first_plan(options.stop_at_first_solution);
    search.set_enough_cost(options.enough_cost);
    search.set_known(options.known_plan, options.known_places, options.known_way);
    search.set_observer([&] {
        check.clock().note(search.iterations(), search.growth().tree().size(), search.statistics().rejections);
    });
    search.begin(start_point(task), random, places);
    search.go_on([&check] { return check.is_over(); });

    std::vector<typename Family::TreeNode> tree;
    if (options.keep_tree) {
        tree = nodes_of(search.growth().tree());
    }
    const FlightNodeOf<Family>& nearest = search.growth().nearest_to_goal();
    ApproachOf<Family> approach;
    approach.nearest_m = search.growth().nearest_distance_m();
    if (nearest.parent != nullptr) {
        approach.status = Status::approximate;
        approach.plan = search.growth().tree().plan_to(nearest);
        approach.cost = nearest.cost;
    }
    return check.result(search.iterations(), search.statistics(), std::move(tree), approach);
}

/// The search with the algorithm that the problem names.
template <class Family>
SearchResultOf<Family> search_by_algorithm(CandidateCheckOf<Family>& check, const SolveOptionsOf<Family>& options) {
    const PlannerSettings& settings = check.task().problem.planner;
    if (settings.algorithm == "rrt-star") {
        return search_tree(check, options);
    }
    return plans_flights(settings.variant) ? search_controls(check, options) : search_lines(check, options);
}

}  // namespace

SearchResultOf<Space> search_goal(const SpaceProblem& part, const SpaceProblem& whole,
                                  const PlannerModelOf<Space>& model, const CourseOf<Space>& before,
                                  const PlanChecksOf<Space>& checks, const SolveOptionsOf<Space>& options) {
    CandidateCheckOf<Space> check(part, whole, model, before, checks, options);
    return search_by_algorithm(check, options);
}

SearchResult search_goal(const Problem& part, const Problem& whole, const PlannerModel& model, const Course& before,
                         const PlanChecks& checks, const SolveOptions& options) {
    CandidateCheck check(part, whole, model, before, checks, options);
    return search_by_algorithm(check, options);
}

}  // namespace downwash::planning

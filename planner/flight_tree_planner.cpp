#include "downwash/planner/flight_tree_planner.hpp"

#include <ompl/base/PlannerData.h>
#include <ompl/base/ScopedState.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_set>

#include "downwash/planner/ompl_space.hpp"

namespace downwash::planning {
namespace {

/// How often the search aims at the goal region.
constexpr double goal_bias = 0.1;

/// How often, once there is a plan, the search looks beside one of its corners (local biasing, Akgun and Stilman 2011).
constexpr double local_bias = 0.5;

/// How far beside it at the most [m].
constexpr double local_radius_m = 2.0;

/// Longest edge as a share of the space's extent; OMPL's own habit.
constexpr double range_share = 0.2;

/// Surfaces may make a flight cheaper than its estimate in free air; a flight is worth its simulation when it could
/// win with so much less.
constexpr double optimism = 0.9;

/// While the search goes on a better plan is worth a direct flight from this relative gain on; at its end any is.
constexpr double worthwhile_gain = 5e-3;
constexpr double any_gain = 1e-6;

/// The nodes and all that lies between them and the root, each once. As every edge ends at rest, one long edge is
/// cheaper than several short ones along the same line, so ancestors are worth trying as parents (Quick-RRT*, Jeong
/// et al. 2019).
std::vector<FlightNode*> with_ancestors(const std::vector<FlightNode*>& nodes) {
    std::vector<FlightNode*> all = nodes;
    std::unordered_set<const FlightNode*> known(nodes.begin(), nodes.end());
    for (FlightNode* node : nodes) {
        for (FlightNode* n = node->parent; n != nullptr && known.insert(n).second; n = n->parent) {
            all.push_back(n);
        }
    }
    return all;
}

}  // namespace

FlightTreePlanner::FlightTreePlanner(const ompl::base::SpaceInformationPtr& information, FlightTree& tree,
                                     const SearchSpace& space, Random& random,
                                     std::function<bool(const Candidate&)> accept)
    : ompl::base::Planner(information, "FlightTree"),
      tree_(tree),
      space_(space),
      random_(random),
      accept_(std::move(accept)),
      nearest_to_goal_(&tree.root()),
      nearest_distance_m_(space.goal_distance_m(tree.root().configuration)),
      range_m_(range_share * space.extent_m()) {
    specs_.approximateSolutions = true;
    specs_.optimizingPaths = true;
}

ompl::base::PlannerStatus FlightTreePlanner::solve(const ompl::base::PlannerTerminationCondition& terminated) {
    if (iterations_ == 0 && space_.is_near_goal(tree_.root().configuration)) {
        try_hold(tree_.root());
        review_holds(worthwhile_gain);
    }
    while (!terminated && !(max_iterations_ && iterations_ >= *max_iterations_)) {
        ++iterations_;
        grow();
        review_holds(worthwhile_gain);
        if (observer_) {
            observer_();
        }
    }
    review_holds(any_gain);
    return incumbent_ ? ompl::base::PlannerStatus::EXACT_SOLUTION : ompl::base::PlannerStatus::TIMEOUT;
}

std::optional<Configuration> FlightTreePlanner::target() {
    if (incumbent_ && random_.chance(local_bias)) {
        return target_beside_incumbent();
    }
    return random_.chance(goal_bias) ? space_.sample_goal(random_) : space_.sample(random_);
}

std::optional<Configuration> FlightTreePlanner::target_beside_incumbent() {
    const std::vector<Waypoint>& corners = incumbent_->plan.waypoints;
    const auto i = static_cast<std::size_t>(random_.uniform(0, static_cast<double>(corners.size())));
    const Configuration corner{corners[i].x_m, corners[i].z_m, corners[i].arm_rad};
    const double radius_m = local_radius_m * random_.uniform(0, 1) * random_.uniform(0, 1);
    return i + 1 == corners.size() ? space_.sample_goal_near(corner, radius_m, random_)
                                   : space_.sample_near(corner, radius_m, random_);
}

std::size_t FlightTreePlanner::neighbour_count() const {
    // k-nearest RRT* (Karaman and Frazzoli 2011): k > e (1 + 1/d) log n in d dimensions.
    constexpr double dimension = 3;
    const auto n = static_cast<double>(tree_.size());
    return static_cast<std::size_t>(std::ceil(std::numbers::e * (1 + 1 / dimension) * std::log(n + 1)));
}

void FlightTreePlanner::grow() {
    const std::optional<Configuration> aim = target();
    if (!aim) {
        return;
    }
    const Configuration& nearest = tree_.nearest(*aim, 1).front()->configuration;
    const Configuration to = space_.steered(nearest, *aim, range_m_);
    if (const FlightFault fault = space_.fault_at(to); fault != FlightFault::none) {
        tree_.count_rejection(cause_of(fault));
        return;
    }
    const std::vector<FlightNode*> neighbours = tree_.nearest(to, neighbour_count());
    FlightNode* const node = connect(to, neighbours);
    if (node == nullptr) {
        return;
    }
    const double distance_m = space_.goal_distance_m(node->configuration);
    if (distance_m < nearest_distance_m_) {
        nearest_distance_m_ = distance_m;
        nearest_to_goal_ = node;
    }
    if (space_.is_near_goal(node->configuration)) {
        try_hold(*node);
    }
    rewire_through(*node, neighbours);
}

FlightNode* FlightTreePlanner::connect(const Configuration& to, const std::vector<FlightNode*>& neighbours) {
    struct Parent {
        FlightNode* node;
        double estimate;
    };
    std::vector<Parent> parents;
    for (FlightNode* node : with_ancestors(neighbours)) {
        const double estimate = node->cost + optimism * tree_.estimated_cost(*node, to);
        const bool is_hopeless = incumbent_ && estimate >= incumbent_->cost;
        if (!is_hopeless && space_.distance_m(node->configuration, to) > 1e-6) {
            parents.push_back({node, estimate});
        }
    }
    std::stable_sort(parents.begin(), parents.end(),
                     [](const Parent& a, const Parent& b) { return a.estimate < b.estimate; });
    std::optional<FlightTree::Flown> best;
    FlightNode* best_parent = nullptr;
    for (const Parent& parent : parents) {
        if (best && parent.estimate >= best->cost) {
            break;
        }
        auto flight = tree_.flown(*parent.node, space_.seen_from(parent.node->configuration, to));
        if (flight && (!best || flight->cost < best->cost)) {
            best = flight;
            best_parent = parent.node;
        }
    }
    if (!best || (incumbent_ && best->cost >= incumbent_->cost)) {
        return nullptr;
    }
    return &tree_.add(*best_parent, *best);
}

void FlightTreePlanner::rewire_through(FlightNode& node, std::vector<FlightNode*> neighbours) {
    // A better corner pays only when the next corner of the best plan, far away as a rule, is reached from it.
    for (FlightNode* n = best_hold_ != nullptr ? best_hold_->parent : nullptr; n != nullptr; n = n->parent) {
        if (n != &node && std::find(neighbours.begin(), neighbours.end(), n) == neighbours.end()) {
            neighbours.push_back(n);
        }
    }
    for (FlightNode* neighbour : neighbours) {
        if (neighbour == &tree_.root() || neighbour == node.parent) {
            continue;
        }
        if (node.cost + optimism * tree_.estimated_cost(node, neighbour->configuration) < neighbour->cost) {
            tree_.rewire(*neighbour, node);
        }
    }
}

void FlightTreePlanner::try_hold(FlightNode& node) {
    tree_.add_hold(node);
}

void FlightTreePlanner::review_holds(double least_gain) {
    for (;;) {
        const double to_beat = incumbent_ ? (1 - least_gain) * incumbent_->cost : HUGE_VAL;
        FlightNode* best = nullptr;
        for (FlightNode* hold : tree_.holds()) {
            if (!hold->is_discarded && hold->cost < to_beat && (best == nullptr || hold->cost < best->cost)) {
                best = hold;
            }
        }
        if (best == nullptr) {
            return;
        }
        Candidate candidate{tree_.plan_to(*best), best->cost, iterations_};
        if (accept_(candidate)) {
            tree_.verify(*best);
            incumbent_ = std::move(candidate);
            best_hold_ = best;
            return;
        }
        best->is_discarded = true;
        tree_.count_rejection("direct_flight");
    }
}

void FlightTreePlanner::getPlannerData(ompl::base::PlannerData& data) const {
    Planner::getPlannerData(data);
    std::vector<ompl::base::ScopedState<>> states;  // one per node, in the order of the tree
    std::map<const FlightNode*, std::size_t> index;
    for (const FlightNode* node : tree_.nodes()) {
        index[node] = states.size();
        write(node->configuration, states.emplace_back(si_).get(), space_);
    }
    for (const FlightNode* node : tree_.nodes()) {
        const ompl::base::PlannerDataVertex vertex(states[index[node]].get());
        if (node->parent == nullptr) {
            data.addStartVertex(vertex);
        } else {
            data.addEdge(ompl::base::PlannerDataVertex(states[index[node->parent]].get()), vertex);
        }
    }
    data.decoupleFromPlanner();  // the states above end here
}

}  // namespace downwash::planning

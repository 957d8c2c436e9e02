#include "downwash/search/tree_growth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <type_traits>
#include <unordered_set>
#include <utility>

namespace downwash::planning {
namespace {

/// The nodes and all that lies between them and the root, each once. As every edge ends at rest, one long edge is
/// cheaper than several short ones along the same line, so ancestors are worth trying as parents (Quick-RRT*, Jeong
/// et al. 2019).
template <class Node>
std::vector<Node*> with_ancestors(const std::vector<Node*>& nodes) {
    std::vector<Node*> all = nodes;
    std::unordered_set<const Node*> known(nodes.begin(), nodes.end());
    for (Node* node : nodes) {
        for (Node* n = node->parent; n != nullptr && known.insert(n).second; n = n->parent) {
            all.push_back(n);
        }
    }
    return all;
}

/// The distance of a place from the straight lines between the points of a way [m].
template <class Configuration, class ReferencePoint>
double distance_from_way_m(const Configuration& place, const std::vector<ReferencePoint>& way,
                           std::span<const std::size_t> translations) {
    double nearest_m = HUGE_VAL;
    for (std::size_t i = 1; i < way.size(); ++i) {
        const Configuration a = configuration_of(way[i - 1]);
        const Configuration b = configuration_of(way[i]);
        double length2 = 0, projection = 0, off2 = 0;
        for (const std::size_t axis : translations) {
            length2 += (b[axis] - a[axis]) * (b[axis] - a[axis]);
            projection += (place[axis] - a[axis]) * (b[axis] - a[axis]);
        }
        const double along = length2 > 0 ? std::clamp(projection / length2, 0.0, 1.0) : 0;
        for (const std::size_t axis : translations) {
            const double off = place[axis] - a[axis] - along * (b[axis] - a[axis]);
            off2 += off * off;
        }
        nearest_m = std::min(nearest_m, std::sqrt(off2));
    }
    return nearest_m;
}

}  // namespace

template <class Family>
TreeGrowthOf<Family>::TreeGrowthOf(const FlightPoint& start, const SearchSpace& space,
                                   const FlightTreeParameters& parameters, PlannedFlights& flights, Random& random,
                                   PlaceSampler& sampler)
    : space_(space),
      parameters_(parameters),
      flights_(flights),
      random_(random),
      sampler_(sampler),
      narrow_ways_(flights.task()),
      tree_(start, flights),
      nearest_to_goal_(&tree_.root()),
      nearest_distance_m_(flights.goal().distance_m(tree_.root().configuration)) {
    if (flights_.goal().contains(tree_.root().configuration)) {
        const std::vector<FlightNode*> root{&tree_.root()};
        tree_.add_holds(root);
        note_best_hold();
    }
}

template <class Family>
void TreeGrowthOf<Family>::try_first(std::vector<Configuration> places) {
    first_places_ = std::move(places);
    std::reverse(first_places_.begin(), first_places_.end());
}

template <class Family>
void TreeGrowthOf<Family>::follow(std::vector<Configuration> corners) {
    way_.corners = std::move(corners);
    way_.samples = 0;
    for (std::size_t i = 0; i < way_.corners.size(); ++i) {
        due_.push_back({std::max<std::uint64_t>(batch_, 1) + i, at_rest(way_.corners[i])});
    }
}

/// The next point on the way through a passage that is due, or the first of a new way; nothing where it is the turn of
/// other samples.
template <>
auto TreeGrowthOf<Plane>::point_of_passage() -> std::optional<ReferencePoint> {
    if (!due_.empty() && due_.front().batch <= batch_) {
        const ReferencePoint point = due_.front().point;
        due_.pop_front();
        return point;
    }
    if (!random_.chance(parameters_.passage_share)) {
        return std::nullopt;
    }
    const auto distance_m = [this](const ReferencePoint& point) {
        const Configuration place = configuration_of(point);
        return space_.distance_m(tree_.nearest(place, 1).front()->configuration, place);
    };
    // A way between places that the tree has reached already is none worth knowing.
    std::optional<Passage> passage = narrow_ways_.sample(random_, [&](const Passage& way) {
        return std::max(distance_m(way.run_up), distance_m(way.run_out)) > parameters_.alternative_distance_m;
    });
    if (!passage) {
        return std::nullopt;
    }
    if (distance_m(passage->run_out) < distance_m(passage->run_up)) {
        passage = reversed(*passage);
    }
    due_.push_back({batch_ + 1, passage->through});
    due_.push_back({batch_ + 2, passage->run_out});
    return passage->run_up;
}

template <>
auto TreeGrowthOf<Space>::point_of_passage() -> std::optional<ReferencePoint> {
    return std::nullopt;
}

/// Looks for a new way of the level vehicle; whether there is one.
template <>
bool TreeGrowthOf<Space>::find_way() {
    constexpr std::uint64_t max_iterations = 2000;
    constexpr std::size_t first_wait = 16, most_doublings = 6;
    follow(narrow_ways_.find(random_, max_iterations, flights_.is_over()));
    way_.failures = way_.corners.empty() ? way_.failures + 1 : 0;
    way_.samples_to_wait = way_.corners.empty() ? first_wait << std::min(way_.failures - 1, most_doublings) : 0;
    return !way_.corners.empty();
}

/// A place near a corner of the way, in the goal region for the last one.
template <class Family>
auto TreeGrowthOf<Family>::beside_corner(std::size_t corner) -> Configuration {
    const Configuration& place = way_.corners[corner];
    const double radius_m = parameters_.local_radius_m * random_.uniform(0, 1) * random_.uniform(0, 1);
    if (corner + 1 == way_.corners.size()) {
        return flights_.goal().sample_near(place, radius_m, random_).value_or(place);
    }
    return sampler_.near(place, radius_m);
}

/// The next corner of a way of the level vehicle, each in a batch of its own; meanwhile places beside those before it.
/// Nothing where it is the turn of other samples.
template <>
auto TreeGrowthOf<Space>::point_of_way() -> std::optional<ReferencePoint> {
    constexpr std::size_t samples_beside_a_corner = 4;
    if (!random_.chance(parameters_.way_share)) {
        return std::nullopt;
    }
    if (way_.samples_to_wait > 0) {
        --way_.samples_to_wait;
        return std::nullopt;
    }
    if (due_.empty() && way_.samples >= samples_beside_a_corner * way_.corners.size() && !find_way()) {
        return std::nullopt;
    }
    if (!due_.empty() && due_.front().batch <= batch_) {
        const ReferencePoint point = due_.front().point;
        due_.pop_front();
        return point;
    }
    ++way_.samples;
    const std::size_t tried = way_.corners.size() - due_.size();
    return at_rest(beside_corner(static_cast<std::size_t>(random_.uniform(0, static_cast<double>(tried)))));
}

template <>
auto TreeGrowthOf<Plane>::point_of_way() -> std::optional<ReferencePoint> {
    return std::nullopt;
}

/// Where the next sample leads; nothing where none is found.
template <class Family>
auto TreeGrowthOf<Family>::aim() -> std::optional<ReferencePoint> {
    if (parameters_.passage_share > 0 && first_places_.empty()) {
        if (const std::optional<ReferencePoint> point = point_of_passage()) {
            return point;
        }
    }
    if (std::is_same_v<Family, Space> && !has_plan() && first_places_.empty()) {
        if (const std::optional<ReferencePoint> point = point_of_way()) {
            return point;
        }
    }
    const std::optional<Configuration> target_place = target();
    if (!target_place) {
        return std::nullopt;
    }
    // Goals are aimed at from any distance: what stands in between is found before anything is flown.
    const Configuration& nearest = tree_.nearest(*target_place, 1).front()->configuration;
    const Configuration to = flights_.goal().contains(*target_place)
                                 ? *target_place
                                 : space_.steered(nearest, *target_place, parameters_.range_share * space_.extent_m());
    const ReferencePoint point = space_.looking(tree_.root().reference, at_rest(to));
    if (const Rejection rejection = space_.rejection_at(configuration_of(point)); rejection != Rejection::none) {
        flights_.count_rejection(rejection);
        return std::nullopt;
    }
    return point;
}

template <class Family>
auto TreeGrowthOf<Family>::target() -> std::optional<Configuration> {
    if (!first_places_.empty()) {
        const Configuration place = first_places_.back();
        first_places_.pop_back();
        return place;
    }
    if (known_plan_ && random_.chance(parameters_.local_bias)) {
        return target_beside_plan();
    }
    return random_.chance(has_plan() ? parameters_.goal_bias : parameters_.first_goal_bias)
               ? flights_.goal().sample(random_)
               : sampler_.anywhere(parameters_.max_detour * best_hold_cost_);
}

template <class Family>
auto TreeGrowthOf<Family>::target_beside_plan() -> std::optional<Configuration> {
    const std::size_t knots = known_plan_->size() - 1;
    const auto i = static_cast<std::size_t>(random_.uniform(0, static_cast<double>(knots)));
    const Configuration knot = configuration_of((*known_plan_)[i].reference);
    const double radius_m = parameters_.local_radius_m * random_.uniform(0, 1) * random_.uniform(0, 1);
    return i + 1 == knots ? flights_.goal().sample_near(knot, radius_m, random_) : sampler_.near(knot, radius_m);
}

template <class Family>
std::size_t TreeGrowthOf<Family>::neighbour_count() const {
    // k-nearest RRT* (Karaman and Frazzoli 2011): k > e (1 + 1/d) log n in d dimensions.
    const auto dimension = static_cast<double>(space_.axes().size());
    const auto n = static_cast<double>(tree_.size());
    return static_cast<std::size_t>(std::ceil(std::numbers::e * (1 + 1 / dimension) * std::log(n + 1)));
}

template <class Family>
std::uint64_t TreeGrowthOf<Family>::grow(std::optional<std::uint64_t> max_samples) {
    const auto wanted = static_cast<std::uint64_t>(has_plan() ? parameters_.batch_size : parameters_.first_batch_size);
    const std::uint64_t samples = std::min(wanted, max_samples.value_or(wanted));
    std::vector<Growth> batch;
    ++batch_;
    for (std::uint64_t i = 0; i < samples; ++i) {
        if (auto growth = sampled()) {
            batch.push_back(std::move(*growth));
        }
    }
    choose_parents(batch);
    const std::vector<FlightNode*> added = add(batch);
    add_holds(added);
    if (has_plan()) {
        rewire_through(batch, added);
    }
    return samples;
}

template <class Family>
auto TreeGrowthOf<Family>::sampled() -> std::optional<TreeGrowth::Growth> {
    const std::optional<ReferencePoint> to = aim();
    if (!to) {
        return std::nullopt;
    }
    Growth growth;
    growth.to = *to;
    const Configuration place = configuration_of(*to);
    growth.neighbours = tree_.nearest(place, neighbour_count());
    const double min_cost_to_goal = parameters_.optimism * tree_.min_cost_to_goal(place);
    for (FlightNode* node : with_ancestors(growth.neighbours)) {
        const double estimate = node->cost + parameters_.optimism * tree_.estimated_cost(*node, place);
        if (estimate + min_cost_to_goal < parameters_.max_detour * best_hold_cost_ &&
            space_.distance_m(node->configuration, place) > 1e-6) {
            growth.parents.push_back({node, estimate});
        }
    }
    std::stable_sort(
        growth.parents.begin(), growth.parents.end(),
        [](const typename Growth::Parent& a, const typename Growth::Parent& b) { return a.estimate < b.estimate; });
    return growth;
}

/// The parents of one sample, tried in the order of their estimates until none can be cheaper.
template <class Family>
class TreeGrowthOf<Family>::ParentChoice final : public FlightTreeOf<Family>::EdgeChain {
 public:
    ParentChoice(const TreeGrowth& tree, Growth& growth) : tree_(tree), growth_(growth) {}

    std::optional<Edge> next() override {
        if (growth_.next_parent == growth_.parents.size()) {
            return std::nullopt;
        }
        const typename Growth::Parent& parent = growth_.parents[growth_.next_parent];
        // Until there is a plan any way on will do.
        if (growth_.best && (parent.estimate >= growth_.best->cost || !tree_.has_plan())) {
            growth_.next_parent = growth_.parents.size();
            return std::nullopt;
        }
        ReferencePoint to = growth_.to;
        const Configuration seen = tree_.space_.seen_from(parent.node->configuration, configuration_of(to));
        std::copy(seen.coordinate.begin(), seen.coordinate.end(), to.position);
        return Edge{parent.node, tree_.space_.looking(parent.node->reference, to)};
    }

    void note(std::optional<Flown> flight) override {
        if (flight && (!growth_.best || flight->cost < growth_.best->cost)) {
            growth_.best = std::move(flight);
            growth_.best_parent = growth_.parents[growth_.next_parent].node;
        }
        ++growth_.next_parent;
    }

 private:
    const TreeGrowth& tree_;
    Growth& growth_;
};

template <class Family>
void TreeGrowthOf<Family>::choose_parents(std::vector<Growth>& batch) {
    std::deque<ParentChoice> choices;
    std::vector<EdgeChain*> chains;
    chains.reserve(batch.size());
    for (Growth& growth : batch) {
        chains.push_back(&choices.emplace_back(*this, growth));
    }
    tree_.fly(chains);
}

/// One node per sample, nullptr for those that became none.
template <class Family>
auto TreeGrowthOf<Family>::add(const std::vector<Growth>& batch) -> std::vector<FlightNode*> {
    std::vector<FlightNode*> added;
    for (const Growth& growth : batch) {
        const bool is_worthwhile =
            growth.best &&
            growth.best->cost + parameters_.optimism * tree_.min_cost_to_goal(configuration_of(growth.to)) <
                parameters_.max_detour * best_hold_cost_;
        added.push_back(is_worthwhile ? &tree_.add(*growth.best_parent, *growth.best) : nullptr);
    }
    return added;
}

template <class Family>
void TreeGrowthOf<Family>::add_holds(const std::vector<FlightNode*>& added) {
    std::vector<FlightNode*> arrived;
    for (FlightNode* node : added) {
        if (node == nullptr || !is_at_rest(node->reference)) {
            continue;
        }
        const double distance_m = flights_.goal().distance_m(node->configuration);
        if (distance_m < nearest_distance_m_) {
            nearest_distance_m_ = distance_m;
            nearest_to_goal_ = node;
        }
        if (flights_.goal().contains(node->configuration)) {
            arrived.push_back(node);
        }
    }
    tree_.add_holds(arrived);
    note_best_hold();
}

template <class Family>
void TreeGrowthOf<Family>::rewire_through(const std::vector<Growth>& batch, const std::vector<FlightNode*>& added) {
    std::vector<Rewiring> rewirings;
    const FlightNode* hold = best_hold();
    for (std::size_t i = 0; i < batch.size(); ++i) {
        FlightNode* const node = added[i];
        if (node == nullptr) {
            continue;
        }
        std::vector<FlightNode*> neighbours = batch[i].neighbours;
        // A better corner pays only when the next corner of the best plan, far away as a rule, is reached from it.
        for (FlightNode* n = hold != nullptr ? hold->parent : nullptr; n != nullptr; n = n->parent) {
            if (n != node && std::find(neighbours.begin(), neighbours.end(), n) == neighbours.end()) {
                neighbours.push_back(n);
            }
        }
        for (FlightNode* neighbour : neighbours) {
            if (neighbour != &tree_.root() && neighbour != node->parent &&
                node->cost + parameters_.optimism * tree_.estimated_cost(*node, neighbour->configuration) <
                    neighbour->cost) {
                rewirings.push_back({neighbour, node});
            }
        }
    }
    tree_.rewire(rewirings);
    note_best_hold();
}

template <class Family>
void TreeGrowthOf<Family>::discard(FlightNode& hold) {
    hold.is_discarded = true;
    note_best_hold();
}

template <class Family>
auto TreeGrowthOf<Family>::hold_away_from(const std::vector<ReferencePoint>& way) -> const FlightNode* {
    constexpr int draws = 8;
    const auto& holds = tree_.holds();
    const FlightNode* farthest = nullptr;
    double farthest_m = parameters_.alternative_distance_m;
    for (int i = 0; i < draws; ++i) {
        const FlightNode* hold = holds[static_cast<std::size_t>(random_.uniform(0, static_cast<double>(holds.size())))];
        double away_m = 0;
        for (const FlightNode* n = hold->parent; n != nullptr; n = n->parent) {
            away_m = std::max(away_m, distance_from_way_m(n->configuration, way, space_.translations()));
        }
        if (!hold->is_discarded && away_m > farthest_m) {
            farthest_m = away_m;
            farthest = hold;
        }
    }
    return farthest;
}

template <class Family>
auto TreeGrowthOf<Family>::hold_by_rank(std::size_t rank) const -> const FlightNode* {
    std::vector<FlightNode*> holds = tree_.holds();
    if (holds.empty()) {
        return nullptr;
    }
    std::stable_sort(holds.begin(), holds.end(),
                     [](const FlightNode* a, const FlightNode* b) { return a->cost < b->cost; });
    return holds[rank % holds.size()];
}

template <class Family>
auto TreeGrowthOf<Family>::best_hold() const -> FlightNode* {
    FlightNode* best = nullptr;
    for (FlightNode* hold : tree_.holds()) {
        if (!hold->is_discarded && (best == nullptr || hold->cost < best->cost)) {
            best = hold;
        }
    }
    return best;
}

template <class Family>
void TreeGrowthOf<Family>::note_best_hold() {
    const FlightNode* const hold = best_hold();
    best_hold_cost_ = hold != nullptr ? hold->cost : HUGE_VAL;
}

template class TreeGrowthOf<Plane>;
template class TreeGrowthOf<Space>;

}  // namespace downwash::planning

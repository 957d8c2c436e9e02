#include "downwash/search/flight_tree_planner.hpp"

#include <ompl/base/PlannerData.h>
#include <ompl/base/ScopedState.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_set>
#include <utility>

#include "downwash/base/parallel.hpp"
#include "downwash/search/ompl_space.hpp"

namespace downwash::planning {
namespace {

/// How often the search aims at the goal region, before it has a plan and after.
constexpr double first_goal_bias = 0.4;
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

/// A way through the tree that is so much dearer than the best one may still overtake it: by rewiring, or when refined.
constexpr double patience = 1.15;

/// Ways that lead nowhere farther from each other than this are the same for the refiner [m].
constexpr double other_way_m = 0.5;

/// While the search goes on a better plan is worth a direct flight from this relative gain on; at its end any is.
constexpr double worthwhile_gain = 0.02;
constexpr double any_gain = 1e-6;

/// Work in rounds is counted in ticks of flights side by side. In a round tree and refiner do so much each ...
constexpr double round_work = 400'000;
/// ... or, while a plan is flown directly, so much by its tick, lest that goes on alone; but no more than this.
constexpr double direct_tick_work = 150;
constexpr double most_round_work = 1'000'000;
/// What a sample of the tree costs beside its flights, and what it mostly costs with them.
constexpr double sample_work = 200;
constexpr double usual_sample_work = 1'500;
/// What a wave of the refiner costs beside its flights.
constexpr double refine_work = 2'000;

/// So many plans may be refused after the end of a search until it is given up.
constexpr int most_refused_at_end = 4;

/// Samples whose flights are flown side by side. Fixed, so that the result does not depend on lanes and threads.
constexpr std::uint64_t wave_size = 32;
constexpr std::uint64_t first_wave_size = 4;  ///< as long as there is no plan

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

/// From the straight lines between the points of a way, in the plane of motion.
double distance_from_way_m(const Configuration& place, const std::vector<ReferencePoint>& way) {
    double nearest_m = HUGE_VAL;
    for (std::size_t i = 1; i < way.size(); ++i) {
        const double* a = way[i - 1].position;
        const double* b = way[i].position;
        const double dx = b[0] - a[0];
        const double dz = b[1] - a[1];
        const double length2 = dx * dx + dz * dz;
        const double along =
            length2 > 0 ? std::clamp(((place.x_m - a[0]) * dx + (place.z_m - a[1]) * dz) / length2, 0.0, 1.0) : 0;
        const double off_x = place.x_m - a[0] - along * dx;
        const double off_z = place.z_m - a[1] - along * dz;
        nearest_m = std::min(nearest_m, std::sqrt(off_x * off_x + off_z * off_z));
    }
    return nearest_m;
}

}  // namespace

FlightTreePlanner::FlightTreePlanner(const ompl::base::SpaceInformationPtr& information, const Problem& problem,
                                     FlightTree& tree, const SearchSpace& space, PlannedFlights& flights,
                                     Random& random, CandidateHooks hooks, int threads)
    : ompl::base::Planner(information, "FlightTree"),
      tree_(tree),
      space_(space),
      flights_(flights),
      refined_flights_(flights, threads),
      random_(random),
      refiner_random_(random.branch()),
      refiner_(problem, space, refined_flights_, refiner_random_),
      hooks_(std::move(hooks)),
      threads_(threads),
      nearest_to_goal_(&tree.root()),
      nearest_distance_m_(space.goal_distance_m(tree.root().configuration)),
      range_m_(range_share * space.extent_m()) {
    specs_.approximateSolutions = true;
    specs_.optimizingPaths = true;
}

FlightStatistics FlightTreePlanner::statistics() const {
    FlightStatistics all = flights_.statistics();
    all += refined_flights_.statistics();
    return all;
}

ompl::base::PlannerStatus FlightTreePlanner::solve(const ompl::base::PlannerTerminationCondition& terminated) {
    if (iterations_ == 0 && space_.is_near_goal(tree_.root().configuration)) {
        const std::vector<FlightNode*> root{&tree_.root()};
        tree_.add_holds(root);
        note_best_hold();
    }
    const auto is_done = [this] { return incumbent_ && stops_at_first_plan_; };
    while (!terminated && !is_used_up() && !is_done()) {
        if (has_plan()) {
            go_on_side_by_side(terminated);
        } else {
            grow();
            tree_left_ = 0;  // the rounds begin with the first plan
        }
        hand_to_refiner();
        if (stops_at_first_plan_) {
            settle_best(terminated);  // at once, and whatever else may have been found beside it
        }
        if (observer_) {
            observer_();
        }
    }
    if (!is_done()) {
        settle_best(terminated);
    }
    return incumbent_ ? ompl::base::PlannerStatus::EXACT_SOLUTION : ompl::base::PlannerStatus::TIMEOUT;
}

/// The work that tree and refiner do in a round beside a plan that is flown directly.
double FlightTreePlanner::work_beside(const Plan& plan) const {
    const ReferenceKnot& end = plan.reference.back();
    const std::int64_t ticks = end.tick + flights_.hold_leg(end.point).segment.ticks();
    return std::clamp(direct_tick_work * static_cast<double>(ticks), round_work, most_round_work);
}

/// A round. Variants without direct flights have rounds of the same length, so that all search the same way.
void FlightTreePlanner::go_on_side_by_side(const ompl::base::PlannerTerminationCondition& terminated) {
    std::optional<Proposal> proposed = stops_at_first_plan_ ? std::nullopt : proposal(worthwhile_gain);
    double work = proposed ? work_beside(proposed->candidate.plan) : round_work;
    if (max_iterations_) {  // the refiner does not go on for long when the tree is at its end
        work = std::min(work, usual_sample_work * static_cast<double>(*max_iterations_ - iterations_));
    }
    tree_left_ = std::min(tree_left_, 0.0) + work;
    refiner_left_ = std::min(refiner_left_, 0.0) + work;
    // Tree and refiner share the threads, and whoever is done leaves all to the other, for the batches of the piece
    // that is being worked on too.
    const int refiner_threads = std::max(1, threads_ / 2);
    refined_flights_.use_threads(refiner_threads);
    flights_.use_threads(std::max(1, threads_ - refiner_threads));
    const Strand strands[] = {
        [&] {
            if (proposed) {
                fly(*proposed);
            }
            return false;
        },
        [&] {
            const bool goes_on = !terminated && !is_used_up() && tree_left_ > 0;
            if (goes_on) {
                grow();
            } else {
                refined_flights_.use_threads(threads_);
            }
            return goes_on;
        },
        [&] {
            const bool has_work = refiner_.champion() != nullptr || !handed_over_.empty();
            const bool goes_on = !terminated && has_work && refiner_left_ > 0;
            if (goes_on) {
                refine();
            } else {
                flights_.use_threads(threads_);
            }
            return goes_on;
        },
    };
    run_side_by_side(strands, std::min(threads_, 2));
    if (proposed) {
        settle(std::move(*proposed));
    }
}

std::optional<Configuration> FlightTreePlanner::target() {
    if (incumbent_ && random_.chance(local_bias)) {
        return target_beside_incumbent();
    }
    return random_.chance(has_plan() ? goal_bias : first_goal_bias) ? space_.sample_goal(random_)
                                                                    : space_.sample(random_);
}

std::optional<Configuration> FlightTreePlanner::target_beside_incumbent() {
    const std::vector<ReferenceKnot>& corners = incumbent_->plan.reference;
    const auto i = static_cast<std::size_t>(random_.uniform(0, static_cast<double>(corners.size())));
    const Configuration corner = configuration_of(corners[i].point);
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
    const std::uint64_t ticks_before = flights_.statistics().ticks;
    const std::uint64_t wanted = has_plan() ? wave_size : first_wave_size;
    const std::uint64_t samples = max_iterations_ ? std::min(wanted, *max_iterations_ - iterations_) : wanted;
    std::vector<Growth> wave;
    for (std::uint64_t i = 0; i < samples; ++i) {
        ++iterations_;
        if (auto growth = sampled()) {
            wave.push_back(std::move(*growth));
        }
    }
    choose_parents(wave);
    const std::vector<FlightNode*> added = add(wave);
    std::vector<FlightNode*> arrived;
    for (FlightNode* node : added) {
        if (node == nullptr) {
            continue;
        }
        const double distance_m = space_.goal_distance_m(node->configuration);
        if (distance_m < nearest_distance_m_) {
            nearest_distance_m_ = distance_m;
            nearest_to_goal_ = node;
        }
        if (space_.is_near_goal(node->configuration)) {
            arrived.push_back(node);
        }
    }
    tree_.add_holds(arrived);
    note_best_hold();
    if (has_plan()) {
        rewire_through(wave, added);
        note_best_hold();
    }
    tree_left_ -=
        static_cast<double>(flights_.statistics().ticks - ticks_before) + sample_work * static_cast<double>(samples);
}

std::optional<FlightTreePlanner::Growth> FlightTreePlanner::sampled() {
    const std::optional<Configuration> aim = target();
    if (!aim) {
        return std::nullopt;
    }
    const Configuration& nearest = tree_.nearest(*aim, 1).front()->configuration;
    Growth growth;
    // Goals are aimed at from any distance: what stands in between is found before anything is flown.
    growth.to = space_.is_near_goal(*aim) ? *aim : space_.steered(nearest, *aim, range_m_);
    if (const Rejection rejection = space_.rejection_at(growth.to); rejection != Rejection::none) {
        flights_.count_rejection(rejection);
        return std::nullopt;
    }
    growth.neighbours = tree_.nearest(growth.to, neighbour_count());
    const double least_to_goal = optimism * tree_.least_cost_to_goal(growth.to);
    for (FlightNode* node : with_ancestors(growth.neighbours)) {
        const double estimate = node->cost + optimism * tree_.estimated_cost(*node, growth.to);
        if (estimate + least_to_goal < patience * best_hold_cost_ &&
            space_.distance_m(node->configuration, growth.to) > 1e-6) {
            growth.parents.push_back({node, estimate});
        }
    }
    std::stable_sort(growth.parents.begin(), growth.parents.end(),
                     [](const Growth::Parent& a, const Growth::Parent& b) { return a.estimate < b.estimate; });
    return growth;
}

void FlightTreePlanner::choose_parents(std::vector<Growth>& wave) {
    for (;;) {
        std::vector<FlightTree::Edge> edges;
        std::vector<Growth*> growths;
        for (Growth& growth : wave) {
            if (growth.next_parent == growth.parents.size()) {
                continue;
            }
            const Growth::Parent& parent = growth.parents[growth.next_parent];
            // Until there is a plan any way on will do.
            if (growth.best && (parent.estimate >= growth.best->cost || !has_plan())) {
                growth.next_parent = growth.parents.size();
                continue;
            }
            edges.push_back({parent.node, space_.seen_from(parent.node->configuration, growth.to)});
            growths.push_back(&growth);
        }
        if (edges.empty()) {
            return;
        }
        const auto flights = tree_.flown(edges);
        for (std::size_t i = 0; i < flights.size(); ++i) {
            Growth& growth = *growths[i];
            if (flights[i] && (!growth.best || flights[i]->cost < growth.best->cost)) {
                growth.best = flights[i];
                growth.best_parent = growth.parents[growth.next_parent].node;
            }
            ++growth.next_parent;
        }
    }
}

/// One node per sample, nullptr for those that became none.
std::vector<FlightNode*> FlightTreePlanner::add(const std::vector<Growth>& wave) {
    std::vector<FlightNode*> added;
    for (const Growth& growth : wave) {
        const bool is_worthwhile = growth.best && growth.best->cost + optimism * tree_.least_cost_to_goal(growth.to) <
                                                      patience * best_hold_cost_;
        added.push_back(is_worthwhile ? &tree_.add(*growth.best_parent, *growth.best) : nullptr);
    }
    return added;
}

void FlightTreePlanner::rewire_through(const std::vector<Growth>& wave, const std::vector<FlightNode*>& added) {
    std::vector<FlightTree::Rewiring> rewirings;
    const FlightNode* hold = best_hold();
    for (std::size_t i = 0; i < wave.size(); ++i) {
        FlightNode* const node = added[i];
        if (node == nullptr) {
            continue;
        }
        std::vector<FlightNode*> neighbours = wave[i].neighbours;
        // A better corner pays only when the next corner of the best plan, far away as a rule, is reached from it.
        for (FlightNode* n = hold != nullptr ? hold->parent : nullptr; n != nullptr; n = n->parent) {
            if (n != node && std::find(neighbours.begin(), neighbours.end(), n) == neighbours.end()) {
                neighbours.push_back(n);
            }
        }
        for (FlightNode* neighbour : neighbours) {
            if (neighbour != &tree_.root() && neighbour != node->parent &&
                node->cost + optimism * tree_.estimated_cost(*node, neighbour->configuration) < neighbour->cost) {
                rewirings.push_back({neighbour, node});
            }
        }
    }
    tree_.rewire(rewirings);
}

void FlightTreePlanner::refine() {
    const std::uint64_t ticks_before = refined_flights_.statistics().ticks;
    if (handed_over_.empty()) {
        refiner_.improve();
    }
    for (const Plan& plan : std::exchange(handed_over_, {})) {
        refiner_.take(plan);
    }
    refiner_left_ -= static_cast<double>(refined_flights_.statistics().ticks - ticks_before) + refine_work;
}

/// The refiner gets the tree's best plan whenever that became better, and any other one when it has time.
void FlightTreePlanner::hand_to_refiner() {
    const FlightNode* const best = best_hold();
    if (best == nullptr) {
        return;
    }
    const bool is_idle = refiner_.champion() == nullptr && handed_over_.empty();
    if (is_idle || best->cost < (1 - worthwhile_gain) * handed_over_cost_) {
        handed_over_cost_ = best->cost;
        handed_over_.push_back(tree_.plan_to(*best));
    } else if (refiner_.champion() != nullptr && refiner_.wants_plan()) {
        if (const FlightNode* hold = other_way()) {
            handed_over_.push_back(tree_.plan_to(*hold));
        }
    }
}

/// Of some holds, drawn by lot, the one whose way leads farthest from the champion's; nullptr when all follow it.
const FlightNode* FlightTreePlanner::other_way() {
    constexpr int draws = 8;
    const std::vector<ReferencePoint>& champion = refiner_.champion()->points;
    const auto& holds = tree_.holds();
    const FlightNode* farthest = nullptr;
    double farthest_m = other_way_m;
    for (int i = 0; i < draws; ++i) {
        const FlightNode* hold = holds[static_cast<std::size_t>(random_.uniform(0, static_cast<double>(holds.size())))];
        double away_m = 0;
        for (const FlightNode* n = hold->parent; n != nullptr; n = n->parent) {
            away_m = std::max(away_m, distance_from_way_m(n->configuration, champion));
        }
        if (!hold->is_discarded && away_m > farthest_m) {
            farthest_m = away_m;
            farthest = hold;
        }
    }
    return farthest;
}

FlightNode* FlightTreePlanner::best_hold() const {
    FlightNode* best = nullptr;
    for (FlightNode* hold : tree_.holds()) {
        if (!hold->is_discarded && (best == nullptr || hold->cost < best->cost)) {
            best = hold;
        }
    }
    return best;
}

void FlightTreePlanner::note_best_hold() {
    const FlightNode* const hold = best_hold();
    best_hold_cost_ = hold != nullptr ? hold->cost : HUGE_VAL;
}

/// The cheapest plan, of tree and refiner, if it is by this share cheaper than the incumbent.
std::optional<FlightTreePlanner::Proposal> FlightTreePlanner::proposal(double least_gain) const {
    const double to_beat = incumbent_ ? (1 - least_gain) * incumbent_->cost : HUGE_VAL;
    const FlownPlan* const champion = refiner_.champion();
    FlightNode* const hold = best_hold();
    if (champion != nullptr && champion->cost < to_beat && (hold == nullptr || champion->cost <= hold->cost)) {
        return Proposal{
            {refiner_.plan_of(*champion), champion->cost, iterations_}, champion->states, refiner_.champion_number()};
    }
    if (hold != nullptr && hold->cost < to_beat) {
        return Proposal{{tree_.plan_to(*hold), hold->cost, iterations_}, tree_.states_to(*hold), 0, hold};
    }
    return std::nullopt;
}

void FlightTreePlanner::fly(Proposal& proposal) const {
    proposal.is_good = hooks_.counts(proposal.candidate);
    flights_.verify(proposal.candidate.plan.reference, proposal.states);
}

/// What becomes of a plan that was flown.
void FlightTreePlanner::settle(Proposal proposal) {
    if (proposal.is_good) {
        hooks_.accept(proposal.candidate);
        incumbent_ = std::move(proposal.candidate);
        return;
    }
    flights_.count_rejection("direct_flight");
    if (proposal.hold == nullptr) {
        refiner_.drop(proposal.refined);
        if (incumbent_) {
            handed_over_.push_back(incumbent_->plan);
        }
    } else if (proposal.hold->cost == proposal.candidate.cost) {
        proposal.hold->is_discarded = true;  // unless it was rewired meanwhile: a new flight, a new chance
        note_best_hold();
    }
}

/// Flies the cheapest plans one after the other until one is good; not many any more once the search is at its end.
void FlightTreePlanner::settle_best(const ompl::base::PlannerTerminationCondition& terminated) {
    int refused_at_end = 0;
    while (auto best = proposal(any_gain)) {
        fly(*best);
        const bool is_good = best->is_good;
        settle(std::move(*best));
        refused_at_end += terminated || is_used_up() ? 1 : 0;
        if (is_good || refused_at_end >= most_refused_at_end) {
            return;
        }
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

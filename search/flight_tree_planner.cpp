#include "downwash/search/flight_tree_planner.hpp"

#include <ompl/base/PlannerData.h>
#include <ompl/base/ScopedState.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_set>
#include <utility>

#include "downwash/base/parallel.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/search/flight_space.hpp"

namespace downwash::planning {
namespace {

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

/// Lets flights ask a termination condition as long as solve() goes on.
class ConditionScope {
 public:
    using Condition = ompl::base::PlannerTerminationCondition;
    ConditionScope(const Condition*& asked, const Condition& condition) : asked_(asked) { asked_ = &condition; }
    ~ConditionScope() { asked_ = nullptr; }
    ConditionScope(const ConditionScope&) = delete;
    ConditionScope& operator=(const ConditionScope&) = delete;

 private:
    const Condition*& asked_;
};

}  // namespace

FlightTreePlanner::FlightTreePlanner(const ompl::base::SpaceInformationPtr& information, const SearchTask& task,
                                     int threads)
    : ompl::base::Planner(information, "FlightTree"),
      task_(task),
      space_(task.space),
      parameters_(task.problem.planner),
      threads_(std::max(1, threads)),
      flights_(
          task, [this] { return terminated_ != nullptr && (*terminated_)(); }, threads_),
      refined_flights_(
          task, [this] { return terminated_ != nullptr && (*terminated_)(); }, threads_),
      random_(task.problem.planner.seed),
      refiner_random_(random_.branch()) {
    specs_.recognizedGoal = ompl::base::GOAL_SAMPLEABLE_REGION;
    specs_.approximateSolutions = true;
    specs_.optimizingPaths = true;
    specs_.multithreaded = threads_ > 1;
    specs_.canReportIntermediateSolutions = true;
    for (const FlightTreeParameters::Member& member : FlightTreeParameters::members()) {
        params_.declareParam<double>(
            std::string(member.name), [this, value = member.value](double given) { parameters_.*value = given; },
            [this, value = member.value] { return parameters_.*value; });
    }
    addPlannerProgressProperty("iterations INTEGER", [this] { return std::to_string(iterations_); });
    addPlannerProgressProperty("best cost REAL", [this] { return best_ ? to_text(best_->cost) : std::string("inf"); });
}

void FlightTreePlanner::setup() {
    Planner::setup();
    for (const FlightTreeParameters::Member& member : FlightTreeParameters::members()) {
        const AlgorithmParameter& known = FlightTreeParameters::info(member.name);
        const double value = parameters_.*member.value;
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
    flights_.forget_statistics();
    refined_flights_.forget_statistics();
    random_ = Random(task_.problem.planner.seed);
    refiner_random_ = random_.branch();
    refiner_.reset();
    tree_.reset();
    iterations_ = 0;
    best_.reset();
    handed_over_.clear();
    best_hold_cost_ = handed_over_cost_ = HUGE_VAL;
    tree_left_ = refiner_left_ = 0;
    nearest_to_goal_ = nullptr;
    nearest_distance_m_ = HUGE_VAL;
}

void FlightTreePlanner::begin(const FlightPoint& start) {
    tree_.emplace(start, flights_);
    refiner_.emplace(start, refined_flights_, refiner_random_);
    nearest_to_goal_ = &tree_->root();
    nearest_distance_m_ = space_.goal_distance_m(tree_->root().configuration);
    if (space_.is_near_goal(tree_->root().configuration)) {
        const std::vector<FlightNode*> root{&tree_->root()};
        tree_->add_holds(root);
        note_best_hold();
    }
}

FlightStatistics FlightTreePlanner::statistics() const {
    FlightStatistics all = flights_.statistics();
    all += refined_flights_.statistics();
    return all;
}

ompl::base::PlannerStatus FlightTreePlanner::solve(const ompl::base::PlannerTerminationCondition& terminated) {
    checkValidity();
    const auto* goal = dynamic_cast<const FlightGoal*>(pdef_->getGoal().get());
    if (goal == nullptr || &goal->task() != &task_) {
        OMPL_ERROR("%s: the goal is not the FlightGoal of the planner's task", getName().c_str());
        return ompl::base::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
    }
    const ConditionScope scope(terminated_, terminated);
    if (!tree_) {
        const ompl::base::State* start = pis_.nextStart();
        if (start == nullptr) {
            OMPL_ERROR("%s: there is no valid start", getName().c_str());
            return ompl::base::PlannerStatus::INVALID_START;
        }
        begin(point_of(start));
    }
    const auto is_done = [this] { return best_ && stops_at_first_plan_; };
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
    const bool is_exact = best_.has_value();
    if (!is_exact && nearest_to_goal_->parent == nullptr) {
        return ompl::base::PlannerStatus::TIMEOUT;
    }
    ompl::base::PlannerSolution solution(
        make_path(is_exact ? best_->moments : FlightTree::moments_to(*nearest_to_goal_)));
    solution.setPlannerName(getName());
    if (is_exact) {
        const auto objective =
            pdef_->hasOptimizationObjective() ? pdef_->getOptimizationObjective() : make_flight_objective(si_);
        const ompl::base::Cost cost(best_->cost);
        solution.setOptimized(objective, cost, objective->isSatisfied(cost));
    } else {
        solution.setApproximate(nearest_distance_m_);
    }
    pdef_->addSolutionPath(solution);
    return is_exact ? ompl::base::PlannerStatus::EXACT_SOLUTION : ompl::base::PlannerStatus::APPROXIMATE_SOLUTION;
}

/// The work that tree and refiner do in a round beside a plan that is flown directly.
double FlightTreePlanner::work_beside(const Candidate& candidate) const {
    const auto ticks = static_cast<double>(candidate.moments.back().ticks);
    return std::clamp(parameters_.execution_tick_work * ticks, parameters_.round_work,
                      std::max(parameters_.round_work, parameters_.max_round_work));
}

/// A round. Variants without direct flights have rounds of the same length, so that all search the same way.
void FlightTreePlanner::go_on_side_by_side(const ompl::base::PlannerTerminationCondition& terminated) {
    std::optional<Proposal> proposed = stops_at_first_plan_ ? std::nullopt : proposal(parameters_.worthwhile_gain);
    double work = proposed ? work_beside(proposed->candidate) : parameters_.round_work;
    if (max_iterations_) {  // the refiner does not go on for long when the tree is at its end
        work = std::min(work, parameters_.usual_sample_work * static_cast<double>(*max_iterations_ - iterations_));
    }
    tree_left_ = std::min(tree_left_, 0.0) + work;
    refiner_left_ = std::min(refiner_left_, 0.0) + work;
    // Tree and refiner share the threads, and whoever is done leaves all to the other, for the batches of the piece
    // that is being worked on too.
    const int refiner_threads = std::max(1, threads_ / 2);
    refined_flights_.use_threads(refiner_threads);
    flights_.use_threads(std::max(1, threads_ - refiner_threads));
    const SteppedTask tasks[] = {
        [&] {
            if (proposed) {
                execute(*proposed);
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
            const bool has_work = refiner_->best() != nullptr || !handed_over_.empty();
            const bool goes_on = !terminated && has_work && refiner_left_ > 0;
            if (goes_on) {
                refine();
            } else {
                flights_.use_threads(threads_);
            }
            return goes_on;
        },
    };
    run_side_by_side(tasks, std::min(threads_, 2));
    if (proposed) {
        settle(std::move(*proposed));
    }
}

std::optional<Configuration> FlightTreePlanner::target() {
    if (best_ && random_.chance(parameters_.local_bias)) {
        return target_beside_best();
    }
    return random_.chance(has_plan() ? parameters_.goal_bias : parameters_.first_goal_bias)
               ? space_.sample_goal(random_)
               : space_.sample(random_);
}

std::optional<Configuration> FlightTreePlanner::target_beside_best() {
    const std::size_t knots = best_->moments.size() - 1;
    const auto i = static_cast<std::size_t>(random_.uniform(0, static_cast<double>(knots)));
    const Configuration knot = configuration_of(best_->moments[i].reference);
    const double radius_m = parameters_.local_radius_m * random_.uniform(0, 1) * random_.uniform(0, 1);
    return i + 1 == knots ? space_.sample_goal_near(knot, radius_m, random_)
                          : space_.sample_near(knot, radius_m, random_);
}

std::size_t FlightTreePlanner::neighbour_count() const {
    // k-nearest RRT* (Karaman and Frazzoli 2011): k > e (1 + 1/d) log n in d dimensions.
    constexpr double dimension = 3;
    const auto n = static_cast<double>(tree_->size());
    return static_cast<std::size_t>(std::ceil(std::numbers::e * (1 + 1 / dimension) * std::log(n + 1)));
}

void FlightTreePlanner::grow() {
    const std::uint64_t ticks_before = flights_.statistics().ticks;
    const std::uint64_t wanted =
        static_cast<std::uint64_t>(has_plan() ? parameters_.batch_size : parameters_.first_batch_size);
    const std::uint64_t samples = max_iterations_ ? std::min(wanted, *max_iterations_ - iterations_) : wanted;
    std::vector<Growth> batch;
    for (std::uint64_t i = 0; i < samples; ++i) {
        ++iterations_;
        if (auto growth = sampled()) {
            batch.push_back(std::move(*growth));
        }
    }
    choose_parents(batch);
    const std::vector<FlightNode*> added = add(batch);
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
    tree_->add_holds(arrived);
    note_best_hold();
    if (has_plan()) {
        rewire_through(batch, added);
        note_best_hold();
    }
    tree_left_ -= static_cast<double>(flights_.statistics().ticks - ticks_before) +
                  parameters_.sample_work * static_cast<double>(samples);
}

std::optional<FlightTreePlanner::Growth> FlightTreePlanner::sampled() {
    const std::optional<Configuration> aim = target();
    if (!aim) {
        return std::nullopt;
    }
    const Configuration& nearest = tree_->nearest(*aim, 1).front()->configuration;
    Growth growth;
    // Goals are aimed at from any distance: what stands in between is found before anything is flown.
    growth.to =
        space_.is_near_goal(*aim) ? *aim : space_.steered(nearest, *aim, parameters_.range_share * space_.extent_m());
    if (const Rejection rejection = space_.rejection_at(growth.to); rejection != Rejection::none) {
        flights_.count_rejection(rejection);
        return std::nullopt;
    }
    growth.neighbours = tree_->nearest(growth.to, neighbour_count());
    const double min_cost_to_goal = parameters_.optimism * tree_->min_cost_to_goal(growth.to);
    for (FlightNode* node : with_ancestors(growth.neighbours)) {
        const double estimate = node->cost + parameters_.optimism * tree_->estimated_cost(*node, growth.to);
        if (estimate + min_cost_to_goal < parameters_.max_detour * best_hold_cost_ &&
            space_.distance_m(node->configuration, growth.to) > 1e-6) {
            growth.parents.push_back({node, estimate});
        }
    }
    std::stable_sort(growth.parents.begin(), growth.parents.end(),
                     [](const Growth::Parent& a, const Growth::Parent& b) { return a.estimate < b.estimate; });
    return growth;
}

void FlightTreePlanner::choose_parents(std::vector<Growth>& batch) {
    for (;;) {
        std::vector<FlightTree::Edge> edges;
        std::vector<Growth*> growths;
        for (Growth& growth : batch) {
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
        const auto flights = tree_->flown(edges);
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
std::vector<FlightNode*> FlightTreePlanner::add(const std::vector<Growth>& batch) {
    std::vector<FlightNode*> added;
    for (const Growth& growth : batch) {
        const bool is_worthwhile =
            growth.best && growth.best->cost + parameters_.optimism * tree_->min_cost_to_goal(growth.to) <
                               parameters_.max_detour * best_hold_cost_;
        added.push_back(is_worthwhile ? &tree_->add(*growth.best_parent, *growth.best) : nullptr);
    }
    return added;
}

void FlightTreePlanner::rewire_through(const std::vector<Growth>& batch, const std::vector<FlightNode*>& added) {
    std::vector<FlightTree::Rewiring> rewirings;
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
            if (neighbour != &tree_->root() && neighbour != node->parent &&
                node->cost + parameters_.optimism * tree_->estimated_cost(*node, neighbour->configuration) <
                    neighbour->cost) {
                rewirings.push_back({neighbour, node});
            }
        }
    }
    tree_->rewire(rewirings);
}

void FlightTreePlanner::refine() {
    const std::uint64_t ticks_before = refined_flights_.statistics().ticks;
    if (handed_over_.empty()) {
        refiner_->improve();
    }
    for (const Plan& plan : std::exchange(handed_over_, {})) {
        refiner_->take(plan);
    }
    refiner_left_ -= static_cast<double>(refined_flights_.statistics().ticks - ticks_before) + parameters_.refine_work;
}

/// The refiner gets the tree's best plan whenever that became better, and any other one when it has time.
void FlightTreePlanner::hand_to_refiner() {
    const FlightNode* const best = best_hold();
    if (best == nullptr) {
        return;
    }
    const bool is_idle = refiner_->best() == nullptr && handed_over_.empty();
    if (is_idle || best->cost < (1 - parameters_.worthwhile_gain) * handed_over_cost_) {
        handed_over_cost_ = best->cost;
        handed_over_.push_back(tree_->plan_to(*best));
    } else if (refiner_->best() != nullptr && refiner_->wants_plan()) {
        if (const FlightNode* hold = other_way()) {
            handed_over_.push_back(tree_->plan_to(*hold));
        }
    }
}

/// Of some holds, drawn at random, the one whose way leads farthest from the best plan; nullptr when all follow it.
const FlightNode* FlightTreePlanner::other_way() {
    constexpr int draws = 8;
    const std::vector<ReferencePoint>& best_points = refiner_->best()->points;
    const auto& holds = tree_->holds();
    const FlightNode* farthest = nullptr;
    double farthest_m = parameters_.alternative_distance_m;
    for (int i = 0; i < draws; ++i) {
        const FlightNode* hold = holds[static_cast<std::size_t>(random_.uniform(0, static_cast<double>(holds.size())))];
        double away_m = 0;
        for (const FlightNode* n = hold->parent; n != nullptr; n = n->parent) {
            away_m = std::max(away_m, distance_from_way_m(n->configuration, best_points));
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
    for (FlightNode* hold : tree_->holds()) {
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

/// The cheapest plan, of tree and refiner, if it is cheaper than the best plan by this share.
std::optional<FlightTreePlanner::Proposal> FlightTreePlanner::proposal(double min_gain) const {
    const double to_beat = best_ ? (1 - min_gain) * best_->cost : HUGE_VAL;
    const FlownPlan* const refined = refiner_->best();
    FlightNode* const hold = best_hold();
    if (refined != nullptr && refined->cost < to_beat && (hold == nullptr || refined->cost <= hold->cost)) {
        return Proposal{{refiner_->moments_of(*refined), refined->cost, iterations_}, refiner_->best_number()};
    }
    if (hold != nullptr && hold->cost < to_beat) {
        return Proposal{{FlightTree::moments_to(*hold), hold->cost, iterations_}, 0, hold};
    }
    return std::nullopt;
}

void FlightTreePlanner::execute(Proposal& proposal) const {
    proposal.is_good = !hooks_.survives_execution || hooks_.survives_execution(proposal.candidate);
    flights_.verify(proposal.candidate.moments);
}

/// What becomes of a plan that was executed.
void FlightTreePlanner::settle(Proposal proposal) {
    if (proposal.is_good) {
        if (hooks_.accept) {
            hooks_.accept(proposal.candidate);
        }
        best_ = std::move(proposal.candidate);
        return;
    }
    flights_.count_rejection("direct_flight");
    if (proposal.hold == nullptr) {
        refiner_->drop(proposal.refined);
        if (best_) {
            handed_over_.push_back(plan_through(best_->moments, task_.model.tick().tick_s));
        }
    } else if (proposal.hold->cost == proposal.candidate.cost) {
        proposal.hold->is_discarded = true;  // unless it was rewired meanwhile: a new flight, a new chance
        note_best_hold();
    }
}

/// Flies the cheapest plans one after the other until one is good; not many any more once the search is at its end.
void FlightTreePlanner::settle_best(const ompl::base::PlannerTerminationCondition& terminated) {
    int rejected_at_end = 0;
    while (auto best = proposal(parameters_.final_gain)) {
        execute(*best);
        const bool is_good = best->is_good;
        settle(std::move(*best));
        rejected_at_end += terminated || is_used_up() ? 1 : 0;
        if (is_good || rejected_at_end >= static_cast<int>(parameters_.max_rejected_at_end)) {
            return;
        }
    }
}

void FlightTreePlanner::getPlannerData(ompl::base::PlannerData& data) const {
    Planner::getPlannerData(data);
    if (!tree_) {
        return;
    }
    std::vector<ompl::base::ScopedState<>> states;  // one per node, in the order of the tree
    std::map<const FlightNode*, std::size_t> index;
    const auto vertex_of = [&](const FlightNode* node) {
        return ompl::base::PlannerDataVertex(states[index.at(node)].get());
    };
    for (const FlightNode* node : tree_->nodes()) {
        index[node] = states.size();
        point_of(states.emplace_back(si_).get()) = moment_at(*node);
    }
    for (const FlightNode* node : tree_->nodes()) {
        if (node->parent == nullptr) {
            data.addStartVertex(vertex_of(node));
        } else {
            data.addEdge(vertex_of(node->parent), vertex_of(node), ompl::base::PlannerDataEdge(),
                         ompl::base::Cost(node->cost - node->parent->cost));
        }
    }
    for (const FlightNode* hold : tree_->holds()) {
        data.addGoalVertex(vertex_of(hold->parent));
    }
    data.decoupleFromPlanner();  // the states above end here
}

}  // namespace downwash::planning

#include "downwash/search/flight_tree_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/base/parallel.hpp"

namespace downwash::planning {
namespace {

/// Lets flights ask a termination condition as long as a search goes on.
class ConditionScope {
 public:
    ConditionScope(const StopCondition*& asked, const StopCondition& condition) : asked_(asked) { asked_ = &condition; }
    ~ConditionScope() { asked_ = nullptr; }
    ConditionScope(const ConditionScope&) = delete;
    ConditionScope& operator=(const ConditionScope&) = delete;

 private:
    const StopCondition*& asked_;
};

}  // namespace

template <class Family>
FlightTreeSearchOf<Family>::FlightTreeSearchOf(const SearchTask& task, int threads)
    : task_(task),
      space_(task.space),
      parameters_(task.problem.planner),
      threads_(std::max(1, threads)),
      flights_(
          task, [this] { return is_over(); }, threads_),
      refined_flights_(
          task, [this] { return is_over(); }, threads_),
      refiner_random_(task.problem.planner.seed) {}

template <class Family>
void FlightTreeSearchOf<Family>::clear() {
    flights_.forget();
    refined_flights_.forget();
    refiner_.reset();
    growth_.reset();
    iterations_ = 0;
    best_.reset();
    handed_over_.clear();
    handed_over_cost_ = HUGE_VAL;
    idle_rounds_ = 0;
    failures_in_a_row_ = 0;
    tree_left_ = refiner_left_ = 0;
}

template <class Family>
void FlightTreeSearchOf<Family>::begin(const FlightPoint& start, Random& random, PlaceSampler& sampler) {
    random = Random(task_.problem.planner.seed);
    refiner_random_ = random.branch();
    growth_.emplace(start, space_, parameters_, flights_, random, sampler);
    refiner_.emplace(start, refined_flights_, refiner_random_);
    growth_->try_first(known_places_);
    growth_->follow(known_way_);
    if (known_plan_ && known_plan_->reference.size() > 1) {
        refiner_->work_on({*known_plan_});
        if (const FlownPlan* const known = refiner_->best()) {
            growth_->know_plan(refiner_->moments_of(*known));
        }
    }
}

template <class Family>
auto FlightTreeSearchOf<Family>::statistics() const -> FlightStatistics {
    FlightStatistics all = flights_.statistics();
    all += refined_flights_.statistics();
    return all;
}

template <class Family>
void FlightTreeSearchOf<Family>::go_on(const StopCondition& terminated,
                                       const std::function<bool(double cost)>& is_enough) {
    const ConditionScope scope(terminated_, terminated);
    const auto is_done = [&] { return best_ && (suffices(best_->cost) || (is_enough && is_enough(best_->cost))); };
    while (!terminated() && !is_used_up() && !is_done()) {
        if (growth_->has_plan() || refined_flights_.has_counterexamples()) {
            go_on_side_by_side(terminated);
        } else {
            grow();
            tree_left_ = 0;  // the rounds begin with the first plan
        }
        hand_to_refiner();
        if (observer_) {
            observer_();
        }
        if (const auto best = proposal(parameters_.final_gain); best && suffices(best->candidate.cost)) {
            settle_best(terminated);  // at once, and whatever else may have been found beside it
        }
    }
    if (!is_done()) {
        settle_best(terminated);
    }
}

/// How far a plan goes back in its lineage: the more plans in a row failed their certificates, the farther.
template <class Family>
std::size_t FlightTreeSearchOf<Family>::steps_back_after(int failures_in_a_row) {
    constexpr int patience = 2, most_doublings = 6;
    return std::size_t{1} << std::clamp(failures_in_a_row - patience, 0, most_doublings);
}

/// The work that tree and refiner do in a round beside a plan that is flown directly.
template <class Family>
double FlightTreeSearchOf<Family>::work_beside(const Candidate& candidate) const {
    const double most = std::max(parameters_.round_work, parameters_.max_round_work);
    if (task_.worlds != nullptr) {
        return most;  // a certificate takes longer than any execution
    }
    const auto ticks = static_cast<double>(candidate.moments.back().ticks);
    return std::clamp(parameters_.execution_tick_work * ticks, parameters_.round_work, most);
}

/// A round. Variants without direct flights have rounds of the same length, so that all search the same way.
template <class Family>
void FlightTreeSearchOf<Family>::go_on_side_by_side(const StopCondition& terminated) {
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
    SteppedTask tasks[] = {
        [&] {
            if (proposed) {
                execute(*proposed);
            }
            return false;
        },
        [&] {
            const bool goes_on = !terminated() && !is_used_up() && tree_left_ > 0;
            if (goes_on) {
                grow();
            } else {
                refined_flights_.use_threads(threads_);
            }
            return goes_on;
        },
        [&] {
            const bool has_work = refiner_->best() != nullptr || !handed_over_.empty();
            const bool goes_on = !terminated() && has_work && refiner_left_ > 0;
            if (goes_on) {
                refine();
            } else {
                flights_.use_threads(threads_);
            }
            return goes_on;
        },
    };
    run_side_by_side(tasks, std::min(threads_, 3));
    if (proposed) {
        settle(std::move(*proposed));
    }
}

template <class Family>
void FlightTreeSearchOf<Family>::grow() {
    const std::uint64_t ticks_before = flights_.statistics().ticks;
    const std::uint64_t samples =
        growth_->grow(max_iterations_ ? std::optional(*max_iterations_ - iterations_) : std::nullopt);
    iterations_ += samples;
    tree_left_ -= static_cast<double>(flights_.statistics().ticks - ticks_before) +
                  parameters_.sample_work * static_cast<double>(samples);
}

template <class Family>
void FlightTreeSearchOf<Family>::refine() {
    const std::uint64_t ticks_before = refined_flights_.statistics().ticks;
    if (handed_over_.empty()) {
        refiner_->improve();
    }
    for (HandedOver& handed_over : std::exchange(handed_over_, {})) {
        refiner_->work_on(std::move(handed_over.lineage), handed_over.steps_back);
    }
    refiner_left_ -= static_cast<double>(refined_flights_.statistics().ticks - ticks_before) + parameters_.refine_work;
}

/// The refiner gets the tree's best plan whenever that became better, and any other one when it has time.
template <class Family>
void FlightTreeSearchOf<Family>::hand_to_refiner() {
    const bool is_idle = refiner_->best() == nullptr && handed_over_.empty();
    idle_rounds_ = is_idle ? idle_rounds_ + 1 : 0;
    const bool has_counterexamples = refined_flights_.has_counterexamples();
    const FlightNode* const best =
        is_idle && has_counterexamples ? growth_->hold_by_rank(idle_rounds_ - 1) : growth_->best_hold();
    if (best == nullptr) {
        return;
    }
    if (is_idle || best->cost < (1 - parameters_.worthwhile_gain) * handed_over_cost_) {
        handed_over_cost_ = best->cost;
        handed_over_.push_back({{growth_->tree().plan_to(*best)}});
    } else if (refiner_->best() != nullptr && refiner_->wants_plan()) {
        if (const FlightNode* hold = growth_->hold_away_from(refiner_->best()->points)) {
            handed_over_.push_back({{growth_->tree().plan_to(*hold)}});
        }
    }
}

/// The cheapest plan, of tree and refiner, if it is cheaper than the best plan by this share.
template <class Family>
auto FlightTreeSearchOf<Family>::proposal(double min_gain) const -> std::optional<Proposal> {
    const double to_beat = best_ ? (1 - min_gain) * best_->cost : HUGE_VAL;
    const FlownPlan* const refined = refiner_->best();
    // The tree does not fly in counterexamples; what it finds has to pass the refiner first.
    FlightNode* const hold = refined_flights_.has_counterexamples() ? nullptr : growth_->best_hold();
    if (refined != nullptr && refined->cost < to_beat && (hold == nullptr || refined->cost <= hold->cost)) {
        return Proposal{{refiner_->moments_of(*refined), refined->cost, iterations_}, refiner_->best_number()};
    }
    if (hold != nullptr && hold->cost < to_beat) {
        return Proposal{{FlightTree::moments_to(*hold), hold->cost, iterations_}, 0, hold};
    }
    return std::nullopt;
}

template <class Family>
void FlightTreeSearchOf<Family>::execute(Proposal& proposal) const {
    proposal.is_good = !hooks_.survives_execution || hooks_.survives_execution(proposal.candidate);
    flights_.verify(proposal.candidate.moments);
}

/// What becomes of a plan that was executed.
template <class Family>
void FlightTreeSearchOf<Family>::settle(Proposal proposal) {
    if (proposal.is_good) {
        if (hooks_.accept) {
            hooks_.accept(proposal.candidate);
        }
        best_ = std::move(proposal.candidate);
        failures_in_a_row_ = 0;
        growth_->know_plan(best_->moments);
        return;
    }
    flights_.count_rejection("direct_flight");
    if (std::vector<Counterexample> found; hooks_.counterexamples && !(found = hooks_.counterexamples()).empty()) {
        learn_from(proposal, found);
    } else if (proposal.hold == nullptr) {
        refiner_->drop(proposal.refined);
        if (best_) {
            handed_over_.push_back({{plan_through(best_->moments, task_.blank_plan)}});
        }
    }
    if (proposal.hold == nullptr) {
        return;
    }
    if (proposal.hold->cost == proposal.candidate.cost) {
        growth_->discard(*proposal.hold);  // unless it was rewired meanwhile: a new flight, a new chance
    }
}

/// From now on the refiner flies in these worlds, too, and takes its plans on anew.
template <class Family>
void FlightTreeSearchOf<Family>::learn_from(const Proposal& failed,
                                            const std::vector<Counterexample>& counterexamples) {
    const bool is_refiners_best =
        failed.hold == nullptr && refiner_->best() != nullptr && refiner_->best_number() == failed.refined;
    refined_flights_.join(counterexamples);
    ++failures_in_a_row_;
    bool is_best = true;
    for (Lineage& lineage : refiner_->release()) {
        handed_over_.push_back(
            {std::move(lineage), is_best && is_refiners_best ? steps_back_after(failures_in_a_row_) : 0});
        is_best = false;
    }
    if (!is_refiners_best) {
        handed_over_.push_back({{plan_through(failed.candidate.moments, task_.blank_plan)}, 1});
    }
}

/// Executes the cheapest plans one after the other until one is good. At the end of the search it gives up after
/// max_rejected_at_end plans.
template <class Family>
void FlightTreeSearchOf<Family>::settle_best(const StopCondition& terminated) {
    int rejected_at_end = 0;
    while (auto best = proposal(parameters_.final_gain)) {
        execute(*best);
        const bool is_good = best->is_good;
        settle(std::move(*best));
        rejected_at_end += terminated() || is_used_up() ? 1 : 0;
        if (is_good || rejected_at_end >= static_cast<int>(parameters_.max_rejected_at_end)) {
            return;
        }
    }
}

template class FlightTreeSearchOf<Plane>;
template class FlightTreeSearchOf<Space>;

}  // namespace downwash::planning

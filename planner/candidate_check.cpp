#include "downwash/planner/candidate_check.hpp"

#include <algorithm>
#include <future>
#include <system_error>
#include <utility>

#include "downwash/planner/family_parts.hpp"
#include "downwash/planner/space_worlds.hpp"
#include "downwash/planner/stop_finder.hpp"
#include "downwash/search/obstacle_labels.hpp"

namespace downwash::planning {
namespace {

constexpr std::string_view failed_certificate = "certificate";

template <class Family>
typename Family::Obstruction obstruction_of(const Certificate& certificate, const typename Family::Plan& plan) {
    return {std::string(certificate.is_refused ? failed_certificate : unfinished_certificate), end_of(plan), 0};
}

/// Whether a search after a course is for the way to the last goal of a problem.
template <class Family>
bool is_last(const CourseOf<Family>& before, const typename Family::Problem& whole) {
    return before.goals.size() + 1 == goals_of(whole).size();
}

}  // namespace

template <class Family>
CandidateCheckOf<Family>::CandidateCheckOf(const Problem& part, const Problem& whole, const PlannerModel& model,
                                           const Course& before, const PlanChecks& checks, const SolveOptions& options)
    : options_(options),
      before_(before),
      checks_(checks),
      goals_(before.goals),
      clock_(part.planner, options, checks.time_s),
      search_worlds_(plans_flights(part.planner.variant) && checks.worlds != nullptr ? checks.worlds->for_search(before)
                                                                                     : SearchWorlds{}),
      task_(part, *model.flight, model.own_map.get(), before.vehicle,
            plans_flights(part.planner.variant) && checks.worlds != nullptr ? &search_worlds_ : nullptr,
            before.ticks()),
      is_executed_alone_(before.plan.reference.empty() || (Family::executes_parts_alone && !is_last(before, whole))),
      start_(is_executed_alone_ ? before.vehicle : start_state(*model.flight, whole.start)) {
    if (!is_last(before, whole)) {
        checks_.stop_finder = nullptr;
    }
    goals_.push_back(goal_of(part));
    result_.attempts = before.attempts;
}

template <class Family>
bool CandidateCheckOf<Family>::counts(const Plan& plan, double cost) {
    counterexamples_.clear();
    clock_.found_first(clock_.seconds());
    if (is_too_late()) {
        return false;
    }
    Candidates& candidates = clock_.record.candidates;
    ++candidates.checked;
    if (task_.problem.planner.check_execution) {
        if (!flies_well(plan, cost)) {
            ++(unfinished_ ? candidates.unfinished : candidates.failed_execution);
            return false;
        }
    } else if (needs_certificate()) {
        certify(before_.plan.followed_by(plan), [this] { return check_is_over(); });
    }
    known_at_s_ = clock_.seconds();
    if (certifies() && !is_certified(plan, cost)) {
        ++(certificate_->is_refused ? candidates.failed_certificate : candidates.unfinished);
        return false;
    }
    if (!can_stop(plan)) {
        ++(stops_ ? candidates.worse_stops : candidates.unfinished);
        return false;
    }
    return true;
}

/// Too late for another certificate and, where a check may end after the search, to begin with another one.
template <class Family>
bool CandidateCheckOf<Family>::is_too_late() {
    const bool has_checked = checks_.time_s > 0 && clock_.record.candidates.checked > 0;
    return (uncertified_ || has_checked) && is_over();
}

/// Flies a plan to the last goal for its certificate.
template <class Family>
void CandidateCheckOf<Family>::certify(const Plan& flown, const StopCondition& is_over) {
    certificate_ = checks_.worlds->certify(flown, result_.attempts + 1, is_over, world_counter());
    clock_.has_certified();
}

/// Whether a plan is good when executed with direct aerodynamics. If the plan needs a certificate, another thread
/// begins with it meanwhile; a plan that is not good has asked for none.
template <class Family>
bool CandidateCheckOf<Family>::flies_well(const Plan& plan, double cost) {
    unfinished_.reset();
    const Plan flown = before_.plan.followed_by(plan);
    const Plan& executed = is_executed_alone_ ? plan : flown;
    const std::vector<Goal> goals = is_executed_alone_ ? std::vector<Goal>{goal_of(task_.problem)} : goals_;
    bool is_finished = false;
    std::atomic<bool> is_bad = false;
    const auto fly = [&] {
        try {
            flight_ = fly_directly(task_.model, start_, executed, goals, task_.problem.energy_budget_j,
                                   [this] { return check_is_over(); });
            is_finished = true;
        } catch (const WorkStopped&) {  // too late
        }
        is_bad = !is_finished || !is_good(flight_->execution, task_.problem.planner.safety_margin_m);
    };
    // The certificate stays on this thread: where it is solve()'s own, it tells the caller how the search goes.
    std::future<void> flight;
    if (needs_certificate() && options_.threads > 1) {
        try {
            flight = std::async(std::launch::async, fly);
        } catch (const std::system_error&) {  // no more threads
        }
    }
    if (!flight.valid()) {
        fly();
    }
    if (needs_certificate() && !is_bad) {
        certify(flown, [&] { return is_bad || check_is_over(); });
    }
    if (flight.valid()) {
        flight.get();
    }
    if (!is_finished) {
        discarded_ = Obstruction{std::string(unfinished_flight), end_of(plan), 0};
        unfinished_ = {plan, cost};
    } else if (is_bad) {
        discarded_ = obstruction_of(flight_->execution, task_);
    }
    return !is_bad;
}

/// Whether a plan can be left for a hover as long as the one that counts. The first one counts in any case, and so does
/// every one where execution is not checked: stops are flights near surfaces, too.
template <class Family>
bool CandidateCheckOf<Family>::can_stop(const Plan& plan) {
    stops_.reset();
    if (checks_.stop_finder == nullptr) {
        return true;
    }
    try {
        stops_ =
            checks_.stop_finder->along(before_.plan.followed_by(plan), [this] { return clock_.is_over_for_checks(); });
    } catch (const WorkStopped&) {  // too late to know, and to find another one
        return !has_plan();
    }
    return !task_.problem.planner.check_execution || !result_.found.safe_stops ||
           !is_clearly_worse(*stops_, *result_.found.safe_stops);
}

/// Whether a plan fails rarely enough in worlds that the search has not seen. One that ends before the last goal needs
/// no certificate; any other has been flown for one.
template <class Family>
bool CandidateCheckOf<Family>::is_certified(const Plan& plan, double cost) {
    if (needs_certificate()) {
        ++result_.attempts;
    } else {
        certificate_ = checks_.worlds->screen(
            before_, plan, [this] { return check_is_over(); }, world_counter());
        clock_.has_certified();
    }
    known_at_s_ = clock_.seconds();
    if (certificate_->is_given) {
        return true;
    }
    if (!uncertified_ || certificate_->failure_probability.high < uncertified_->certificate.failure_probability.high) {
        uncertified_ = {plan, cost, *certificate_};
    }
    discarded_ = obstruction_of<Family>(*certificate_, plan);
    if (task_.worlds != nullptr) {
        counterexamples_ = checks_.worlds->counterexamples(*certificate_, before_);
    }
    weakest_ = weakest_part(*certificate_);
    return false;
}

template <class Family>
auto CandidateCheckOf<Family>::new_counterexamples() -> std::vector<Counterexample> {
    const std::optional<std::size_t> weakest = std::exchange(weakest_, std::nullopt);
    if (weakest && *weakest < before_.goals.size() && !has_plan()) {
        result_.weak_goal = weakest;
    }
    return std::exchange(counterexamples_, {});
}

/// The plan has counted since that was known. One that is cheaper in the planner's model only, and not when executed,
/// is no better.
template <class Family>
void CandidateCheckOf<Family>::accept(const Plan& plan, double cost, std::uint64_t iteration) {
    Found& best = result_.found;
    const CostFunction& objective = task_.problem.planner.objective;
    std::optional<double> executed_cost;
    if (flight_) {
        executed_cost = cost_when_executed(flight_->execution, objective);
        if (best.execution && *executed_cost >= cost_when_executed(*best.execution, objective)) {
            return;
        }
        best.execution = std::move(flight_->execution);
        best.flight_wall_s = flight_->wall_s;
        flight_.reset();
    }
    best.status = Status::solved;
    best.plan = plan;
    best.cost = cost;
    best.certificate = certificate_;
    best.safe_stops = stops_;
    if (certificate_ && !clock_.record.first_certified_wall_s) {
        clock_.record.first_certified_wall_s = known_at_s_;
    }
    clock_.improved(known_at_s_, cost, iteration, executed_cost);
    if (options_.on_plan) {
        options_.on_plan({plan, cost, executed_cost});
    }
}

template <class Family>
auto CandidateCheckOf<Family>::result(std::uint64_t iterations, const FlightStatistics& statistics,
                                      std::vector<TreeNode> tree, const Approach& nearest) -> SearchResult {
    SearchRecord& record = clock_.record;
    record.wall_s = clock_.seconds();
    record.iterations = iterations;
    if (task_.flies()) {
        record.edges_simulated = statistics.edges;
        record.simulated_s = static_cast<double>(statistics.ticks) * task_.tick_s;
    }
    record.states_checked = statistics.states_checked;
    record.rejected = statistics.rejected;
    record.rejected["direct_flight"] = record.candidates.rejected();  // without those that lacked time
    record.stopped_by = labelled(statistics.stopped_by, task_.model.scene());
    result_.record = std::move(record);
    result_.found.tree = std::move(tree);
    if (!has_plan()) {
        report_failure(statistics, nearest);
    }
    if (result_.found.certificate) {
        result_.found.certificate->attempts = result_.attempts;
    }
    return std::move(result_);
}

/// Reports what a search without a plan that counts came to, and what stood before the goal. If it had a plan, that is
/// what became of its execution.
template <class Family>
void CandidateCheckOf<Family>::report_failure(const FlightStatistics& statistics, const Approach& nearest) {
    Found& found = result_.found;
    found.obstruction = discarded_ ? discarded_ : statistics.obstruction;
    found.nearest_approach_m = nearest.nearest_m;
    found.status = nearest.status;
    found.plan = nearest.plan;
    found.cost = nearest.cost;
    if (uncertified_) {
        found.status = Status::approximate;
        found.plan = uncertified_->plan;
        found.cost = uncertified_->cost;
        found.certificate = uncertified_->certificate;
        if (discarded_->cause == failed_certificate || discarded_->cause == unfinished_certificate) {
            found.obstruction =
                obstruction_of<Family>(*found.certificate, *found.plan);  // which may be of a plan before
        }
    } else if (unfinished_) {
        found.status = Status::approximate;
        found.plan = unfinished_->plan;
        found.cost = unfinished_->cost;
    }
}

template class CandidateCheckOf<Plane>;
template class CandidateCheckOf<Space>;

}  // namespace downwash::planning

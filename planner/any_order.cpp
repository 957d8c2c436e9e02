#include "downwash/planner/any_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "downwash/planner/direct_flight.hpp"
#include "downwash/planner/family_parts.hpp"
#include "downwash/planner/goals_in_order.hpp"
#include "downwash/planner/leg_table.hpp"
#include "downwash/planner/order_comparison.hpp"
#include "downwash/planner/stopwatch.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::planning {
namespace {

/// Whether ways around obstacles are known before anything is flown.
template <class Family>
constexpr bool knows_ways = std::is_same_v<Family, Space>;

template <class Family>
class AnyOrder {
 public:
    using Problem = typename Family::Problem;
    using Goal = typename Family::Goal;
    using PlannerModel = PlannerModelOf<Family>;
    using SolveOptions = SolveOptionsOf<Family>;
    using FoundPlan = FoundPlanOf<Family>;
    using Found = FoundOf<Family>;
    using SearchResult = SearchResultOf<Family>;
    using SequenceEffort = SequenceEffortOf<Family>;

    AnyOrder(const Problem& problem, const PlannerModel& model, const SolveOptions& options)
        : problem_(problem),
          model_(model),
          options_(options),
          silent_(silent(options)),
          table_(problem, model, silent_),
          left_(problem.planner),
          comparison_(table_, [this] {
              tell_of_legs();
              return is_over();
          }) {}

    [[nodiscard]] SearchResult run();

 private:
    [[nodiscard]] static SolveOptions silent(SolveOptions options) {
        options.on_plan = nullptr;
        options.on_progress = nullptr;
        options.known_plan.reset();
        options.known_places.clear();
        options.known_way.clear();
        options.enough_cost.reset();
        return options;
    }
    [[nodiscard]] bool is_over() const { return left_.is_used_up() || options_.stop.stop_requested(); }
    [[nodiscard]] bool has_way() const { return best_.status == Status::solved; }
    [[nodiscard]] bool is_limited() const { return problem_.energy_budget_j.has_value(); }
    /// Whether time alone is limited: it goes into direct flights and certificates, too, which take no iterations.
    [[nodiscard]] bool is_timed() const { return !problem_.planner.max_iterations; }

    [[nodiscard]] bool is_done() const { return is_over() || (options_.stop_at_first_solution && has_way()); }
    void search();
    [[nodiscard]] bool is_settled(const PlaceOrder& order) const;
    [[nodiscard]] bool has_energy_to_spare(const PlaceOrder& order) const;
    [[nodiscard]] bool leaves_energy(const PlaceOrder& order);
    [[nodiscard]] bool finds_more_places();
    [[nodiscard]] SearchBudget budget_of_try() const;
    [[nodiscard]] SearchBudget share_of_left(double share) const;
    [[nodiscard]] SequenceEffort effort(const PlaceOrder& order) const;
    void compare_orders(const SearchBudget& budget);
    void tell_of_legs();
    [[nodiscard]] VisitOrder described(const PlaceOrder& order) const;
    [[nodiscard]] double cost_when_flown(const Found& way) const {
        return planning::cost_when_flown(way, problem_.planner.objective);
    }
    [[nodiscard]] bool attempt(const PlaceOrder& order, const SearchBudget& budget, bool is_first_only);
    [[nodiscard]] SolveOptions options_of_attempt(bool is_first_only, const PlaceOrder& order);
    void learn_from_failure(const PlaceOrder& order, const SearchResult& result);
    void give_up_leg(const PlaceOrder& order, std::size_t goal);
    [[nodiscard]] std::size_t place_of(const PlaceOrder& order, std::size_t goal) const;
    void keep_if_better(const PlaceOrder& order, SearchResult result, double begun_at_s,
                        std::uint64_t iterations_before);
    void explain();
    void spend(std::uint64_t iterations_before);

    const Problem& problem_;
    const PlannerModel& model_;
    const SolveOptions& options_;
    Stopwatch clock_;      ///< what the table asks before anything is flown counts, too
    SolveOptions silent_;  ///< for searches of which the caller hears nothing
    LegTableOf<Family> table_;
    SearchBudget left_;
    OrderComparisonOf<Family> comparison_;
    double spent_at_s_ = 0;                                  ///< when time was last taken from what is left
    double told_at_s_ = 0;                                   ///< when the caller was last told of legs
    bool is_thrifty_ = false;                                ///< the first plan of each leg may take too much energy
    std::uint64_t nodes_before_ = 0, nodes_of_attempt_ = 0;  ///< of searches that are over and of the one that is not
    std::uint64_t attempts_ = 0;                             ///< plans that asked for a certificate
    PlaceOrder failed_;                                      ///< in which the last search for a flight failed
    Found best_;                                             ///< the best flight so far
    PlaceOrder best_order_;                                  ///< in which it visits places; empty without a flight
    SearchRecord record_;
};

/// Takes what has passed since it was called last from what is left.
template <class Family>
void AnyOrder<Family>::spend(std::uint64_t iterations_before) {
    SearchRecord work;
    const double now_s = clock_.seconds();
    work.wall_s = now_s - std::exchange(spent_at_s_, now_s);
    work.iterations = record_.iterations - iterations_before;
    left_.spend(work);
}

constexpr double share_of_more_legs = 0.2;

/// First a flight through all in the order that looks best, where only time is limited with all of it: a list in that
/// order would have no more. Where that order is settled, the flight gets all limits, and that is all. Else orders are
/// compared; then a flight in the best of them or, where there is none, in the next one.
template <class Family>
void AnyOrder<Family>::search() {
    constexpr double share_of_first = 0.15, share_of_legs = 0.35, share_before_a_way = 0.15;
    const PlaceOrder likely = comparison_.likely();
    const bool may_fly_at_once = is_timed() || knows_ways<Family>;
    is_thrifty_ = is_limited() && !(may_fly_at_once && has_energy_to_spare(likely));
    if (!is_thrifty_ && is_settled(likely)) {
        if (attempt(likely, left_, options_.stop_at_first_solution)) {
            return;
        }
    } else if (!is_thrifty_ && is_order(likely)) {
        const std::uint64_t least = min_iterations_of_part<Family> * (likely.places.size() + 1);
        const SearchBudget first = left_.part(share_of_first).at_least_iterations(least).at_most(left_);
        static_cast<void>(attempt(likely, is_timed() ? left_ : first, true));
    }
    if (!is_done()) {
        compare_orders(left_.part(is_timed() && !has_way() ? share_before_a_way : share_of_legs));
    }
    bool has_grown = false, has_looked_again = false;
    for (PlaceOrder order = comparison_.chosen(); !is_done();) {
        if (!is_order(order) && !(is_timed() && has_way())) {
            if (!finds_more_places()) {
                break;
            }
            order = comparison_.chosen();
            continue;
        }
        const bool is_known = has_way() && (order.places == best_order_.places || !is_order(order));
        if (!is_known && !attempt(order, budget_of_try(), true)) {
            compare_orders(left_.part(share_of_more_legs));
            order = comparison_.chosen();
            continue;
        }
        if (options_.stop_at_first_solution && has_way()) {
            break;
        }
        if (!has_grown && is_order(order) && leaves_energy(order)) {
            has_grown = true;
            compare_orders(left_.part(share_of_more_legs));
            if (PlaceOrder more = comparison_.chosen(); more.places.size() > order.places.size()) {
                order = std::move(more);
                continue;
            }
        }
        if (!std::exchange(has_looked_again, true) && finds_more_places()) {
            if (PlaceOrder more = comparison_.chosen(); more.places.size() > best_order_.places.size()) {
                order = std::move(more);
                continue;
            }
        }
        static_cast<void>(attempt(best_order_, left_, options_.stop_at_first_solution));
        break;
    }
}

/// Whether short flights along legs would not change an order: through many targets, of which none can be proven best,
/// known ways tell more than luck.
template <class Family>
bool AnyOrder<Family>::is_settled(const PlaceOrder& order) const {
    return knows_ways<Family> && !order.is_best && order.places.size() == targets_of(problem_).size();
}

/// Where time alone is limited and legs were searched for in vain: searches for them again, for longer. @return whether
/// there were any
template <class Family>
bool AnyOrder<Family>::finds_more_places() {
    if (!is_timed() || !table_.search_on()) {
        return false;
    }
    compare_orders(left_.part(share_of_more_legs));
    return true;
}

/// Whether first plans of its legs are likely to take no more than the budget: they may be twice as dear as estimates.
template <class Family>
bool AnyOrder<Family>::has_energy_to_spare(const PlaceOrder& order) const {
    constexpr double factor = 2;
    return factor * order.energy_j <= comparison_.energy_limit_j;
}

/// What a search for a first flight in another order may take. Without any flight and with time alone, it may take all:
/// it ends by itself where it comes no farther (effort()).
template <class Family>
SearchBudget AnyOrder<Family>::budget_of_try() const {
    constexpr double share = 0.35;
    return is_timed() && !has_way() ? left_ : share_of_left(share);
}

template <class Family>
auto AnyOrder<Family>::effort(const PlaceOrder& order) const -> SequenceEffort {
    constexpr double patience = 0.25, patience_with_energy = 0.1;  // there, fewer targets may be the answer
    constexpr double min_round = 0.22;                             // two rounds then, of 22 and 78 %
    SequenceEffort effort;
    effort.has_energy_to_spare = !is_thrifty_;
    effort.ends_with_first_plan = options_.stop_at_first_solution;
    for (std::size_t i = 0; knows_ways<Family> && i < order.places.size() + (problem_.return_to ? 1 : 0); ++i) {
        effort.expected.push_back(table_.expected(place_of(order, i), place_of(order, i + 1)));
    }
    if (has_way()) {
        effort.min_round = min_round;  // short rounds are for a first flight, and there is one
    } else if (is_timed() || knows_ways<Family>) {
        effort.patience = SearchBudget(problem_.planner).part(is_thrifty_ ? patience_with_energy : patience);
    }
    return effort;
}

/// A share of what is left of the limits, at least a tenth of all.
template <class Family>
SearchBudget AnyOrder<Family>::share_of_left(double share) const {
    constexpr double least = 0.1;
    return left_.part(share).at_least(SearchBudget(problem_.planner).part(least)).at_most(left_);
}

template <class Family>
auto AnyOrder<Family>::run() -> SearchResult {
    try {
        search();
    } catch (const WorkStopped&) {  // there is what was found before
    }
    explain();
    record_.wall_s = clock_.seconds();
    return {std::move(best_), std::move(record_), attempts_};
}

/// Whether a whole flight took less than its legs: then there may be energy for another target.
template <class Family>
bool AnyOrder<Family>::leaves_energy(const PlaceOrder& order) {
    if (!is_limited() || order.places.size() == targets_of(problem_).size() || !best_.execution) {
        return false;
    }
    comparison_.energy_limit_j = *problem_.energy_budget_j * std::max(1.0, order.energy_j / best_.execution->energy_j);
    return true;
}

template <class Family>
void AnyOrder<Family>::compare_orders(const SearchBudget& budget) {
    const std::uint64_t iterations = record_.iterations;
    add_work(record_, comparison_.compare(budget));
    spend(iterations);
}

/// Tells the caller that orders are compared, ten times a second.
template <class Family>
void AnyOrder<Family>::tell_of_legs() {
    constexpr double period_s = 0.1;
    const double now_s = clock_.seconds();
    if (!options_.on_progress || now_s < told_at_s_ + period_s) {
        return;
    }
    told_at_s_ = now_s;
    Progress progress;
    progress.wall_s = now_s;
    progress.iterations = record_.iterations;
    progress.nodes = nodes_before_;
    for (const auto& [cause, count] : record_.rejected) {
        progress.rejected += count;
    }
    progress.best_cost = has_way() ? std::optional(best_.cost) : std::nullopt;
    progress.goals = targets_of(problem_).size() + (problem_.return_to ? 1 : 0);
    progress.legs = table_.legs_flown();
    options_.on_progress(progress);
}

template <class Family>
VisitOrder AnyOrder<Family>::described(const PlaceOrder& order) const {
    VisitOrder described;
    for (const std::size_t place : order.places) {
        described.visits.push_back(table_.visit_at(place));
    }
    described.is_best = order.is_best;
    described.legs = table_.legs_flown();
    const double cost = order_of(table_.estimates(), order.places).cost;
    described.cost_of_legs = std::isfinite(cost) ? cost : order.cost;
    return described;
}

/// Searches for a flight in an order. @return whether there is one
template <class Family>
bool AnyOrder<Family>::attempt(const PlaceOrder& order, const SearchBudget& budget, bool is_first_only) {
    Problem part = in_order(problem_, described(order));
    budget.limit(part.planner);
    const double begun_at_s = clock_.seconds();
    const std::uint64_t iterations = record_.iterations;
    const SolveOptions options = options_of_attempt(is_first_only, order);
    SearchResult result = search_in_order(part, model_, options, effort(order), attempts_);
    attempts_ = result.attempts;
    Found& found = result.found;
    if (found.status == Status::solved && is_limited() && !found.execution) {
        found.execution =
            fly_directly(*model_.flight, start_state(*model_.flight, part.start), *found.plan, goals_of(part),
                         part.energy_budget_j, [this] { return options_.stop.stop_requested(); })
                .execution;
        if (found.execution->outcome == Outcome::over_budget) {
            found.status = Status::approximate;
        }
    }
    add_work(record_, result.record);
    nodes_before_ += std::exchange(nodes_of_attempt_, 0);
    spend(iterations);
    const bool is_found = found.status == Status::solved;
    if (!is_found) {
        learn_from_failure(order, result);
    }
    keep_if_better(order, std::move(result), begun_at_s, iterations);
    return is_found;
}

template <class Family>
auto AnyOrder<Family>::options_of_attempt(bool is_first_only, const PlaceOrder& order) -> SolveOptions {
    SolveOptions inner = options_;
    inner.known_plan.reset();
    inner.known_places.clear();
    inner.known_way.clear();
    inner.enough_cost.reset();
    inner.stop_at_first_solution = is_first_only;
    const bool counts_alone = !has_way() || order.places.size() > best_order_.places.size();
    const double to_beat = counts_alone ? std::numeric_limits<double>::infinity() : cost_when_flown(best_);
    if (options_.on_progress) {
        inner.on_progress = [this, counts_alone](Progress progress) {
            progress.wall_s = clock_.seconds();
            progress.iterations += record_.iterations;
            nodes_of_attempt_ = progress.nodes;
            progress.nodes += nodes_before_;
            for (const auto& [cause, count] : record_.rejected) {
                progress.rejected += count;
            }
            if (has_way()) {
                const double cost = progress.best_cost.value_or(best_.cost);
                progress.best_cost = counts_alone ? cost : std::min(cost, best_.cost);
            }
            options_.on_progress(progress);
        };
    }
    inner.on_plan = nullptr;
    if (options_.on_plan && (counts_alone || order.places.size() == best_order_.places.size())) {
        inner.on_plan = [this, to_beat](const FoundPlan& found) {
            if (found.flown_cost.value_or(found.cost) < to_beat) {
                options_.on_plan(found);
            }
        };
    }
    return inner;
}

/// What does not fly as a whole is not to be chosen again: at once where it takes too much energy, else when it fails
/// for the second time. Without any flight and with time alone, one that ended with the time says nothing.
template <class Family>
void AnyOrder<Family>::learn_from_failure(const PlaceOrder& order, const SearchResult& result) {
    const Found& failed = result.found;
    if (options_.stop.stop_requested()) {
        return;
    }
    const bool is_too_much =
        (failed.execution && failed.execution->outcome == Outcome::over_budget) ||
        (failed.obstruction && failed.obstruction->cause == name_of(Outcome::over_budget)) ||
        (failed.certificate && failed.certificate->causes.contains(std::string(name_of(Outcome::over_budget))));
    if (is_too_much && !is_thrifty_) {
        is_thrifty_ = true;
        return;
    }
    if (is_too_much) {
        constexpr double less = 0.98;
        comparison_.energy_limit_j = less * std::min(comparison_.energy_limit_j, order.energy_j);
        return;
    }
    if (!has_way() && (is_timed() || result.hard_goal)) {
        if (result.hard_goal) {
            // First a flight to the others, then more of this one.
            give_up_leg(order, *result.hard_goal + 1);
            table_.put_off(place_of(order, *result.hard_goal + 1));
        }
        return;
    }
    if (order.places != failed_.places) {
        failed_ = order;  // it is tried once more: luck differs between searches
        return;
    }
    give_up_leg(order, failed.missed_goal.value_or(1));
}

/// The place of a goal of an order by its number from 1; outside() where it returns and, for 0, where it starts.
template <class Family>
std::size_t AnyOrder<Family>::place_of(const PlaceOrder& order, std::size_t goal) const {
    return goal > 0 && goal <= order.places.size() ? order.places[goal - 1] : table_.estimates().outside();
}

/// @param goal to which it leads, from 1
template <class Family>
void AnyOrder<Family>::give_up_leg(const PlaceOrder& order, std::size_t goal) {
    table_.give_up(place_of(order, goal - 1), place_of(order, goal));
}

/// Takes a flight as the solution if it visits more than the present one, or as many for less; where there is none yet,
/// a part of one that comes farther.
template <class Family>
void AnyOrder<Family>::keep_if_better(const PlaceOrder& order, SearchResult result, double begun_at_s,
                                      std::uint64_t iterations_before) {
    Found& found = result.found;
    const bool is_solved = found.status == Status::solved;
    const bool visits_more = order.places.size() > best_order_.places.size();
    const bool is_better =
        has_way() ? is_solved && (visits_more || (order.places.size() == best_order_.places.size() &&
                                                  cost_when_flown(found) < cost_when_flown(best_)))
                  : is_solved || !best_.plan || found.missed_goal.value_or(0) > best_.missed_goal.value_or(0);
    note_first_plans(record_, result.record, begun_at_s);
    if (!is_better) {
        return;
    }
    if (!has_way() || visits_more) {
        record_.improvements.clear();  // those of flights to fewer targets
    }
    for (const Improvement& each : result.record.improvements) {
        if (record_.improvements.empty() ||
            each.flown_cost.value_or(each.cost) < record_.improvements.back().flown_cost.value_or(each.cost)) {
            record_.improvements.push_back(
                {begun_at_s + each.wall_s, iterations_before + each.iteration, each.cost, each.flown_cost});
        }
    }
    best_order_ = order;
    best_ = std::move(found);
}

/// Which targets are left out, and why. Where no flight to one was found, the solution is approximate.
template <class Family>
void AnyOrder<Family>::explain() {
    PlaceOrder order = best_order_;
    if (has_way() && !best_order_.is_best) {
        const PlaceOrder known = comparison_.chosen();
        order.is_best = known.is_best && known.places == best_order_.places;
    }
    VisitOrder described = this->described(order);
    for (std::size_t target = 0; target < targets_of(problem_).size(); ++target) {
        const auto is_it = [target](const Visit& visit) { return visit.target == target; };
        if (std::ranges::any_of(described.visits, is_it)) {
            continue;
        }
        LeftOutTarget left_out{target, LeftOutReason::no_flight, std::nullopt};
        const double energy_j = energy_with(table_.at_least(), best_order_.places, target);
        // Where there is no flight at all, it is not for its energy that one to a cheap target is missing.
        const bool is_for_energy = has_way() || energy_j > problem_.energy_budget_j.value_or(energy_j);
        if (is_limited() && std::isfinite(energy_j) && is_for_energy && !table_.is_out_of_reach(target)) {
            left_out = {target, LeftOutReason::energy_budget, energy_j};
        } else if (has_way()) {
            best_.status = Status::approximate;
        }
        described.left_out.push_back(left_out);
    }
    best_.order = std::move(described);
}

}  // namespace

SearchResult search_in_any_order(const Problem& problem, const PlannerModel& model, const SolveOptions& options) {
    return AnyOrder<Plane>(problem, model, options).run();
}

SearchResultOf<Space> search_in_any_order(const SpaceProblem& problem, const PlannerModelOf<Space>& model,
                                          const SolveOptionsOf<Space>& options) {
    return AnyOrder<Space>(problem, model, options).run();
}

}  // namespace downwash::planning

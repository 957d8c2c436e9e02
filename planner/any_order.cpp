#include "downwash/planner/any_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "downwash/planner/flight_search.hpp"
#include "downwash/planner/order_comparison.hpp"
#include "downwash/planner/search_clock.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::planning {
namespace {

class AnyOrder {
 public:
    AnyOrder(const Problem& problem, const FlightModel& model, const AeroMap* map, const SolveOptions& options,
             const LegSearch& search_leg, const SequenceSearch& search_sequence, Solution& solution)
        : problem_(problem),
          model_(model),
          options_(options),
          silent_(silent(options)),
          search_sequence_(search_sequence),
          solution_(solution),
          table_(problem, model, map, silent_, search_leg),
          left_(problem.planner),
          comparison_(table_, [this] { return is_over(); }) {}

    void run();

 private:
    [[nodiscard]] static SolveOptions silent(SolveOptions options) {
        options.on_plan = nullptr;
        options.on_progress = nullptr;
        options.known_plan.reset();
        options.known_places.clear();
        return options;
    }
    [[nodiscard]] bool is_over() const { return left_.is_used_up() || options_.stop.stop_requested(); }
    [[nodiscard]] bool has_way() const { return solution_.status == Status::solved; }
    [[nodiscard]] bool is_limited() const { return problem_.energy_budget_j.has_value(); }

    [[nodiscard]] bool is_done() const { return is_over() || (options_.stop_at_first_solution && has_way()); }
    void search();
    [[nodiscard]] bool leaves_energy(const PlaceOrder& order);
    [[nodiscard]] SearchBudget share_of_left(double share) const;
    void compare_orders(const SearchBudget& budget);
    [[nodiscard]] VisitOrder described(const PlaceOrder& order) const;
    [[nodiscard]] double cost_of_way(const Solution& way) const;
    [[nodiscard]] bool attempt(const PlaceOrder& order, const SearchBudget& budget, bool is_first_only);
    [[nodiscard]] SolveOptions options_of_attempt(bool is_first_only, const PlaceOrder& order);
    void learn_from_failure(const PlaceOrder& order, const Solution& failed);
    void take_if_better(const PlaceOrder& order, Solution found, double begun_at_s, std::uint64_t iterations_before);
    void explain();
    [[nodiscard]] double energy_with(std::size_t target) const;
    void spend(std::uint64_t iterations_before);

    const Problem& problem_;
    const FlightModel& model_;
    const SolveOptions& options_;
    SolveOptions silent_;  ///< of searches of which the caller hears nothing
    const SequenceSearch& search_sequence_;
    Solution& solution_;
    LegTable table_;
    SearchBudget left_;
    OrderComparison comparison_;
    Stopwatch clock_;
    double spent_at_s_ = 0;       ///< when time was last taken from what is left
    std::uint64_t attempts_ = 0;  ///< plans that asked for a certificate
    PlaceOrder failed_;           ///< in which the last search for a flight failed
    PlaceOrder best_;             ///< of the solution; empty without one
};

/// Takes what has passed since it was called last from what is left.
void AnyOrder::spend(std::uint64_t iterations_before) {
    SearchRecord work;
    const double now_s = clock_.seconds();
    work.wall_s = now_s - std::exchange(spent_at_s_, now_s);
    work.iterations = solution_.planning.iterations - iterations_before;
    left_.spend(work);
}

/// First a flight through all in the order that looks best; then orders are compared; then a flight in the best of
/// them or, where there is none, in the next one.
void AnyOrder::search() {
    constexpr double share_of_first = 0.15, share_of_legs = 0.35, share_of_try = 0.35, share_of_more_legs = 0.2;
    const PlaceOrder likely = comparison_.likely();
    if (!is_limited() && is_order(likely)) {
        static_cast<void>(attempt(likely, left_.part(share_of_first), true));
    }
    if (!is_done()) {
        compare_orders(left_.part(share_of_legs));
    }
    bool has_grown = false;
    for (PlaceOrder order = comparison_.chosen(); !is_done() && is_order(order);) {
        const bool is_known = has_way() && order.places == best_.places;
        if (!is_known && !attempt(order, share_of_left(share_of_try), true)) {
            compare_orders(left_.part(share_of_more_legs));
            order = comparison_.chosen();
            continue;
        }
        if (!has_grown && leaves_energy(order)) {
            has_grown = true;
            compare_orders(left_.part(share_of_more_legs));
            if (PlaceOrder more = comparison_.chosen(); more.places.size() > order.places.size()) {
                order = std::move(more);
                continue;
            }
        }
        static_cast<void>(attempt(best_, left_, options_.stop_at_first_solution));
        break;
    }
}

/// Of the limits, but no crumbs.
SearchBudget AnyOrder::share_of_left(double share) const {
    constexpr double least = 0.1;
    return left_.part(share).at_least(SearchBudget(problem_.planner).part(least)).at_most(left_);
}

void AnyOrder::run() {
    try {
        search();
    } catch (const WorkStopped&) {  // there is what was found before
    }
    explain();
}

/// Whether a whole flight took less than its legs: then there may be energy for another target.
bool AnyOrder::leaves_energy(const PlaceOrder& order) {
    if (!is_limited() || order.places.size() == problem_.targets.size() || !solution_.execution) {
        return false;
    }
    comparison_.energy_limit_j =
        *problem_.energy_budget_j * std::max(1.0, order.energy_j / solution_.execution->energy_j);
    return true;
}

void AnyOrder::compare_orders(const SearchBudget& budget) {
    const std::uint64_t iterations = solution_.planning.iterations;
    comparison_.compare(budget, solution_.planning);
    spend(iterations);
}

VisitOrder AnyOrder::described(const PlaceOrder& order) const {
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

double AnyOrder::cost_of_way(const Solution& way) const {
    return way.execution ? cost_of(*way.execution, problem_.planner.objective) : way.cost;
}

/// Searches for a flight in an order. @return whether there is one
bool AnyOrder::attempt(const PlaceOrder& order, const SearchBudget& budget, bool is_first_only) {
    Problem part = in_order(problem_, described(order));
    budget.limit(part.planner);
    Solution found;
    const double begun_at_s = clock_.seconds();
    const std::uint64_t iterations = solution_.planning.iterations;
    SolveOptions options = options_of_attempt(is_first_only, order);
    // Short rounds are for a first flight, and there is one.
    constexpr double least_round = 0.22;  // two rounds then, of 22 and 78 %
    search_sequence_(part, options, has_way() ? least_round : 0, attempts_, found);
    if (found.status == Status::solved && is_limited() && !found.execution) {
        double wall_s = 0;
        found.execution =
            execute_directly(model_, start_state(model_, part.start), *found.plan, goals_of(part), part.energy_budget_j,
                             wall_s, [this] { return options_.stop.stop_requested(); });
        if (found.execution->outcome == Outcome::over_budget) {
            found.status = Status::approximate;
        }
    }
    add_work(solution_.planning, found.planning);
    spend(iterations);
    if (found.status != Status::solved) {
        learn_from_failure(order, found);
    }
    const bool is_found = found.status == Status::solved;
    take_if_better(order, std::move(found), begun_at_s, iterations);
    return is_found;
}

SolveOptions AnyOrder::options_of_attempt(bool is_first_only, const PlaceOrder& order) {
    SolveOptions inner = options_;
    inner.known_plan.reset();
    inner.known_places.clear();
    inner.stop_at_first_solution = is_first_only;
    const bool counts_alone = !has_way() || order.places.size() > best_.places.size();
    const double to_beat = counts_alone ? std::numeric_limits<double>::infinity() : cost_of_way(solution_);
    if (options_.on_progress) {
        inner.on_progress = [this, to_beat](Progress progress) {
            progress.wall_s = clock_.seconds();
            progress.iterations += solution_.planning.iterations;
            if (has_way()) {
                progress.best_cost = std::min(progress.best_cost.value_or(solution_.cost), to_beat);
            }
            options_.on_progress(progress);
        };
    }
    inner.on_plan = nullptr;
    if (options_.on_plan && (counts_alone || order.places.size() == best_.places.size())) {
        inner.on_plan = [this, to_beat](const FoundPlan& found) {
            if (found.flown_cost.value_or(found.cost) < to_beat) {
                options_.on_plan(found);
            }
        };
    }
    return inner;
}

/// What does not fly as a whole is not to be chosen again: at once where it takes too much energy, else when it fails
/// for the second time.
void AnyOrder::learn_from_failure(const PlaceOrder& order, const Solution& failed) {
    if (options_.stop.stop_requested()) {
        return;
    }
    const bool is_too_much =
        (failed.execution && failed.execution->outcome == Outcome::over_budget) ||
        (failed.planning.obstruction && failed.planning.obstruction->cause == name_of(Outcome::over_budget)) ||
        (failed.certificate && failed.certificate->causes.contains(std::string(name_of(Outcome::over_budget))));
    if (is_too_much) {
        constexpr double less = 0.98;
        comparison_.energy_limit_j = less * std::min(comparison_.energy_limit_j, order.energy_j);
        return;
    }
    if (order.places != failed_.places) {
        failed_ = order;  // it is tried once more: luck differs between searches
        return;
    }
    const std::size_t goal = failed.planning.goal.value_or(1);
    const std::size_t outside = table_.estimates().outside();
    table_.give_up(goal >= 2 ? order.places[goal - 2] : outside,
                   goal <= order.places.size() ? order.places[goal - 1] : outside);
}

/// Takes a flight as the solution if it visits more than the present one, or as many for less; where there is none yet,
/// a part of one that comes farther.
void AnyOrder::take_if_better(const PlaceOrder& order, Solution found, double begun_at_s,
                              std::uint64_t iterations_before) {
    const bool is_solved = found.status == Status::solved;
    const bool visits_more = order.places.size() > best_.places.size();
    const bool is_better = has_way() ? is_solved && (visits_more || (order.places.size() == best_.places.size() &&
                                                                     cost_of_way(found) < cost_of_way(solution_)))
                                     : is_solved || !solution_.plan ||
                                           found.planning.goal.value_or(0) > solution_.planning.goal.value_or(0);
    SearchRecord& whole = solution_.planning;
    const auto note_first = [begun_at_s](std::optional<double>& at_s, const std::optional<double>& in_part_s) {
        if (!at_s && in_part_s) {
            at_s = begun_at_s + *in_part_s;
        }
    };
    note_first(whole.first_solution_wall_s, found.planning.first_solution_wall_s);
    note_first(whole.first_certified_wall_s, found.planning.first_certified_wall_s);
    if (!is_better) {
        return;
    }
    if (!has_way() || visits_more) {
        whole.improvements.clear();  // of flights to fewer targets
    }
    for (const Improvement& each : found.planning.improvements) {
        if (whole.improvements.empty() ||
            each.flown_cost.value_or(each.cost) < whole.improvements.back().flown_cost.value_or(each.cost)) {
            whole.improvements.push_back(
                {begun_at_s + each.wall_s, iterations_before + each.iteration, each.cost, each.flown_cost});
        }
    }
    whole.flight_wall_s = found.planning.flight_wall_s;
    whole.nearest_approach_m = found.planning.nearest_approach_m;
    whole.obstruction = found.planning.obstruction;
    whole.goal = found.planning.goal;
    best_ = order;
    solution_.status = found.status;
    solution_.cost = found.cost;
    solution_.plan = std::move(found.plan);
    solution_.tree = std::move(found.tree);
    solution_.certificate = found.certificate;
    solution_.execution = std::move(found.execution);
    solution_.stops = std::move(found.stops);
}

/// Which targets are left out, and why. Where no flight to one was found, the solution is approximate.
void AnyOrder::explain() {
    PlaceOrder order = best_;
    if (has_way() && !best_.is_best) {
        const PlaceOrder known = comparison_.chosen();
        order.is_best = known.is_best && known.places == best_.places;
    }
    VisitOrder described = this->described(order);
    for (std::size_t target = 0; target < problem_.targets.size(); ++target) {
        const auto is_it = [target](const Visit& visit) { return visit.target == target; };
        if (std::ranges::any_of(described.visits, is_it)) {
            continue;
        }
        LeftOutTarget left_out{target, LeftOutReason::no_flight, std::nullopt};
        const double energy_j = energy_with(target);
        if (is_limited() && std::isfinite(energy_j) && !table_.is_out_of_reach(target)) {
            left_out = {target, LeftOutReason::energy_budget, energy_j};
        } else if (has_way()) {
            solution_.status = Status::approximate;
        }
        described.left_out.push_back(left_out);
    }
    solution_.order = std::move(described);
    solution_.planning.wall_s = clock_.seconds();
}

/// What a target more would take, in the cheapest order with it [J].
double AnyOrder::energy_with(std::size_t target) const {
    std::vector<std::size_t> places;
    std::vector<std::size_t> target_of;
    std::vector<std::size_t> numbers(problem_.targets.size(), problem_.targets.size());
    const LegCosts& all = table_.estimates();
    std::size_t count = 0;
    for (std::size_t place = 0; place < all.places(); ++place) {
        const std::size_t of = all.target_of(place);
        const bool is_wanted = of == target || std::ranges::find(best_.places, place) != best_.places.end();
        if (is_wanted) {
            numbers[of] = numbers[of] == problem_.targets.size() ? count++ : numbers[of];
            places.push_back(place);
            target_of.push_back(numbers[of]);
        }
    }
    LegCosts energies(std::move(target_of));
    places.push_back(all.outside());
    for (std::size_t from = 0; from < places.size(); ++from) {
        for (std::size_t to = 0; to < places.size(); ++to) {
            const LegCost& leg = all.leg(places[from], places[to]);
            energies.leg(from, to) = {std::isfinite(leg.cost) ? leg.energy_j : leg.cost, leg.energy_j};
        }
    }
    const PlaceOrder order = best_order(energies);
    return order.places.size() == count ? order.cost : std::numeric_limits<double>::infinity();
}

}  // namespace

void solve_in_any_order(const Problem& problem, const FlightModel& model, const AeroMap* map,
                        const SolveOptions& options, const LegSearch& search_leg, const SequenceSearch& search_sequence,
                        Solution& solution) {
    AnyOrder(problem, model, map, options, search_leg, search_sequence, solution).run();
}

}  // namespace downwash::planning

#include "downwash/planner/leg_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "downwash/planner/family_parts.hpp"
#include "downwash/planner/goal_search.hpp"
#include "downwash/planner/stopwatch.hpp"

namespace downwash::planning {
namespace {

/// The goals of every place: of the targets with their alternatives, and of the place to return to.
template <class AnyProblem>
auto goals_at_places(const AnyProblem& problem) {
    const auto targets = targets_of(problem);
    using Goal = typename decltype(targets)::value_type;
    std::vector<std::pair<Visit, Goal>> goals;
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const Goal& target = targets[i];
        for (std::size_t k = 0; k < target.any_of.size(); ++k) {
            goals.emplace_back(Visit{i, k}, target.any_of[k]);
        }
        if (target.any_of.empty()) {
            goals.emplace_back(Visit{i, std::nullopt}, target);
        }
    }
    if (problem.return_to) {
        goals.emplace_back(Visit{targets.size(), std::nullopt}, *problem.return_to);
    }
    return goals;
}

template <class AnyProblem>
std::vector<std::size_t> targets_of_places(const AnyProblem& problem) {
    std::vector<std::size_t> targets;
    for (const auto& [visit, goal] : goals_at_places(problem)) {
        if (visit.target < targets_of(problem).size()) {
            targets.push_back(visit.target);
        }
    }
    return targets;
}

}  // namespace

template <class Family>
LegTableOf<Family>::LegTableOf(const Problem& problem, const PlannerModel& model, const SolveOptions& options)
    : problem_(problem),
      model_(model),
      options_(options),
      start_(Course::from_start(problem, *model.flight)),
      estimates_(targets_of_places(problem)),
      at_least_(estimates_) {
    const Configuration start = place_of(problem.start);
    for (auto& [visit, goal] : goals_at_places(problem)) {
        bounds_.push_back(std::make_unique<LegBoundsOf<Family>>(problem, goal, *model.flight));
        // In the goal region; it may be in collision.
        Configuration at = bounds_.back()->space().moved_into_goal(start, 0);
        places_.push_back({visit, std::move(goal), std::move(at), std::nullopt});
    }
    const std::size_t outside = estimates_.outside();
    legs_.resize((outside + 1) * (outside + 1));
    estimates_.energy_budget_j = problem.energy_budget_j.value_or(std::numeric_limits<double>::infinity());
    at_least_.energy_budget_j = estimates_.energy_budget_j;
    constexpr double most_of_time = 0.2;
    const double most_s = SearchBudget(problem.planner).part(most_of_time).time_s();
    expected_ = expected_legs(problem, bounds_, outside, [this, most_s, clock = Stopwatch()] {
        return options_.stop.stop_requested() || clock.seconds() >= most_s;
    });
    for (std::size_t from = 0; from <= outside; ++from) {
        bound_legs_from(from);
    }
}

template <class Family>
LegTableOf<Family>::~LegTableOf() = default;

/// Sets the estimates and lower bounds of the legs from a place that are not flown.
template <class Family>
void LegTableOf<Family>::bound_legs_from(std::size_t from) {
    const Configuration at = from == estimates_.outside() ? place_of(problem_.start) : places_[from].at;
    for (std::size_t to = 0; to <= estimates_.outside(); ++to) {
        if (!is_leg(from, to)) {
            set(from, to, to < estimates_.outside() ? LegCost{} : LegCost{0, 0});
        } else if (!leg(from, to).is_known && !is_closed(leg(from, to))) {
            const LegCost bound = bounds_[to]->from(at), likely = expected(from, to).cost;
            const bool is_expected = std::isfinite(likely.cost) && likely.cost > bound.cost;
            at_least_.leg(from, to) = bound;
            estimates_.leg(from, to) = is_expected ? likely : bound;
        }
    }
}

template <class Family>
ExpectedLegOf<Family> LegTableOf<Family>::expected(std::size_t from, std::size_t to) const {
    return expected_.empty() ? ExpectedLegOf<Family>() : expected_[number_of(from, to)];
}

template <class Family>
void LegTableOf<Family>::set(std::size_t from, std::size_t to, const LegCost& cost) {
    estimates_.leg(from, to) = cost;
    at_least_.leg(from, to) = cost;
}

/// Not between places of one target, nor back to where the flight may end anywhere.
template <class Family>
bool LegTableOf<Family>::is_leg(std::size_t from, std::size_t to) const {
    if (to == estimates_.outside()) {
        return problem_.return_to.has_value();
    }
    return from == estimates_.outside() || places_[from].visit.target != places_[to].visit.target;
}

template <class Family>
LegCosts LegTableOf<Family>::flown_costs() const {
    LegCosts none = estimates_;
    for (std::size_t from = 0; from <= none.outside(); ++from) {
        for (std::size_t to = 0; to <= none.outside(); ++to) {
            none.leg(from, to) = is_leg(from, to) ? LegCost{} : none.leg(from, to);
        }
    }
    return flown_or(std::move(none));
}

template <class Family>
LegCosts LegTableOf<Family>::flown_or(LegCosts costs) const {
    for (std::size_t from = 0; from <= costs.outside(); ++from) {
        for (std::size_t to = 0; to <= costs.outside(); ++to) {
            const LegCost& flown = leg(from, to).flown;
            costs.leg(from, to) = std::isfinite(flown.cost) ? flown : costs.leg(from, to);
        }
    }
    return costs;
}

template <class Family>
void LegTableOf<Family>::begin_pass() {
    ++pass_;
    for (LegState& state : legs_) {
        state.is_known = false;
    }
    for (std::size_t from = 0; from <= estimates_.outside(); ++from) {
        bound_legs_from(from);
    }
}

template <class Family>
bool LegTableOf<Family>::is_known(std::size_t from, std::size_t to) const {
    return !is_leg(from, to) || leg(from, to).is_known;
}

template <class Family>
SearchRecord LegTableOf<Family>::fly(std::size_t from, std::size_t to, const SearchBudget& budget, double most_s) {
    LegState& state = leg(from, to);
    const Course* const before = from == estimates_.outside() ? &start_
                                 : places_[from].hover        ? &*places_[from].hover
                                                              : nullptr;
    if (before == nullptr || is_closed(state)) {
        return {};
    }
    Place& place = places_[to];
    Problem part = part_of(problem_, place.goal, {});
    if (from != estimates_.outside()) {
        part.start = start_at(problem_, places_[from].at);
    }
    const std::size_t legs = legs_.size();
    part.planner.seed += static_cast<std::uint32_t>((pass_ + static_cast<std::uint32_t>(state.failures)) * legs +
                                                    from * (estimates_.outside() + 1) + to);
    const SearchBudget mine = budget.part(std::ldexp(1.0, state.failures)).within_s(most_s);
    mine.limit(part.planner);
    SolveOptions options = options_;
    options.keep_tree = false;
    options.stop_at_first_solution = false;
    options.on_plan = nullptr;
    options.known_way = expected(from, to).corners;
    const SearchResultOf<Family> result = search_goal(part, part, model_, *before, {}, options);
    const FoundOf<Family>& found = result.found;
    const bool is_unfinished = found.obstruction && found.obstruction->cause == unfinished_flight && found.plan;
    if (found.status != Status::solved && !is_unfinished) {
        if (std::isfinite(state.flown.cost)) {  // there is a flight of a pass before
            state.is_known = true;
            set(from, to, state.flown);
        } else if (!options_.stop.stop_requested() && ++state.failures >= most_failures_) {
            set(from, to, {});
        }
        return result.record;
    }
    Course hover = advanced(*before, place.goal, *found.plan, found.cost, model_, problem_.planner.variant);
    LegCost cost{found.cost, hover.vehicle.plant.energy_j - before->vehicle.plant.energy_j};
    if (found.execution) {
        cost = {cost_when_executed(*found.execution, problem_.planner.objective), found.execution->energy_j};
    }
    legs_flown_ += std::isfinite(state.flown.cost) ? 0 : 1;
    state.flown = cost.cost < state.flown.cost ? cost : state.flown;
    state.is_known = true;
    set(from, to, state.flown);
    if (!place.hover) {
        place.at = end_of(*found.plan);
        hover.goals.clear();
        hover.plan = {};
        hover.cost = 0;
        hover.vehicle.plant.energy_j = 0;
        place.hover = std::move(hover);
        if (to < estimates_.outside()) {
            bound_legs_from(to);
        }
    }
    return result.record;
}

template <class Family>
void LegTableOf<Family>::give_up(std::size_t from, std::size_t to) {
    leg(from, to) = {false, 0, true, {}};
    set(from, to, {});
}

template <class Family>
void LegTableOf<Family>::put_off(std::size_t to) {
    for (std::size_t from = 0; from <= estimates_.outside(); ++from) {
        LegState& state = leg(from, to);
        if (is_leg(from, to) && !std::isfinite(state.flown.cost)) {
            state.failures = std::max(state.failures, most_failures_);
            set(from, to, {});
        }
    }
}

template <class Family>
bool LegTableOf<Family>::search_on() {
    const bool is_any = std::ranges::any_of(
        legs_, [this](const LegState& state) { return !state.is_given_up && state.failures >= most_failures_; });
    if (is_any) {
        ++most_failures_;
        for (std::size_t from = 0; from <= estimates_.outside(); ++from) {
            bound_legs_from(from);
        }
    }
    return is_any;
}

template <class Family>
bool LegTableOf<Family>::is_out_of_reach(std::size_t target) const {
    for (std::size_t to = 0; to < estimates_.outside(); ++to) {
        for (std::size_t from = 0; from <= estimates_.outside() && places_[to].visit.target == target; ++from) {
            if (is_leg(from, to) && !is_closed(leg(from, to))) {
                return false;
            }
        }
    }
    return true;
}

template class LegTableOf<Plane>;
template class LegTableOf<Space>;

}  // namespace downwash::planning

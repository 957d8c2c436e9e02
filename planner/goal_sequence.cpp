#include "downwash/planner/goal_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

#include "downwash/planner/family_parts.hpp"
#include "downwash/problems/problem_model.hpp"

namespace downwash::planning {
namespace {

template <class TreeNode>
void add_trees(std::vector<TreeNode>& sum, const std::vector<TreeNode>& part) {
    const int begin = static_cast<int>(sum.size());
    for (const TreeNode& node : part) {
        sum.push_back({node.at, node.parent == TreeNode::no_parent ? TreeNode::no_parent : begin + node.parent});
    }
}

/// The configurations at the knots of a plan after the first; in the plane nobody asks for them.
std::vector<Configuration> corners_of(const Plan& /*plan*/) {
    return {};
}
std::vector<SpaceConfiguration> corners_of(const SpacePlan& plan) {
    std::vector<SpaceConfiguration> corners;
    for (std::size_t i = 1; i < plan.reference.size(); ++i) {
        corners.push_back(configuration_of(plan.reference[i].point));
    }
    return corners;
}

}  // namespace

template <class Family>
GoalSequenceOf<Family>::GoalSequenceOf(const Problem& problem, const PlannerModel& model, const SolveOptions& options,
                                       const SequenceEffort& effort, std::uint64_t attempts)
    : problem_(problem),
      model_(model),
      options_(options),
      effort_(effort),
      goals_(goals_of(problem)),
      searches_(goals_.size()),
      given_up_(goals_.size()),
      vain_(goals_.size()),
      left_ways_(goals_.size()),
      whole_(problem.planner),
      left_(whole_),
      part_budget_(whole_),
      round_(new_round(whole_)),
      attempts_(attempts) {}

template <class Family>
auto GoalSequenceOf<Family>::new_round(const SearchBudget& budget) const -> Round {
    return {budget, {Course::from_start(problem_, *model_.flight)}, {}, {}, {}};
}

template <class Family>
auto GoalSequenceOf<Family>::next() -> std::optional<Part> {
    if (is_done_) {
        return std::nullopt;
    }
    const std::size_t number = round_.part_costs.size();
    Course& course = round_.courses.back();
    course.attempts = attempts_;
    Part part{part_of(problem_, goals_[number], course.plan), &course, options_of_part(), 0};
    use_what_is_known(number, part.options);
    part.problem.planner.seed += searches_[number]++;
    part_budget_ = has_way() ? round_.left.part(share(number)) : budget_of(number).at_most(round_.left);
    part_budget_.limit(part.problem.planner);
    if (!has_way() && std::isfinite(round_.left.time_s())) {
        part.check_time_s = round_.left.time_s();
    }
    return part;
}

template <class Family>
void GoalSequenceOf<Family>::add(SearchResult part) {
    if (!goes_on_after(std::move(part)) || round_.part_costs.size() == goals_.size()) {
        end_round();
    }
}

template <class Family>
auto GoalSequenceOf<Family>::result() && -> SearchResult {
    if (has_way() && best_.certificate) {
        best_.certificate->attempts = attempts_;
    }
    return {std::move(best_), std::move(record_), attempts_, {}, hard_goal_};
}

/// Begins the next round, if there is time. After the first whole way, a round may take twice as much as all that
/// before it or, later, as the round before; the last one takes the rest.
template <class Family>
void GoalSequenceOf<Family>::end_round() {
    constexpr std::uint64_t min_iterations = 50;
    constexpr double min_s = 0.1;
    if (number_ == 1) {
        keep_if_farther();
        is_last_ = options_.stop_at_first_solution || !has_way();
        round_work_ = record_;
        round_work_.iterations = std::max(round_work_.iterations, min_iterations);
        round_work_.wall_s = std::max(round_work_.wall_s, min_s);
        whole_.part(effort_.min_round / 2).charge(round_work_);
    } else if (round_.way.status == Status::solved && is_better(round_.way)) {
        keep(std::move(round_));
    }
    is_done_ = is_last_ || is_over();
    if (is_done_) {
        return;
    }
    ++number_;
    round_work_.iterations *= 2;
    round_work_.wall_s *= 2;
    const double share = left_.share_of(round_work_);
    is_last_ = share > 0.5;
    round_ = new_round(left_.part(is_last_ ? 1 : share));
}

/// A part was not found in time. Until there is a whole way, it is searched anew, every second time from another end of
/// the part before: the goal may be out of reach from the first one. In space at once where the search came no nearer
/// to the goal than where it began: that may be a dead end, which no edge leaves in all worlds.
template <class Family>
bool GoalSequenceOf<Family>::give_up(bool came_nearer) {
    if (has_way()) {
        return false;
    }
    const std::size_t part = round_.part_costs.size();
    if (effort_.patience && effort_.patience->share_of(vain_[part]) >= 1) {
        hard_goal_ = part;
        return false;
    }
    const bool is_second = ++given_up_[part] % 2 == 0;
    const bool is_dead_end = std::is_same_v<Family, Space> && !came_nearer;
    return go_back((is_second || is_dead_end) && part > 0 ? part - 1 : part);
}

/// Before there is a whole way: what a search for a part may take. Luck differs between searches, so that several short
/// ones find more than one long one; each that is given up allows the next one twice as much.
template <class Family>
auto GoalSequenceOf<Family>::budget_of(std::size_t part) const -> SearchBudget {
    constexpr double longest_first_s = 2.5;
    // Where energy is limited it is not the first plan of a part that counts, but a cheap one.
    const double first_share = (is_thrifty() ? 0.6 : 0.25) / static_cast<double>(goals_.size());
    const int doublings = static_cast<int>(std::min(given_up_[part], 30U));
    return whole_.part(first_share)
        .at_least_iterations(expects_ways() ? min_iterations_of_part<Family> : 0)
        .within_s(longest_first_s)
        .part(std::ldexp(1.0, doublings))
        .at_most(whole_);
}

/// Goes back to search the way to some goal anew. False if there is no time for it.
template <class Family>
bool GoalSequenceOf<Family>::go_back(std::size_t part) {
    keep_if_farther();
    round_.courses.resize(part + 1);
    for (std::size_t i = part + 1; i < round_.part_ways.size(); ++i) {
        left_ways_[i] = std::move(round_.part_ways[i]);
    }
    round_.part_costs.resize(part);
    round_.part_ways.resize(part);
    round_.way.plan = part > 0 ? std::optional(round_.courses.back().plan) : std::nullopt;
    round_.way.cost = round_.courses.back().cost;
    round_.way.certificate.reset();
    return !round_.left.is_used_up() && !options_.stop.stop_requested();
}

/// Takes the way to the next goal or, if none was found in time, goes back to an earlier one. @return whether the round
/// goes on
template <class Family>
bool GoalSequenceOf<Family>::goes_on_after(SearchResult part) {
    const std::size_t number = round_.part_costs.size();
    const bool is_last = number + 1 == goals_.size();
    const Course& course = round_.courses.back();
    Found& found = part.found;
    SearchRecord spent = part.record;
    if (found.status != Status::solved && !part.weak_goal) {
        part_budget_.charge(spent);
        // The check of a plan may take much longer than the search for it, and tells that there is a way.
        vain_[number].wall_s += std::min(spent.wall_s, part_budget_.time_s());
        vain_[number].iterations += spent.iterations;
    }
    round_.left.spend(spent);
    left_.spend(spent);

    attempts_ = part.attempts;
    Found& way = round_.way;
    way.flight_wall_s = found.flight_wall_s;
    way.nearest_approach_m = found.nearest_approach_m;
    way.obstruction = found.obstruction;
    way.missed_goal = number + 1;
    if (found.certificate) {
        // That a part passes says nothing of the whole; that it does not says why there is none.
        const bool tells = is_last || found.status != Status::solved;
        way.certificate = tells ? found.certificate : std::nullopt;
    }
    const double begun_at_s = record_.wall_s;
    const std::uint64_t iterations_before = record_.iterations;
    add_work(record_, part.record);
    nodes_before_ += std::max<std::uint64_t>(found.tree.size(), std::exchange(nodes_of_part_, 0));
    add_trees(way.tree, found.tree);
    if (found.plan) {
        way.plan = course.plan.followed_by(*found.plan);
        way.cost = course.cost + found.cost;
    }
    way.status = way.plan ? Status::approximate : Status::none;
    if (part.weak_goal) {
        return go_back(*part.weak_goal);
    }
    if (found.status != Status::solved) {
        return give_up(found.plan.has_value());
    }
    if (way.plan->reference.back().tick > max_plan_ticks) {
        ++record_.rejected["too_long"];
        way.plan = course.plan;
        way.cost = course.cost;
        return give_up(true);
    }
    round_.part_costs.push_back(found.cost);
    round_.part_ways.push_back(corners_of(*found.plan));
    if (is_last) {
        way.status = Status::solved;
        way.execution = std::move(found.execution);
        way.safe_stops = std::move(found.safe_stops);
        note_improvements(course, part.record, begun_at_s, iterations_before);
        return true;
    }
    round_.courses.push_back(
        advanced(course, goals_[number], *found.plan, found.cost, model_, problem_.planner.variant));
    way.plan = round_.courses.back().plan;
    return true;
}

/// A search for a goal grows along the part of the best way so far. Before there is one, the first search grows along
/// the way that is expected, and later ones along the part that was left to go back; and a first plan is good enough if
/// it costs not much more than is expected.
template <class Family>
void GoalSequenceOf<Family>::use_what_is_known(std::size_t goal, SolveOptions& options) {
    if (!expects_ways() || problem_.planner.algorithm != "rrt-star") {
        return;
    }
    if (has_way()) {
        options.known_way = part_ways_[goal];
        return;
    }
    const ExpectedLegOf<Family>& expected = effort_.expected[goal];
    options.known_way = searches_[goal] == 0 ? expected.corners : std::exchange(left_ways_[goal], {});
    if (options.stop_at_first_solution && std::isfinite(expected.cost.cost)) {
        constexpr double much_more = 1.25;
        options.stop_at_first_solution = false;
        options.enough_cost = much_more * expected.cost.cost;
    }
}

/// Options under which a part reports its progress as that of the whole.
template <class Family>
auto GoalSequenceOf<Family>::options_of_part() -> SolveOptions {
    SolveOptions inner = options_;
    inner.known_plan.reset();
    inner.known_places.clear();
    inner.known_way.clear();
    inner.enough_cost.reset();
    const std::size_t goal = round_.part_costs.size() + 1;
    const bool is_last = goal == goals_.size();
    // A first plan is far from the cheapest.
    inner.stop_at_first_solution = !has_way() && (!is_thrifty() || (is_last && effort_.ends_with_first_plan));
    if (options_.on_progress) {
        inner.on_progress = [this, goal, is_last](Progress progress) {
            progress.wall_s += record_.wall_s;
            progress.iterations += record_.iterations;
            nodes_of_part_ = progress.nodes;
            progress.nodes += nodes_before_;
            for (const auto& [cause, count] : record_.rejected) {
                progress.rejected += count;
            }
            progress.goal = goal;
            progress.goals = goals_.size();
            progress.round = number_;
            const std::optional<double> best_of_part = std::exchange(progress.best_cost, std::nullopt);
            if (has_way()) {
                progress.best_cost = best_.cost;
            }
            if (is_last && best_of_part) {
                const double whole = round_.courses.back().cost + *best_of_part;
                progress.best_cost = std::min(progress.best_cost.value_or(whole), whole);
            }
            options_.on_progress(progress);
        };
    }
    inner.on_plan = nullptr;
    if (options_.on_plan && is_last) {
        inner.on_plan = [this](const FoundPlan& found) {
            const Course& course = round_.courses.back();
            const double cost = course.cost + found.cost;
            if (found.flown_cost.value_or(cost) < told_cost_) {
                told_cost_ = found.flown_cost.value_or(cost);
                options_.on_plan({course.plan.followed_by(found.plan), cost, found.flown_cost});
            }
        };
    }
    return inner;
}

/// The share of what is left of a round for a part: half of a round is shared equally, half by where it paid.
template <class Family>
double GoalSequenceOf<Family>::share(std::size_t part) const {
    const double all_gains = std::accumulate(gains_.begin(), gains_.end(), 0.0);
    const auto weight = [&](std::size_t i) {
        const double equal = 1 / static_cast<double>(goals_.size());
        return 0.5 * equal + 0.5 * (all_gains > 0 ? gains_[i] / all_gains : equal);
    };
    double parts_left = 0;
    for (std::size_t i = part; i < goals_.size(); ++i) {
        parts_left += weight(i);
    }
    return weight(part) / parts_left;
}

/// Whether a way is better than the best so far: it can be left for a hover for clearly more of its time or, else,
/// costs less.
template <class Family>
bool GoalSequenceOf<Family>::is_better(const Found& way) const {
    if (way.safe_stops && best_.safe_stops) {
        if (is_clearly_worse(*way.safe_stops, *best_.safe_stops) ||
            is_clearly_worse(*best_.safe_stops, *way.safe_stops)) {
            return is_clearly_worse(*best_.safe_stops, *way.safe_stops);
        }
    }
    return cost_when_flown(way) < cost_when_flown(best_);
}

/// What the search for the last part found, as ways through all goals.
/// @param begun_at_s,iterations_before of the whole when it began
template <class Family>
void GoalSequenceOf<Family>::note_improvements(const Course& before, const SearchRecord& last, double begun_at_s,
                                               std::uint64_t iterations_before) {
    note_first_plans(record_, last, begun_at_s);
    for (const Improvement& found : last.improvements) {
        const double cost = before.cost + found.cost;
        if (!has_way() || found.flown_cost.value_or(cost) < cost_when_flown(best_)) {
            record_.improvements.push_back(
                {begun_at_s + found.wall_s, iterations_before + found.iteration, cost, found.flown_cost});
        }
    }
}

/// Until there is a whole way: keeps one that goes through more goals, or as many.
template <class Family>
void GoalSequenceOf<Family>::keep_if_farther() {
    const bool is_farther = round_.part_costs.size() > part_costs_.size() ||
                            (round_.part_costs.size() == part_costs_.size() &&
                             (!best_.plan || (round_.way.certificate && !best_.certificate)));
    if (!has_way() && is_farther) {
        keep(round_);
    }
}

/// Keeps a way as the best one.
template <class Family>
void GoalSequenceOf<Family>::keep(Round round) {
    gains_.resize(goals_.size());
    for (std::size_t i = 0; has_way() && i < goals_.size(); ++i) {
        gains_[i] = std::max(0.0, part_costs_[i] - round.part_costs[i]);
    }
    part_costs_ = std::move(round.part_costs);
    part_ways_ = std::move(round.part_ways);
    best_ = std::move(round.way);
    if (has_way()) {
        best_.missed_goal.reset();
    }
}

template class GoalSequenceOf<Plane>;
template class GoalSequenceOf<Space>;

}  // namespace downwash::planning

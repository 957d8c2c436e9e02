#include "downwash/planner/goal_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "downwash/planner/braking.hpp"
#include "downwash/planner/search_budget.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/flight.hpp"

namespace downwash::planning {
namespace {

/// The search for the way to a goal from the end of a course.
Problem part_of(const Problem& problem, const Goal& goal, const Course& before) {
    Problem part = problem;
    part.stops.clear();
    part.goal = goal;
    if (!before.plan.reference.empty()) {
        part.start = Start::resting_at(before.plan.last());
    }
    return part;
}

void add(std::vector<TreeNode>& sum, const std::vector<TreeNode>& part) {
    const int begin = static_cast<int>(sum.size());
    for (const TreeNode& node : part) {
        sum.push_back({node.at, node.parent == TreeNode::no_parent ? TreeNode::no_parent : begin + node.parent});
    }
}

/// Finds a whole way through all goals, then better ones.
class GoalSequence {
 public:
    GoalSequence(const Problem& problem, const FlightModel& model, const AeroMap* map, const SolveOptions& options,
                 const PartSearch& search, double least_round, std::uint64_t& attempts, Solution& solution)
        : problem_(problem),
          model_(model),
          map_(map),
          options_(options),
          search_(search),
          least_round_(least_round),
          solution_(solution),
          goals_(goals_of(problem)),
          searches_(goals_.size()),
          given_up_(goals_.size()),
          whole_(problem.planner),
          left_(problem.planner),
          attempts_(attempts) {}

    void run();

 private:
    /// One try to find a whole way.
    struct Round {
        SearchBudget left;
        std::vector<Course> courses;     ///< before each part, the one that is searched for included
        Solution way;                    ///< as far as it has come
        std::vector<double> part_costs;  ///< of the parts that were found
    };

    [[nodiscard]] bool is_over() const { return left_.is_used_up() || options_.stop.stop_requested(); }
    [[nodiscard]] bool has_way() const { return solution_.status == Status::solved; }
    [[nodiscard]] Round try_round(const SearchBudget& budget);
    [[nodiscard]] bool search_part(Round& round);
    [[nodiscard]] bool go_back(Round& round, std::size_t part);
    [[nodiscard]] bool give_up(Round& round);
    [[nodiscard]] SearchBudget slice(std::size_t part) const;
    void take_farther(const Round& round);
    [[nodiscard]] SolveOptions options_of_part(const Round& round);
    [[nodiscard]] double share(std::size_t part) const;
    [[nodiscard]] double cost_of_way(const Solution& way) const;
    [[nodiscard]] bool is_better(const Solution& way) const;
    void note_improvements(const Course& before, const SearchRecord& last, double begun_at_s,
                           std::uint64_t iterations_before);
    void take(Round round);

    const Problem& problem_;
    const FlightModel& model_;
    const AeroMap* map_;
    const SolveOptions& options_;
    const PartSearch& search_;
    double least_round_;  ///< see solve_in_turn()
    Solution& solution_;
    std::vector<Goal> goals_;
    std::vector<std::uint32_t> searches_;  ///< for the way to each goal so far; each draws other samples
    std::vector<std::uint32_t> given_up_;  ///< of these, because they took too long
    SearchBudget whole_;
    SearchBudget left_;
    std::size_t round_ = 1;           ///< that is going on
    std::uint64_t& attempts_;         ///< plans that asked for a certificate
    std::vector<double> part_costs_;  ///< of the best way
    std::vector<double> gains_;       ///< by how much each part became cheaper when the best way last did
    double handed_over_ = std::numeric_limits<double>::infinity();  ///< cost of the best way that the caller knows
};

/// After the first whole way, a round may take twice as much as all that before it or, later, as the round before; the
/// last one takes the rest.
void GoalSequence::run() {
    constexpr std::uint64_t least_iterations = 50;
    constexpr double least_s = 0.1;
    take_farther(try_round(left_));
    if (options_.stop_at_first_solution || !has_way()) {
        return;
    }
    SearchRecord work = solution_.planning;
    work.iterations = std::max(work.iterations, least_iterations);
    work.wall_s = std::max(work.wall_s, least_s);
    whole_.part(least_round_ / 2).charge(work);
    bool is_last = false;
    while (!is_last && !is_over()) {
        ++round_;
        work.iterations *= 2;
        work.wall_s *= 2;
        const double share = left_.share_of(work);
        is_last = share > 0.5;
        Round round = try_round(left_.part(is_last ? 1 : share));
        if (round.way.status == Status::solved && is_better(round.way)) {
            take(std::move(round));
        }
    }
    if (solution_.certificate) {
        solution_.certificate->attempts = attempts_;
    }
}

GoalSequence::Round GoalSequence::try_round(const SearchBudget& budget) {
    Round round{budget, {Course::from_start(problem_, model_)}, {}, {}};
    while (round.part_costs.size() < goals_.size() && search_part(round)) {
    }
    return round;
}

/// A part was not found in time. Until there is a whole way, it is searched anew, every second time from another end of
/// the part before: the goal may be out of reach from the first one.
bool GoalSequence::give_up(Round& round) {
    if (has_way()) {
        return false;
    }
    const std::size_t part = round.part_costs.size();
    const bool is_second = ++given_up_[part] % 2 == 0;
    return go_back(round, is_second && part > 0 ? part - 1 : part);
}

/// Before there is a whole way: what a search for a part may take. Luck differs between searches, so that several short
/// ones find more than one long one; each that is given up allows the next one twice as much.
SearchBudget GoalSequence::slice(std::size_t part) const {
    constexpr double longest_first_s = 2.5;
    // Where energy is limited it is not the first plan of a part that counts, but a cheap one.
    const double first_share = (problem_.energy_budget_j ? 0.6 : 0.25) / static_cast<double>(goals_.size());
    const int doublings = static_cast<int>(std::min(given_up_[part], 30U));
    return whole_.part(first_share).within_s(longest_first_s).part(std::ldexp(1.0, doublings)).at_most(whole_);
}

/// Goes back to search the way to some goal anew. False if there is no time for it.
bool GoalSequence::go_back(Round& round, std::size_t part) {
    take_farther(round);
    round.courses.resize(part + 1);
    round.part_costs.resize(part);
    round.way.plan = part > 0 ? std::optional(round.courses.back().plan) : std::nullopt;
    round.way.cost = round.courses.back().cost;
    round.way.certificate.reset();
    return !round.left.is_used_up() && !options_.stop.stop_requested();
}

/// Searches the way to the next goal, or goes back to an earlier one. False if no way is found in time.
bool GoalSequence::search_part(Round& round) {
    const std::size_t number = round.part_costs.size();
    const bool is_last = number + 1 == goals_.size();
    Course& course = round.courses.back();
    course.attempts = attempts_;
    Problem part = part_of(problem_, goals_[number], course);
    part.planner.seed += searches_[number]++;
    const SearchBudget budget = has_way() ? round.left.part(share(number)) : slice(number).at_most(round.left);
    budget.limit(part.planner);
    Solution found;
    const std::optional<std::size_t> weak_goal = search_(part, options_of_part(round), course, found);
    SearchRecord spent = found.planning;
    if (found.status != Status::solved && !weak_goal) {
        budget.charge(spent);
    }
    round.left.spend(spent);
    left_.spend(spent);

    Solution& way = round.way;
    way.planning.flight_wall_s = found.planning.flight_wall_s;
    way.planning.nearest_approach_m = found.planning.nearest_approach_m;
    way.planning.obstruction = found.planning.obstruction;
    way.planning.goal = number + 1;
    if (found.certificate) {
        attempts_ = found.certificate->attempts;
        way.certificate = is_last ? found.certificate : std::nullopt;  // a part says nothing of the whole
    }
    const double begun_at_s = solution_.planning.wall_s;
    const std::uint64_t iterations_before = solution_.planning.iterations;
    add_work(solution_.planning, found.planning);
    add(way.tree, found.tree);
    if (found.plan) {
        way.plan = course.continued_by(*found.plan);
        way.cost = course.cost + found.cost;
    }
    way.status = way.plan ? Status::approximate : Status::none;
    if (weak_goal) {
        return go_back(round, *weak_goal);
    }
    if (found.status != Status::solved) {
        return give_up(round);
    }
    if (way.plan->reference.back().tick > max_plan_ticks) {
        ++solution_.planning.rejected["too_long"];
        way.plan = course.plan;
        way.cost = course.cost;
        return give_up(round);
    }
    round.part_costs.push_back(found.cost);
    if (is_last) {
        way.status = Status::solved;
        way.execution = std::move(found.execution);
        way.stops = std::move(found.stops);
        note_improvements(course, found.planning, begun_at_s, iterations_before);
        return true;
    }
    round.courses.push_back(advanced(course, goals_[number], *found.plan, found.cost, model_, map_,
                                     problem_.planner.variant != Variant::mp_arm));
    way.plan = round.courses.back().plan;
    return true;
}

/// Options under which a part reports its progress as that of the whole.
SolveOptions GoalSequence::options_of_part(const Round& round) {
    SolveOptions inner = options_;
    inner.known_plan.reset();
    inner.known_places.clear();
    // A first plan is far from the cheapest.
    inner.stop_at_first_solution = !has_way() && !problem_.energy_budget_j;
    const std::size_t number = round.part_costs.size();
    const bool is_last = number + 1 == goals_.size();
    if (options_.on_progress) {
        inner.on_progress = [this, &round, number, is_last](Progress progress) {
            progress.wall_s += solution_.planning.wall_s;
            progress.iterations += solution_.planning.iterations;
            progress.goal = number + 1;
            progress.goals = goals_.size();
            progress.round = round_;
            const std::optional<double> best_of_part = std::exchange(progress.best_cost, std::nullopt);
            if (has_way()) {
                progress.best_cost = solution_.cost;
            }
            if (is_last && best_of_part) {
                const double whole = round.courses.back().cost + *best_of_part;
                progress.best_cost = std::min(progress.best_cost.value_or(whole), whole);
            }
            options_.on_progress(progress);
        };
    }
    inner.on_plan = nullptr;
    if (options_.on_plan && is_last) {
        inner.on_plan = [this, &round](const FoundPlan& found) {
            const double cost = round.courses.back().cost + found.cost;
            if (found.flown_cost.value_or(cost) < handed_over_) {
                handed_over_ = found.flown_cost.value_or(cost);
                options_.on_plan({round.courses.back().continued_by(found.plan), cost, found.flown_cost});
            }
        };
    }
    return inner;
}

/// Of what is left of a round, for a part: half of a round is shared equally, half by where it paid.
double GoalSequence::share(std::size_t part) const {
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

/// Where it was flown with direct aerodynamics, there.
double GoalSequence::cost_of_way(const Solution& way) const {
    return way.execution ? cost_of(*way.execution, problem_.planner.objective) : way.cost;
}

/// Than the best way so far: one that can be left for a hover for clearly more of its time or, else, a cheaper one.
bool GoalSequence::is_better(const Solution& way) const {
    if (way.stops && solution_.stops) {
        if (stops_less(*way.stops, *solution_.stops) || stops_less(*solution_.stops, *way.stops)) {
            return stops_less(*solution_.stops, *way.stops);
        }
    }
    return cost_of_way(way) < cost_of_way(solution_);
}

/// What the search for the last part found, as ways through all goals.
/// @param begun_at_s,iterations_before of the whole when it began
void GoalSequence::note_improvements(const Course& before, const SearchRecord& last, double begun_at_s,
                                     std::uint64_t iterations_before) {
    SearchRecord& whole = solution_.planning;
    const auto note_first = [begun_at_s](std::optional<double>& at_s, const std::optional<double>& in_part_s) {
        if (!at_s && in_part_s) {
            at_s = begun_at_s + *in_part_s;
        }
    };
    note_first(whole.first_solution_wall_s, last.first_solution_wall_s);
    note_first(whole.first_certified_wall_s, last.first_certified_wall_s);
    for (const Improvement& found : last.improvements) {
        const double cost = before.cost + found.cost;
        if (!has_way() || found.flown_cost.value_or(cost) < cost_of_way(solution_)) {
            whole.improvements.push_back(
                {begun_at_s + found.wall_s, iterations_before + found.iteration, cost, found.flown_cost});
        }
    }
}

/// Until there is a whole way: takes one that goes through more goals, or as many.
void GoalSequence::take_farther(const Round& round) {
    const bool is_farther = round.part_costs.size() > part_costs_.size() ||
                            (round.part_costs.size() == part_costs_.size() &&
                             (!solution_.plan || (round.way.certificate && !solution_.certificate)));
    if (!has_way() && is_farther) {
        take(round);
    }
}

/// Takes a way as the best one.
void GoalSequence::take(Round round) {
    gains_.resize(goals_.size());
    for (std::size_t i = 0; has_way() && i < goals_.size(); ++i) {
        gains_[i] = std::max(0.0, part_costs_[i] - round.part_costs[i]);
    }
    part_costs_ = std::move(round.part_costs);
    Solution& way = round.way;
    solution_.status = way.status;
    solution_.cost = way.cost;
    solution_.plan = std::move(way.plan);
    solution_.tree = std::move(way.tree);
    solution_.certificate = way.certificate;
    solution_.execution = std::move(way.execution);
    solution_.stops = std::move(way.stops);
    solution_.planning.flight_wall_s = way.planning.flight_wall_s;
    solution_.planning.nearest_approach_m = way.planning.nearest_approach_m;
    solution_.planning.obstruction = way.planning.obstruction;
    solution_.planning.goal = has_way() ? std::nullopt : way.planning.goal;
}

}  // namespace

Course advanced(Course course, const Goal& goal, const Plan& part, double cost, const FlightModel& model,
                const AeroMap* map, bool plans_flights) {
    const double tick_s = model.tick().tick_s;
    Plan plan = course.continued_by(part);
    ReferenceKnot held = plan.reference.back();
    held.tick += hold_ticks(goal, model, held.point);
    plan.reference.push_back(held);
    const std::size_t known = course.plan.reference.empty() ? 1 : course.plan.reference.size();
    for (std::size_t i = known; i < plan.reference.size(); ++i) {
        const ReferenceKnot& from = plan.reference[i - 1];
        const ReferenceKnot& to = plan.reference[i];
        const ReferenceSegment segment(from.point, to.point, to.tick - from.tick, tick_s);
        const Rejection rejection = fly(model, map, rules_of_execution(), segment, course.vehicle).rejection;
        if (rejection != Rejection::none && plans_flights) {
            throw std::logic_error("a part of a plan does not fly as it was planned");
        }
    }
    course.plan = std::move(plan);
    course.goals.push_back(goal);
    course.cost += cost;
    return course;
}

Course Course::from_start(const Problem& problem, const FlightModel& model) {
    Course course;
    course.vehicle = start_state(model, problem.start);
    return course;
}

Plan Course::continued_by(const Plan& next) const {
    if (plan.reference.empty()) {
        return next;
    }
    Plan whole = plan;
    const std::int64_t begin = plan.reference.back().tick;
    for (std::size_t i = 1; i < next.reference.size(); ++i) {
        whole.reference.push_back({begin + next.reference[i].tick, next.reference[i].point});
    }
    return whole;
}

void solve_in_turn(const Problem& problem, const FlightModel& model, const AeroMap* map, const SolveOptions& options,
                   const PartSearch& search, double least_round, std::uint64_t& attempts, Solution& solution) {
    GoalSequence(problem, model, map, options, search, least_round, attempts, solution).run();
}

}  // namespace downwash::planning

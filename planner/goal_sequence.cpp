#include "downwash/planner/goal_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "downwash/problems/problem_model.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/flight.hpp"

namespace downwash::planning {
namespace {

/// What is left of a search's limits when it has several goals.
class Budget {
 public:
    explicit Budget(const PlannerSettings& settings) : iterations_(settings.max_iterations) {
        if (settings.time_limit_s || !settings.max_iterations) {
            time_s_ = settings.time_limit_s.value_or(default_time_limit_s);
        }
    }

    /// Gives a search its share of what is left for so many.
    void share(PlannerSettings& settings, std::size_t searches) const {
        constexpr double min_s = 1e-6;
        if (iterations_) {
            settings.max_iterations = std::max<std::uint64_t>(1, *iterations_ / searches);
        }
        if (std::isfinite(time_s_)) {
            settings.time_limit_s = std::max(min_s, time_s_ / static_cast<double>(searches));
        }
    }

    void spend(const SearchRecord& record) {
        if (iterations_) {
            *iterations_ -= std::min(*iterations_, record.iterations);
        }
        time_s_ -= record.wall_s;
    }

 private:
    std::optional<std::uint64_t> iterations_;
    double time_s_ = std::numeric_limits<double>::infinity();
};

/// Adds a part's plan and the hold at its end, and flies them in the planner's model. What was planned by flights flies
/// as it did; of MP-ARM's plans nobody has to know where the vehicle gets to, as none of them looks at it.
void advance(Course& course, const Goal& goal, const Plan& part, double cost, const FlightModel& model,
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
}

/// The search for the way to a goal from the end of a course.
Problem part_of(const Problem& problem, const Goal& goal, const Course& before) {
    Problem part = problem;
    part.stops.clear();
    part.goal = goal;
    if (!before.plan.reference.empty()) {
        const Configuration end = before.plan.last();
        part.start = {};
        part.start.x_m = end.x_m;
        part.start.z_m = end.z_m;
        part.start.arm_rad = end.arm_rad;
    }
    return part;
}

void add(std::vector<TreeNode>& sum, const std::vector<TreeNode>& part) {
    const int begin = static_cast<int>(sum.size());
    for (const TreeNode& node : part) {
        sum.push_back({node.at, node.parent == TreeNode::no_parent ? TreeNode::no_parent : begin + node.parent});
    }
}

void add(SearchRecord& sum, const SearchRecord& part) {
    sum.wall_s += part.wall_s;
    sum.flight_wall_s = part.flight_wall_s;
    sum.iterations += part.iterations;
    sum.edges_simulated += part.edges_simulated;
    sum.simulated_s += part.simulated_s;
    sum.states_checked += part.states_checked;
    sum.nearest_approach_m = part.nearest_approach_m;
    sum.obstruction = part.obstruction;
    for (const auto& [cause, count] : part.rejected) {
        sum.rejected[cause] += count;
    }
}

/// What the last part found, as plans of the whole.
void take_improvements(SearchRecord& whole, const SearchRecord& last, double cost_before) {
    if (last.first_solution_wall_s) {
        whole.first_solution_wall_s = whole.wall_s + *last.first_solution_wall_s;
    }
    if (last.first_certified_wall_s) {
        whole.first_certified_wall_s = whole.wall_s + *last.first_certified_wall_s;
    }
    for (const Improvement& improvement : last.improvements) {
        whole.improvements.push_back({whole.wall_s + improvement.wall_s, whole.iterations + improvement.iteration,
                                      cost_before + improvement.cost, improvement.flown_cost});
    }
}

/// Options under which a part reports its progress as that of the whole.
SolveOptions options_of_part(const SolveOptions& options, const SearchRecord& before, double cost_before,
                             bool is_last) {
    SolveOptions inner = options;
    if (options.on_progress) {
        inner.on_progress = [&options, wall_s = before.wall_s, iterations = before.iterations, cost_before,
                             is_last](Progress progress) {
            progress.wall_s += wall_s;
            progress.iterations += iterations;
            progress.best_cost =
                is_last && progress.best_cost ? std::optional(cost_before + *progress.best_cost) : std::nullopt;
            options.on_progress(progress);
        };
    }
    return inner;
}

}  // namespace

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
                   const PartSearch& search, Solution& solution) {
    const std::vector<Goal> goals = goals_of(problem);
    Budget budget(problem.planner);
    Course course = Course::from_start(problem, model);
    for (std::size_t i = 0; i < goals.size(); ++i) {
        const bool is_last = i + 1 == goals.size();
        Problem part = part_of(problem, goals[i], course);
        budget.share(part.planner, goals.size() - i);
        Solution found;
        search(part, options_of_part(options, solution.planning, course.cost, is_last), course, found);
        budget.spend(found.planning);

        if (found.certificate) {
            course.attempts = found.certificate->attempts;
            solution.certificate = found.certificate;
        }

        const bool is_solved = found.status == Status::solved;
        if (is_last && is_solved) {
            take_improvements(solution.planning, found.planning, course.cost);
        }
        add(solution.planning, found.planning);
        add(solution.tree, found.tree);
        if (found.plan) {
            solution.plan = course.continued_by(*found.plan);
            solution.cost = course.cost + found.cost;
        }
        solution.status = solution.plan ? Status::approximate : Status::none;
        if (!is_solved) {
            return;
        }
        if (solution.plan->reference.back().tick > max_plan_ticks) {
            ++solution.planning.rejected["too_long"];
            solution.planning.improvements.clear();
            solution.planning.first_solution_wall_s.reset();
            solution.planning.first_certified_wall_s.reset();
            solution.status = Status::approximate;
            solution.plan = course.plan;
            solution.cost = course.cost;
            return;
        }
        if (is_last) {
            solution.status = Status::solved;
            solution.execution = std::move(found.execution);
            return;
        }
        advance(course, goals[i], *found.plan, found.cost, model, map, problem.planner.variant != Variant::mp_arm);
        solution.plan = course.plan;
    }
}

}  // namespace downwash::planning

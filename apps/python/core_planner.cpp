#include <pybind11/stl.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/planner/planner.hpp"
#include "downwash/python/columns.hpp"
#include "downwash/python/core_solution.hpp"
#include "downwash/python/core_starts.hpp"
#include "downwash/python/interruptible.hpp"

namespace downwash::python {
namespace {

std::int64_t tick_within(std::int64_t tick) {
    if (tick < 0 || tick > max_plan_ticks) {
        throw_input_error("is " + std::to_string(tick) + ": expected 0 to " + std::to_string(max_plan_ticks), "tick");
    }
    return tick;
}

/// What a search of a planner has found, as Python gets it.
CoreSolution solved(const std::shared_ptr<const CoreProblem>& of, const Solution& found, int /*threads*/) {
    return {of, found};
}
CoreSpaceSolution solved(const std::shared_ptr<const CoreSpaceProblem>& of, const SpaceSearchResult& found,
                         int threads) {
    return {of, solution_of(of->problem(), std::make_shared<const SpaceSearchResult>(found), threads)};
}

/// What Python gets of an answer.
template <class Family>
struct CoreAnswer {
    AnswerOf<Family> answer;
    std::shared_ptr<const typename CoreOf<Family>::Problem> of;  ///< where there is a solution
    int threads = 1;

    [[nodiscard]] std::optional<typename CoreOf<Family>::Solution> solution() const {
        return answer.solution ? std::optional(solved(of, *answer.solution, threads)) : std::nullopt;
    }
};

/// The problem of a planner as it is now.
std::shared_ptr<CoreProblem> problem_of(const Planner& planner, const CoreProblem& began_with, std::uint32_t seed) {
    auto of = std::make_shared<CoreProblem>(
        CoreProblem{{{planner.problem(), planner.shared_model()}, {}, {}, began_with.placed.placed}, began_with.file});
    of->placed.plannable.problem.planner.seed = seed;
    return of;
}
std::shared_ptr<CoreSpaceProblem> problem_of(const SpacePlanner& planner, const CoreSpaceProblem& began_with,
                                             std::uint32_t seed) {
    SpaceProblem problem = planner.problem();
    problem.planner.seed = seed;
    return std::make_shared<CoreSpaceProblem>(
        CoreSpaceProblem{{std::make_shared<const SpaceProblemModel>(std::move(problem), planner.model()),
                          {},
                          {},
                          began_with.placed.placed},
                         began_with.file});
}

/// The changes of a call.
struct CoreChange {
    std::string text;  ///< text of a problem file, whose obstacles are put and whose goal is taken; empty: neither
    bool has_goal = false;
    std::vector<std::string> removed;
};

constexpr const char* changes_to = "changes to one goal: expected ";

/// The one goal in the values of a problem. @throws InputError
Goal goal_of(const Problem& values) {
    if (!values.goals_before.empty() || !values.targets.empty()) {
        throw_input_error(std::string(changes_to) + "end_effector, configuration, contact or any_of", "goal");
    }
    return values.goal;
}
SpaceGoal goal_of(const SpaceProblem& values) {
    if (values.goals.size() != 1 || values.in_any_order) {
        throw_input_error(std::string(changes_to) + "end_effector, camera, pose, configuration, contact or any_of",
                          "goal");
    }
    return values.goals.front();
}

void read_values(const std::string& text, Problem& values) {
    values = parse_values(text, "<dict>");
}
void read_values(const std::string& text, SpaceProblem& values) {
    values = parse_space_values(text, "<dict>");
}

template <class Family>
SceneChangeOf<Family> change_of(const CoreChange& given) {
    SceneChangeOf<Family> change;
    change.removed = given.removed;
    if (given.text.empty()) {
        return change;
    }
    typename Family::Problem values;
    read_values(given.text, values);
    change.put = values.obstacles;
    if (given.has_goal) {
        change.goal = goal_of(values);
    }
    return change;
}

/// A planner with the problem that it began with. One call at a time, apart from latest().
template <class Family>
class CorePlanner {
 public:
    using Problem = typename CoreOf<Family>::Problem;
    using Solution = typename CoreOf<Family>::Solution;
    using Start = typename Family::Start;
    using SceneChange = SceneChangeOf<Family>;
    using ReplanOptions = ReplanOptionsOf<Family>;
    using SolveOptions = SolveOptionsOf<Family>;
    using Answer = CoreAnswer<Family>;

    CorePlanner(const Problem& problem, int threads, bool stop_at_first, bool finds_stops, const std::string& cache)
        : began_with_(problem),
          threads_(thread_count(threads)),
          planner_(problem.problem(), options(stop_at_first, finds_stops, cache)) {}

    Solution solve(const py::object& on_progress, const py::object& stop) {
        const Call call(*this);
        return interruptible(stop, [&](Attendance& attendance) {
            tell_ = telling(attendance, on_progress);
            const std::shared_ptr<const Problem> of = problem_now();  // which loses its targets to their order
            return solved(of, planner_.solve(attendance.token()), threads_);
        });
    }

    Answer replan(const CoreStart& from, std::int64_t tick, const CoreChange& given,
                  const std::optional<double>& time_limit_s, const std::optional<std::uint64_t>& max_iterations,
                  const py::object& on_answer, const py::object& stop) {
        const Call call(*this);
        const Start start = start_of(from, problem_at_first());
        const SceneChange change = change_of<Family>(given);
        tick_within(tick);
        if (time_limit_s && !(*time_limit_s > 0)) {
            throw_input_error("is " + std::to_string(*time_limit_s) + ": expected more than 0 s", "time_limit_s");
        }
        if (max_iterations && *max_iterations == 0) {
            throw_input_error("is 0: expected at least 1", "max_iterations");
        }
        std::optional<Answer> before;
        {
            const std::scoped_lock lock(mutex_);
            before = std::exchange(latest_, std::nullopt);
        }
        try {
            return find_answer(start, tick, change, {time_limit_s, max_iterations, {}, {}}, on_answer, stop);
        } catch (const InputError&) {  // nothing has changed, so its answer stays the latest
            const std::scoped_lock lock(mutex_);
            latest_ = latest_ ? latest_ : before;
            throw;
        }
    }

    [[nodiscard]] std::optional<Answer> latest() const {
        const std::scoped_lock lock(mutex_);
        return latest_;
    }

    CoreStart predicted(const CoreStart& from, const Points& knots, std::int64_t ticks) {
        const Call call(*this);
        const Start start = start_of(from, problem_at_first());
        throw_if_any(start_errors(start, problem_at_first().robot));
        return numbers_of(planner_.predicted(start, plan_of(knots, problem_at_first()), tick_within(ticks)));
    }

    [[nodiscard]] std::vector<double> reference_of(const Points& knots, std::int64_t tick) const {
        return numbers_of(plan_of(knots, problem_at_first()).at(tick_within(tick)), axes_of(problem_at_first()).size());
    }

    void adopt(const Points& knots) {
        const Call call(*this);
        planner_.adopt(plan_of(knots, problem_at_first()));
    }

    [[nodiscard]] std::optional<py::dict> plan() {
        const Call call(*this);
        return planner_.plan() ? std::optional(columns_of(knot_table(*planner_.plan()))) : std::nullopt;
    }

    [[nodiscard]] CoreStart start() {
        const Call call(*this);
        return numbers_of(planner_.problem().start);
    }

    [[nodiscard]] std::shared_ptr<Problem> problem() {
        const Call call(*this);
        return problem_now();
    }

    [[nodiscard]] double tick_s() const { return no_knots(problem_at_first()).tick_s; }
    [[nodiscard]] std::vector<std::string> names() const { return knot_names(axes_of(problem_at_first())); }

 private:
    Answer find_answer(const Start& start, std::int64_t tick, const SceneChange& change, ReplanOptions options,
                       const py::object& on_answer, const py::object& stop) {
        return interruptible(stop, [&](Attendance& attendance) {
            options.stop = attendance.token();
            options.on_answer = [&](const AnswerOf<Family>& answer) {
                Answer told = with_problem(answer);
                {
                    const std::scoped_lock lock(mutex_);
                    latest_ = told;
                }
                if (!on_answer.is_none()) {
                    attendance.tell_each([&on_answer, told = std::move(told)] { on_answer(told); });
                }
            };
            return with_problem(planner_.replan(start, tick, change, options));
        });
    }

    /// While it lives no other call may begin.
    class Call {
     public:
        explicit Call(CorePlanner& planner) : planner_(planner) {
            if (planner_.is_busy_.exchange(true)) {
                throw std::runtime_error(
                    "another call of this Planner is running: wait until it returns; only latest() may be called now");
            }
        }
        ~Call() {
            planner_.tell_ = {};
            planner_.is_busy_ = false;
        }
        Call(const Call&) = delete;
        Call& operator=(const Call&) = delete;

     private:
        CorePlanner& planner_;
    };

    SolveOptions options(bool stop_at_first, bool finds_stops, const std::string& cache) {
        SolveOptions options;
        options.threads = threads_;
        options.stop_at_first_solution = stop_at_first;
        options.finds_stops = finds_stops;
        options.map_cache = cache;
        options.on_progress = [this](const Progress& now) {
            if (tell_) {
                tell_(now);
            }
        };
        return options;
    }

    /// Robot and control ticks never change.
    [[nodiscard]] const typename Family::Problem& problem_at_first() const { return began_with_.problem(); }

    [[nodiscard]] std::shared_ptr<Problem> problem_now() const {
        return problem_of(planner_, began_with_, planner_.problem().planner.seed);
    }

    [[nodiscard]] Answer with_problem(const AnswerOf<Family>& answer) const {
        return {answer, answer.solution ? problem_of(planner_, began_with_, answer.solution->seed) : nullptr, threads_};
    }

    Problem began_with_;
    int threads_;
    std::function<void(const Progress&)> tell_;  ///< what the running call tells
    PlannerOf<Family> planner_;
    std::atomic<bool> is_busy_ = false;
    mutable std::mutex mutex_;  ///< guards latest_
    std::optional<Answer> latest_;
};

template <class Family>
void bind_family(py::module_& module, const char* answer, const char* planner) {
    using OneAnswer = CoreAnswer<Family>;
    using OnePlanner = CorePlanner<Family>;
    py::class_<OneAnswer>(module, answer)
        .def_property_readonly("advice", [](const OneAnswer& of) { return name_of(of.answer.advice); })
        .def_property_readonly("cost", [](const OneAnswer& of) { return of.answer.cost; })
        .def_property_readonly("after_wall_s", [](const OneAnswer& of) { return of.answer.after_wall_s; })
        .def("plan", [](const OneAnswer& of) { return columns_of(knot_table(of.answer.plan)); })
        .def("solution", &OneAnswer::solution);
    py::class_<OnePlanner>(module, planner)
        .def(py::init<const typename OnePlanner::Problem&, int, bool, bool, const std::string&>())
        .def("solve", &OnePlanner::solve)
        .def(
            "replan",
            [](OnePlanner& of, const CoreStart& start, std::int64_t tick, const std::string& text, bool has_goal,
               const std::vector<std::string>& removed, const std::optional<double>& time_limit_s,
               const std::optional<std::uint64_t>& max_iterations, const py::object& on_answer,
               const py::object& stop) {
                return of.replan(start, tick, {text, has_goal, removed}, time_limit_s, max_iterations, on_answer, stop);
            })
        .def("latest", &OnePlanner::latest)
        .def("predicted", &OnePlanner::predicted)
        .def("reference_of", &OnePlanner::reference_of)
        .def("adopt", &OnePlanner::adopt)
        .def("plan", &OnePlanner::plan)
        .def("start", &OnePlanner::start)
        .def("problem", &OnePlanner::problem)
        .def_property_readonly("knot_names", &OnePlanner::names)
        .def_property_readonly("tick_s", &OnePlanner::tick_s);
}

}  // namespace

void bind_planner(py::module_& module) {
    bind_family<planning::Plane>(module, "Answer", "Planner");
    bind_family<planning::Space>(module, "SpaceAnswer", "SpacePlanner");
}

}  // namespace downwash::python

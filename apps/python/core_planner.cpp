#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/planner/planner.hpp"
#include "downwash/python/columns.hpp"
#include "downwash/python/core_solution.hpp"
#include "downwash/python/interruptible.hpp"

namespace downwash::python {
namespace {

/// The coordinates of a reference point, then their first and second derivatives.
using ReferenceNumbers = std::array<double, 3 * max_axes>;

ReferencePoint reference_point(const double* numbers) {
    ReferencePoint point;
    std::copy_n(numbers, max_axes, point.position);
    std::copy_n(numbers + max_axes, max_axes, point.velocity);
    std::copy_n(numbers + 2 * max_axes, max_axes, point.acceleration);
    return point;
}

/// A start: pose and speeds, the reference with its derivatives, rotor thrusts, the controller's memory.
using CoreStart =
    std::tuple<std::array<double, 8>, std::optional<ReferenceNumbers>, std::vector<double>, std::vector<double>>;

Start start_of(const CoreStart& given) {
    const auto& [s, reference, rotor_thrust_n, memory] = given;
    Start start{{s[0], s[1], s[2]}, s[3], {s[4], s[5], s[7]}, s[6], {}, rotor_thrust_n, memory};
    if (reference) {
        start.reference = reference_point(reference->data());
    }
    return start;
}

ReferenceNumbers numbers_of(const ReferencePoint& point) {
    ReferenceNumbers numbers;
    std::copy_n(point.position, max_axes, numbers.begin());
    std::copy_n(point.velocity, max_axes, numbers.begin() + max_axes);
    std::copy_n(point.acceleration, max_axes, numbers.begin() + 2 * max_axes);
    return numbers;
}

CoreStart numbers_of(const Start& s) {
    return {{s.at[plane::x], s.at[plane::z], s.at[plane::arm], s.pitch_rad, s.velocity[plane::x], s.velocity[plane::z],
             s.pitch_rate_rad_s, s.velocity[plane::arm]},
            s.reference ? std::optional(numbers_of(*s.reference)) : std::nullopt,
            s.rotor_thrust_n,
            s.controller_memory};
}

/// A plan from the rows of its knots, with the columns of knot_table().
Plan plan_of(const Points& knots, double tick_s) {
    constexpr auto columns = static_cast<py::ssize_t>(1 + 3 * max_axes);
    if (knots.ndim() != 2 || knots.shape(0) < 1 || knots.shape(1) != columns) {
        throw_input_error("has no knots: expected columns as solution.plan has them", "plan");
    }
    Plan plan;
    plan.tick_s = tick_s;
    const auto at = knots.unchecked<2>();
    for (py::ssize_t i = 0; i < knots.shape(0); ++i) {
        for (py::ssize_t k = 0; k < columns; ++k) {
            if (!std::isfinite(at(i, k))) {
                throw_input_error("has a number that is not finite in its row " + std::to_string(i), "plan");
            }
        }
        const double ticks = at(i, 0) / tick_s;
        const double before = i == 0 ? -1 : static_cast<double>(plan.reference.back().tick);
        const bool is_in_order = i == 0 ? std::round(ticks) == 0 : std::round(ticks) > before;
        if (std::abs(ticks - std::round(ticks)) > 1e-3 || !is_in_order || ticks > max_plan_ticks) {
            throw_input_error("has t_s = " + std::to_string(at(i, 0)) + " in its row " + std::to_string(i) +
                                  ": expected times on control ticks that rise from 0, at most an hour",
                              "plan");
        }
        plan.reference.push_back({std::llround(ticks), reference_point(knots.data(i, 1))});
    }
    return plan;
}

std::int64_t tick_within(std::int64_t tick) {
    if (tick < 0 || tick > max_plan_ticks) {
        throw_input_error("is " + std::to_string(tick) + ": expected 0 to " + std::to_string(max_plan_ticks), "tick");
    }
    return tick;
}

/// What Python gets of an answer.
struct CoreAnswer {
    Answer answer;
    std::shared_ptr<const CoreProblem> of;  ///< where there is a solution

    [[nodiscard]] std::optional<CoreSolution> solution() const {
        return answer.solution ? std::optional(CoreSolution{of, *answer.solution}) : std::nullopt;
    }
};

/// The changes of a call.
struct CoreChange {
    std::string text;  ///< text of a problem file, whose obstacles are put and whose goal is taken; empty: neither
    bool has_goal = false;
    std::vector<std::string> removed;
};

SceneChange change_of(const CoreChange& given) {
    SceneChange change;
    change.removed = given.removed;
    if (given.text.empty()) {
        return change;
    }
    const Problem values = parse_values(given.text, "<dict>");
    change.put = values.obstacles;
    if (given.has_goal) {
        if (!values.goals_before.empty() || !values.targets.empty() || asks_for_contact(values.goal)) {
            throw_input_error("changes to one goal: expected end_effector, configuration or any_of", "goal");
        }
        change.goal = values.goal;
    }
    return change;
}

/// A Planner with the problem that it began with. One call at a time, apart from latest().
class CorePlanner {
 public:
    CorePlanner(const CoreProblem& problem, int threads, bool stop_at_first, bool finds_stops, const std::string& cache)
        : began_with_(problem), planner_(problem.problem(), options(threads, stop_at_first, finds_stops, cache)) {}

    CoreSolution solve(const py::object& on_progress, const py::object& stop) {
        const Call call(*this);
        return interruptible(stop, [&](Attendance& attendance) {
            tell_ = telling(attendance, on_progress);
            const std::shared_ptr<const CoreProblem> of = problem_now();  // which loses its targets to their order
            Solution solution = planner_.solve(attendance.token());
            return CoreSolution{of, std::move(solution)};
        });
    }

    CoreAnswer replan(const CoreStart& from, std::int64_t tick, const CoreChange& given,
                      const std::optional<double>& time_limit_s, const std::optional<std::uint64_t>& max_iterations,
                      const py::object& on_answer, const py::object& stop) {
        const Call call(*this);
        const Start start = start_of(from);
        const SceneChange change = change_of(given);
        tick_within(tick);
        if (time_limit_s && !(*time_limit_s > 0)) {
            throw_input_error("is " + std::to_string(*time_limit_s) + ": expected more than 0 s", "time_limit_s");
        }
        if (max_iterations && *max_iterations == 0) {
            throw_input_error("is 0: expected at least 1", "max_iterations");
        }
        std::optional<CoreAnswer> before;
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

    [[nodiscard]] std::optional<CoreAnswer> latest() const {
        const std::scoped_lock lock(mutex_);
        return latest_;
    }

    CoreStart predicted(const CoreStart& from, const Points& knots, std::int64_t ticks) {
        const Call call(*this);
        const Start start = start_of(from);
        throw_if_any(start_errors(start, began_with_.problem().robot));
        const Plan plan = plan_of(knots, tick_s());
        return numbers_of(planner_.predicted(start, plan, tick_within(ticks)));
    }

    [[nodiscard]] ReferenceNumbers reference_of(const Points& knots, std::int64_t tick) const {
        return numbers_of(plan_of(knots, tick_s()).at(tick_within(tick)));
    }

    void adopt(const Points& knots) {
        const Call call(*this);
        planner_.adopt(plan_of(knots, tick_s()));
    }

    [[nodiscard]] std::optional<py::dict> plan() {
        const Call call(*this);
        return planner_.plan() ? std::optional(columns_of(knot_table(*planner_.plan()))) : std::nullopt;
    }

    [[nodiscard]] CoreStart start() {
        const Call call(*this);
        return numbers_of(planner_.problem().start);
    }

    [[nodiscard]] std::shared_ptr<CoreProblem> problem() {
        const Call call(*this);
        return problem_now();
    }

    [[nodiscard]] double tick_s() const { return began_with_.model()->tick().tick_s; }

 private:
    CoreAnswer find_answer(const Start& start, std::int64_t tick, const SceneChange& change, ReplanOptions options,
                           const py::object& on_answer, const py::object& stop) {
        return interruptible(stop, [&](Attendance& attendance) {
            options.stop = attendance.token();
            options.on_answer = [&](const Answer& answer) {
                CoreAnswer told = with_problem(answer);
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

    SolveOptions options(int threads, bool stop_at_first, bool finds_stops, const std::string& cache) {
        SolveOptions options;
        options.threads = thread_count(threads);
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

    [[nodiscard]] std::shared_ptr<CoreProblem> problem_now() const {
        return std::make_shared<CoreProblem>(CoreProblem{
            {{planner_.problem(), planner_.shared_model()}, {}, {}, began_with_.placed.placed}, began_with_.file});
    }

    [[nodiscard]] CoreAnswer with_problem(const Answer& answer) const {
        if (!answer.solution) {
            return {answer, nullptr};
        }
        const std::shared_ptr<CoreProblem> of = problem_now();
        of->placed.plannable.problem.planner.seed = static_cast<std::uint32_t>(answer.solution->seed);
        return {answer, of};
    }

    CoreProblem began_with_;
    std::function<void(const Progress&)> tell_;  ///< what the running call tells
    Planner planner_;
    std::atomic<bool> is_busy_ = false;
    mutable std::mutex mutex_;  ///< guards latest_
    std::optional<CoreAnswer> latest_;
};

}  // namespace

void bind_planner(py::module_& module) {
    py::class_<CoreAnswer>(module, "Answer")
        .def_property_readonly("advice", [](const CoreAnswer& of) { return name_of(of.answer.advice); })
        .def_property_readonly("cost", [](const CoreAnswer& of) { return of.answer.cost; })
        .def_property_readonly("after_wall_s", [](const CoreAnswer& of) { return of.answer.after_wall_s; })
        .def("plan", [](const CoreAnswer& of) { return columns_of(knot_table(of.answer.plan)); })
        .def("solution", &CoreAnswer::solution);
    py::class_<CorePlanner>(module, "Planner")
        .def(py::init<const CoreProblem&, int, bool, bool, const std::string&>())
        .def("solve", &CorePlanner::solve)
        .def("replan",
             [](CorePlanner& planner, const CoreStart& start, std::int64_t tick, const std::string& text, bool has_goal,
                const std::vector<std::string>& removed, const std::optional<double>& time_limit_s,
                const std::optional<std::uint64_t>& max_iterations, const py::object& on_answer,
                const py::object& stop) {
                 return planner.replan(start, tick, {text, has_goal, removed}, time_limit_s, max_iterations, on_answer,
                                       stop);
             })
        .def("latest", &CorePlanner::latest)
        .def("predicted", &CorePlanner::predicted)
        .def("reference_of", &CorePlanner::reference_of)
        .def("adopt", &CorePlanner::adopt)
        .def("plan", &CorePlanner::plan)
        .def("start", &CorePlanner::start)
        .def("problem", &CorePlanner::problem)
        .def_property_readonly("tick_s", &CorePlanner::tick_s);
}

}  // namespace downwash::python

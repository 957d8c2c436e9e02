#include <pybind11/stl.h>

#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>

#include "downwash/base/key_error.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/python/core_aeromap.hpp"
#include "downwash/python/core_solution.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash::python {
std::function<void(const Progress&)> telling(Attendance& attendance, const py::object& on_progress) {
    if (on_progress.is_none()) {
        return {};
    }
    return [&attendance, &on_progress](const Progress& now) {
        attendance.tell([&on_progress, now] {
            on_progress(now.wall_s, now.iterations, now.nodes, now.rejected, now.best_cost, now.worlds, now.failures);
        });
    };
}

namespace {

CoreSolution solve_problem(const std::shared_ptr<CoreProblem>& problem, int threads, bool stop_at_first,
                           const std::string& cache, const std::shared_ptr<CoreMap>& map, const py::object& on_progress,
                           const py::object& stop) {
    Solution solution = interruptible(stop, [&](Attendance& attendance) {
        SolveOptions options;
        options.threads = thread_count(threads);
        options.stop = attendance.token();
        options.on_progress = telling(attendance, on_progress);
        options.stop_at_first_solution = stop_at_first;
        options.keep_tree = true;
        options.finds_stops = true;
        options.map = map != nullptr ? map->map : nullptr;
        options.map_cache = cache;
        const Problem& asked = problem->problem();
        const bool needs_map = downwash::needs_map(asked, options.finds_stops);
        if (needs_map && options.map != nullptr && !problem->model()->matches(*options.map, asked.bounds)) {
            throw_input_error("is of another scene, robot, model or bounds: expected a map of the same problem", "map");
        }
        return solve(problem->placed.plannable, options);
    });
    return {problem, std::move(solution)};
}

/// The world that was asked for; nothing for the nominal one.
std::optional<FlownWorld> world_of(const Problem& problem, const std::optional<ExecutionWorld>& asked) {
    if (!asked) {
        return std::nullopt;
    }
    if (!problem.uncertainty) {
        throw_input_error("needs to know what is uncertain: the problem has no `uncertainty:`", "world");
    }
    return make_world(problem.robot, draw_world(*problem.uncertainty, problem.robot, asked->seed, asked->index));
}

/// The same solution with another flight of its plan.
CoreSolution executed(const CoreSolution& of, const std::shared_ptr<CoreProblem>& problem, bool aero,
                      const std::optional<std::uint64_t>& world_index, const std::optional<std::uint64_t>& seed,
                      const py::object& stop) {
    if (!of.solution.plan) {
        throw_input_error("has no plan to be executed", "the solution");
    }
    CoreSolution flown{problem, of.solution};
    Solution& solution = flown.solution;
    solution.execution_world.reset();
    if (world_index) {
        solution.execution_world = {*world_index, seed.value_or(solution.seed)};
    }
    const auto world = world_of(problem->problem(), solution.execution_world);
    solution.execution = interruptible(stop, [&](Attendance& attendance) {
        const FlightModel& model = *problem->model();
        const FlightWorld in{world ? &*world : nullptr, 0};
        FlightState nominal = start_state(model, problem->problem().start);
        if (world) {
            nominal.world = memory_at_start(*world, nominal.plant);
        }
        const auto start = world && is_at_rest(problem->problem().start) ? hovering_start(model, nominal, aero, in)
                                                                         : std::optional(nominal);
        if (!start) {
            throw_input_error("has a vehicle that cannot hover at its start: its controller diverges there", "world");
        }
        const Problem visited = as_visited(problem->problem(), solution);
        return execute(
            model, *start, solution.plan->reference, goals_of(visited), aero, in,
            [token = attendance.token()] { return token.stop_requested(); }, visited.energy_budget_j);
    });
    solution.execution_cost = cost_of(*solution.execution, solution.objective);
    return flown;
}

}  // namespace

void bind_solve(py::module_& module) {
    module.def("solve", solve_problem);
    module.def("execute", executed);
}

}  // namespace downwash::python

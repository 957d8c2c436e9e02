#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/controllers/space_axes.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/problems/space_problem_writer.hpp"
#include "downwash/problems/visit_order.hpp"
#include "downwash/python/columns.hpp"
#include "downwash/python/core_aeromap.hpp"
#include "downwash/python/core_solution.hpp"
#include "downwash/results/run_folder.hpp"
#include "downwash/results/space_trajectory_csv.hpp"
#include "downwash/results/tree_csv.hpp"
#include "downwash/simulation/space_world_parameters.hpp"
#ifdef DOWNWASH_WITH_REPORT
#include "downwash/report/run_page.hpp"
#include "downwash/report/space_page.hpp"
#endif

// Problems in space, planned and flown. Functions have the names and arguments of those of the plane.

namespace downwash::python {
namespace {

std::vector<LocatedError> remarks_on(const PlacedSpaceProblem& problem) {
    std::vector<LocatedError> all = problem.outdated;
    all.insert(all.end(), problem.warnings.begin(), problem.warnings.end());
    return all;
}

CoreSpaceSolution solve_in_space(const std::shared_ptr<CoreSpaceProblem>& problem, int threads, bool stop_at_first,
                                 const std::string& cache, const std::shared_ptr<CoreVolumes>& map,
                                 const py::object& on_progress, const py::object& stop) {
    if (const auto errors = space_planning_errors(problem->problem()); !errors.empty()) {
        throw ProblemFileError(problem->placed.placed(errors));
    }
    const int count = thread_count(threads);
    auto found = interruptible(stop, [&](Attendance& attendance) {
        SpaceSolveOptions options;
        options.threads = count;
        options.stop = attendance.token();
        options.on_progress = telling(attendance, on_progress);
        options.stop_at_first_solution = stop_at_first;
        options.keep_tree = true;
        options.finds_stops = true;
        options.map = map != nullptr ? map->volumes : nullptr;
        options.map_cache = cache;
        return std::make_shared<const SpaceSearchResult>(solve(problem->model(), options));
    });
    return {problem, solution_of(problem->problem(), std::move(found), count)};
}

/// The same solution with another flight of its plan.
CoreSpaceSolution executed_in_space(const CoreSpaceSolution& of, const std::shared_ptr<CoreSpaceProblem>& problem,
                                    bool aero, const std::optional<std::uint64_t>& world,
                                    const std::optional<std::uint64_t>& seed, const py::object& stop) {
    if (!of.solution.plan) {
        throw_input_error("has no plan to be executed", "the solution");
    }
    const SpaceProblem visited = as_visited(problem->problem(), of.solution);
    CoreSpaceSolution flown{problem, of.solution};
    SpaceSolution& solution = flown.solution;
    solution.aero = aero;
    solution.execution_world.reset();
    SpaceExecutionSettings settings;
    settings.aero = aero;
    if (world) {
        const auto& uncertainty = problem->problem().uncertainty;
        if (!uncertainty) {
            throw_input_error("needs to know what is uncertain: the problem has no `uncertainty:`", "world");
        }
        solution.execution_world = {*world, seed.value_or(solution.seed)};
        settings.world =
            draw_space_world(*uncertainty, problem->problem().robot, solution.execution_world->seed, *world);
    }
    solution.execution = interruptible(stop, [&](Attendance& attendance) {
        settings.is_over = [token = attendance.token()] { return token.stop_requested(); };
        return SpaceProblemModel(visited).execute(*solution.plan, settings);
    });
    return flown;
}

CoreSpaceSolution read_in_space(const std::string& file, const std::shared_ptr<CoreSpaceProblem>& problem) {
    SpaceSolution solution = read_solution(file, problem->problem());
    solution.joints = problem->problem().robot.joints();
    return {problem, std::move(solution)};
}

std::string space_json(const CoreSpaceSolution& of) {
    const SpaceProblem& problem = of.of->problem();
    return solution_json(of.solution, {problem.name, of.of->file, problem_sha256(problem), remarks_on(of.of->placed),
                                       input_facts(problem, of.of->model()->scene())});
}

/// Writes the page of a run, if this build brings pages.
void write_page(const std::filesystem::path& folder, const SpaceRunRecord& record) {
#ifdef DOWNWASH_WITH_REPORT
    if (has_pages()) {
        const std::string page = space_page(record.problem, shown_run(record));
        const FolderLock lock(folder);
        write_file(folder / run_page_name, page);
    }
#else
    static_cast<void>(folder), static_cast<void>(record);
#endif
}

void write_in_space(const CoreSpaceSolution& of, const std::string& path, bool force) {
    const py::gil_scoped_release released;
    const SpaceProblem& problem = of.of->problem();
    RunFolder folder(path, problem, of.of->file, force);
    const SpaceRunRecord record = folder.write(problem, of.of->file, remarks_on(of.of->placed), of.solution,
                                               input_facts(problem, of.of->model()->scene()));
    write_page(folder.path(), record);
}

std::optional<py::dict> space_plan_columns(const CoreSpaceSolution& of) {
    return of.solution.plan ? std::optional(columns_of(knot_table(*of.solution.plan))) : std::nullopt;
}

std::optional<py::dict> space_flight_columns(const CoreSpaceSolution& of) {
    return of.solution.execution ? std::optional(columns_of(trajectory_table(*of.solution.execution))) : std::nullopt;
}

py::dict space_tree_columns(const CoreSpaceSolution& of) {
    const auto& search = of.solution.search;
    return columns_of(
        tree_table(search ? std::span<const SpaceTreeNode>(search->tree) : std::span<const SpaceTreeNode>(),
                   axes_in_space(of.of->problem().robot.joints())));
}

/// Files hold all digits, those of angles in degrees.
bool is_nearly(double a, double b) {
    return std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)});
}

}  // namespace

SpaceProblem as_visited(const SpaceProblem& problem, const SpaceSolution& solution) {
    const SpacePlan& plan = *solution.plan;
    if (plan.joints != problem.robot.joints()) {
        throw_input_error("is a plan for a robot with " + std::to_string(plan.joints) +
                              " joints, and the problem's has " + std::to_string(problem.robot.joints()),
                          "the solution");
    }
    const double tick_s = 1 / problem.robot.controller.rate_hz;
    if (!is_nearly(plan.tick_s, tick_s)) {
        throw_input_error("is a plan on control ticks of " + std::to_string(plan.tick_s) +
                              " s, but the problem's robot has ticks of " + std::to_string(tick_s) + " s",
                          "the solution");
    }
    const double* first = plan.reference.front().point.position;
    const SpacePoint begin = reference_at(problem.start);
    if (!std::equal(first, first + space::yaw, begin.position, is_nearly) ||
        !std::equal(first + space::first_joint, first + space::first_joint + plan.joints,
                    begin.position + space::first_joint, is_nearly)) {
        throw_input_error("is a plan that begins elsewhere than the problem", "the solution");
    }
    const auto fits = [&problem](const Visit& visit) {
        return visit.target < problem.goals.size() &&
               (!visit.alternative || *visit.alternative < problem.goals[visit.target].any_of.size());
    };
    if (solution.order && !(problem.in_any_order && std::ranges::all_of(solution.order->visits, fits))) {
        throw_input_error("is a plan of other targets than the problem has", "the solution");
    }
    return in_order(problem, solution.order);
}

void bind_space(py::module_& module) {
    py::class_<CoreSpaceSolution, std::shared_ptr<CoreSpaceSolution>>(module, "SpaceSolution")
        .def_property_readonly("status", [](const CoreSpaceSolution& of) { return name_of(of.solution.status); })
        .def_property_readonly("interrupted", [](const CoreSpaceSolution& of) { return of.solution.interrupted; })
        .def_property_readonly(
            "cost", [](const CoreSpaceSolution& of) { return of.solution.search ? of.solution.search->cost : 0; })
        .def("problem", [](const CoreSpaceSolution& of) { return std::make_shared<CoreSpaceProblem>(*of.of); })
        .def("json", space_json)
        .def("plan", space_plan_columns)
        .def("flight", space_flight_columns)
        .def("tree", space_tree_columns)
        .def("write", write_in_space);
    module.def("solve", solve_in_space);
    module.def("execute", executed_in_space);
    module.def("read_solution", read_in_space);
}

}  // namespace downwash::python

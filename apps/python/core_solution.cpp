#include "downwash/python/core_solution.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/problems/visit_order.hpp"
#include "downwash/python/columns.hpp"
#include "downwash/results/run_folder.hpp"
#include "downwash/results/solution_file.hpp"
#include "downwash/results/trajectory_csv.hpp"
#include "downwash/results/tree_csv.hpp"
#ifdef DOWNWASH_WITH_REPORT
#include "downwash/report/run_page.hpp"
#endif

namespace downwash::python {
namespace {

/// What reading the problem told: keys by their former names, then warnings.
std::vector<LocatedError> remarks_on(const PlacedProblem& problem) {
    std::vector<LocatedError> all = problem.outdated;
    all.insert(all.end(), problem.warnings.begin(), problem.warnings.end());
    return all;
}

std::string json_of(const CoreSolution& of) {
    const Problem& problem = of.of->problem();
    return solution_json(of.solution, {problem.name, of.of->file, problem_sha256(problem), remarks_on(of.of->placed),
                                       problem.axes(), input_facts(problem, of.of->model()->scene())});
}

/// Writes the page of a run, if this build brings pages.
void write_page(const std::filesystem::path& folder, const RunRecord& record, const FlightModel& model, int threads) {
#ifdef DOWNWASH_WITH_REPORT
    if (has_pages()) {
        const std::string page = run_page(record, model, threads);
        const FolderLock lock(folder);
        write_file(folder / run_page_name, page);
    }
#else
    static_cast<void>(folder), static_cast<void>(record), static_cast<void>(model), static_cast<void>(threads);
#endif
}

void write(const CoreSolution& of, const std::string& path, bool force) {
    const py::gil_scoped_release released;
    const Problem& problem = of.of->problem();
    require_readable_again(problem, path);
    RunFolder folder(path, problem, of.of->file, force);
    const RunRecord record = folder.write(problem, of.of->file, remarks_on(of.of->placed), of.solution,
                                          input_facts(problem, of.of->model()->scene()));
    if (of.solution.map != nullptr || !of.solution.interrupted) {  // without a map there was no search to be shown yet
        write_page(folder.path(), record, *of.of->model(), of.solution.threads);
    }
}

std::optional<py::dict> plan_columns(const CoreSolution& of) {
    return of.solution.plan ? std::optional(columns_of(knot_table(*of.solution.plan))) : std::nullopt;
}

std::optional<py::dict> flight_columns(const CoreSolution& of) {
    return of.solution.execution ? std::optional(columns_of(trajectory_table(*of.solution.execution))) : std::nullopt;
}

CoreSolution read(const std::string& file, const std::shared_ptr<CoreProblem>& problem) {
    return {problem, read_solution(file, problem->problem())};
}

/// Files hold all digits, those of angles in degrees.
bool is_near(double a, double b) {
    return std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)});
}

}  // namespace

Problem as_visited(const Problem& problem, const Solution& solution) {
    const auto fits = [&problem](const Visit& visit) {
        return visit.target < problem.targets.size() &&
               (!visit.alternative || *visit.alternative < problem.targets[visit.target].any_of.size());
    };
    if (!problem.targets.empty() && solution.order && !std::ranges::all_of(solution.order->visits, fits)) {
        throw_input_error("is a plan of other targets than the problem has", "the solution");
    }
    if (solution.plan) {
        const double tick_s = 1 / problem.robot.controller.rate_hz;
        if (!is_near(solution.plan->tick_s, tick_s)) {
            throw_input_error("is a plan on control ticks of " + std::to_string(solution.plan->tick_s) +
                                  " s, but the problem's robot has ticks of " + std::to_string(tick_s) + " s",
                              "the solution");
        }
        const Start& start = problem.start;
        const Configuration begin = start.reference ? configuration_of(*start.reference) : start.at;
        const Configuration first = solution.plan->first();
        if (!std::ranges::equal(begin.coordinate, first.coordinate, is_near)) {
            throw_input_error("is a plan that begins elsewhere than the problem", "the solution");
        }
    }
    return in_order(problem, solution.order);
}

void bind_solution(py::module_& module) {
    py::class_<CoreSolution, std::shared_ptr<CoreSolution>>(module, "Solution")
        .def_property_readonly("status", [](const CoreSolution& of) { return name_of(of.solution.status); })
        .def_property_readonly("interrupted", [](const CoreSolution& of) { return of.solution.interrupted; })
        .def_property_readonly("cost", [](const CoreSolution& of) { return of.solution.cost; })
        .def("problem", [](const CoreSolution& of) { return std::make_shared<CoreProblem>(*of.of); })
        .def("json", json_of)
        .def("plan", plan_columns)
        .def("flight", flight_columns)
        .def("tree",
             [](const CoreSolution& of) { return columns_of(tree_table(of.solution.tree, of.of->problem().axes())); })
        .def("write", write);
    module.def("read_solution", read);
}

}  // namespace downwash::python

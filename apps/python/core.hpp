#pragma once

// What the parts of the extension module downwash._core share. downwash/__init__.py is what users see.

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "downwash/problems/placed_problem.hpp"

namespace downwash::python {

namespace py = pybind11;

/// A checked problem, with the name of where it was read from.
struct CoreProblem {
    PlacedProblem placed;
    std::string file;  ///< as the user gave it

    [[nodiscard]] const Problem& problem() const noexcept { return placed.plannable.problem; }
    [[nodiscard]] const std::shared_ptr<const FlightModel>& model() const noexcept { return placed.plannable.model; }
};

/// The same in space.
struct CoreSpaceProblem {
    PlacedSpaceProblem placed;
    std::string file;  ///< as the user gave it

    [[nodiscard]] const SpaceProblem& problem() const noexcept { return placed.model->problem(); }
    [[nodiscard]] const std::shared_ptr<const SpaceProblemModel>& model() const noexcept { return placed.model; }
};

/// The number of threads that a user asks for; one per processor, 64 at most, where that is 0.
[[nodiscard]] int thread_count(int asked);

/// Registers the classes and functions of a source file.
void bind_errors(py::module_& module);
void bind_problem(py::module_& module);
void bind_solution(py::module_& module);
void bind_solve(py::module_& module);
void bind_space(py::module_& module);
void bind_planner(py::module_& module);
void bind_aeromap(py::module_& module);
void bind_hold(py::module_& module);
void bind_validate(py::module_& module);
void bind_figures(py::module_& module);

}  // namespace downwash::python

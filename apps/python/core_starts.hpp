#pragma once

#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "downwash/controllers/axes.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/python/columns.hpp"

// Starts, points of references and plans of both families, as lists of numbers that Python names.

namespace downwash::python {

/// The axes of a problem's references.
[[nodiscard]] std::span<const Axis> axes_of(const Problem& problem);
[[nodiscard]] std::span<const Axis> axes_of(const SpaceProblem& problem);

/// A plan without knots.
[[nodiscard]] Plan no_knots(const Problem& problem);
[[nodiscard]] SpacePlan no_knots(const SpaceProblem& problem);

/// A start of either family: the numbers of the vehicle, of its joints and of their rates, then the reference with its
/// derivatives (knot_names() without t_s), rotor thrusts and the controller's memory. In the plane the vehicle has x,
/// z, arm, pitch and their rates, and the lists of joints are empty; in space x, y, z, attitude, velocity and body
/// rates.
using CoreStart = std::tuple<std::vector<double>, std::vector<double>, std::vector<double>,
                             std::optional<std::vector<double>>, std::vector<double>, std::vector<double>>;

/// @throws InputError if it has another number of numbers than a vehicle of that problem
[[nodiscard]] Start start_of(const CoreStart& given, const Problem& problem);
[[nodiscard]] SpaceStart start_of(const CoreStart& given, const SpaceProblem& problem);
[[nodiscard]] CoreStart numbers_of(const Start& start);
[[nodiscard]] CoreStart numbers_of(const SpaceStart& start);

/// A plan of a problem from the rows of its knots, with the columns of knot_names().
/// @throws InputError if they are none
[[nodiscard]] Plan plan_of(const Points& knots, const Problem& problem);
[[nodiscard]] SpacePlan plan_of(const Points& knots, const SpaceProblem& problem);

}  // namespace downwash::python

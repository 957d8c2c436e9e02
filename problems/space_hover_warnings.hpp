#pragma once

#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash {

/// Goals that a vehicle misses in clearly more worlds than its plans may fail in, though it does nothing but hover in
/// the middle of the goal in free air: no plan to them gets a certificate. Nothing without an uncertainty, of problems
/// that ask for no certificate, and of contacts. Goals with equal tolerances are asked once.
/// @pre space_problem_errors(problem) is empty
[[nodiscard]] std::vector<KeyError> space_hover_warnings(const SpaceProblem& problem);

}  // namespace downwash

#pragma once

#include "downwash/base/checks.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/parameter_table.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash {

/// Every parameter of a problem in space, its robot's included: see problem_parameters().
[[nodiscard]] DOWNWASH_EXPORT const ParameterTable<SpaceProblem>& space_problem_parameters();

/// As space_problem_errors(), for a problem of which some values are already known to be wrong or missing: neither they
/// nor anything that depends on them is reported again.
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> further_space_problem_errors(const SpaceProblem& problem,
                                                                                 WrongKeys wrong);

}  // namespace downwash

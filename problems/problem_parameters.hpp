#pragma once

#include <span>

#include "downwash/base/checks.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/parameter_table.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// Every parameter of a problem, its robot's included, with key, unit, default and range: the one table behind reading,
/// writing, errors and documentation. A default is what the parameter holds in `Problem{}`.
[[nodiscard]] DOWNWASH_EXPORT const ParameterTable<Problem>& problem_parameters();

/// As problem_errors, for a problem of which some values are already known to be wrong or missing: neither they nor
/// anything that depends on them is reported again.
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> further_problem_errors(const Problem& problem, WrongKeys wrong);

}  // namespace downwash

#pragma once

#include <cstddef>

#include "downwash/controllers/plan.hpp"
#include "downwash/dynamics/plant.hpp"

// Private to results/. What the readers of tables accept. A run never writes more: its flight is at most max_plan_ticks
// long and its last hover as long again. How large numbers may be: see max_result; solution files: max_solution_bytes.

namespace downwash {

/// Larger tables, trajectory.csv or tree.csv, are not read [bytes].
inline constexpr std::size_t max_table_bytes = std::size_t{1} << 30U;

/// Tables of more numbers are not read.
inline constexpr std::size_t max_table_numbers = 40'000'000;

static_assert(2 * (max_plan_ticks + 1) * (24 + 3 * max_rotors) <= std::ptrdiff_t{max_table_numbers});
static_assert(max_table_numbers * 26 <= max_table_bytes, "a number has 24 letters at most, and its comma");

}  // namespace downwash

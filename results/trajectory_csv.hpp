#pragma once

#include <string>

#include "downwash/base/export.hpp"
#include "downwash/results/number_table.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash {

/// The text of trajectory.csv: the column names, then one row per control tick. Every number is the shortest that reads
/// back as the very same. `clearance_m` is empty without obstacles; rotors have a lag column only when they lag.
[[nodiscard]] DOWNWASH_EXPORT std::string trajectory_csv(const Execution& execution);

/// The numbers of a trajectory as a table; a clearance without obstacles is NaN.
[[nodiscard]] DOWNWASH_EXPORT NumberTable trajectory_table(const Execution& execution);

}  // namespace downwash

#pragma once

#include <string>

#include "downwash/base/export.hpp"
#include "downwash/results/number_table.hpp"
#include "downwash/simulation/space_flight.hpp"

namespace downwash {

/// The numbers of a flight in space as a table, with the columns of trajectory.csv: one row per control tick. A
/// clearance without obstacles is NaN; rotors have a lag column only when they lag, and the last column, of a flight
/// with a touch, is its force.
[[nodiscard]] DOWNWASH_EXPORT NumberTable trajectory_table(const SpaceFlight& flight);

/// The text of trajectory.csv: see the trajectory_csv() of an execution in the plane.
[[nodiscard]] DOWNWASH_EXPORT std::string trajectory_csv(const SpaceFlight& flight);

}  // namespace downwash

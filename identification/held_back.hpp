#pragma once

#include <array>
#include <cstdint>

#include "downwash/base/export.hpp"
#include "downwash/identification/logged_flight.hpp"
#include "downwash/simulation/space_robot.hpp"

namespace downwash {

/// How a flight compares with flights along the same reference in worlds.
struct HeldBackCoverage {
    int worlds = 0;
    int lost = 0;  ///< flights in worlds that end early
    /// Of x, y and z: share of the ticks at which the flight was seen where a flight in one more world is with 95 %,
    /// and the mean width of that interval [m].
    std::array<double, 3> share_within{};
    std::array<double, 3> width_m{};
};

/// Flies the reference of a logged flight in worlds of the robot's uncertainty, in closed loop and free air, and says
/// how often the log is within them. @param air of wind and gusts
/// @pre the flight has a reference and begins at rest; worlds >= 1
[[nodiscard]] DOWNWASH_EXPORT HeldBackCoverage held_back_coverage(const SpaceRobot& robot, const LoggedFlight& flight,
                                                                  const Uncertainty& air, int worlds,
                                                                  std::uint64_t seed);

}  // namespace downwash

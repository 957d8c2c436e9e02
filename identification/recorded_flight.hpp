#pragma once

#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/identification/logged_flight.hpp"
#include "downwash/logs/flight_log.hpp"
#include "downwash/simulation/space_robot.hpp"

namespace downwash {

/// What a log is taken for.
struct RecordedFlightOptions {
    bool is_true_motion = false;  ///< see LoggedFlight
    /// Of commands that are no thrusts: thrust over the greatest is the share of the full command to this power.
    std::optional<double> thrust_exponent;
};

/// The part of a log in which all is recorded that identification needs, at the times of the rotor commands: the
/// longest one without a gap. Yaw and joints of the reference are those that were flown: logs have set-points of the
/// position.
/// @throws InputError that names what the log lacks
[[nodiscard]] DOWNWASH_EXPORT LoggedFlight recorded_flight(const FlightLog& log, const SpaceRobot& robot,
                                                           const RecordedFlightOptions& options = {});

}  // namespace downwash

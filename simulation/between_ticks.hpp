#pragma once

// What happens between two control ticks: where the robot was looked at twice, and what it may have touched on the way.
// Private: not installed.

#include "downwash/simulation/flight_model.hpp"
#include "downwash/simulation/motion_reach.hpp"

namespace downwash::simulation {

/// The reach of what can touch an obstacle.
[[nodiscard]] MotionReach motion_reach(const FlightModel& model) noexcept;

/// No point of the robot's surface moves farther between two poses whose coordinates all change evenly [m].
[[nodiscard]] double motion_m(const FlightModel& model, const PlanarPose& from, const PlanarPose& to) noexcept;

/// Whether the robot is nearer than a margin to an obstacle at some pose between two at which it is not. Looks at as
/// many that it moves by at most greatest_unseen_motion_m(margin_m) from one to the next; at none, where that is the
/// case already.
[[nodiscard]] bool comes_nearer_between(const FlightModel& model, const PlanarPose& from, const PlanarPose& to,
                                        double margin_m);

/// A clearance of zero or less that the robot has between two poses; that of the nearer pose where there is none.
/// Two clearances whose sum is no less than the motion between them leave no room for contact; other stretches are
/// halved until that shows or a corner is cut by half a millimetre at most.
/// @param from_m,to_m the clearances at both poses [m], above 0
[[nodiscard]] double least_clearance_between_m(const FlightModel& model, const PlanarPose& from, double from_m,
                                               const PlanarPose& to, double to_m);

}  // namespace downwash::simulation

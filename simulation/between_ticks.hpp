#pragma once

// What the robot may touch between two control ticks, given the poses at both. Private: not installed.

#include "downwash/simulation/flight_model.hpp"
#include "downwash/simulation/motion_reach.hpp"

namespace downwash::simulation {

/// The reach of what can touch an obstacle.
[[nodiscard]] MotionReach motion_reach(const FlightModel& model) noexcept;

/// A bound on how far any point of the robot's surface moves between two poses whose coordinates change evenly [m].
/// Both, here and below, are equally far beside the plane.
[[nodiscard]] double motion_m(const FlightModel& model, const PlanarPose& from, const PlanarPose& to) noexcept;

/// Whether the robot is nearer than a margin to an obstacle at some pose between two poses at which it is not. Checks
/// intermediate poses that are at most max_unseen_motion_m(margin_m) apart; none, if the two poses are that near
/// already.
[[nodiscard]] bool comes_nearer_between(const FlightModel& model, const PlanarPose& from, const PlanarPose& to,
                                        double margin_m);

/// A clearance of zero or less that the robot has between two poses; without one, the lesser clearance of both poses.
/// If the sum of two clearances is at least the motion between them, no contact is possible. Other intervals are halved
/// until that holds, or until a corner can be cut by half a millimetre at most.
/// @param from_m,to_m the clearances at both poses [m], above 0   @param clearance_m measures those of other poses
[[nodiscard]] double least_clearance_between_m(const FlightModel& model, const PlanarPose& from, double from_m,
                                               const PlanarPose& to, double to_m,
                                               double (*clearance_m)(const FlightModel&, const PlanarPose&));

/// Clearances of planned and of executed flights, for least_clearance_between_m().
[[nodiscard]] inline double planned_clearance_m(const FlightModel& model, const PlanarPose& pose) {
    return model.collisions().clearance_m(pose);
}
[[nodiscard]] inline double executed_clearance_m(const FlightModel& model, const PlanarPose& pose) {
    return model.executed_clearance_m(pose);
}

}  // namespace downwash::simulation

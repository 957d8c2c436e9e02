#pragma once

// Private: not installed.

#include <cstdint>

#include "downwash/base/vector3.hpp"
#include "downwash/exports/setpoint.hpp"

namespace downwash {

inline constexpr double max_bearing_deg = 360;

/// The frame that a file has its set-points in. The origins of all are that of the world.
enum class SetpointFrame : std::uint8_t {
    world,            ///< that of the problem: x forward, y left, z up
    east_north_up,    ///< a map of ROS (REP 103 and 105); yaw counts counterclockwise from east
    north_east_down,  ///< the local frame of PX4 and MAVLink; yaw counts clockwise from north, -pi to pi
};

/// Turns set-points from the world into the frame of a file.
class SetpointAxes {
 public:
    /// @param bearing_deg compass direction of the world's x axis, clockwise from north
    /// @throws InputError if the bearing is beyond max_bearing_deg
    SetpointAxes(SetpointFrame frame, double bearing_deg);

    [[nodiscard]] Vector3 of(const Vector3& in_world) const;
    [[nodiscard]] Setpoint of(const Setpoint& in_world) const;

 private:
    [[nodiscard]] double yaw_rad(double in_world_rad) const;

    SetpointFrame frame_;
    Matrix3 axes_;        ///< of the frame in the world, by rows
    double bearing_rad_;  ///< of the world's x axis
};

}  // namespace downwash

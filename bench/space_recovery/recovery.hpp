#pragma once

#include "../../tests/support/random.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/simulation/space_loop.hpp"
#include "downwash/simulation/space_robot.hpp"

// Vehicles in space that are thrown at any attitude and shall come to rest where they were thrown.

namespace downwash::bench {

/// The robot without its arm.
[[nodiscard]] SpaceRobot without_arm(SpaceRobot robot);

/// The robot with rotors whose limits are scaled so that all together lift so many times its weight.
/// @pre its rotors push upward
[[nodiscard]] SpaceRobot with_thrust_over_weight(SpaceRobot robot, double ratio);

/// The robot under PX4's cascade, with the gains that our bandwidths give for the lag of its rotors.
[[nodiscard]] SpaceRobot under_cascade(SpaceRobot robot);

/// For each body axis the greatest rate that the rotors stop within half a turn [rad/s]: beyond it the shortest way
/// back is another one by then. The vehicle turns on at w until commands act, for the time t of a tick, the delay and
/// the rotors' lag; then the greatest torque of the rotors slows it: w t + I w^2 / (2 torque) = pi. I is that of the
/// whole vehicle with its joints at zero.
/// @pre space_robot_errors(robot) is empty
[[nodiscard]] Vector3 stoppable_rates_rad_s(const SpaceRobot& robot);

/// A vehicle as it is thrown: at the origin, its joints at zero and at rest.
struct Throw {
    SpaceMotion motion;
    double effort = 0;  ///< sqrt(sum (w_i / stoppable rate_i)^2)
};

/// A throw at an attitude drawn evenly from all and up to 1 m/s along each axis; its rates have a direction drawn
/// evenly among those in units of the stoppable rates, and an effort drawn evenly up to the greatest.
[[nodiscard]] Throw drawn_throw(const Vector3& stoppable_rad_s, double max_effort, test::Random& random);

/// What became of a throw.
struct Recovery {
    /// The vehicle is upright in the last second: tilted by less than 60 degrees, no body rate above 2 rad/s, sinking
    /// by less than 2 m/s.
    bool is_upright = false;
    double upright_s = 0;  ///< when the first such second began; the whole flight where there was none
    /// It is back in the last second, too: within 0.1 m of the origin, slower than 0.1 m/s and 0.1 rad/s, tilted by
    /// less than 2 degrees.
    bool is_home = false;
    double home_s = 0;            ///< when that second began, or the whole flight
    double height_lost_m = 0;     ///< from the throw to the lowest place
    double joint_beyond_rad = 0;  ///< the most that a joint was beyond its limits
    SpaceMotion end;
};

/// A flight ends when the vehicle has been home for a second, or now.
inline constexpr double max_recovery_s = 40;

/// Flies a thrown vehicle in free air, with a reference at rest in the origin.
[[nodiscard]] Recovery recover(const SpaceRobot& robot, const SpaceMotion& thrown);

}  // namespace downwash::bench

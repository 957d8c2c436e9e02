#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <downwash/controllers/space_reference.hpp>
#include <downwash/mavlink/messages.hpp>
#include <downwash/problems/space_problem.hpp>

// What vehicle and streamer both know of PX4.

constexpr double setpoint_period_s = 0.02;  ///< 50 Hz
constexpr double loss_timeout_s = 0.5;      ///< COM_OF_LOSS_T: so long PX4 waits for a set-point; its default is 1 s
constexpr double warm_up_s = 1;             ///< of set-points, before PX4 enters offboard mode

/// Reads a problem. @throws downwash::InputError if its robot's controller is not PX4's cascade, ProblemFileError
downwash::SpaceProblem read_px4_problem(const std::string& file);

/// PX4's cascade of the robot of such a problem.
const downwash::Px4Cascade& px4_of(const downwash::SpaceRobot& robot);

/// A vector of the world (x forward, y left, z up) in the local frame (north, east, down), and the other way round. x
/// points north here; a real vehicle needs the bearing of x.
inline std::array<double, 3> turned_over(double x, double y, double z) {
    return {x, -y, -z};
}

/// A reference as MAVLink's set-point. @param target_system 0: all
downwash::mavlink::SetPositionTargetLocalNed setpoint_of(const downwash::SpacePoint& reference, double time_s);

/// The reference of a set-point. @param before the reference so far: its joints stay, and the yaw is that next to its
downwash::SpacePoint reference_of(const downwash::mavlink::SetPositionTargetLocalNed& setpoint,
                                  const downwash::SpacePoint& before);

/// The joints as MAV_CMD_DO_SET_ACTUATOR: -1 is a joint's lower limit, 1 its upper one; half a turn either way for
/// those without limits.
downwash::mavlink::CommandLong actuators_of(const downwash::SpacePoint& reference, const downwash::SpaceRobot& robot);
/// The angle of a joint at such a value.
double angle_at(double value, const downwash::SpaceLinkLimits& joint);

/// How PX4 stops in Hold: straight on, to a place v (v / (2 MPC_ACC_HOR) + 0.6 s) ahead
/// (Navigator::preproject_stop_point). Joints stay where they are. @param from position and velocity
downwash::SpacePlan stop_in_hold(const downwash::SpacePoint& from, int joints, double tick_s);

/// What the vehicle flies from a tick of a plan on when no set-point comes after that of this tick: it holds on to the
/// last one for loss_timeout_s, which carries it on, and then stops in Hold.
downwash::SpacePlan flown_in_silence(const downwash::SpacePlan& plan, std::int64_t tick,
                                     const downwash::Px4Cascade& law);

#pragma once

#include <functional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/simulation/space_robot.hpp"

// A robot in space at rest, with its multirotor level: where its arm is, and what holds it there.

namespace downwash {

/// Where the parts of an arm are, in the multirotor's frame.
struct ArmPose {
    std::vector<Vector3> joint_m, axis;     ///< of each link: its joint, and the joint's axis, of length 1
    std::vector<Vector3> center_of_mass_m;  ///< of each link
    Vector3 end_effector_m = {};
    Vector3 direction = {};  ///< where the end effector points
};

/// @param joints_rad one angle for each link
[[nodiscard]] DOWNWASH_EXPORT ArmPose arm_pose(const SpaceRobot& robot, const std::vector<double>& joints_rad);

/// Centre of mass of the whole robot, from the multirotor's.
[[nodiscard]] DOWNWASH_EXPORT Vector3 center_of_mass_m(const SpaceRobot& robot, const ArmPose& pose);

/// Torque by which a joint holds what it carries against gravity [Nm], about its axis.
[[nodiscard]] DOWNWASH_EXPORT double holding_torque_nm(const SpaceRobot& robot, const ArmPose& pose, std::size_t joint);

/// How the rotors share a vertical force of 1 N that acts along a line through a place: the least squares that yield
/// thrust along the body's z and three torques. Horizontal forces of tilted rotors are what comes of it. Empty if the
/// rotors cannot do it.
/// @param at_m from the multirotor's centre of mass
[[nodiscard]] DOWNWASH_EXPORT std::vector<double> thrust_shares(const SpacePlant& plant, const Vector3& at_m);

/// Rank of the rotors' thrust and torques, each row scaled to length 1: 4 if they turn the vehicle about every axis.
/// @param with_yaw without it, of thrust, roll and pitch alone: 3 at most
[[nodiscard]] DOWNWASH_EXPORT int allocation_rank(const SpacePlant& plant, bool with_yaw);

/// Principal moments of an inertia, in its unit and in rising order. @pre the matrix is symmetric
[[nodiscard]] DOWNWASH_EXPORT Vector3 principal_moments(const Matrix3& inertia);

/// The greatest value that a function of the joints takes, and where.
struct WorstPose {
    double value = 0;
    std::vector<double> joints_rad;
};

/// Looks for the greatest value within the limits of the joints. It is exact in each joint alone and starts from 32
/// poses; a greater value elsewhere is possible but unlikely.
/// @param value of joint angles: with the others held, a + b cos(q) + c sin(q) of each
[[nodiscard]] DOWNWASH_EXPORT WorstPose worst_pose(const SpaceRobot& robot,
                                                   const std::function<double(const std::vector<double>&)>& value);

/// Farthest that the end effector gets from the multirotor's centre of mass [m], in any pose that is tried.
/// @pre no axis of a joint is zero
[[nodiscard]] DOWNWASH_EXPORT double arm_reach_m(const SpaceRobot& robot);

/// "[30, -90]" in degrees, to a tenth.
[[nodiscard]] DOWNWASH_EXPORT std::string joints_text(const std::vector<double>& joints_rad);

}  // namespace downwash

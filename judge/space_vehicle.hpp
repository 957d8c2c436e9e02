#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/space_world_description.hpp"

// The numbers of a vehicle in space as the judge's plant and its controller need them. Private: not installed.

namespace downwash::judge {

/// A rigid body. Its frame has the origin in its centre of mass.
struct FlyingBody {
    double mass_kg;
    Eigen::Matrix3d inertia_kg_m2;
};

/// The joint between body i and body i + 1. At an angle of zero the axes of both are parallel.
struct FlyingJoint {
    Eigen::Vector3d in_inner_m, in_outer_m;  ///< its place, from the centres of mass of body i and of body i + 1
    Eigen::Vector3d axis;                    ///< of length 1; the same in the axes of both bodies
    double viscous_friction_nm_s, coulomb_friction_nm;
    std::optional<JointStop> stop;
    double max_torque_nm;
    Eigen::Vector3d link_m;  ///< of the link beyond it: from this joint to the next one or to the end effector
    DragParameters drag;     ///< of that link
};

/// A rotor on body 0.
struct FlyingRotor {
    Eigen::Vector3d hub_m;    ///< from the centre of mass of body 0
    Eigen::Vector3d axis;     ///< of its thrust, of length 1
    double spin, reaction_m;  ///< 1 or -1; torque about the axis per newton of free-air thrust
    double thrust_of;         ///< thrust over that of the nominal coefficient
    double min_thrust_n, max_thrust_n;
};

/// The multirotor (body 0) and the links of its arm (bodies 1 to n).
struct SpaceVehicle {
    std::vector<FlyingBody> bodies;
    std::vector<FlyingJoint> joints;
    std::vector<FlyingRotor> rotors;
    Eigen::Vector3d center_of_mass_m;  ///< the true one, from the point that the robot file calls so
    Eigen::Vector3d end_effector_m;    ///< from the centre of mass of the last body
    double rotor_time_constant_s;      ///< 0: no lag
    double power_coefficient_w_n1p5;
    double spin_kg_m2_s_n0p5;  ///< angular momentum of a rotor per square root of thrust; 0: no gyroscopic term
    DragParameters body_drag;
    double rotor_radius_m;
    double wash_scale;  ///< speed of the slipstreams over that of momentum theory; 0: none meets a link

    [[nodiscard]] int joint_count() const noexcept { return static_cast<int>(joints.size()); }
    [[nodiscard]] double mass_kg() const noexcept;
};

/// The vehicle that flies in a world; that of the robot file in the nominal one.
/// @pre space_robot_errors(robot) is empty
[[nodiscard]] DOWNWASH_EXPORT SpaceVehicle vehicle_in(const SpaceWorld& world, const SpaceRobot& robot);

}  // namespace downwash::judge

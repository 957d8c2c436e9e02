#pragma once

#include <optional>
#include <vector>

#include "downwash/base/vector3.hpp"
#include "downwash/dynamics/plant.hpp"

// Parameters of a multirotor that flies in all six degrees of freedom, with a serial arm of n >= 0 revolute joints.

namespace downwash {

/// One rigid body of a plant in space.
struct SpaceBody {
    double mass_kg = 0;                 ///< > 0
    Matrix3 inertia_kg_m2 = Matrix3{};  ///< about its centre of mass, in the axes of its frame; positive definite
};

/// A stop at either end of a joint's way: a spring on one side, with the damping of Hunt and Crossley. Neither pulls,
/// and both only take energy (docs/model.md 2.10).
struct JointStop {
    double lower_rad = 0, upper_rad = 0;  ///< where they begin, lower < upper
    double stiffness_nm_rad = 0;          ///< > 0
    double dissipation_s_rad = 1;         ///< c: torque k d (1 + c d') at the depth d, >= 0
};

/// A link of the arm. At joint angles of zero the axes of all links are parallel to the multirotor's.
struct SpaceLink {
    SpaceBody body;
    Vector3 joint_m = {};  ///< joint in the frame of what the link is mounted on: the multirotor, or the link before
    Vector3 axis = {0, 1, 0};       ///< axis of the joint in the same frame; it is normalised
    Vector3 center_of_mass_m = {};  ///< from the joint, in the link's own axes
    /// Drag of the whole link in a stream across its way to the next joint or, of the last link, to the end effector;
    /// one along it has none. A link without any way has it in every direction.
    DragParameters drag = {};
    double viscous_friction_nm_s = 0;    ///< of its joint: torque against its rate, per rad/s, >= 0
    double coulomb_friction_nm = 0;      ///< of its joint: torque against its rate, >= 0
    std::optional<JointStop> stop = {};  ///< of its joint; empty: it turns on
};

/// One rotor: where it is, which way it pushes and which way it spins.
struct SpaceRotor {
    Vector3 position_m = {};   ///< position of the hub, from the multirotor's centre of mass
    Vector3 axis = {0, 0, 1};  ///< the direction of its thrust in the body frame; it is normalised
    int spin = 1;              ///< 1 where it turns counterclockwise about its axis, -1 where clockwise
    double drag_torque_m = 0;  ///< torque about its axis, against its spin, per newton of free-air thrust; >= 0
};

/// A plant in space. The body frame has its origin in the multirotor's centre of mass: x forward, y left, z up.
struct SpacePlant {
    SpaceBody multirotor;            ///< rotors and battery included, arm excluded
    std::vector<SpaceLink> links;    ///< from the multirotor outward
    std::vector<SpaceRotor> rotors;  ///< up to max_rotors
    double time_constant_s = 0;      ///< time constant of the first-order thrust lag; 0 switches the lag off
    /// Thrust = coefficient * speed^2, > 0; only the gyroscopic term needs it.
    double thrust_coefficient_n_s2 = 0;
    double rotor_inertia_kg_m2 = 0;       ///< Jr of each rotor about its axis; 0: no gyroscopic term
    double power_coefficient_w_n1p5 = 0;  ///< P = coefficient * thrust^1.5 (docs/model.md 3), >= 0
    DragParameters drag = {};             ///< of the multirotor at its centre of mass, the same in every direction
    Vector3 end_effector_m = {};          ///< from the last joint, in the last link's axes; without links in the body's
    std::optional<WashParameters> wash = {};  ///< of the rotors on the links; empty: rotors blow past them
};

}  // namespace downwash

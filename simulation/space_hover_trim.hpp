#pragma once

#include <array>

#include "downwash/controllers/space_reference.hpp"
#include "downwash/simulation/hover_analysis.hpp"
#include "downwash/simulation/space_loop.hpp"

namespace downwash {

/// The loops of a vehicle in space, by where each is opened: at the acceleration that the law asks for along x and y,
/// at the lift and the three torques that it asks of the rotors, at the torque of each joint.
namespace space_loops {
inline constexpr int x = 0, y = 1, height = 2, roll = 3, pitch = 4, yaw = 5, first_joint = 6;
inline constexpr int max = first_joint + max_joints;
}  // namespace space_loops

/// How a vehicle in space hovers: the equilibrium of its closed loop near surfaces.
struct SpaceHoverTrim {
    HoldLimit limit = HoldLimit::none;  ///< anything else: there is no equilibrium; the other members show why
    SpaceMotion motion;                 ///< at rest. It leans where surfaces or tilted rotors push sideways
    double tilt_rad = 0;                ///< by so much
    /// The reference that makes the controller hold the vehicle there. It differs from the vehicle's place on axes
    /// without an integrator, and where an integrator has reached its limit.
    SpacePoint reference;
    std::array<double, max_rotors> rotor_command_n{};
    std::array<double, max_joints> joint_torque_nm{};
    double saturation = 0;        ///< greatest demand over its limit, as in a tick
    double height_gain_1_s2 = 0;  ///< vertical acceleration that the controller sets against a metre of error
    double tilt_gain_1_s2 = 0;    ///< roll and pitch acceleration that it sets against a radian of error
};

}  // namespace downwash

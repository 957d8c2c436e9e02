#pragma once

#include <optional>
#include <string>
#include <vector>

#include "downwash/base/vector3.hpp"

namespace downwash {

/// A joint that does not move in the robot that is made.
struct FrozenJoint {
    std::string joint;
    double position = 0;  ///< [degrees]; of a prismatic joint [m]
};

/// What an import is told beside the file: choices where the file leaves one, and numbers that it does not have.
struct ImportSettings {
    std::string name;  ///< of the robot; empty: that of the file's robot
    std::vector<FrozenJoint> frozen;
    std::string arm_end;                ///< a link: joints that do not lead to it are frozen at zero; empty: none are
    std::string tool;                   ///< the link at whose origin the end effector is; empty: see import_robot()
    std::vector<std::string> massless;  ///< links that are taken to have no mass
    bool skips_meshes = false;          ///< leaves out meshes that are not there, or that are in other formats
    /// Axes of the file's base link that point forward and up: "x", "-y". Together with left they are right-handed.
    std::string forward = "x", up = "z";

    /// Links that are rotors, as a regular expression (ECMAScript) that the whole name of the link, or of its joint,
    /// matches; empty: those that the file describes.
    std::string rotors;
    // These replace what the file says of all rotors.
    std::optional<double> rotor_radius_m, min_thrust_n, max_thrust_n, torque_ratio_m, time_constant_s,
        power_coefficient_w_n1p5;
    std::vector<int> spins;  ///< 1 counterclockwise, -1 clockwise, one for each rotor in the file's order
};

}  // namespace downwash

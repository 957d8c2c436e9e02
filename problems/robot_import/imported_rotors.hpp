#pragma once

#include <string>
#include <vector>

#include "downwash/dynamics/space_plant.hpp"
#include "downwash/robot_import/arm_chain.hpp"

namespace downwash::robot_import {

/// A number of a robot file, and where it comes from.
struct Sourced {
    double value = 0;
    std::string source;
};

/// The rotors of a robot, with where their numbers come from.
struct ImportedRotors {
    std::vector<SpaceRotor> rotors;  ///< positions from the base's origin
    std::vector<std::string> names;
    std::vector<int> links;
    std::vector<double> min_thrust_n, max_thrust_n;
    std::string thrust_source, torque_source, spin_source;
    Sourced radius_m, time_constant_s, power_coefficient_w_n1p5, thrust_coefficient_n_s2;
};

/// Makes the links that the settings name rotors of the tree, instead of those that the file describes.
/// @throws ProblemFileError if there are none
void name_rotors(KinematicTree& tree, const ImportSettings& settings, Findings& findings);

/// The rotors of a tree, with the numbers that the settings give. Numbers that neither has are errors, one for each.
/// @pre the tree has rotors
ImportedRotors imported_rotors(const KinematicTree& tree, const ArmChain& chain, const ImportSettings& settings,
                               Findings& findings);

}  // namespace downwash::robot_import

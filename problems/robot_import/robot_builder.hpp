#pragma once

#include <string>
#include <vector>

#include "downwash/robot_import/imported_rotors.hpp"
#include "downwash/robot_import/part_masses.hpp"
#include "downwash/simulation/space_robot.hpp"

namespace downwash::robot_import {

/// A robot made of a tree, and where its numbers come from.
struct BuiltRobot {
    SpaceRobot robot;
    std::vector<std::string> part_sources;  ///< the links that each part is made of, with their masses
    std::vector<std::string> joint_names;
    std::vector<std::string> joint_rates;  ///< what the file says of each joint's rate; empty: nothing
    std::vector<std::string> frozen;
    ImportedRotors rotors;  ///< their sources; positions are those of `robot`
    std::string body_source, tool_source;
};

/// Turns a tree into a robot without gains. @throws ProblemFileError
/// @param root the link without a parent
BuiltRobot built_robot(KinematicTree tree, int root, const ImportSettings& settings, Findings& findings);

}  // namespace downwash::robot_import

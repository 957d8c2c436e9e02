#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/problems/located_error.hpp"
#include "downwash/robot_import/import_settings.hpp"
#include "downwash/simulation/space_robot.hpp"

namespace downwash {

/// A robot made from a file of another program.
struct ImportedRobot {
    SpaceRobot robot;
    std::string yaml;                    ///< the robot file, whose comments say where each number comes from
    std::vector<LocatedError> warnings;  ///< what is likely not meant, with its place in the imported file
};

/// Makes a robot in space from a URDF, SDF or MJCF, told apart by the file's root element.
///
/// The base is the link without a parent. What is fixed to it, by fixed or frozen joints or as a rotor, is the
/// multirotor; the other joints are the arm, each with all that is fixed behind it. They have to be one serial chain of
/// revolute joints with limits and torques. Inertias are joined by the parallel-axis rule, all frames turned to the
/// multirotor's: x forward, y left, z up, from its centre of mass. Joint angles are those of the file.
///
/// The end effector is the origin of the settings' tool; without one that of the only link without mass that is fixed
/// to the last joint's, or else the farthest point of the last joint's shapes. It points away from the last joint.
///
/// Solids are those of collision geometry, or else of visual geometry: boxes that are askew and meshes become the least
/// box, cylinder, capsule or sphere around them. Gains are designed (design_controller()).
/// @throws ProblemFileError with every error that one reading finds: what is wrong with the file, what it lacks, and
/// what makes the robot impossible to fly (space_robot_errors()), each with a remedy
[[nodiscard]] DOWNWASH_EXPORT ImportedRobot import_robot(const std::filesystem::path& file,
                                                         const ImportSettings& settings = {});

}  // namespace downwash

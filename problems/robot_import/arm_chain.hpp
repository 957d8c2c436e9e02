#pragma once

#include <vector>

#include "downwash/robot_import/import_settings.hpp"
#include "downwash/robot_import/kinematic_tree.hpp"

namespace downwash::robot_import {

/// Which joints of a tree move, and where all links are while they are at zero.
struct ArmChain {
    int base = 0;             ///< the link from which places count
    std::vector<int> joints;  ///< that move, from the multirotor outward
    /// Of each link: 0 if it is part of the multirotor, k if it turns with the k-th joint, -1 if it is not of the
    /// robot.
    std::vector<int> part;
    std::vector<RigidTransform> pose;  ///< of each link, from the base's origin: x forward, y left, z up
    std::vector<std::string> frozen;   ///< "gripper_joint at 0 deg": of each joint that does not move though it could
};

/// Decides which joints are the arm. Rotors' joints do not count.
/// @param root the link without a parent   @throws ProblemFileError where joints are no serial chain of revolute ones
ArmChain arm_chain(const KinematicTree& tree, int root, const ImportSettings& settings, Findings& findings);

}  // namespace downwash::robot_import

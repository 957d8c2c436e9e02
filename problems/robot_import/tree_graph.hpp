#pragma once

#include "downwash/robot_import/kinematic_tree.hpp"

namespace downwash::robot_import {

/// Checks that links and joints are a tree: names used once, one base, no loops. Needs names, places and the links of
/// joints alone. @return the base, the link that hangs on no other   @throws ProblemFileError with every error
int require_tree(const KinematicTree& tree, Findings& findings);

}  // namespace downwash::robot_import

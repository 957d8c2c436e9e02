#pragma once

#include <vector>

#include "downwash/robot_import/arm_chain.hpp"

namespace downwash::robot_import {

/// The solids of one part in our axes, from a place. A box that is askew, and each group of pieces of a mesh
/// (joined_pieces()), becomes the least solid around it (least_solid_around()), with a warning of how much larger it
/// is.
/// @param part 0: the multirotor, k: what turns with the k-th joint   @param origin_m the place, from the base's origin
/// @param skipped links that have other solids: rotors
std::vector<SpaceBodyShape> collision_bodies(const KinematicTree& tree, const ArmChain& chain, int part,
                                             const Vector3& origin_m, const std::vector<int>& skipped,
                                             bool skips_meshes, Findings& findings);

/// The greatest distance of a link's shapes from the z axis of a hub: the radius of its rotor. 0 without shapes.
/// Of a mesh its bounding box counts, half its greatest edge across.
double disc_radius_m(const TreeLink& link, bool skips_meshes, Findings& findings);

}  // namespace downwash::robot_import

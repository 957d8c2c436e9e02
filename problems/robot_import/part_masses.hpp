#pragma once

#include <string>
#include <vector>

#include "downwash/robot_import/arm_chain.hpp"

namespace downwash::robot_import {

/// Links that move as one body.
struct PartMass {
    double mass_kg = 0;
    Vector3 center_of_mass_m{};  ///< from the base's origin in our axes, all joints at zero
    Matrix3 inertia_kg_m2{};     ///< about it, in our axes
    std::vector<int> links;      ///< those with mass, in the file's order
    Place place;                 ///< of the heaviest
};

/// Checks masses and inertias of all links of a robot: that what has a shape has a mass, that no body has what none
/// can have, and that all is in metres.
void check_links(const KinematicTree& tree, const ArmChain& chain, const ImportSettings& settings, Findings& findings);

/// The multirotor and each link of the arm, joined by the parallel-axis rule.
/// @throws ProblemFileError for a part without mass
std::vector<PartMass> part_masses(const KinematicTree& tree, const ArmChain& chain, Findings& findings);

/// The farthest point of a shape from a place in the same frame [m]; of a mesh 0 if it was not read.
double farthest_m(const TreeShape& shape, const Vector3& from_m);

}  // namespace downwash::robot_import

#pragma once

#include <string>

#include "downwash/problems/input_facts.hpp"

namespace downwash::cli {

// What was read, each on one line without its end.

/// The obstacle, then what its file became: "left_girder: mesh of 164 triangles, 11 pieces, solid, x -8.9 to 3.1 m,
/// ... in the world".
[[nodiscard]] std::string text_of(const GeometryInput& geometry);

/// The robot, then what it amounts to: "ars_lrm: 4.95 kg, thrust 2.31 times the weight, reach 1.2 m, ...".
[[nodiscard]] std::string text_of(const RobotInput& robot);

/// The file, then how it was read: "k.csv: effect table of 12 rows, z_over_r [rotor radii] 0.5 to 4, factor 1 to 1.3;
/// separated by ';', decimal commas".
[[nodiscard]] std::string text_of(const DataFacts& data);

/// The same lines as rows of a summary. Of many meshes and octrees, or tables, only the first few.
[[nodiscard]] std::string input_rows(const InputFacts& inputs);

}  // namespace downwash::cli

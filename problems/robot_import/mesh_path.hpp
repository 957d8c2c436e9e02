#pragma once

#include <filesystem>
#include <string>

#include "downwash/robot_import/kinematic_tree.hpp"

namespace downwash::robot_import {

/// Finds a file that another file names. Relative paths are from the folder of the latter; of package://NAME/PATH and
/// model://NAME/PATH, PATH is looked for in that folder and all around it, below NAME or in a folder of that name.
/// @return its path, empty if it is not there
std::string named_file(const std::string& uri, const std::filesystem::path& named_in);

/// The same for the file of a mesh.
MeshReference mesh_reference(const std::string& uri, const std::filesystem::path& named_in);

}  // namespace downwash::robot_import

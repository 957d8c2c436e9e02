#pragma once

// Private to problems/.

#include <optional>
#include <string>

#include "downwash/problems/yaml_node.hpp"

// Robots and problems of a vertical plane and of space have different keys below the same schema. Which kind a file is
// shows in those that only one of the two has.

namespace downwash {
struct Campaign;
struct Problem;
struct SpaceProblem;
}  // namespace downwash

namespace downwash::problems {

/// A key that only one of the two kinds has.
struct FamilyKey {
    std::string path;  ///< "multirotor.inertia_kg_m2"
    Mark mark;
};

/// What the keys of a robot or a problem say.
struct FamilyKeys {
    std::optional<FamilyKey> plane, space;  ///< the first of each kind
};

/// @param robot the keys of a robot
[[nodiscard]] FamilyKeys family_keys_of_robot(const YamlNode& robot);

/// @param problem the keys of a problem; its robot does not count
[[nodiscard]] FamilyKeys family_keys_of_problem(const YamlNode& problem);

/// Why a group cannot be read into a Model at all, with the place of that; empty for most.
/// @param path of the group, "" for the whole file
template <class Model>
[[nodiscard]] std::optional<YamlError> misfit(const std::string& path, const YamlNode& node);
template <>
std::optional<YamlError> misfit<Problem>(const std::string& path, const YamlNode& node);
template <>
std::optional<YamlError> misfit<SpaceProblem>(const std::string& path, const YamlNode& node);
template <>
std::optional<YamlError> misfit<Campaign>(const std::string& path, const YamlNode& node);

}  // namespace downwash::problems

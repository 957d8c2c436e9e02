#pragma once

#include <string>

#include "downwash/base/export.hpp"
#include "downwash/problems/input_facts.hpp"

namespace downwash {

/// What was read, each as the text of a JSON object as `check --json` lists it; docs/check.md says what the keys mean.
/// Numbers of a robot have six digits.
[[nodiscard]] DOWNWASH_EXPORT std::string geometry_document(const GeometryInput& geometry);
[[nodiscard]] DOWNWASH_EXPORT std::string robot_document(const RobotInput& robot);
[[nodiscard]] DOWNWASH_EXPORT std::string robot_document(const SpaceRobotInput& robot);
[[nodiscard]] DOWNWASH_EXPORT std::string data_document(const DataFacts& data);

}  // namespace downwash

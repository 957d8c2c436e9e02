#pragma once

// Private: not installed.

#include <nlohmann/json_fwd.hpp>

#include "downwash/base/export.hpp"
#include "downwash/problems/input_facts.hpp"

namespace downwash {

/// What was read, as `check --json` lists it; docs/check.md says what the keys mean. Numbers of a
/// robot have six digits.
[[nodiscard]] DOWNWASH_EXPORT nlohmann::ordered_json geometry_json(const GeometryInput& geometry);
[[nodiscard]] DOWNWASH_EXPORT nlohmann::ordered_json robot_json(const RobotInput& robot);
[[nodiscard]] DOWNWASH_EXPORT nlohmann::ordered_json data_json(const DataFacts& data);

/// All of it, for solution.json: files by their names alone, so that a run of the same problem elsewhere says the same.
[[nodiscard]] DOWNWASH_EXPORT nlohmann::ordered_json inputs_json(const InputFacts& inputs);

}  // namespace downwash

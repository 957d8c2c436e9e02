#pragma once

// Private: not installed.

#include <nlohmann/json_fwd.hpp>

#include "downwash/problems/input_facts.hpp"

namespace downwash {

/// All that was read, for solution.json: files by their names alone, so that a run of the same problem elsewhere says
/// the same.
[[nodiscard]] nlohmann::ordered_json inputs_json(const InputFacts& inputs);
[[nodiscard]] nlohmann::ordered_json inputs_json(const SpaceInputFacts& inputs);

}  // namespace downwash

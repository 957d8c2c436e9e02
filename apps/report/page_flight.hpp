#pragma once

// Private: not installed.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "downwash/results/number_table.hpp"

namespace downwash {

/// The columns of a flight, packed without loss; null without rows. Equal columns, such as those of rotors one behind
/// the other, are stored once.
[[nodiscard]] nlohmann::ordered_json flight_json(const NumberTable& flight);

/// The command that flies the plan of a solution again as it was flown; to be given in its folder.
/// @param solution as in solution.json; a world without a number or a seed counts as none
[[nodiscard]] std::string command_of_execution(const nlohmann::ordered_json& solution);

}  // namespace downwash

#pragma once

// Private: not installed.

#include <nlohmann/json_fwd.hpp>

#include "downwash/results/number_table.hpp"

namespace downwash {

/// The columns of a flight, packed without loss; null without rows. Equal columns, such as those of rotors one behind
/// the other, are stored once.
[[nodiscard]] nlohmann::ordered_json flight_json(const NumberTable& flight);

}  // namespace downwash

#pragma once

#include <optional>

#include "downwash/simulation/flight_model.hpp"

namespace downwash::cli {

/// The rotor that --rotor N names, from 0 on; the first one when it is not given. @throws UsageError for no such rotor
[[nodiscard]] int rotor_option(const std::optional<int>& number, const FlightModel& model);

}  // namespace downwash::cli

#include "downwash/cli/rotor_option.hpp"

#include <fmt/core.h>

#include "downwash/cli/usage_error.hpp"

namespace downwash::cli {

int rotor_option(const std::optional<int>& number, const FlightModel& model) {
    const int rotors = model.tick().plant.rotor_count;
    const int rotor = number.value_or(1);
    if (rotor < 1 || rotor > rotors) {
        throw UsageError(fmt::format("--rotor {}: expected a number from 1 to {}", rotor, rotors));
    }
    return rotor - 1;
}

}  // namespace downwash::cli

#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/thrust_stand/stand_columns.hpp"

namespace downwash::thrust_stand {

/// What was measured at one time, in SI units; NaN where it was not. Thrust and torque are above 0.
struct StandRow {
    std::array<double, quantity_count> values;

    StandRow() { values.fill(std::numeric_limits<double>::quiet_NaN()); }
    [[nodiscard]] double operator[](Quantity quantity) const { return values[static_cast<std::size_t>(quantity)]; }
    [[nodiscard]] double& operator[](Quantity quantity) { return values[static_cast<std::size_t>(quantity)]; }
};

/// A file of a thrust stand.
struct StandLog {
    StandFile facts;  ///< without its measurements
    std::vector<StandRow> rows;
    bool has_time = false;
    bool is_of_shaft_power = false;  ///< `power` holds that of the shaft
};

/// Reads the text of a file. Coefficients become thrust, torque and shaft power; voltage times current a power that is
/// not there. @param remarks says what was chosen   @throws InputError
[[nodiscard]] StandLog parse_stand_log(std::string_view text, const std::string& name,
                                       const ThrustStandSettings& settings, std::vector<std::string>& remarks);

}  // namespace downwash::thrust_stand

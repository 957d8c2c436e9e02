#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/csv_reader.hpp"
#include "downwash/base/line_errors.hpp"
#include "downwash/thrust_stand/stand_results.hpp"

namespace downwash::thrust_stand {

/// What columns can hold.
enum class Quantity { time, throttle, thrust, torque, speed, voltage, current, power, shaft_power, ct, cp };
inline constexpr std::size_t quantity_count = 11;

/// Name in options and results: "shaft_power".
[[nodiscard]] std::string_view name_of(Quantity quantity);

/// A column of a file with what turns its numbers into SI units.
struct FoundColumn {
    Quantity quantity = Quantity::time;
    std::size_t index = 0;
    std::string unit;   ///< as it is called here: "gf"
    double factor = 1;  ///< number * factor: s, N, Nm, rad/s, V, A, W; throttle as it stands
};

/// The columns that count, of each quantity in the order in which they are preferred. Adds errors at columns whose
/// units are not known, and for settings that fit nothing. @throws InputError if there is no thrust
[[nodiscard]] std::vector<FoundColumn> find_columns(const CsvReader& csv, const ThrustStandSettings& settings,
                                                    LineErrors& errors);

}  // namespace downwash::thrust_stand

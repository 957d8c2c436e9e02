#pragma once

// Private to logs/.

#include <cstdint>
#include <string>
#include <string_view>

namespace downwash::logs {

/// What the unit behind the name of a column is of.
enum class Dimension : std::uint8_t { none, time, length, speed, angle, rate, acceleration, force };

/// The name of a column as people write it: "Pos X [mm]", "yaw_deg".
struct ColumnName {
    std::string plain;                      ///< in lower case, without the unit, with _ for blanks and dashes: "pos_x"
    Dimension dimension = Dimension::none;  ///< of the unit; none: it has no unit that is known
    double factor = 1;                      ///< number * factor is in s, m, m/s, rad, rad/s, m/s2 or N
};

/// Takes a name apart. A unit stands in brackets at its end, or behind its last `_`.
[[nodiscard]] ColumnName column_name(std::string_view written);

}  // namespace downwash::logs

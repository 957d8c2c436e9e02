#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace downwash::problems {

/// A number as YAML files hold it ("3", "-.5", "1e3"); empty when the text is not wholly one, is not finite or is out
/// of a double's range. Independent of the locale.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// As parse_number, from degrees to radians. The product is rounded once, so that every radian can be written.
[[nodiscard]] std::optional<double> parse_degrees(std::string_view text);

/// A whole number that is not negative.
[[nodiscard]] std::optional<std::uint64_t> parse_integer(std::string_view text);

/// The shortest decimal in degrees that parse_degrees turns into the very same radians.
[[nodiscard]] std::string degrees_text(double angle_rad);

}  // namespace downwash::problems

#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace downwash::problems {

/// As parse_number (base/text.hpp), from degrees to radians. The product is rounded once, so that every radian can be
/// written.
[[nodiscard]] std::optional<double> parse_degrees(std::string_view text);

/// The shortest decimal in degrees that parse_degrees turns into the very same radians.
[[nodiscard]] std::string degrees_text(double angle_rad);

}  // namespace downwash::problems

#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "downwash/base/text.hpp"

namespace downwash::problems {

/// As parse_number (base/text.hpp), from degrees to radians. The product is rounded once, so that every radian can be
/// written.
[[nodiscard]] std::optional<double> parse_degrees(std::string_view text);

/// The shortest decimal in degrees that parse_degrees turns into the very same radians.
[[nodiscard]] std::string degrees_text(double angle_rad);

/// A number in a message.
[[nodiscard]] inline std::string rounded(double value) {
    return to_text(value, 4);
}

}  // namespace downwash::problems

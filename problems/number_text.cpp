#include "downwash/problems/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include "downwash/base/text.hpp"

namespace downwash::problems {
namespace {

// Degrees as doubles are sometimes farther apart than the radians they stand for: this takes a wider type.
constexpr long double radians_per_degree = std::numbers::pi_v<long double> / 180;

std::string_view rounded(std::array<char, 64>& text, long double number, int digits) {
    const auto format = std::chars_format::general;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number, format, digits).ptr;
    return {text.data(), static_cast<std::size_t>(end - text.data())};
}

}  // namespace

std::optional<double> parse_degrees(std::string_view text) {
    const auto degrees = parse_number<long double>(text);
    if (!degrees) {
        return std::nullopt;
    }
    const auto radians = static_cast<double>(*degrees * radians_per_degree);
    return std::isfinite(radians) ? std::optional(radians) : std::nullopt;
}

std::string degrees_text(double angle_rad) {
    const long double degrees = static_cast<long double>(angle_rad) / radians_per_degree;
    constexpr int max_digits = std::numeric_limits<long double>::max_digits10;
    std::array<char, 64> text{};
    for (int digits = 1; digits < max_digits; ++digits) {
        const std::string_view written = rounded(text, degrees, digits);
        // As a double 90 is written "90" where one digit is "9e+01".
        std::string plain = digits <= 17 ? to_text(parse_number<double>(written).value_or(0)) : std::string(written);
        if (parse_degrees(plain) == angle_rad) {
            return plain;
        }
    }
    return std::string(rounded(text, degrees, max_digits));
}

}  // namespace downwash::problems

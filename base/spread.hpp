#pragma once

#include <cstdint>
#include <string>

#include "downwash/base/export.hpp"

namespace downwash {

/// How far a number may be from its nominal value: a distribution, cut where it has an end.
struct Spread {
    /// What `low` and `high` are.
    enum class Form : std::uint8_t {
        exact,  ///< The number is nominal.
        /// Normal with the standard deviation `high`, cut at 3 of them; its mean is the nominal value plus `low`.
        sd,
        range,   ///< Uniform from low to high.
        factor,  ///< Uniform from low to high times the nominal value.
    };
    Form form = Form::exact;
    double low = 0;
    double high = 0;

    [[nodiscard]] static constexpr Spread of_sd(double sd, double mean = 0) noexcept { return {Form::sd, mean, sd}; }
    [[nodiscard]] static constexpr Spread over(double low, double high) noexcept { return {Form::range, low, high}; }
    [[nodiscard]] static constexpr Spread of_factor(double low, double high) noexcept {
        return {Form::factor, low, high};
    }

    /// The difference from the nominal value that is not exceeded with probability p.
    /// @param p from 0 to 1; both ends give the ends of the spread   @param nominal the value itself, for a range of
    /// the number (`range_is_of_number`) and for factors
    [[nodiscard]] DOWNWASH_EXPORT double difference(double p, double nominal, bool range_is_of_number) const noexcept;

    friend constexpr bool operator==(const Spread&, const Spread&) = default;
};

/// A spread as files write it: "0", "{sd: 0.15}", "{mean: 0.1, sd: 0.15}", "{range: [-0.1, 0.2]}".
/// @param number_text (double) -> std::string
template <class NumberText>
std::string spread_text(const Spread& spread, const NumberText& number_text) {
    const auto ends = [&] { return "[" + number_text(spread.low) + ", " + number_text(spread.high) + "]"; };
    switch (spread.form) {
        case Spread::Form::sd:
            return (spread.low != 0 ? "{mean: " + number_text(spread.low) + ", sd: " : "{sd: ") +
                   number_text(spread.high) + "}";
        case Spread::Form::range:
            return "{range: " + ends() + "}";
        case Spread::Form::factor:
            return "{factor: " + ends() + "}";
        case Spread::Form::exact:
            break;
    }
    return "0";
}

}  // namespace downwash

#pragma once

#include <span>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// A number that an algorithm works with. Fixed; listed so that results can be compared with others'.
struct AlgorithmParameter {
    std::string_view name;  ///< as OMPL calls it, where it is OMPL's
    double value;
    std::string_view description;
};

/// One search algorithm.
struct AlgorithmInfo {
    std::string_view name;
    std::string_view kind;  ///< "geometric, anytime", ...
    std::string_view description;
    bool plans_lines = false;    ///< for mp-arm
    bool plans_flights = false;  ///< for mp-arm-da and mp-arm-ada
    std::span<const AlgorithmParameter> parameters = {};

    /// Whether a problem may name it together with a variant.
    [[nodiscard]] bool plans_for(Variant variant) const noexcept {
        return variant == Variant::mp_arm ? plans_lines : plans_flights;
    }
};

/// Every algorithm that a problem may name.
[[nodiscard]] DOWNWASH_EXPORT std::span<const AlgorithmInfo> algorithms();

}  // namespace downwash

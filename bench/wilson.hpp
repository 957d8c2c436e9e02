#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace downwash::bench {

/// Wilson score interval of a proportion at 95 %. @pre n > 0
inline std::pair<double, double> wilson(std::size_t hits, std::size_t attempts) {
    constexpr double z = 1.959963984540054;
    const auto n = static_cast<double>(attempts);
    const double p = static_cast<double>(hits) / n;
    const double centre = (p + z * z / (2 * n)) / (1 + z * z / n);
    const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
    return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

}  // namespace downwash::bench

#pragma once

#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// The q-quantile, 0 <= q <= 1: linear between the order statistics (type 7 of Hyndman and Fan 1996). Values may be
/// infinite; between a finite and an infinite one it is infinite. NaN without values.
[[nodiscard]] DOWNWASH_EXPORT double quantile(std::vector<double> values, double q);
/// The quantile of values that are sorted already; see quantile().
[[nodiscard]] DOWNWASH_EXPORT double quantile_of_sorted(const std::vector<double>& values, double q);

}  // namespace downwash

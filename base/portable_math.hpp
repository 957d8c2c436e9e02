#pragma once

#include "downwash/base/export.hpp"

// Functions whose results are the same bits on every machine, which those of the C library are not.

namespace downwash {

/// Natural logarithm to some 1e-15. @param x >= 0, perhaps infinite
[[nodiscard]] DOWNWASH_EXPORT double natural_log(double x) noexcept;

/// e to the power x, to some 1e-14 of it. @param x from -700 to 0
[[nodiscard]] DOWNWASH_EXPORT double natural_exp(double x) noexcept;

/// The number that a standard normal variable stays below with probability p, to some 1e-15 of it (Wichura 1988,
/// algorithm AS 241). @param p between 0 and 1, both excluded
[[nodiscard]] DOWNWASH_EXPORT double normal_quantile(double p) noexcept;

}  // namespace downwash

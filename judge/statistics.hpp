#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash::judge {

/// A probability, estimated by counting.
struct Probability {
    double estimate = 0;
    double low = 0, high = 1;  ///< 95 % interval of Clopper and Pearson (1934)
};

/// The probability of an event that happened in some of so many runs. @pre hits <= runs, runs > 0
[[nodiscard]] DOWNWASH_EXPORT Probability probability_of(std::size_t hits, std::size_t runs);

/// Spearman's rank correlation (1904), from -1 to 1; ties get the mean of their ranks. Nothing if either side has equal
/// values only. @pre equal sizes, no NaN
[[nodiscard]] DOWNWASH_EXPORT std::optional<double> rank_correlation(std::span<const double> a,
                                                                     std::span<const double> b);

/// How many tenths of a sample there are.
inline constexpr std::size_t deciles = 10;

/// The share of hits in each tenth of the runs, in rising order of a value; nothing for fewer than ten runs.
/// @pre equal sizes
[[nodiscard]] DOWNWASH_EXPORT std::optional<std::array<double, deciles>> share_by_decile(std::span<const double> values,
                                                                                         const std::vector<bool>& hits);

}  // namespace downwash::judge

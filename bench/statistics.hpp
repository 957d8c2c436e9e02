#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace downwash::bench {

/// A share of attempts with its 95 % interval.
struct Share {
    std::size_t hits = 0;
    std::size_t attempts = 0;
    double low = 0;
    double high = 1;
};

/// Wilson's score interval of a proportion at 95 %, without continuity correction (E. B. Wilson 1927, "Probable
/// inference, the law of succession, and statistical inference"). Without attempts: 0 to 1.
/// @pre hits <= attempts
[[nodiscard]] Share share_of(std::size_t hits, std::size_t attempts);

struct Range {
    double low, high;
};

/// The narrowest pair of order statistics, as many from either end, between which the median lies with at least the
/// given confidence, whatever the distribution (Conover 1999, "Practical nonparametric statistics", section 3.2).
/// Values may be infinite; minus to plus infinity when there are too few.
/// @pre 0 < confidence < 1, no NaN
[[nodiscard]] Range median_range(std::vector<double> values, double confidence);

/// Two runs of equal seeds after the other, compared.
struct Pairing {
    std::size_t first_smaller = 0, second_smaller = 0, equal = 0;
    /// Two-sided sign test (Dixon and Mood 1946): of the pairs that differ, as uneven a split or worse under a fair
    /// coin. 1 when none differ.
    double sign_test_p = 1;
    std::size_t finite = 0;  ///< pairs in which both values are finite
    /// Median of first - second over the finite pairs; NaN without any.
    double median_difference = 0;
    /// Two-sided signed rank test over the finite pairs; 1 when none differ. See signed_rank_p.
    double signed_rank_p = 1;
};

/// Compares first[i] with second[i]; values may be infinite (no solution), and two infinite ones are equal.
/// @pre equal sizes, no NaN
[[nodiscard]] Pairing compare_pairs(std::span<const double> first, std::span<const double> second);

/// Two-sided p of the sign test for so many wins on either side: min(1, 2 P(X <= min)), X binomial with p = 1/2.
[[nodiscard]] double sign_test_p(std::size_t wins, std::size_t losses);

/// Two-sided p of Wilcoxon's signed rank test (F. Wilcoxon 1945): zeros are dropped, ties get the mean of their ranks.
/// Up to 200 differences the distribution is counted out over all signs of the ranks at hand; beyond it is normal with
/// the variance sum(ranks^2) / 4 and a continuity correction (Hollander, Wolfe and Chicken 2013, section 3.1).
/// @pre finite values
[[nodiscard]] double signed_rank_p(std::span<const double> differences);

}  // namespace downwash::bench

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "downwash/bench/statistics.hpp"

// What two ways to plan differ in, on runs of the same problem and seed. All intervals have 95 %.

namespace downwash::bench {

/// An estimate and its interval.
struct Estimate {
    double value = 0;
    double low = 0;
    double high = 0;
};

/// A share with the exact interval of C. J. Clopper and E. S. Pearson (1934). Without attempts: 0 to 1.
/// @pre hits <= attempts
[[nodiscard]] Share exact_share(std::size_t hits, std::size_t attempts);

/// What happened in so many pairs of runs.
struct PairCounts {
    std::size_t both = 0;         ///< in both runs
    std::size_t first_only = 0;   ///< in the first run alone
    std::size_t second_only = 0;  ///< in the second run alone
    std::size_t neither = 0;

    [[nodiscard]] std::size_t pairs() const noexcept { return both + first_only + second_only + neither; }
};

/// Two-sided exact test that the event is as likely in either run (Q. McNemar 1947, with the binomial distribution of
/// the pairs that differ); 1 when none differ.
[[nodiscard]] double mcnemar_p(const PairCounts& counts);

/// Probability in the first run less that in the second, with the interval of R. G. Newcombe 1998 ("Improved
/// confidence intervals for the difference between binomial proportions based on paired data", method 10): Wilson's
/// limits of both, squared and added, with their correlation. -1 to 1 without pairs.
[[nodiscard]] Estimate risk_difference(const PairCounts& counts);

/// Odds of the event in the first run over those in the second, of matched pairs: first_only / second_only. The
/// interval is Clopper and Pearson's of the first one's share of the pairs that differ, as odds; it may end at 0 or
/// infinity. NaN when no pairs differ, with an interval from 0 to infinity.
[[nodiscard]] Estimate matched_odds_ratio(const PairCounts& counts);

/// The shift of J. L. Hodges and E. L. Lehmann (1963): the median of the means of all pairs of differences, each with
/// itself included. The interval is J. W. Tukey's, from the signed rank test (Hollander, Wolfe and Chicken 2013,
/// section 3.3): exact for up to 200 differences without ties, beyond with the normal approximation. Infinite ends with
/// too few differences, NaN without any.
/// @pre finite values
[[nodiscard]] Estimate shift_of(std::span<const double> differences);

/// The median ratio of pairs by shift_of() of their logarithms.
/// @pre positive, finite values
[[nodiscard]] Estimate ratio_of(std::span<const double> ratios);

/// The p values of several tests, adjusted so that the probability of a false claim among all of them stays below the
/// level (S. Holm 1979), in the order given.
[[nodiscard]] std::vector<double> holm_adjusted(std::span<const double> p_values);

/// The mean of values that come in groups, with the percentile interval of a bootstrap that draws as many values from
/// every group anew (B. Efron 1979). The same on every machine. NaN without values; an interval of NaN where a group
/// has one value alone, which says nothing of its spread.
[[nodiscard]] Estimate bootstrap_mean(std::span<const std::vector<double>> groups, std::uint64_t draws = 2000);

}  // namespace downwash::bench

#include "downwash/bench/paired_statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "downwash/base/infinity.hpp"
#include "downwash/base/quantile.hpp"

namespace downwash::bench {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double tail = 0.025;  // on either side of every interval

/// The correlation of the two events of a pair as Newcombe takes it: with a continuity correction where it is positive,
/// none where an event is certain or impossible.
double correlation(const PairCounts& c) {
    const auto a = static_cast<double>(c.both), b = static_cast<double>(c.first_only),
               d = static_cast<double>(c.second_only), e = static_cast<double>(c.neither);
    const double margins = (a + b) * (d + e) * (a + d) * (b + e);
    if (margins == 0) {
        return 0;
    }
    double cross = a * e - b * d;
    const double half = (a + b + d + e) / 2;
    if (cross > half) {
        cross -= half;
    } else if (cross > 0) {
        cross = 0;
    }
    return cross / std::sqrt(margins);
}

/// How many of the smallest sums of ranks 1 to n have together at most the tail's probability: the largest such sum, as
/// R's qsignrank() less one.
double sums_in_tail(std::size_t n) {
    constexpr std::size_t most_counted_out = 200;
    const std::size_t all = n * (n + 1) / 2;
    if (n > most_counted_out) {
        const double mean = static_cast<double>(all) / 2;
        const double variance = static_cast<double>(all) * static_cast<double>(2 * n + 1) / 12;
        return std::floor(mean + boost::math::quantile(boost::math::normal(), tail) * std::sqrt(variance) - 0.5);
    }
    std::vector<double> probability(all + 1, 0.0);
    probability[0] = 1;
    for (std::size_t rank = 1; rank <= n; ++rank) {
        for (std::size_t s = all + 1; s-- > 0;) {
            probability[s] = 0.5 * (probability[s] + (s >= rank ? probability[s - rank] : 0));
        }
    }
    double sum = 0;
    double last = -1;
    for (std::size_t s = 0; s <= all; ++s) {
        sum += probability[s];
        if (sum > tail) {
            break;
        }
        last = static_cast<double>(s);
    }
    return last;
}

}  // namespace

Share exact_share(std::size_t hits, std::size_t attempts) {
    if (attempts == 0) {
        return {};
    }
    using Binomial = boost::math::binomial_distribution<double>;
    const auto n = static_cast<double>(attempts);
    const auto k = static_cast<double>(hits);
    return {hits, attempts, hits == 0 ? 0 : Binomial::find_lower_bound_on_p(n, k, tail),
            hits == attempts ? 1 : Binomial::find_upper_bound_on_p(n, k, tail)};
}

double mcnemar_p(const PairCounts& counts) {
    return sign_test_p(counts.first_only, counts.second_only);
}

Estimate risk_difference(const PairCounts& counts) {
    const std::size_t pairs = counts.pairs();
    if (pairs == 0) {
        return {not_a_number, -1, 1};
    }
    const auto n = static_cast<double>(pairs);
    const Share first = share_of(counts.both + counts.first_only, pairs);
    const Share second = share_of(counts.both + counts.second_only, pairs);
    const double p = static_cast<double>(first.hits) / n, q = static_cast<double>(second.hits) / n;
    const double phi = correlation(counts);
    const auto joined = [phi](double x, double y) { return std::sqrt(std::max(0.0, x * x - 2 * phi * x * y + y * y)); };
    return {p - q, p - q - joined(p - first.low, second.high - q), p - q + joined(first.high - p, q - second.low)};
}

Estimate matched_odds_ratio(const PairCounts& counts) {
    const std::size_t differing = counts.first_only + counts.second_only;
    if (differing == 0) {
        return {not_a_number, 0, infinity};
    }
    const Share share = exact_share(counts.first_only, differing);
    const auto odds = [](double p) { return p < 1 ? p / (1 - p) : infinity; };
    return {odds(static_cast<double>(share.hits) / static_cast<double>(differing)), odds(share.low), odds(share.high)};
}

Estimate shift_of(std::span<const double> differences) {
    const std::size_t n = differences.size();
    if (n == 0) {
        return {not_a_number, -infinity, infinity};
    }
    std::vector<double> means;
    means.reserve(n * (n + 1) / 2);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i; j < n; ++j) {
            means.push_back((differences[i] + differences[j]) / 2);
        }
    }
    std::sort(means.begin(), means.end());
    const double sums = sums_in_tail(n);
    Estimate shift{quantile_of_sorted(means, 0.5), -infinity, infinity};
    if (sums >= 0) {
        const auto beyond = static_cast<std::size_t>(sums);
        shift.low = means[beyond];
        shift.high = means[means.size() - 1 - beyond];
    }
    return shift;
}

Estimate ratio_of(std::span<const double> ratios) {
    std::vector<double> logarithms;
    logarithms.reserve(ratios.size());
    for (const double ratio : ratios) {
        logarithms.push_back(std::log(ratio));
    }
    const Estimate shift = shift_of(logarithms);
    return {std::exp(shift.value), std::exp(shift.low), std::exp(shift.high)};
}

std::vector<double> holm_adjusted(std::span<const double> p_values) {
    std::vector<std::size_t> order(p_values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t i, std::size_t j) { return p_values[i] < p_values[j]; });
    std::vector<double> adjusted(p_values.size());
    double largest = 0;
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        const auto left = static_cast<double>(order.size() - rank);
        largest = std::max(largest, std::min(1.0, left * p_values[order[rank]]));
        adjusted[order[rank]] = largest;
    }
    return adjusted;
}

Estimate bootstrap_mean(std::span<const std::vector<double>> groups, std::uint64_t draws) {
    double sum = 0;
    std::size_t count = 0;
    bool has_spread = true;
    for (const std::vector<double>& group : groups) {
        has_spread = has_spread && group.size() != 1;
        sum = std::accumulate(group.begin(), group.end(), sum);
        count += group.size();
    }
    if (count == 0) {
        return {not_a_number, not_a_number, not_a_number};
    }
    if (!has_spread) {
        return {sum / static_cast<double>(count), not_a_number, not_a_number};
    }
    std::mt19937_64 random(1);  // NOLINT(cert-msc51-cpp): the same interval every time
    std::vector<double> means;
    means.reserve(draws);
    for (std::uint64_t draw = 0; draw < draws; ++draw) {
        double drawn = 0;
        for (const std::vector<double>& group : groups) {
            for (std::size_t i = 0; i < group.size(); ++i) {
                drawn += group[static_cast<std::size_t>(random() % group.size())];
            }
        }
        means.push_back(drawn / static_cast<double>(count));
    }
    std::sort(means.begin(), means.end());
    return {sum / static_cast<double>(count), quantile_of_sorted(means, tail), quantile_of_sorted(means, 1 - tail)};
}

}  // namespace downwash::bench

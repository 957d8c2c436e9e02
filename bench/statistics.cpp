#include "downwash/bench/statistics.hpp"
#include "downwash/base/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace downwash::bench {
namespace {

/// Twice the ranks of absolute values, ties sharing the mean of theirs: whole numbers.
/// @param magnitudes sorted
std::vector<std::size_t> doubled_ranks(const std::vector<double>& magnitudes) {
    std::vector<std::size_t> ranks(magnitudes.size());
    for (std::size_t i = 0; i < magnitudes.size();) {
        std::size_t end = i + 1;
        while (end < magnitudes.size() && magnitudes[end] == magnitudes[i]) {
            ++end;
        }
        for (std::size_t j = i; j < end; ++j) {
            ranks[j] = i + 1 + end;  // twice the mean of i + 1 ... end
        }
        i = end;
    }
    return ranks;
}

/// Probability that a sum of the ranks, each taken or not by a fair coin, is at most `sum`.
double lower_tail(const std::vector<std::size_t>& ranks, std::size_t sum) {
    std::vector<double> probability(sum + 1, 0.0);
    probability[0] = 1;
    for (const std::size_t rank : ranks) {
        for (std::size_t s = sum + 1; s-- > 0;) {
            probability[s] = 0.5 * (probability[s] + (s >= rank ? probability[s - rank] : 0));
        }
    }
    double tail = 0;
    for (const double p : probability) {
        tail += p;
    }
    return tail;
}

}  // namespace

Share share_of(std::size_t hits, std::size_t attempts) {
    if (attempts == 0) {
        return {};
    }
    constexpr double z = 1.959963984540054;
    const auto n = static_cast<double>(attempts);
    const double p = static_cast<double>(hits) / n;
    const double centre = (p + z * z / (2 * n)) / (1 + z * z / n);
    const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
    return {hits, attempts, hits == 0 ? 0 : centre - half, hits == attempts ? 1 : centre + half};
}

Range median_range(std::vector<double> values, double confidence) {
    std::sort(values.begin(), values.end());
    Range range{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    // With i of n values before it the median is outside of the next pair.
    for (std::size_t i = 0; 2 * i < values.size() && sign_test_p(i, values.size() - i) <= 1 - confidence; ++i) {
        range = {values[i], values[values.size() - 1 - i]};
    }
    return range;
}

double sign_test_p(std::size_t wins, std::size_t losses) {
    const auto n = static_cast<double>(wins + losses);
    double tail = 0;
    for (std::size_t k = 0; k <= std::min(wins, losses); ++k) {
        const auto i = static_cast<double>(k);
        tail += std::exp(std::lgamma(n + 1) - std::lgamma(i + 1) - std::lgamma(n - i + 1) - n * std::numbers::ln2);
    }
    return std::min(1.0, 2 * tail);
}

double signed_rank_p(std::span<const double> differences) {
    std::vector<double> nonzero;
    std::copy_if(differences.begin(), differences.end(), std::back_inserter(nonzero), [](double d) { return d != 0; });
    if (nonzero.empty()) {
        return 1;
    }
    std::sort(nonzero.begin(), nonzero.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    std::vector<double> magnitudes;
    magnitudes.reserve(nonzero.size());
    for (const double difference : nonzero) {
        magnitudes.push_back(std::abs(difference));
    }
    const std::vector<std::size_t> ranks = doubled_ranks(magnitudes);
    std::size_t positive = 0, all = 0;
    double squares = 0;
    for (std::size_t i = 0; i < ranks.size(); ++i) {
        positive += nonzero[i] > 0 ? ranks[i] : 0;
        all += ranks[i];
        squares += 0.25 * static_cast<double>(ranks[i]) * static_cast<double>(ranks[i]);
    }
    const std::size_t smaller = std::min(positive, all - positive);
    constexpr std::size_t most_counted_out = 200;
    if (ranks.size() <= most_counted_out) {
        return std::min(1.0, 2 * lower_tail(ranks, smaller));
    }
    const double beyond = 0.25 * static_cast<double>(all) - 0.5 * static_cast<double>(smaller) - 0.5;
    return std::min(1.0, std::erfc(std::max(0.0, beyond) / std::sqrt(squares / 4) / std::numbers::sqrt2));
}

Pairing compare_pairs(std::span<const double> first, std::span<const double> second) {
    Pairing pairing;
    std::vector<double> differences;
    for (std::size_t i = 0; i < first.size(); ++i) {
        pairing.first_smaller += first[i] < second[i] ? 1 : 0;
        pairing.second_smaller += second[i] < first[i] ? 1 : 0;
        pairing.equal += first[i] == second[i] ? 1 : 0;
        if (std::isfinite(first[i]) && std::isfinite(second[i])) {
            differences.push_back(first[i] - second[i]);
        }
    }
    pairing.sign_test_p = sign_test_p(pairing.first_smaller, pairing.second_smaller);
    pairing.finite = differences.size();
    pairing.signed_rank_p = signed_rank_p(differences);
    pairing.median_difference = quantile(std::move(differences), 0.5);
    return pairing;
}

}  // namespace downwash::bench

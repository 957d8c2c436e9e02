#include "downwash/base/quantile.hpp"
#include "downwash/bench/statistics.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

using namespace downwash::bench;
using downwash::quantile;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// The two-sided p of the signed rank test by going through all signs, for magnitudes that differ.
double by_all_signs(const std::vector<double>& differences) {
    std::vector<std::size_t> ranks;
    std::size_t positive = 0, all = 0;
    for (const double d : differences) {
        std::size_t rank = 1;
        for (const double other : differences) {
            rank += std::abs(other) < std::abs(d) ? 1 : 0;
        }
        ranks.push_back(rank);
        positive += d > 0 ? rank : 0;
        all += rank;
    }
    const std::size_t smaller = std::min(positive, all - positive);
    const std::uint32_t cases = 1U << differences.size();
    std::uint32_t hits = 0;
    for (std::uint32_t signs = 0; signs < cases; ++signs) {
        std::size_t sum = 0;
        for (std::size_t i = 0; i < ranks.size(); ++i) {
            sum += (signs >> i & 1U) != 0 ? ranks[i] : 0;
        }
        hits += sum <= smaller ? 1 : 0;
    }
    return std::min(1.0, 2.0 * hits / cases);
}

}  // namespace

TEST_CASE("Wilson's interval is that of Newcombe's table") {
    // R. G. Newcombe 1998, "Two-sided confidence intervals for the single proportion", table I, method 3.
    struct Case {
        std::size_t hits, attempts;
        double low, high;
    };
    const Case c = GENERATE(Case{81, 263, 0.2553, 0.3662}, Case{15, 148, 0.0624, 0.1605}, Case{0, 20, 0, 0.1611},
                            Case{1, 29, 0.0061, 0.1718});
    const Share share = share_of(c.hits, c.attempts);
    CHECK(share.low == Approx(c.low).margin(5e-5));
    CHECK(share.high == Approx(c.high).margin(5e-5));
    // It ends at the share where that is none or all, and is everything without attempts.
    CHECK(share_of(0, 200).low == 0);
    CHECK(share_of(0, 200).high == Approx(3.841458820694124 / 203.841458820694124));  // z^2 / (n + z^2)
    CHECK(share_of(200, 200).high == 1);
    CHECK(share_of(0, 0).low == 0);
    CHECK(share_of(0, 0).high == 1);
}

TEST_CASE("quantiles lie between the order statistics, and what has no value is infinite") {
    CHECK(quantile({4, 1, 3, 2}, 0.5) == 2.5);
    CHECK(quantile({4, 1, 3, 2}, 0.25) == 1.75);
    CHECK(quantile({7}, 0.95) == 7);
    CHECK(quantile({1, 2, infinite}, 0.5) == 2);
    CHECK(quantile({1, 2, infinite}, 0.6) == infinite);
    CHECK(quantile({1, infinite, infinite}, 0.75) == infinite);
    CHECK(quantile({1, 2, 3, 4, infinite}, 0.75) == 4);
    CHECK(std::isnan(quantile({}, 0.5)));
}

TEST_CASE("the median's range is that of the tables of order statistics") {
    // Of 1 to n: from the 95 % ranks of the binomial distribution, as tabulated for 6, 10, 20 and 100 values.
    struct Case {
        std::size_t count;
        double low, high;
    };
    const Case c = GENERATE(Case{6, 1, 6}, Case{10, 2, 9}, Case{20, 6, 15}, Case{100, 40, 61},
                            Case{5, -infinite, infinite}, Case{0, -infinite, infinite});
    std::vector<double> values;
    for (std::size_t i = c.count; i > 0; --i) {
        values.push_back(static_cast<double>(i));
    }
    const Range range = median_range(values, 0.95);
    CHECK(range.low == c.low);
    CHECK(range.high == c.high);
    CHECK(median_range({1, 2, 3, 4, infinite, infinite}, 0.95).high == infinite);
    CHECK(median_range({3, 1, 2}, 0.7).low == 1);
}

TEST_CASE("the sign test counts the tails of a fair coin") {
    CHECK(sign_test_p(5, 0) == Approx(2.0 / 32));
    CHECK(sign_test_p(1, 9) == Approx(2.0 * (1 + 10) / 1024));
    CHECK(sign_test_p(6, 6) == 1);
    CHECK(sign_test_p(0, 0) == 1);
    CHECK(sign_test_p(0, 1000) == Approx(2 * std::pow(0.5, 1000)).epsilon(1e-9));
}

TEST_CASE("the signed rank test of Darwin's maize and of Hollander's and Wolfe's patients is as published") {
    // Fisher 1935, crossed minus self-fertilised plants in eighths of an inch: V = 96 of 15 pairs, 676 of 2^15 signs.
    const std::vector<double> maize{49, -67, 8, 16, 6, 23, 28, 41, 14, 29, 56, 24, 75, 60, -48};
    CHECK(signed_rank_p(maize) == Approx(2 * 676.0 / 32768));
    // Hollander and Wolfe 1973, table 3.1: V = 40 of 9 pairs, one-sided p 0.01953.
    const std::vector<double> patients{1.83 - 0.878, 0.50 - 0.647, 1.62 - 0.598, 2.48 - 2.05, 1.68 - 1.06,
                                       1.88 - 1.29,  1.55 - 1.06,  3.06 - 3.14,  1.30 - 1.29};
    CHECK(signed_rank_p(patients) == Approx(2 * 0.01953).margin(2e-5));
    // And that of all signs, whatever the differences.
    std::uint32_t state = 12345;
    for (int round = 0; round < 30; ++round) {
        std::vector<double> differences;
        for (int i = 0; i < 10; ++i) {
            state = state * 1664525U + 1013904223U;
            differences.push_back(static_cast<double>(state) / 4294967296.0 - 0.3);
        }
        CHECK(signed_rank_p(differences) == Approx(by_all_signs(differences)));
    }
}

TEST_CASE("in the signed rank test zeros are dropped and ties share their rank") {
    // Ranks 2, 2, 2, 4, 5 and a negative sum of 2: the empty set and three single ties of 32 are as small.
    CHECK(signed_rank_p(std::array{1.0, 0.0, 1.0, -1.0, 2.0, 0.0, 3.0}) == Approx(2 * 4.0 / 32));
    // Ranks 1, 2.5, 2.5 and a negative 4: seven sets of sixteen are as small, among them no pair of the ties.
    CHECK(signed_rank_p(std::array{1.0, 2.0, 2.0, -3.0}) == Approx(2 * 7.0 / 16));
    CHECK(signed_rank_p(std::array{0.0, 0.0}) == 1);
}

TEST_CASE("for many pairs the normal approximation takes over without a step") {
    std::vector<double> differences;
    for (int i = 1; i <= 200; ++i) {
        differences.push_back(i % 20 < 9 ? -i : i);
    }
    const double counted_out = signed_rank_p(differences);
    differences.push_back(0.5);
    const double approximated = signed_rank_p(differences);
    CHECK(counted_out > 0.01);
    CHECK(counted_out < 0.9);
    CHECK(approximated == Approx(counted_out).epsilon(0.05));
}

TEST_CASE("pairs without a value lose to those with one, and differences are of pairs that have both") {
    const std::array<double, 6> first{1, 2, infinite, infinite, 5, 3};
    const std::array<double, 6> second{2, 5, 1, infinite, infinite, 3};
    const Pairing pairs = compare_pairs(first, second);
    CHECK(pairs.first_smaller == 3);
    CHECK(pairs.second_smaller == 1);
    CHECK(pairs.equal == 2);
    CHECK(pairs.sign_test_p == Approx(2.0 * (1 + 4) / 16));
    CHECK(pairs.finite == 3);
    CHECK(pairs.median_difference == -1);
    CHECK(pairs.signed_rank_p == Approx(2 * 0.25));  // -1, -3: one of four signs
}

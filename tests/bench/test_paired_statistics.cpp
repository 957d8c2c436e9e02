#include "downwash/bench/paired_statistics.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

using namespace downwash::bench;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Airway hyper-responsiveness before and after stem cell transplantation in 21 children (Bentur et al. 2009), as
/// Fagerland, Lydersen and Laake 2014 analyse it ("Recommended tests and confidence intervals for paired binomial
/// proportions").
constexpr PairCounts airways{1, 1, 7, 12};

}  // namespace

TEST_CASE("Clopper and Pearson's interval of none, all and some is that of its closed form and of its definition") {
    // No failure in n: 1 - 0.025^(1/n).
    CHECK(exact_share(0, 50).low == 0);
    CHECK(exact_share(0, 50).high == Approx(1 - std::pow(0.025, 1.0 / 50)));
    CHECK(exact_share(50, 50).low == Approx(std::pow(0.025, 1.0 / 50)));
    CHECK(exact_share(50, 50).high == 1);
    // One of two: at the lower end P(X >= 1) = 1 - (1 - p)^2 is 0.025, at the upper one P(X <= 1) = 1 - p^2.
    CHECK(exact_share(1, 2).low == Approx(1 - std::sqrt(0.975)));
    CHECK(exact_share(1, 2).high == Approx(std::sqrt(0.975)));
    CHECK(exact_share(0, 0).low == 0);
    CHECK(exact_share(0, 0).high == 1);
}

TEST_CASE("McNemar's exact test counts the pairs that differ alone") {
    CHECK(mcnemar_p(airways) == Approx(2 * 9.0 / 256));  // 1 and 7: (1 + 8) of 2^8 on either side
    CHECK(mcnemar_p({0, 1, 7, 500}) == mcnemar_p(airways));
    CHECK(mcnemar_p({3, 0, 0, 4}) == 1);
}

TEST_CASE("the risk difference of pairs has Newcombe's interval as published") {
    // Fagerland, Lydersen and Laake 2014, table IV: -0.507 to -0.026.
    const Estimate transplantation = risk_difference(airways);
    CHECK(transplantation.value == Approx(-6.0 / 21));
    CHECK(transplantation.low == Approx(-0.507).margin(5e-4));
    CHECK(transplantation.high == Approx(-0.026).margin(5e-4));
    // Newcombe 1998, table II, method 10: 0.0569 to 0.3404.
    const Estimate table = risk_difference({36, 12, 2, 0});
    CHECK(table.value == Approx(0.2));
    CHECK(table.low == Approx(0.0569).margin(5e-5));
    CHECK(table.high == Approx(0.3404).margin(5e-5));
    // The other way round it has the other sign.
    const Estimate turned = risk_difference({36, 2, 12, 0});
    CHECK(turned.low == Approx(-table.high));
    CHECK(turned.high == Approx(-table.low));
    // Without any event the interval is Wilson's on both sides: z^2 / (n + z^2), once.
    const Estimate nothing = risk_difference({0, 0, 0, 50});
    CHECK(nothing.value == 0);
    CHECK(nothing.high == Approx(3.841458820694124 / 53.841458820694124));
    CHECK(nothing.low == Approx(-nothing.high));
    CHECK(risk_difference({}).low == -1);
}

TEST_CASE("the odds ratio of matched pairs is that of the pairs that differ") {
    const Estimate odds = matched_odds_ratio(airways);
    CHECK(odds.value == Approx(1.0 / 7));
    // 1 of 8 by Clopper and Pearson: 1 - 0.975^(1/8) below; above, the p at which (1 - p)^8 + 8 p (1 - p)^7 is 0.025.
    const double low = 1 - std::pow(0.975, 1.0 / 8);
    CHECK(odds.low == Approx(low / (1 - low)));
    const double high = odds.high / (1 + odds.high);
    CHECK(std::pow(1 - high, 8) + 8 * high * std::pow(1 - high, 7) == Approx(0.025));
    CHECK(matched_odds_ratio({5, 4, 0, 5}).value == infinite);
    CHECK(matched_odds_ratio({5, 4, 0, 5}).high == infinite);
    CHECK(matched_odds_ratio({5, 0, 4, 5}).low == 0);
    CHECK(std::isnan(matched_odds_ratio({5, 0, 0, 5}).value));
}

TEST_CASE("Hodges' and Lehmann's shift of Hollander's and Wolfe's patients is as published") {
    // Hollander and Wolfe 1973, table 3.1, examples 3.3 and 3.4: after less before; -0.46 with -0.786 to -0.010.
    const std::array patients{0.878 - 1.83, 0.647 - 0.50, 0.598 - 1.62, 2.05 - 2.48, 1.06 - 1.68,
                              1.29 - 1.88,  1.06 - 1.55,  3.14 - 3.06,  1.29 - 1.30};
    const Estimate shift = shift_of(patients);
    CHECK(shift.value == Approx(-0.46));
    CHECK(shift.low == Approx(-0.786));
    CHECK(shift.high == Approx(-0.010));
}

TEST_CASE("a shift needs six differences for an interval, and its interval grows narrow with many") {
    // With five, even the least sum of ranks has 1/32 on either side; with six it has 1/64.
    CHECK(shift_of(std::array{1.0, 2.0, 3.0, 4.0, 5.0}).low == -infinite);
    const Estimate six = shift_of(std::array{1.0, 2.0, 3.0, 4.0, 5.0, 6.0});
    CHECK(six.value == 3.5);
    CHECK(six.low == 1);
    CHECK(six.high == 6);
    CHECK(std::isnan(shift_of({}).value));
    // From 200 to 201 the normal approximation takes over without a step.
    std::vector<double> many;
    for (int i = 1; i <= 200; ++i) {
        many.push_back(i);
    }
    const Estimate counted_out = shift_of(many);
    many.push_back(100.5);
    const Estimate approximated = shift_of(many);
    CHECK(counted_out.value == 100.5);
    CHECK(approximated.low == Approx(counted_out.low).margin(0.6));
    CHECK(approximated.high == Approx(counted_out.high).margin(0.6));
    CHECK(counted_out.high - counted_out.low < 20);
}

TEST_CASE("the ratio of pairs is the same whichever way round") {
    const std::vector<double> ratios{1.1, 1.2, 0.9, 1.3, 1.05, 1.15, 1.4};
    std::vector<double> turned;
    for (const double ratio : ratios) {
        turned.push_back(1 / ratio);
    }
    const Estimate ratio = ratio_of(ratios), inverse = ratio_of(turned);
    CHECK(ratio.value == Approx(1 / inverse.value));
    CHECK(ratio.low == Approx(1 / inverse.high));
    CHECK(ratio.value == Approx(std::sqrt(1.1 * 1.2)).epsilon(0.02));  // near the median of 1.15
    CHECK(ratio_of(std::vector<double>(8, 2.0)).value == Approx(2));
}

TEST_CASE("Holm multiplies the smallest p by their number, the next by one less, and never turns their order") {
    const std::vector<double> adjusted = holm_adjusted(std::array{0.01, 0.04, 0.03, 0.005});
    CHECK(adjusted[0] == Approx(0.03));  // 3 * 0.01
    CHECK(adjusted[1] == Approx(0.06));  // 1 * 0.04, but no less than the one before
    CHECK(adjusted[2] == Approx(0.06));  // 2 * 0.03
    CHECK(adjusted[3] == Approx(0.02));  // 4 * 0.005
    CHECK(holm_adjusted(std::array{0.7, 0.8})[0] == 1);
    CHECK(holm_adjusted({}).empty());
}

TEST_CASE("a bootstrap draws within groups: what differs between them alone has no spread") {
    const std::vector<std::vector<double>> apart{{1, 1, 1}, {3, 3, 3}};
    const Estimate fixed = bootstrap_mean(apart);
    CHECK(fixed.value == 2);
    CHECK(fixed.low == 2);
    CHECK(fixed.high == 2);
    // Of one group of 0 and 1, 50 each, the mean has a standard deviation of 0.05.
    std::vector<double> half(50, 0.0);
    half.resize(100, 1.0);
    const Estimate mixed = bootstrap_mean(std::vector<std::vector<double>>{half});
    CHECK(mixed.value == 0.5);
    CHECK(mixed.low == Approx(0.5 - 1.96 * 0.05).margin(0.015));
    CHECK(mixed.high == Approx(0.5 + 1.96 * 0.05).margin(0.015));
    const Estimate alone = bootstrap_mean(std::vector<std::vector<double>>{{1, 2}, {3}});
    CHECK(alone.value == 2);
    CHECK(std::isnan(alone.low));
    CHECK(std::isnan(bootstrap_mean({}).value));
}

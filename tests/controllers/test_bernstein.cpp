#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "../support/random.hpp"
#include "downwash/controllers/bernstein.hpp"

using namespace downwash;
using namespace downwash::controllers;
using test::Random;

namespace {

template <std::size_t size>
std::array<double, size> random_powers(Random& random) {
    std::array<double, size> c;
    for (double& coefficient : c) {
        coefficient = random.uniform(-1, 1);
    }
    return c;
}

/// By powers, in extended precision.
template <std::size_t size>
double value(const std::array<double, size>& powers, double s) {
    long double sum = 0;
    for (std::size_t i = size; i-- > 0;) {
        sum = sum * s + powers[i];
    }
    return static_cast<double>(sum);
}

/// By the definition of the basis.
template <std::size_t size>
double value_of_bernstein(const std::array<double, size>& p, double s) {
    constexpr int n = static_cast<int>(size) - 1;
    double sum = 0;
    double binomial = 1;
    for (int k = 0; k <= n; ++k) {
        sum += p[static_cast<std::size_t>(k)] * binomial * std::pow(s, k) * std::pow(1 - s, n - k);
        binomial = binomial * (n - k) / (k + 1);
    }
    return sum;
}

template <std::size_t size>
double greatest(const std::array<double, size>& powers) {
    double value_there = -std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 4000; ++i) {
        value_there = std::max(value_there, value(powers, i / 4000.0));
    }
    return value_there;
}

template <std::size_t size>
void check_basis(Random& random) {
    for (int i = 0; i < 200; ++i) {
        const auto powers = random_powers<size>(random);
        const auto p = from_powers(powers);
        const double s = random.uniform(0, 1);
        CHECK(value_of_bernstein(p, s) == Approx(value(powers, s)).margin(1e-13));
        CHECK(p.front() == powers.front());
        CHECK(p.back() == Approx(value(powers, 1)).margin(1e-13));
    }
}

}  // namespace

TEST_CASE("A polynomial in the Bernstein basis is the one in powers") {
    Random random(1);
    check_basis<1>(random);
    check_basis<3>(random);
    check_basis<5>(random);
    check_basis<6>(random);
    check_basis<13>(random);
}

TEST_CASE("Derivatives, products and squared lengths in the Bernstein basis are those of the polynomials") {
    Random random(2);
    for (int i = 0; i < 200; ++i) {
        const auto a = random_powers<6>(random);
        const auto b = random_powers<4>(random);
        const double s = random.uniform(0, 1);
        std::array<double, 5> slope;
        for (std::size_t k = 0; k < 5; ++k) {
            slope[k] = static_cast<double>(k + 1) * a[k + 1];
        }
        CHECK(value_of_bernstein(derivative(from_powers(a), 0.25), s) == Approx(0.25 * value(slope, s)).margin(1e-12));
        const double a_s = value(a, s);
        const double b_s = value(b, s);
        CHECK(value_of_bernstein(product(from_powers(a), from_powers(b)), s) == Approx(a_s * b_s).margin(1e-12));
        auto sum = product(from_powers(a), from_powers(b));
        add_product(sum, -2, from_powers(b), from_powers(a));
        CHECK(value_of_bernstein(sum, s) == Approx(-a_s * b_s).margin(1e-12));
        const auto c = random_powers<4>(random);
        const std::array<std::array<double, 4>, 2> both{from_powers(b), from_powers(c)};
        CHECK(value_of_bernstein(squared_length(both), s) ==
              Approx(b_s * b_s + value(c, s) * value(c, s)).margin(1e-12));
    }
}

TEST_CASE("A bound is proven or refuted as dense samples say, however near the greatest value is") {
    Random random(3);
    int kept = 0;
    int broken = 0;
    for (int i = 0; i < 3000; ++i) {
        const auto powers = random_powers<13>(random);
        const auto p = from_powers(powers);
        const double top = greatest(powers);
        // Samples miss a peak by at most |p''| h^2 / 8, and |p''| is at most 572 here.
        constexpr double missed = 572.0 / 8 / (4000.0 * 4000.0);
        const double limit = top + random.magnitude(-8, 0);
        const Bound bound = is_at_most(p, limit);
        REQUIRE(bound != Bound::open);
        if (limit < top) {
            CHECK(bound == Bound::broken);
        } else if (limit > top + missed) {
            CHECK(bound == Bound::kept);
        }
        kept += bound == Bound::kept ? 1 : 0;
        broken += bound == Bound::broken ? 1 : 0;
    }
    CHECK(kept > 1000);
    CHECK(broken > 1000);
}

TEST_CASE("A peak that touches the limit is neither proven nor refuted, one with the least room is") {
    // 1 - (s - 1/3)^2: the peak is not met by halving.
    const Bernstein<2> peak = from_powers<3>({1 - 1.0 / 9, 2.0 / 3, -1});
    CHECK(is_at_most(peak, 1 + 1e-9) == Bound::kept);
    CHECK(is_at_most(peak, 1 + 1e-11) == Bound::kept);
    CHECK(is_at_most(peak, 1 - 1e-11) == Bound::broken);
    CHECK(is_at_most(peak, 1) != Bound::broken);
    // Six peaks of equal height that all but touch: the work stays small, and so does the room that is needed.
    // Chebyshev's polynomial of degree 12 on [0, 1].
    std::array<double, 13> low{1};
    std::array<double, 13> chebyshev{-1, 2};
    for (int n = 1; n < 12; ++n) {
        std::array<double, 13> next{};
        for (std::size_t k = 0; k < 13; ++k) {
            next[k] = -2 * chebyshev[k] - low[k] + (k > 0 ? 4 * chebyshev[k - 1] : 0);
        }
        low = chebyshev;
        chebyshev = next;
    }
    CHECK(is_at_most(from_powers(chebyshev), 1 + 1e-6) == Bound::kept);
    CHECK(is_at_most(from_powers(chebyshev), 1 - 1e-6) == Bound::broken);
}

TEST_CASE("Constants are compared, and what is no number keeps no limit") {
    CHECK(is_at_most(std::array<double, 1>{2}, 2) == Bound::kept);
    CHECK(is_at_most(std::array<double, 1>{2}, 1.999) == Bound::broken);
    CHECK(is_at_most(std::array<double, 5>{3, 3, 3, 3, 3}, 3) == Bound::kept);
    constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinite = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 5; ++i) {
        std::array<double, 5> p{};
        p[i] = no_number;
        CHECK(is_at_most(p, 1) == Bound::broken);
        p[i] = infinite;
        CHECK(is_at_most(p, 1) == Bound::broken);
    }
    CHECK(is_at_most(std::array<double, 2>{0, 1}, no_number) == Bound::broken);
}

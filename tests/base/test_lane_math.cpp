#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "../support/random.hpp"
#include "downwash/base/lane_math.hpp"

// The functions are compared with the C library's in long double, which has eleven more bits.

namespace {

using downwash::test::Random;
namespace lane = downwash::lane;

constexpr long double pi = 3.14159265358979323846264338327950288L;

/// Distance from the exact value in units of its last place.
double ulps(double value, long double exact) {
    if (static_cast<long double>(value) == exact) {
        return 0;
    }
    const double size = std::abs(static_cast<double>(exact));
    const double ulp = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
    return static_cast<double>(std::abs(static_cast<long double>(value) - exact) / static_cast<long double>(ulp));
}

/// The worst of many samples and where it was.
struct Worst {
    double error_ulp = 0;
    double at = 0;
    double at_y = 0;
    void add(double ulp, double x, double y = 0) {
        if (!(ulp <= error_ulp)) {
            error_ulp = ulp;
            at = x;
            at_y = y;
        }
    }
    void check() const {
        CAPTURE(at, at_y);
        CHECK(error_ulp <= 2);
    }
};

void add_sin_cos(Worst& worst, double x) {
    double sine = 0;
    double cosine = 0;
    lane::sin_cos(x, sine, cosine);
    worst.add(ulps(sine, std::sin(static_cast<long double>(x))), x);
    worst.add(ulps(cosine, std::cos(static_cast<long double>(x))), x);
}

void add_angle(Worst& worst, double y, double x) {
    worst.add(ulps(lane::atan2(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x))), x, y);
}

}  // namespace

TEST_CASE("Sine and cosine stay within 2 ulp up to 1e5, at and beside multiples of an eighth of a turn too") {
    Random random(1);
    Worst worst;
    for (int i = 0; i < 1'000'000; ++i) {
        add_sin_cos(worst, random.uniform(-20, 20));
        add_sin_cos(worst, random.uniform(-20, 20));
        add_sin_cos(worst, random.uniform(-1e5, 1e5));
        add_sin_cos(worst, random.magnitude(-300, 5));
    }
    for (const double x : {1e5, -1e5, 0.0}) {
        add_sin_cos(worst, x);
    }
    constexpr int last = 127'323;  // times pi/4 is just below 1e5
    for (int k = -last; k <= last; ++k) {
        const double x = static_cast<double>(static_cast<long double>(k) * pi / 4);
        add_sin_cos(worst, x);
        add_sin_cos(worst, std::nextafter(x, 1e6));
        add_sin_cos(worst, std::nextafter(x, -1e6));
        add_sin_cos(worst, x * (1 + 1e-12));
        add_sin_cos(worst, x + 1e-7);
    }
    worst.check();
}

TEST_CASE("Sine is odd and cosine even to the last bit") {
    Random random(3);
    int odd = 0;
    for (int i = 0; i < 100'000; ++i) {
        const double x = random.uniform(0, 1000);
        double s1 = 0;
        double c1 = 0;
        double s2 = 0;
        double c2 = 0;
        lane::sin_cos(x, s1, c1);
        lane::sin_cos(-x, s2, c2);
        odd += s1 == -s2 && c1 == c2 ? 0 : 1;
    }
    CHECK(odd == 0);
}

TEST_CASE("The angle of a vector stays within 2 ulp in all directions and sizes") {
    Random random(4);
    Worst worst;
    for (int i = 0; i < 1'000'000; ++i) {
        add_angle(worst, random.uniform(-3, 3), random.uniform(-3, 3));
        add_angle(worst, random.magnitude(-100, 100), random.magnitude(-100, 100));
        const double x = random.magnitude(-3, 3);
        add_angle(worst, x * random.uniform(0.499, 0.501), x);  // where the argument is reduced
        add_angle(worst, x * random.uniform(0.999, 1.001), x);  // where the axes change places
        add_angle(worst, x * random.magnitude(-18, 0), x);
        add_angle(worst, x, x * random.magnitude(-18, 0));
    }
    worst.check();
}

TEST_CASE(
    "The angle of a vector on an axis or a diagonal has the sign of its quadrant, that of the zero vector is zero") {
    const double half_pi = std::acos(0.0);
    CHECK(lane::atan2(0.0, 2.0) == 0);
    CHECK(lane::atan2(3.0, 0.0) == half_pi);
    CHECK(lane::atan2(-3.0, 0.0) == -half_pi);
    CHECK(lane::atan2(0.0, -2.0) == 2 * half_pi);
    CHECK(lane::atan2(-0.0, -2.0) == 2 * half_pi);  // (-pi, pi]: one name for this direction
    CHECK(lane::atan2(1.0, 1.0) == half_pi / 2);
    CHECK(lane::atan2(-1.0, 1.0) == -half_pi / 2);
    CHECK(ulps(lane::atan2(1.0, -1.0), 0.75L * pi) <= 1);
    CHECK(ulps(lane::atan2(-1.0, -1.0), -0.75L * pi) <= 1);
    CHECK(lane::atan2(-1e-30, -1.0) == -2 * half_pi);
    for (const auto& [y, x] : {std::pair(0.0, 0.0), {-0.0, 0.0}, {0.0, -0.0}}) {
        CHECK(lane::atan2(y, x) == 0);
    }
}

TEST_CASE("Powers of three halves stay within 2 ulp") {
    Random random(5);
    Worst worst;
    for (int i = 0; i < 1'000'000; ++i) {
        for (const double x : {random.uniform(0, 30), std::abs(random.magnitude(-100, 100))}) {
            const long double exact = static_cast<long double>(x) * std::sqrt(static_cast<long double>(x));
            worst.add(ulps(lane::power_three_halves(x), exact), x);
        }
    }
    worst.check();
    CHECK(lane::power_three_halves(0.0) == 0);
    CHECK(lane::power_three_halves(4.0) == 8);
}

TEST_CASE("A wrapped angle lies within half a turn and differs by whole turns to the last place of the argument") {
    Random random(6);
    const double half_turn = std::acos(-1.0);
    double outside = 0;
    Worst worst;
    const auto add = [&](double x) {
        const double wrapped = lane::wrap_angle(x);
        if (!(wrapped > -half_turn && wrapped <= half_turn)) {
            outside = x;
        }
        // The argument's own last place bounds what can be known of the result.
        const long double turns = (static_cast<long double>(x) - static_cast<long double>(wrapped)) / (2 * pi);
        const long double error = std::abs(turns - std::round(turns)) * 2 * pi;
        const double size = std::max(std::abs(x), half_turn);
        worst.add(static_cast<double>(error) / (std::nextafter(size, 1e9) - size), x);
    };
    for (int i = 0; i < 1'000'000; ++i) {
        add(random.uniform(-20, 20));
        add(random.uniform(-1e5, 1e5));
        add(random.magnitude(-300, 5));
    }
    constexpr int last = 31'830;  // odd multiples of pi below 1e5, where the wrap jumps
    for (int k = -last; k < last; ++k) {
        const double x = static_cast<double>(static_cast<long double>(k) * pi);
        add(x);
        add(std::nextafter(x, 1e6));
        add(std::nextafter(x, -1e6));
    }
    CHECK(outside == 0);
    worst.check();
    CHECK(lane::wrap_angle(half_turn) == half_turn);
    CHECK(lane::wrap_angle(-half_turn) == half_turn);
    CHECK(lane::wrap_angle(0.25) == 0.25);
}

TEST_CASE("Rounding gives the nearest integer with ties to even up to 2^51") {
    Random random(7);
    int wrong = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const double x = random.magnitude(-5, 15.3);
        wrong += lane::round_to_integer(x) == std::nearbyint(x) ? 0 : 1;
    }
    CHECK(wrong == 0);
    for (const double tie : {0.5, 1.5, 2.5, -0.5, -1.5, 1048576.5}) {
        CHECK(lane::round_to_integer(tie) == std::nearbyint(tie));
    }
    const double limit = std::nextafter(0x1p51, 0);
    CHECK(lane::round_to_integer(limit) == std::nearbyint(limit));
    CHECK(lane::round_to_integer(-limit) == std::nearbyint(-limit));
}

TEST_CASE("Selections compare as their names say") {
    CHECK(lane::abs(-2.0) == 2);
    CHECK(lane::min(1.0, 2.0) == 1);
    CHECK(lane::max(1.0, 2.0) == 2);
    CHECK(lane::clamp(5.0, -1.0, 1.0) == 1);
    CHECK(lane::clamp(-5.0, -1.0, 1.0) == -1);
    CHECK(lane::clamp(0.5, -1.0, 1.0) == 0.5);
    CHECK(lane::sqrt(2.0) == std::sqrt(2.0));
}

TEST_CASE("The exponential function is within 2 ulp of the exact one over its whole range") {
    Random random(8);
    Worst worst;
    for (int i = 0; i < 400000; ++i) {
        const double x = i % 2 == 0 ? random.uniform(-707, 709) : random.uniform(-3, 3);
        worst.add(ulps(lane::exp(x), std::exp(static_cast<long double>(x))), x);
    }
    worst.check();
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(lane::exp(0.0) == 1);
    CHECK(lane::exp(-infinity) == 0);
    CHECK(lane::exp(-1000.0) == 0);
    CHECK(lane::exp(infinity) == infinity);
    CHECK(lane::exp(710.0) == infinity);
    CHECK(std::isnan(lane::exp(std::numeric_limits<double>::quiet_NaN())));
}

TEST_CASE("The cube root is within 2 ulp of the exact one for any size and sign") {
    Random random(9);
    Worst worst;
    for (int i = 0; i < 400000; ++i) {
        const double x = std::ldexp(random.uniform(-1, 1), random.integer(-900, 900));
        worst.add(ulps(lane::cube_root(x), std::cbrt(static_cast<long double>(x))), x);
    }
    worst.check();
    CHECK(lane::cube_root(27.0) == 3);
    CHECK(lane::cube_root(-8.0) == -2);
    CHECK(lane::cube_root(0.0) == 0);
    CHECK(lane::cube_root(std::numeric_limits<double>::infinity()) == std::numeric_limits<double>::infinity());
}

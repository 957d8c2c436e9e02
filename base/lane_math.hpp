#pragma once

// The arithmetic of one tick, written once for every lane type: `double` now, packs of doubles later. Nothing here
// calls the C library, whose sin and cos differ between processors: the same input gives the same bytes everywhere.
// That needs a build without contraction (-ffp-contract=off). sqrt is exact by IEEE 754 and may be used.

#include <cmath>
#include <initializer_list>

namespace downwash::lane {

/// `yes` where the condition holds, `no` where not; both are computed.
inline double select(bool condition, double yes, double no) {
    return condition ? yes : no;
}
/// Correctly rounded.
inline double sqrt(double x) {
    return std::sqrt(x);
}
/// Without its sign, that of zeros and NaN too.
inline double abs(double x) {
    return std::fabs(x);
}
/// Lanes of a lane type.
template <class T>
inline constexpr int width = sizeof(T) / sizeof(double);
/// The number of one lane.
inline double number_in(double x, int /*lane*/) {
    return x;
}
/// Replaces the number of one lane.
inline void set_number(double& x, int /*lane*/, double number) {
    x = number;
}
/// The lanes in which a condition holds, as bits; the first lane is the lowest.
inline unsigned int bits_of(bool condition) {
    return condition ? 1 : 0;
}
/// The numbers of all lanes, one after the other.
template <class T>
T load(const double* from) {
    T all;
    __builtin_memcpy(&all, from, sizeof all);
    return all;
}
/// The lesser; a when either is NaN.
template <class T>
T min(T a, T b) {
    return select(b < a, b, a);
}
/// The greater; a when either is NaN.
template <class T>
T max(T a, T b) {
    return select(a < b, b, a);
}
/// @pre low <= high
template <class T>
T clamp(T x, T low, T high) {
    return max(low, min(x, high));
}

/// The integer nearest to x as a floating point number, ties to even. @pre |x| < 2^51
template <class T>
T round_to_integer(T x) {
    const T magic(6755399441055744.0);  // 1.5 * 2^52: adding it leaves no room for a fraction
    return (x + magic) - magic;
}

/// Sine and cosine to 2 ulp. @pre |x| <= 1e5 rad (the quotient must leave 33-bit products exact)
template <class T>
void sin_cos(T x, T& sine, T& cosine) {
    // pi/2 in three parts of 33 bits and a rest (Cody and Waite 1980), so that quotient * part is exact.
    const T part1(0x1.921fb544p+0);
    const T part2(0x1.0b4611a6p-34);
    const T part3(0x1.3198a2ep-69);
    const T rest(0x1.b839a252049c1p-104);
    const T quotient = round_to_integer(x * T(0.63661977236758134308));
    const T a = x - quotient * part1;
    const T b = a - quotient * part2;
    const T b_lost = (a - b) - quotient * part2;
    const T small = quotient * part3 - b_lost;
    const T r = b - small;
    const T r_low = ((b - r) - small) - quotient * rest;

    // sin r = r + r w s(w) and cos r = 1 - w / 2 + w^2 c(w), s and c interpolated at the six Chebyshev points of
    // w in [0, (pi/4)^2]: off by less than 2e-17 of the result.
    const T w = r * r;
    T s(1.5918129294509297e-10);
    s = s * w - T(2.5051131844998664e-08);
    s = s * w + T(2.7557316102552418e-06);
    s = s * w - T(0.00019841269836758574);
    s = s * w + T(0.008333333333330948);
    s = s * w - T(0.16666666666666666);
    const T sin_r = r + (r * w * s + r_low * (T(1) - T(0.5) * w));
    T c(1.1382632425298186e-11);
    c = T(2.0876146268400097e-09) - c * w;
    c = c * w - T(2.7557317271729777e-07);
    c = c * w + T(2.480158729876569e-05);
    c = c * w - T(0.0013888888888887398);
    c = c * w + T(0.041666666666666664);
    const T half_w = T(0.5) * w;
    const T one_less = T(1) - half_w;
    const T cos_r = one_less + (((T(1) - one_less) - half_w) + (w * w * c - r * r_low));

    // The quadrant, quotient mod 4, found without integers as one of -2, -1, 0, 1, 2 (-2 and 2 are the same).
    const T quadrant = quotient - T(4) * round_to_integer(quotient * T(0.25));
    const auto is_odd = abs(abs(quadrant) - T(1)) < T(0.5);
    const T sin_base = select(is_odd, cos_r, sin_r);
    const T cos_base = select(is_odd, sin_r, cos_r);
    sine = select(abs(quadrant - T(0.5)) > T(1.25), -sin_base, sin_base);
    cosine = select(abs(quadrant + T(0.5)) > T(1.25), -cos_base, cos_base);
}

/// Sine and cosine of one angle.
struct SinCos {
    double sine, cosine;
};
/// As sin_cos(x, sine, cosine).
[[nodiscard]] inline SinCos sin_cos(double x) {
    SinCos both{};
    sin_cos(x, both.sine, both.cosine);
    return both;
}

/// Angle of the vector (x, y) in (-pi, pi] to 2 ulp; 0 for the zero vector.
template <class T>
T atan2(T y, T x) {
    const T ax = abs(x);
    const T ay = abs(y);
    const T larger = max(ax, ay);
    const T smaller = min(ax, ay);
    const T ratio = smaller / select(larger > T(0), larger, T(1));  // in [0, 1]
    // atan(t) = pi/4 + atan((t - 1) / (t + 1)) brings the argument into [-1/3, 1/2].
    const auto is_large = ratio > T(0.5);
    const T t = select(is_large, (smaller - larger) / (smaller + select(larger > T(0), larger, T(1))), ratio);
    const T w = t * t;
    // atan t = t - t w p(w), where p = 1/3 - w/5 + w^2/7 - ... is interpolated at the 13 Chebyshev points of [0, 1/4]:
    // t w p is off by less than 5e-18 t. Even and odd powers apart, which is twice as fast.
    const T v = w * w;
    T even(0.009215792047089858);
    even = even * v + T(0.03806653672057366);
    even = even * v + T(0.05240099507994713);
    even = even * v + T(0.06666435677235948);
    even = even * v + T(0.09090908620322523);
    even = even * v + T(0.14285714285599188);
    even = even * v + T(0.3333333333333333);
    T odd(0.025006503566489507);
    odd = odd * v + T(0.04628024868570153);
    odd = odd * v + T(0.05879578429582425);
    odd = odd * v + T(0.07692294712540285);
    odd = odd * v + T(0.11111111100917376);
    odd = odd * v + T(0.19999999999999488);
    const T bend = t * w * (even - w * odd);
    const T pi_low(1.2246467991473532e-16);
    const T pi_quarter(0.78539816339744830962);
    const T sum = pi_quarter + t;
    const T sum_lost = t - (sum - pi_quarter);
    const T first = select(is_large, sum + (sum_lost + (T(0.25) * pi_low - bend)), t - bend);
    const T second = select(ay > ax, T(1.57079632679489661923) - (first - T(0.5) * pi_low), first);
    const T third = select(x < T(0), T(3.14159265358979323846) - (second - pi_low), second);
    return select(y < T(0), -third, third);
}

/// x^1.5 to 2 ulp. @pre x >= 0
template <class T>
T power_three_halves(T x) {
    return x * sqrt(x);
}

/// e^x to 2 ulp, for one double; infinite beyond the greatest one, 0 below the smallest normal one.
inline double exp(double x) {
    if (!(x > -708)) {
        return x <= -708 ? 0 : x;  // NaN stays
    }
    if (x > 709.78) {
        return 2 * 0x1p1023;
    }
    const double k = round_to_integer(x * 1.44269504088896340736);
    // ln 2 in 33 bits and a rest: k times the first is exact.
    const double r = (x - k * 0x1.62e42feep-1) - k * 0x1.a39ef35793c76p-33;
    double sum = 1.0 / 6227020800.0;  // Taylor, 13! first: |r| <= ln 2 / 2 leaves less than 2^-58
    for (const double factorial :
         {479001600.0, 39916800.0, 3628800.0, 362880.0, 40320.0, 5040.0, 720.0, 120.0, 24.0, 6.0, 2.0, 1.0, 1.0}) {
        sum = sum * r + 1 / factorial;
    }
    return std::ldexp(sum, static_cast<int>(k));
}

/// The real cube root to 2 ulp, for one double.
inline double cube_root(double x) {
    if (x == 0 || x - x != 0) {  // 0, infinite or no number
        return x;
    }
    int exponent = 0;
    double m = std::frexp(abs(x), &exponent);
    for (; exponent % 3 != 0; ++exponent) {
        m *= 0.5;
    }
    double root = 0.37 + 0.65 * m;  // within 10 % for 1/8 <= m < 1
    for (int i = 0; i < 5; ++i) {   // Newton
        root = (2 * root + m / (root * root)) * (1.0 / 3.0);
    }
    return std::ldexp(x < 0 ? -root : root, exponent / 3);
}

/// The angle in (-pi, pi] that differs from x by whole turns. @pre |x| <= 1e5 rad
template <class T>
T wrap_angle(T x) {
    const T turn(6.28318530717958647692);
    const T half_turn(3.14159265358979323846);
    const T r = x - turn * round_to_integer(x / turn);
    // The quotient is rounded, so that r may lie outside by its rounding on either side.
    const T lowered = select(r > half_turn, r - turn, r);
    return select(lowered > -half_turn, lowered, lowered + turn);
}

}  // namespace downwash::lane

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "downwash/base/export.hpp"

// Polynomials of small degree on [0, 1] by their Bernstein coefficients: the least and the greatest of these enclose
// the polynomial, and the first and the last are its values at 0 and 1 (R. T. Farouki, "The Bernstein polynomial basis:
// a centennial retrospective", Computer Aided Geometric Design 29, 2012).

namespace downwash::controllers {

/// A polynomial of degree n: the sum over k of c[k] binomial(n, k) s^k (1 - s)^(n - k).
template <int n>
using Bernstein = std::array<double, n + 1>;

namespace bernstein_detail {

constexpr double binomial(std::size_t n, std::size_t k) {
    double number = 1;
    for (std::size_t i = 1; i <= k; ++i) {
        number = number * static_cast<double>(n + 1 - i) / static_cast<double>(i);  // whole after each step
    }
    return number;
}

/// Row k, column j: how much a power s^j adds to coefficient k.
template <std::size_t n>
constexpr auto powers = [] {
    std::array<std::array<double, n + 1>, n + 1> share{};
    for (std::size_t k = 0; k <= n; ++k) {
        for (std::size_t j = 0; j <= k; ++j) {
            share[k][j] = binomial(k, j) / binomial(n, j);
        }
    }
    return share;
}();

/// Row i, column j: how much of a[i] b[j] is in coefficient i + j of the product.
template <std::size_t n, std::size_t m>
constexpr auto products = [] {
    std::array<std::array<double, m + 1>, n + 1> share{};
    for (std::size_t i = 0; i <= n; ++i) {
        for (std::size_t j = 0; j <= m; ++j) {
            share[i][j] = binomial(n, i) * binomial(m, j) / binomial(n + m, i + j);
        }
    }
    return share;
}();

}  // namespace bernstein_detail

/// The polynomial c[0] + c[1] s + ... + c[n] s^n.
template <std::size_t size>
[[nodiscard]] constexpr Bernstein<static_cast<int>(size) - 1> from_powers(const std::array<double, size>& c) noexcept {
    Bernstein<static_cast<int>(size) - 1> p{};
    for (std::size_t k = 0; k < size; ++k) {
        for (std::size_t j = 0; j <= k; ++j) {
            p[k] += bernstein_detail::powers<size - 1>[k][j] * c[j];
        }
    }
    return p;
}

/// The derivative by s times the inverse of a duration: the derivative by time where s is a time over that duration.
template <std::size_t size>
[[nodiscard]] constexpr std::array<double, size - 1> derivative(const std::array<double, size>& p,
                                                                double inverse_duration = 1) noexcept {
    std::array<double, size - 1> d{};
    for (std::size_t k = 0; k + 1 < size; ++k) {
        d[k] = static_cast<double>(size - 1) * inverse_duration * (p[k + 1] - p[k]);
    }
    return d;
}

/// Adds factor a b to a sum.
template <std::size_t a_size, std::size_t b_size>
constexpr void add_product(std::array<double, a_size + b_size - 1>& sum, double factor,
                           const std::array<double, a_size>& a, const std::array<double, b_size>& b) noexcept {
    constexpr auto& share = bernstein_detail::products<a_size - 1, b_size - 1>;
    for (std::size_t i = 0; i < a_size; ++i) {
        for (std::size_t j = 0; j < b_size; ++j) {
            sum[i + j] += share[i][j] * (factor * a[i]) * b[j];
        }
    }
}

/// a b.
template <std::size_t a_size, std::size_t b_size>
[[nodiscard]] constexpr std::array<double, a_size + b_size - 1> product(const std::array<double, a_size>& a,
                                                                        const std::array<double, b_size>& b) noexcept {
    std::array<double, a_size + b_size - 1> whole{};
    add_product(whole, 1, a, b);
    return whole;
}

/// The square of the length of a vector of polynomials.
template <std::size_t size, std::size_t dimensions>
[[nodiscard]] constexpr std::array<double, 2 * size - 1> squared_length(
    const std::array<std::array<double, size>, dimensions>& vector) noexcept {
    std::array<double, 2 * size - 1> square{};
    for (const auto& part : vector) {
        add_product(square, 1, part, part);
    }
    return square;
}

/// What is known of a polynomial and a limit.
enum class Bound : std::uint8_t {
    kept,    ///< proven: nowhere on [0, 1] above the limit
    broken,  ///< above the limit somewhere, or no number
    open,    ///< so near to the limit, about 1e-10 of the greatest coefficient, that halving does not tell
};

/// The greatest degree that is_at_most() takes.
inline constexpr int max_bernstein_degree = 12;

/// Whether a polynomial is at most `limit` all over [0, 1]. The greatest coefficient within the limit proves it, a
/// value above refutes it; else the interval is halved, at most 20 times (de Casteljau). Allocates nothing.
/// The arithmetic rounds: what is kept may be above the limit by some 1e-14 of the greatest coefficient.
/// @param coefficients of degree 0 to max_bernstein_degree
[[nodiscard]] DOWNWASH_EXPORT Bound is_at_most(std::span<const double> coefficients, double limit) noexcept;

}  // namespace downwash::controllers

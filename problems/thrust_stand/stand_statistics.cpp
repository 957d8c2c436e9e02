#include "downwash/thrust_stand/stand_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace downwash::thrust_stand {
namespace {

constexpr double normal_975 = 1.959963984540054;

/// The 97.5 % quantile of Student's t, by Cornish and Fisher's expansion in 1 / freedom: to 1 % from 4 degrees on, and
/// too narrow below.
double student_975(double freedom) {
    const double z = normal_975, n = freedom;
    return z + (std::pow(z, 3) + z) / (4 * n) + (5 * std::pow(z, 5) + 16 * std::pow(z, 3) + 3 * z) / (96 * n * n) +
           (3 * std::pow(z, 7) + 19 * std::pow(z, 5) + 17 * std::pow(z, 3) - 15 * z) / (384 * n * n * n);
}

/// A quantile of chi-squared (Wilson and Hilferty 1931). @param z that of the normal distribution
double chi_squared(double freedom, double z) {
    const double part = 2 / (9 * freedom);
    return freedom * std::pow(1 - part + z * std::sqrt(part), 3);
}

/// @param freedom below two an interval would say nothing
StandEstimate around(double value, double error, double freedom) {
    constexpr double least_freedom = 2;
    StandEstimate estimate{value, {}, {}};
    if (freedom >= least_freedom) {
        const double half = student_975(freedom) * error;
        estimate.low = value - half;
        estimate.high = value + half;
    }
    return estimate;
}

}  // namespace

StandEstimate ratio_of(const std::vector<std::pair<double, double>>& points) {
    double sum_x = 0, sum_y = 0, squares_x = 0, fourths_x = 0;
    for (const auto& [x, y] : points) {
        sum_x += x;
        sum_y += y;
        squares_x += x * x;
        fourths_x += std::pow(x, 4);
    }
    const double ratio = sum_y / sum_x;
    double squares = 0;
    for (const auto& [x, y] : points) {
        const double leverage = x / sum_x;
        squares += leverage < 1 ? std::pow(y - ratio * x, 2) / (1 - leverage) : 0;
    }
    return around(ratio, std::sqrt(squares) / sum_x, squares_x * squares_x / fourths_x - 1);
}

StandEstimate mean_of(const std::vector<double>& values) {
    const double n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double squares = 0;
    for (const double value : values) {
        squares += (value - mean) * (value - mean);
    }
    return around(mean, std::sqrt(squares / std::max(1.0, n - 1) / n), n - 1);
}

std::optional<StandScatter> scatter_within(const std::vector<std::vector<double>>& groups) {
    constexpr std::size_t least_freedom = 3;
    double squares = 0;
    std::size_t freedom = 0;
    for (const std::vector<double>& group : groups) {
        if (group.empty()) {
            continue;
        }
        const double mean = mean_of(group).value;
        for (const double value : group) {
            squares += (value - mean) * (value - mean);
        }
        freedom += group.size() - 1;
    }
    if (freedom < least_freedom) {
        return std::nullopt;
    }
    const double n = static_cast<double>(freedom);
    return StandScatter{std::sqrt(squares / n), std::sqrt(squares / chi_squared(n, normal_975)),
                        std::sqrt(squares / chi_squared(n, -normal_975)), freedom};
}

}  // namespace downwash::thrust_stand

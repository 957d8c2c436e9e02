#include "downwash/simulation/noise.hpp"

#include <array>
#include <cmath>

#include "downwash/base/portable_math.hpp"

namespace downwash::simulation {
namespace {

constexpr int level_count = 1 << normal_level_bits;

double density(double x) {
    return 0.3989422804014327 * natural_exp(-0.5 * x * x);
}

/// The mean of a standard normal variable between two quantiles is the difference of its densities there over the share
/// of the distribution; what that takes from the variance is given back.
std::array<float, level_count> make_levels() {
    std::array<double, level_count> means{};
    double below = 0;
    double sum_of_squares = 0;
    for (int i = 0; i < level_count; ++i) {
        const bool is_last = i + 1 == level_count;
        const double above = is_last ? 0 : density(normal_quantile((i + 1.0) / level_count));
        means[static_cast<std::size_t>(i)] = (below - above) * level_count;
        sum_of_squares += means[static_cast<std::size_t>(i)] * means[static_cast<std::size_t>(i)];
        below = above;
    }
    const double scale = std::sqrt(level_count / sum_of_squares);
    std::array<float, level_count> levels{};
    for (std::size_t i = 0; i < level_count; ++i) {
        levels[i] = static_cast<float>(scale * means[i]);
    }
    return levels;
}

}  // namespace

const float* normal_levels() noexcept {
    static const std::array<float, level_count> levels = make_levels();
    return levels.data();
}

}  // namespace downwash::simulation

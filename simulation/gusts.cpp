#include "downwash/simulation/gusts.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/base/portable_math.hpp"

namespace downwash::simulation {

GustFilter gust_filter(double ticks) {
    const double a = natural_exp(-ticks);
    return {a, std::sqrt(1 - a * a)};
}

GustPairFilter gust_pair_filter(double ticks) {
    // y1' = -y1 / tau + w, y2' = (y1 - y2) / tau with covariance P = ((2, 1), (1, 1)) / 4; a tick adds P - F P F^T.
    const double b = natural_exp(-ticks);
    const double c = b * ticks;
    GustPairFilter filter{b, c, {}};
    const double q11 = 0.5 - 0.5 * b * b;
    const double q21 = 0.25 - (0.5 * b * c + 0.25 * b * b);
    const double q22 = 0.25 - (0.5 * c * c + 0.5 * b * c + 0.25 * b * b);
    filter.noise[0] = std::sqrt(q11);
    filter.noise[1] = q21 / filter.noise[0];
    filter.noise[2] = std::sqrt(std::max(0.0, q22 - filter.noise[1] * filter.noise[1]));
    return filter;
}

void start_gust_pair(double first, double second, double state[2]) {
    state[0] = std::sqrt(0.5) * first;
    state[1] = std::sqrt(0.125) * (first + second);
}

}  // namespace downwash::simulation

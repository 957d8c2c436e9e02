#include "downwash/effects/pipe_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

/// Half the width of the covered strip in radii.
double half_width(double pipe_radii) {
    return std::min(pipe_radii, 1.0);
}

double covered_share(double pipe_radii) {
    const double m = half_width(pipe_radii);
    return 2 / std::numbers::pi * (std::asin(m) + m * std::sqrt(1 - m * m));
}

}  // namespace

double mean_over_pipe(const EffectTable::Curve& points, double pipe_radii, double z_over_r) {
    // x = m sin(phi) from the axis: smooth up to both ends, so that the midpoint rule converges fast.
    constexpr int steps = 256;
    const double m = half_width(pipe_radii);
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double phi = (i + 0.5) * std::numbers::pi / 2 / steps;
        const double x = m * std::sin(phi);
        const double away = pipe_radii - std::sqrt(std::max(0.0, pipe_radii * pipe_radii - x * x));
        sum += std::sqrt(1 - x * x) * (points(z_over_r + away) - 1) * m * std::cos(phi);
    }
    // Both halves of the strip, chords of length 2 sqrt(1 - x^2), over the area pi.
    return 1 + sum * 4 / std::numbers::pi * (std::numbers::pi / 2 / steps);
}

EffectTable points_of_pipe(const EffectTable& measured, double pipe_radii) {
    constexpr double tolerance = 1e-9;
    constexpr int max_rounds = 500;
    const std::vector<double> z(measured.z_over_r().begin(), measured.z_over_r().end());
    const std::vector<double> d(measured.d_over_r().begin(), measured.d_over_r().end());
    const std::span<const double> wanted = measured.factors();
    const std::size_t columns = std::max<std::size_t>(1, d.size());
    const double share = covered_share(pipe_radii);
    const auto fail = [&](std::size_t i) {
        throw_input_error("no K of points from 0 to 100 has the mean " + to_text(wanted[i]) + " of z_over_r " +
                          to_text(z[i / columns]) + " over a pipe that covers " + to_text(100 * share, 3) +
                          " % of the disc: is the table of this pipe?");
    };
    // A point's K tells on the means of its own row most: correcting each row by its own error converges.
    std::vector<double> points(wanted.begin(), wanted.end());
    double largest = 1;
    for (int round = 0; round < max_rounds && largest > tolerance; ++round) {
        const EffectTable table(z, d, points);
        largest = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double d_over_r = d.empty() ? 0 : d[i % columns];
            const double error = wanted[i] - mean_over_pipe(table.at(d_over_r), pipe_radii, z[i / columns]);
            points[i] += error / share;
            largest = std::max(largest, std::abs(error));
            if (!(points[i] >= 0 && points[i] <= 100)) {
                fail(i);
            }
        }
    }
    if (largest > tolerance) {
        throw_input_error("its rows leap so much that no K of points has them as means over the pipe");
    }
    return {z, d, std::move(points), measured.csv()};
}

}  // namespace downwash

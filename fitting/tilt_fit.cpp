#include "downwash/fitting/tilt_fit.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/effects/effect_table.hpp"
#include "downwash/effects/sided_factor.hpp"

namespace downwash {
namespace {

constexpr double max_loss = 100;  // as in problem files

/// A measurement of a tilted rotor beside the level one's K - 1.
struct TiltedPoint {
    double level_change, sine, thrust_ratio;
    std::string source;

    [[nodiscard]] double error(double loss) const { return 1 + tilted_change(level_change, loss, sine) - thrust_ratio; }
};

using Points = std::vector<TiltedPoint>;

EffectTable level_curve(const std::vector<Measurement>& points) {
    std::map<double, std::pair<double, int>> at;  // sum and count of the ratios at a distance
    for (const Measurement& point : points) {
        if (point.tilt_deg == 0) {
            at[point.z_over_r].first += point.thrust_ratio;
            at[point.z_over_r].second += 1;
        }
    }
    if (at.size() < 2) {
        throw_input_error("a tilt loss needs measurements without tilt at two distances or more: these have " +
                          std::to_string(at.size()));
    }
    std::vector<double> z_over_r;
    std::vector<double> factors;
    for (const auto& [z, ratios] : at) {
        z_over_r.push_back(z);
        factors.push_back(ratios.first / ratios.second);
    }
    return {std::move(z_over_r), {}, std::move(factors)};
}

double sum_of_squares(const Points& points, double loss) {
    double sum = 0;
    for (const TiltedPoint& point : points) {
        sum += point.error(loss) * point.error(loss);
    }
    return sum;
}

double best_loss(const Points& points) {
    // A coarse look first: Brent's method finds the minimum between three points.
    double best = 0;
    for (double loss = 0.001; loss < max_loss; loss *= 1.3) {
        best = sum_of_squares(points, loss) < sum_of_squares(points, best) ? loss : best;
    }
    if (best == 0) {
        return 0;
    }
    constexpr int bits = 24;
    return boost::math::tools::brent_find_minima([&](double loss) { return sum_of_squares(points, loss); }, best / 1.3,
                                                 best * 1.3, bits)
        .first;
}

TiltScore score_of(const Points& points, double loss) {
    TiltScore score{loss, std::sqrt(sum_of_squares(points, loss) / static_cast<double>(points.size())), 0,
                    points.size()};
    for (const TiltedPoint& point : points) {
        score.max_error = std::max(score.max_error, std::abs(point.error(loss)));
    }
    return score;
}

std::optional<double> standard_error(const Points& points, double loss) {
    if (points.size() < 2) {
        return std::nullopt;
    }
    const double step = 1e-4 * std::max(loss, 1e-3);
    double slopes = 0;
    for (const TiltedPoint& point : points) {
        const double slope = (point.error(loss + step) - point.error(loss)) / step;
        slopes += slope * slope;
    }
    return std::sqrt(sum_of_squares(points, loss) / static_cast<double>(points.size() - 1) / slopes);
}

}  // namespace

TiltFit fit_tilt_loss(const Measurements& measurements) {
    const EffectTable level = level_curve(measurements.points);
    const auto source = measurements.index("source");
    Points points;
    for (const Measurement& point : measurements.points) {
        if (point.tilt_deg != 0) {
            points.push_back({level.at()(point.z_over_r) - 1, std::sin(point.tilt_deg * std::numbers::pi / 180),
                              point.thrust_ratio, source ? point.cells[*source] : ""});
        }
    }
    if (points.empty()) {
        throw_input_error(
            "a tilt loss needs measurements of tilted rotors: expected a column tilt_deg with some above 0");
    }
    TiltFit fit;
    const double loss = best_loss(points);
    fit.fitted = score_of(points, loss);
    fit.standard_error = standard_error(points, loss);
    fit.as_level = score_of(points, 0);
    for (const std::string& name : measurements.entries("source")) {
        Points others;
        Points of_source;
        for (const TiltedPoint& point : points) {
            (point.source == name ? of_source : others).push_back(point);
        }
        if (!of_source.empty() && !others.empty()) {
            fit.left_out.emplace_back(name, score_of(of_source, best_loss(others)));
        }
    }
    return fit;
}

}  // namespace downwash

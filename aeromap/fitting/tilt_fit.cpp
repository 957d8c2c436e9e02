#include "downwash/fitting/tilt_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/effects/effect_table.hpp"
#include "downwash/effects/sided_factor.hpp"
#include "downwash/fitting/least_place.hpp"

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

LeastPlace best_loss(const Points& points) {
    return least_place([&](double loss) { return sum_of_squares(points, loss); }, 0, max_loss);
}

TiltScore score_of(const Points& points, const LeastPlace& loss) {
    TiltScore score{loss.at, loss.is_at_bound,
                    std::sqrt(sum_of_squares(points, loss.at) / static_cast<double>(points.size())), 0, points.size()};
    for (const TiltedPoint& point : points) {
        score.max_error = std::max(score.max_error, std::abs(point.error(loss.at)));
    }
    return score;
}

double standard_error(const Points& points, double loss) {
    const double step = 1e-4 * std::max(loss, 1e-3);
    double slopes = 0;
    for (const TiltedPoint& point : points) {
        const double slope = (point.error(loss + step) - point.error(loss)) / step;
        slopes += slope * slope;
    }
    return std::sqrt(sum_of_squares(points, loss) / static_cast<double>(points.size() - 1) / slopes);
}

void require_one_surface(const Measurements& measurements) {
    const std::vector<std::string> surfaces = measurements.entries("surface");
    if (surfaces.size() > 1) {
        const std::vector<std::string_view> names(surfaces.begin(), surfaces.end());
        throw_input_error("a tilt loss is that of one surface: expected only measurements at " +
                          excerpt(joined_names(names)));
    }
}

/// @throws InputError for a tilted rotor nearer or farther than all level ones
void require_level_beside(const Measurement& point, const EffectTable& level) {
    const double nearest = level.z_over_r().front();
    const double farthest = level.z_over_r().back();
    if (point.z_over_r < nearest || point.z_over_r > farthest) {
        throw_input_error("line " + std::to_string(point.line) + " has a tilted rotor at the z_over_r " +
                          to_text(point.z_over_r) + ", and those without tilt are from " + to_text(nearest) + " to " +
                          to_text(farthest) + "; expected tilted rotors within that range");
    }
}

}  // namespace

TiltFit fit_tilt_loss(const Measurements& measurements) {
    require_one_surface(measurements);
    const EffectTable level = level_curve(measurements.points);
    const auto source = measurements.index("source");
    Points points;
    for (const Measurement& point : measurements.points) {
        if (point.tilt_deg != 0) {
            require_level_beside(point, level);
            points.push_back({level.at()(point.z_over_r) - 1, std::sin(point.tilt_deg * std::numbers::pi / 180),
                              point.thrust_ratio, source ? point.cells[*source] : ""});
        }
    }
    if (points.empty()) {
        throw_input_error(
            "a tilt loss needs measurements of tilted rotors: expected a column tilt_deg with some above 0");
    }
    constexpr double min_change = 1e-6;  // of K, which no one measures
    if (std::all_of(points.begin(), points.end(),
                    [](const TiltedPoint& point) { return std::abs(point.level_change) < min_change; })) {
        throw_input_error(
            "a tilt loss needs an effect that fades: without tilt the thrust ratio is 1 at every tilted rotor");
    }
    TiltFit fit;
    const LeastPlace loss = best_loss(points);
    fit.fitted = score_of(points, loss);
    if (points.size() > 1 && !loss.is_at_bound) {
        fit.standard_error = standard_error(points, loss.at);
    }
    fit.as_level = score_of(points, {});
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

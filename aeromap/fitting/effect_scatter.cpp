#include "downwash/fitting/effect_scatter.hpp"

#include <cmath>

#include "downwash/base/infinity.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/fitting/effect_comparison.hpp"

namespace downwash {
namespace {

/// @param points all of a surface
RelativeScatter scatter_between(double z_low, double z_high, const std::vector<Measurement>& points,
                                const SurfaceEffect& effect, const RotorNeighbours& neighbours, double max_factor) {
    RelativeScatter scatter{z_low, z_high, 0, 0, 0};
    double xx = 0;
    double ex = 0;
    double ee = 0;
    for (const Measurement& point : points) {
        if (point.z_over_r >= z_low && point.z_over_r < z_high) {
            const double k = lane::clamp(formula_factor(effect, point.z_over_r, neighbours), 1.0, max_factor);
            const double e = point.thrust_ratio - k;
            xx += (k - 1) * (k - 1);
            ex += e * (k - 1);
            ee += e * e;
            ++scatter.points;
        }
    }
    if (xx > 0) {
        scatter.bias = ex / xx;
        scatter.scatter = std::sqrt(std::max(0.0, ee - ex * ex / xx) / xx);
    }
    return scatter;
}

}  // namespace

std::vector<EffectScatter> effect_scatter(const std::vector<Measurements>& data, const RotorNeighbours& neighbours,
                                          double max_factor) {
    std::vector<EffectScatter> all;
    for (const std::string surface : {"ground", "ceiling"}) {
        std::vector<Measurement> points;
        for (const Measurements& measurements : data) {
            for (const Measurement& point : measurements.with("surface", surface).points) {
                if (point.tilt_deg == 0) {
                    points.push_back(point);
                }
            }
        }
        for (const EffectModelInfo& model : effect_models()) {
            if (points.empty() || model.model == EffectModel::none || !is_comparable(model, surface, neighbours)) {
                continue;
            }
            EffectScatter scatter{model.model, surface, {}, {}};
            const auto between = [&](double z_low, double z_high) {
                return scatter_between(z_low, z_high, points, model.model, neighbours, max_factor);
            };
            for (std::size_t i = 0; i + 1 < error_band_edges.size(); ++i) {
                scatter.bands.push_back(between(error_band_edges[i], error_band_edges[i + 1]));
            }
            scatter.all = between(scatter_from_z_over_r, infinity);
            all.push_back(std::move(scatter));
        }
    }
    return all;
}

}  // namespace downwash

#include "downwash/fitting/effect_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/effects/sided_factor.hpp"
#include "downwash/fitting/effect_fit.hpp"

namespace downwash {
namespace {

/// The level measurements of one source at one surface, or those at one tilt.
struct DataSet {
    std::string source, surface;
    double tilt_deg;
    std::vector<Measurement> points;
};

/// What flights take for the tilt loss of a surface.
double tilt_loss_of(const std::string& surface) {
    return surface == "ground" ? default_ground_tilt_loss : 0;
}

double rmse_of(const SurfaceEffect& effect, const std::vector<Measurement>& points, const RotorNeighbours& neighbours,
               double max_factor) {
    double squares = 0;
    for (const Measurement& point : points) {
        const double factor = lane::clamp(formula_factor(effect, point.z_over_r, neighbours), 1.0, max_factor);
        squares += (factor - point.thrust_ratio) * (factor - point.thrust_ratio);
    }
    return std::sqrt(squares / static_cast<double>(points.size()));
}

ModelScore score_of(const SurfaceEffect& effect, bool is_refitted, const DataSet& set,
                    const RotorNeighbours& neighbours, double max_factor) {
    ModelScore score;
    score.effect = effect;
    score.is_refitted = is_refitted;
    for (std::size_t i = 0; i + 1 < error_band_edges.size(); ++i) {
        score.bands.push_back({error_band_edges[i], error_band_edges[i + 1], 0, 0});
    }
    const double sine = std::sin(set.tilt_deg * std::numbers::pi / 180);
    double squares = 0;
    for (const Measurement& point : set.points) {
        const double level = lane::clamp(formula_factor(effect, point.z_over_r, neighbours), 1.0, max_factor);
        const double error = 1 + tilted_change(level - 1, tilt_loss_of(set.surface), sine) - point.thrust_ratio;
        squares += error * error;
        const auto band = std::find_if(score.bands.begin(), score.bands.end(),
                                       [&point](const ErrorBand& b) { return point.z_over_r < b.z_high; });
        band->points += 1;
        band->mean_error += error;
    }
    score.rmse = std::sqrt(squares / static_cast<double>(set.points.size()));
    score.level_rmse = rmse_of(effect, set.points, neighbours, max_factor);
    for (ErrorBand& band : score.bands) {
        band.mean_error /= static_cast<double>(std::max<std::size_t>(1, band.points));
    }
    return score;
}

/// @param others all level measurements of other sources at the surface
DataSetComparison compare(const DataSet& set, const std::vector<Measurement>& others, const RotorNeighbours& neighbours,
                          double max_factor) {
    DataSetComparison comparison{set.source, set.surface, set.tilt_deg, set.points.size(), 0, 0, {}};
    const auto [nearest, farthest] =
        std::minmax_element(set.points.begin(), set.points.end(),
                            [](const Measurement& a, const Measurement& b) { return a.z_over_r < b.z_over_r; });
    comparison.z_low = nearest->z_over_r;
    comparison.z_high = farthest->z_over_r;
    FitOptions options;
    options.neighbours = neighbours;
    for (const EffectModelInfo& model : effect_models()) {
        if (!is_comparable(model, set.surface, neighbours)) {
            continue;
        }
        comparison.scores.push_back(score_of(model.model, false, set, neighbours, max_factor));
        if (model.parameters.empty() || set.tilt_deg != 0) {
            continue;  // parameters are those of level rotors
        }
        try {
            const EffectFit fit = fit_effect(model.model, set.points, options);
            comparison.scores.push_back(score_of(fit.effect, true, set, neighbours, max_factor));
            ModelScore& refitted = comparison.scores.back();
            refitted.is_at_bound = std::any_of(fit.parameters.begin(), fit.parameters.end(),
                                               [](const FittedParameter& parameter) { return parameter.is_at_bound; });
            if (!others.empty()) {
                refitted.others_rmse = rmse_of(fit.effect, others, neighbours, max_factor);
            }
        } catch (const InputError&) {
            // Too few distances, or too near for the formula: there is no refit.
        }
    }
    return comparison;
}

/// In the order of their first appearance.
std::vector<DataSet> data_sets(const std::vector<Measurements>& data) {
    constexpr std::size_t max_sets = 100;
    std::vector<DataSet> sets;
    for (const Measurements& measurements : data) {
        const auto source = measurements.index("source");
        const auto surface = measurements.index("surface");
        for (const Measurement& point : measurements.points) {
            const DataSet key{
                source ? point.cells[*source] : "", surface ? point.cells[*surface] : "", point.tilt_deg, {}};
            auto set = std::find_if(sets.begin(), sets.end(), [&key](const DataSet& known) {
                return known.source == key.source && known.surface == key.surface && known.tilt_deg == key.tilt_deg;
            });
            if (set == sets.end()) {
                if (sets.size() == max_sets) {
                    throw_input_error("the measurements have more than " + std::to_string(max_sets) +
                                      " sources, surfaces and tilts; expected some of them");
                }
                if (const auto error = surface_error(key.surface)) {
                    throw_input_error("line " + std::to_string(point.line) + " of the measurements " + *error);
                }
                set = sets.insert(set, key);
            }
            set->points.push_back(point);
        }
    }
    return sets;
}

}  // namespace

bool is_comparable(const EffectModelInfo& model, const std::string& surface, const RotorNeighbours& neighbours) {
    const bool is_for_surface = surface.empty() || model.surface == "any" || model.surface == surface;
    return model.model != EffectModel::table && is_for_surface &&
           (!is_multirotor(model.model) || neighbours.rotors() > 1);
}

std::vector<DataSetComparison> compare_effects(const std::vector<Measurements>& data, const RotorNeighbours& neighbours,
                                               double max_factor) {
    const std::vector<DataSet> sets = data_sets(data);
    std::vector<DataSetComparison> comparisons;
    for (const DataSet& set : sets) {
        std::vector<Measurement> others;
        for (const DataSet& other : sets) {
            if (other.source != set.source && other.surface == set.surface && other.tilt_deg == 0) {
                others.insert(others.end(), other.points.begin(), other.points.end());
            }
        }
        comparisons.push_back(compare(set, others, neighbours, max_factor));
    }
    return comparisons;
}

}  // namespace downwash

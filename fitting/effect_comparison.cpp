#include "downwash/fitting/effect_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/fitting/effect_fit.hpp"

namespace downwash {
namespace {

constexpr std::array band_edges{0.0, 0.5, 1.0, 2.0, std::numeric_limits<double>::infinity()};

ModelScore score_of(const SurfaceEffect& effect, bool is_refitted, const std::vector<Measurement>& points,
                    const RotorNeighbours& neighbours, double max_factor) {
    ModelScore score{effect, is_refitted, false, 0, {}};
    for (std::size_t i = 0; i + 1 < band_edges.size(); ++i) {
        score.bands.push_back({band_edges[i], band_edges[i + 1], 0, 0});
    }
    double squares = 0;
    for (const Measurement& point : points) {
        const double factor = lane::clamp(formula_factor(effect, point.z_over_r, neighbours), 1.0, max_factor);
        const double error = factor - point.thrust_ratio;
        squares += error * error;
        const auto band = std::find_if(score.bands.begin(), score.bands.end(),
                                       [&point](const ErrorBand& b) { return point.z_over_r < b.z_high; });
        band->points += 1;
        band->mean_error += error;
    }
    score.rmse = std::sqrt(squares / static_cast<double>(points.size()));
    for (ErrorBand& band : score.bands) {
        band.mean_error /= static_cast<double>(std::max<std::size_t>(1, band.points));
    }
    return score;
}

bool is_comparable(const EffectModelInfo& model, const std::string& surface, const RotorNeighbours& neighbours) {
    const bool is_for_surface = surface.empty() || model.surface == "any" || model.surface == surface;
    return model.model != EffectModel::table && is_for_surface &&
           (!is_multirotor(model.model) || neighbours.rotors() > 1);
}

DataSetComparison compare(const std::string& source, const std::string& surface, const std::vector<Measurement>& points,
                          const RotorNeighbours& neighbours, double max_factor) {
    DataSetComparison comparison{source, surface, points.size(), 0, 0, {}};
    const auto [nearest, farthest] =
        std::minmax_element(points.begin(), points.end(),
                            [](const Measurement& a, const Measurement& b) { return a.z_over_r < b.z_over_r; });
    comparison.z_low = nearest->z_over_r;
    comparison.z_high = farthest->z_over_r;
    FitOptions options;
    options.neighbours = neighbours;
    for (const EffectModelInfo& model : effect_models()) {
        if (!is_comparable(model, surface, neighbours)) {
            continue;
        }
        comparison.scores.push_back(score_of(model.model, false, points, neighbours, max_factor));
        if (model.parameters.empty()) {
            continue;
        }
        try {
            const EffectFit fit = fit_effect(model.model, points, options);
            comparison.scores.push_back(score_of(fit.effect, true, points, neighbours, max_factor));
            comparison.scores.back().is_at_bound =
                std::any_of(fit.parameters.begin(), fit.parameters.end(),
                            [](const FittedParameter& parameter) { return parameter.is_at_bound; });
        } catch (const InputError&) {
            // Too few distances, or too near for the formula: there is no refit.
        }
    }
    return comparison;
}

/// Measurements of one source at one surface, in the order of their first appearance.
using DataSets = std::vector<std::pair<std::pair<std::string, std::string>, std::vector<Measurement>>>;

/// @throws InputError for a surface that no model was made for
void require_known_surface(const std::string& surface, std::size_t line) {
    const std::vector<std::string_view> known{"ground", "ceiling"};
    if (!surface.empty() && std::find(known.begin(), known.end(), surface) == known.end()) {
        throw_input_error("line " + std::to_string(line) + " of the measurements has the surface '" + excerpt(surface) +
                          "'; expected ground or ceiling" + did_you_mean(surface, known));
    }
}

DataSets data_sets(const Measurements& measurements) {
    constexpr std::size_t max_sets = 100;
    DataSets sets;
    const auto source = measurements.index("source");
    const auto surface = measurements.index("surface");
    for (const Measurement& point : measurements.points) {
        const std::pair key(source ? point.cells[*source] : "", surface ? point.cells[*surface] : "");
        auto set = std::find_if(sets.begin(), sets.end(), [&key](const auto& known) { return known.first == key; });
        if (set == sets.end()) {
            if (sets.size() == max_sets) {
                throw_input_error("the measurements have more than " + std::to_string(max_sets) +
                                  " sources and surfaces; expected some of them");
            }
            require_known_surface(key.second, point.line);
            set = sets.insert(set, {key, {}});
        }
        set->second.push_back(point);
    }
    return sets;
}

}  // namespace

std::vector<DataSetComparison> compare_effects(const Measurements& measurements, const RotorNeighbours& neighbours,
                                               double max_factor) {
    std::vector<DataSetComparison> comparisons;
    for (const auto& [key, points] : data_sets(measurements)) {
        comparisons.push_back(compare(key.first, key.second, points, neighbours, max_factor));
    }
    return comparisons;
}

}  // namespace downwash

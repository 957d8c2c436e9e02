#include "downwash/aeromap/grid_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/base/text.hpp"
#include "downwash/base/version.hpp"

namespace downwash {
namespace {

GridAxis axis_over(double low_m, double high_m, double step_m, const char* name) {
    if (!(std::isfinite(low_m) && std::isfinite(high_m) && low_m < high_m && step_m > 0)) {
        throw_input_error(std::string("the axis ") + name + " of a grid runs from " + to_text(low_m, 6) + " to " +
                          to_text(high_m, 6) + " m in steps of " + to_text(step_m, 6) +
                          " m: expected the lower end first and steps above 0");
    }
    const double steps = std::max(1.0, std::ceil((high_m - low_m) / step_m - 1e-9));
    if (!(steps < static_cast<double>(max_grid_nodes))) {
        throw_input_error("a grid in steps of " + to_text(step_m, 6) + " m has " + to_text(steps, 3) + " nodes along " +
                          name + ", more than the " + std::to_string(max_grid_nodes) +
                          " that are possible: choose a larger step or smaller bounds");
    }
    return {low_m, high_m, static_cast<std::size_t>(steps) + 1};
}

void require_storable(const FactorGridParts& parts, std::size_t layers) {
    const double nodes = static_cast<double>(parts.x.count) * static_cast<double>(parts.y.count) *
                         static_cast<double>(parts.z.count) * static_cast<double>(layers);
    if (nodes > static_cast<double>(max_grid_nodes)) {
        throw_input_error("a grid of " + to_text(nodes, 3) + " nodes is more than the " +
                          std::to_string(max_grid_nodes) +
                          " that are possible: choose a larger step, smaller bounds or one rotor");
    }
}

/// Fills the fields; `layer_at(l, j)` gives the effect and lateral offset of node (., j, .) in layer l.
template <class LayerAt>
FactorGrid sampled(FactorGridParts parts, std::size_t layers, const GridSampling& sampling, const LayerAt& layer_at) {
    require_storable(parts, layers);
    const std::size_t columns = parts.x.count;
    const std::size_t rows = layers * parts.z.count * parts.y.count;
    parts.fields = {{"factor", {}}, {"flyable", {}}, {"ground", {}}, {"ceiling", {}}};
    for (GridField& field : parts.fields) {
        field.values.resize(rows * columns);
    }
    run_parallel(
        rows, sampling.threads,
        [&](std::size_t row) {
            const std::size_t j = row % parts.y.count;
            const std::size_t k = row / parts.y.count % parts.z.count;
            const auto [effect, lateral_m] = layer_at(row / (parts.y.count * parts.z.count), j);
            for (std::size_t i = 0; i < columns; ++i) {
                const Vector3 hub_m = parts.frame.to_world(parts.x.at(i), lateral_m, parts.z.at(k));
                const DirectEffect::Factors factors = effect->factors(hub_m);
                const std::size_t node = row * columns + i;
                parts.fields[0].values[node] = factors.total;
                parts.fields[1].values[node] = effect->is_flyable(hub_m) ? 1 : 0;
                parts.fields[2].values[node] = factors.ground;
                parts.fields[3].values[node] = factors.ceiling;
            }
        },
        sampling.on_progress);
    if (std::isnan(parts.fields[2].values.front())) {  // a given map knows no sides
        parts.fields.resize(2);
    }
    return FactorGrid(std::move(parts));
}

FactorGridParts parts_over(const GridSampling& sampling, const Provenance& provenance) {
    const Bounds& extent = sampling.extent;
    FactorGridParts parts;
    parts.frame = sampling.plane;
    parts.x = axis_over(extent.x_low_m, extent.x_high_m, sampling.step_m, "x");
    parts.z = axis_over(extent.z_low_m, extent.z_high_m, sampling.step_m, "z");
    parts.provenance = provenance;
    return parts;
}

std::string described(const SurfaceEffect& effect) {
    const EffectModelInfo& model = info(effect.model);
    std::string text(model.name);
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
        text += (i == 0 ? " (" : ", ") + std::string(model.parameters[i].name) + " " + to_text(effect.parameters[i]);
    }
    text += model.parameters.empty() ? "" : ")";
    return text + "; " + std::string(model.source);
}

}  // namespace

FactorGrid sample_planes(std::vector<MapLayer> layers, const GridSampling& sampling, const Provenance& provenance) {
    std::sort(layers.begin(), layers.end(),
              [](const MapLayer& a, const MapLayer& b) { return a.lateral_m < b.lateral_m; });
    FactorGridParts parts = parts_over(sampling, provenance);
    for (const MapLayer& layer : layers) {
        if (!parts.lateral_offsets_m.empty() && parts.lateral_offsets_m.back() == layer.lateral_m) {
            throw_input_error(
                "two rotors " + to_text(layer.lateral_m, 6) +
                " m beside the plane feel different effects, as their neighbours differ: choose one rotor");
        }
        parts.lateral_offsets_m.push_back(layer.lateral_m);
    }
    return sampled(std::move(parts), layers.size(), sampling, [&](std::size_t layer, std::size_t) {
        return std::pair(layers[layer].effect.get(), layers[layer].lateral_m);
    });
}

FactorGrid sample_volume(const DirectEffect& effect, double lateral_low_m, double lateral_high_m,
                         const GridSampling& sampling, const Provenance& provenance) {
    FactorGridParts parts = parts_over(sampling, provenance);
    parts.y = axis_over(lateral_low_m, lateral_high_m, sampling.step_m, "y");
    const GridAxis y = parts.y;
    return sampled(std::move(parts), 1, sampling,
                   [&](std::size_t, std::size_t j) { return std::pair(&effect, y.at(j)); });
}

Provenance provenance_of(const DirectEffect& effect) {
    const AeroSettings& settings = effect.settings();
    Provenance provenance{{"program", "downwash " + std::string(version())},
                          {"quantity", "factor on a rotor's free-air thrust at constant command; lengths in m"},
                          {"rotor_radius_m", to_text(effect.rotor_radius_m())}};
    if (settings.map) {
        provenance.emplace_back("map", "sampled from a given grid");
    } else {
        provenance.emplace_back("ground", described(effect.ground().effect()));
        provenance.emplace_back("ceiling", described(effect.ceiling().effect()));
        provenance.emplace_back("max_factor", to_text(settings.max_factor));
    }
    provenance.emplace_back("min_distance_radii", to_text(settings.min_distance_radii));
    return provenance;
}

}  // namespace downwash

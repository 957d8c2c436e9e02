#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "downwash/base/text.hpp"
#include "downwash/cli/plot_request.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::cli {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The effects that a picture is to show: all, or those of one side.
AeroSettings shown_settings(const PlotRequest& request, AeroSettings aero) {
    if (request.what != "factor" && aero.map) {
        throw UsageError("--what " + request.what + ": the problem's factors come from a map, which does not tell " +
                         "ground from ceiling; expected --what factor");
    }
    if (request.what == "ground") {
        aero.ceiling = SurfaceEffect{};
    } else if (request.what == "ceiling") {
        aero.ground = SurfaceEffect{};
    }
    return aero;
}

MapLayer shown_layer(const PlotRequest& request, const Problem& problem, const std::shared_ptr<const Scene>& scene) {
    const int rotors = static_cast<int>(problem.robot.rotors.positions_m.size());
    if (request.rotor < 1 || request.rotor > rotors) {
        throw UsageError(fmt::format("--rotor {}: expected 1 to {}, as the robot has them", request.rotor, rotors));
    }
    const EffectLayers layers = effect_layers(problem.robot.rotors, scene, shown_settings(request, problem.aero));
    MapLayer layer = layers.layers[layers.layer_of[static_cast<std::size_t>(request.rotor) - 1]];
    layer.lateral_m = request.lateral_m.value_or(layer.lateral_m);
    return layer;
}

std::string place_text(double lateral_m) {
    if (lateral_m == 0) {
        return "in the plane of motion";
    }
    return fmt::format("{} m {} of the plane of motion", to_text(std::abs(lateral_m), 4),
                       lateral_m > 0 ? "left" : "right");
}

std::string model_text(const PlotRequest& request, const AeroSettings& aero) {
    if (!aero.enabled) {
        return "surface effects switched off";
    }
    if (aero.map) {
        return "factors from a map";
    }
    const std::string ground = fmt::format("ground: {}", info(aero.ground.model).name);
    const std::string ceiling = fmt::format("ceiling: {}", info(aero.ceiling.model).name);
    if (request.what == "factor") {
        return ground + ", " + ceiling;
    }
    return request.what == "ground" ? ground : ceiling;
}

/// K at (x, z) of a layer: from a map where that is the quicker way, else evaluated directly.
std::function<double(double, double)> field_of(const MapLayer& layer, const PlaneOfMotion& plane,
                                               const Bounds& extent) {
    constexpr double most_cells = 2e6;
    if (map_cells({layer}, extent) <= most_cells) {
        const auto map = std::make_shared<const AeroMap>(std::vector{layer}, plane, extent);
        return [map](double x_m, double z_m) { return map->is_flyable(0, x_m, z_m) ? map->factor(0, x_m, z_m) : nan; };
    }
    return [layer, plane](double x_m, double z_m) {
        const Vector3 hub_m = plane.to_world(x_m, layer.lateral_m, z_m);
        return layer.effect->is_flyable(hub_m) ? layer.effect->factor(hub_m) : nan;
    };
}

/// The least and the greatest value of a field, as far as some points tell.
AxisRange range_of(const std::function<double(double, double)>& field, const Bounds& extent) {
    constexpr int points = 400;  // each way
    AxisRange range{1, 1};
    for (int k = 0; k < points; ++k) {
        for (int i = 0; i < points; ++i) {
            const auto along = [](double low, double high, int at) { return low + (high - low) * (at + 0.5) / points; };
            const double value =
                field(along(extent.x_low_m, extent.x_high_m, i), along(extent.z_low_m, extent.z_high_m, k));
            if (!std::isnan(value)) {
                range = {std::min(range.low, value), std::max(range.high, value)};
            }
        }
    }
    return range;
}

}  // namespace

std::string undefined_name(const Problem& problem) {
    return problem.aero.map ? "not flyable, or outside the given map" : "not flyable";
}

FieldFigure factor_figure(const PlotRequest& request, const Problem& problem, const Bounds& extent) {
    const auto scene = std::make_shared<const Scene>(problem.obstacles);
    const MapLayer layer = shown_layer(request, problem, scene);
    FieldFigure figure;
    const std::string side = request.what == "factor" ? "" : " (" + request.what + " only)";
    figure.title = fmt::format("{}: factor K on the thrust of rotor {}{}", problem.name, request.rotor, side);
    figure.subtitle = fmt::format("rotor hub {}; {}", place_text(layer.lateral_m), model_text(request, problem.aero));
    figure.extent = extent;
    figure.undefined_name = undefined_name(problem);
    figure.value = field_of(layer, problem.plane, extent);
    const AxisRange range = range_of(figure.value, extent);
    figure.scale = factor_scale("K, thrust over that in free air at the same command [1]", range.low, range.high);
    figure.obstacles = obstacle_outlines(*scene, problem.plane, layer.lateral_m);
    return figure;
}

}  // namespace downwash::cli

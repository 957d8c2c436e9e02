#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <memory>

#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/plot_request.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::cli {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The effects that a picture shows: all, or those of one side.
AeroSettings shown_settings(const PlotRequest& request, AeroSettings aero) {
    if (request.what != "factor" && aero.map) {
        throw UsageError("--what " + request.what +
                         ": the problem's factors come from a map, which does not distinguish " +
                         "ground and ceiling; expected --what factor");
    }
    if (request.what == "ground") {
        aero.ceiling = SurfaceEffect{};
    } else if (request.what == "ceiling") {
        aero.ground = SurfaceEffect{};
    }
    return aero;
}

MapLayer shown_layer(const PlotRequest& request, const Problem& problem, const std::shared_ptr<const Scene>& scene) {
    const int rotor = rotor_option(request.rotor, static_cast<int>(problem.robot.rotors.positions_m.size()));
    const EffectLayers layers = effect_layers(problem.robot.rotors, scene, shown_settings(request, problem.aero));
    MapLayer layer = layers.layers[layers.layer_of[static_cast<std::size_t>(rotor)]];
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

/// K at (x, z) of a layer: from a map if that is faster, otherwise evaluated directly.
std::function<double(double, double)> field_of(const MapLayer& layer, const PlaneOfMotion& plane,
                                               const Bounds& extent) {
    constexpr double max_cells = 2e6;
    if (map_cells({layer}, extent) <= max_cells) {
        const auto map = std::make_shared<const AeroMap>(std::vector{layer}, plane, extent);
        return [map](double x_m, double z_m) { return map->is_flyable(0, x_m, z_m) ? map->factor(0, x_m, z_m) : nan; };
    }
    return [layer, plane](double x_m, double z_m) {
        const Vector3 hub_m = plane.to_world(x_m, layer.lateral_m, z_m);
        return layer.effect->is_flyable(hub_m) ? layer.effect->factor(hub_m) : nan;
    };
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
    constexpr int steps = 400;
    const AxisRange range = value_range(figure.value, extent, steps, 1);
    figure.scale = factor_scale("K, thrust over that in free air at the same command [1]", range.low, range.high);
    figure.obstacles = obstacle_outlines(*scene, problem.plane, layer.lateral_m);
    return figure;
}

}  // namespace downwash::cli

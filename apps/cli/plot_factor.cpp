#include <fmt/core.h>

#include <cmath>
#include <memory>

#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/plot_request.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/report/factor_field.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::cli {
namespace {

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
    const EffectLayers layers =
        effect_layers(problem.robot.rotors, scene, shown_settings(request, problem.aero), problem.plane.heading_rad());
    MapLayer layer = layers.layers[layers.of_rotor[static_cast<std::size_t>(rotor)]];
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
    figure.value = factor_field(layer, problem.plane);
    figure.scale = factor_scale("K, thrust over that in free air at the same command [1]",
                                factor_range(figure, rotor_extent(problem.robot.rotors, problem.bounds)));
    figure.obstacles = obstacle_outlines(*scene, problem.plane, layer.lateral_m);
    return figure;
}

}  // namespace downwash::cli

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "downwash/base/angles.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/plot_request.hpp"
#include "downwash/cli/vehicle_table.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/report/factor_field.hpp"
#include "downwash/simulation/hold_map.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

namespace downwash::cli {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// A figure of the whole vehicle, without a field.
FieldFigure vehicle_figure(const Problem& problem, const FlightModel& model, const Bounds& extent, std::string title,
                           const std::string& attitude) {
    FieldFigure figure;
    figure.title = std::move(title);
    figure.subtitle = fmt::format("{}, {}{}", problem.name, problem.robot.name, attitude);
    figure.x_label = "x of the centre of mass [m]";
    figure.z_label = "z of the centre of mass [m]";
    figure.extent = extent;
    figure.undefined_name = undefined_name(problem);
    figure.obstacles = obstacle_outlines(model.effect(0).scene(), model.plane(), 0);
    return figure;
}

/// A figure of one of the effects on the vehicle at the pitch asked for, without a scale.
FieldFigure effect_figure(const PlotRequest& request, const Problem& problem,
                          const std::shared_ptr<const FlightModel>& model, const Bounds& extent, std::string title,
                          double VehicleEffect::*effect) {
    const double pitch_rad = pitch_option(request.pitch_deg);
    const std::string attitude =
        pitch_rad == 0 ? ", level"
                       : fmt::format(", pitched {:.6g} degrees nose {}", std::abs(pitch_rad) * degrees_per_radian,
                                     pitch_rad > 0 ? "down" : "up");
    FieldFigure figure = vehicle_figure(problem, *model, extent, std::move(title), attitude);
    figure.value = [=](double x_m, double z_m) {
        const PlanarPose pose{x_m, z_m, pitch_rad, 0};
        return is_flyable(*model, pose) ? vehicle_effect(*model, pose).*effect : undefined;
    };
    return figure;
}

/// The maximum size of a field over its extent.
double max_size(const FieldFigure& figure) {
    constexpr int steps = 120;
    const AxisRange range = value_range(figure.value, figure.extent, steps, 0);
    return std::max(-range.low, range.high);
}

/// The bounds of the centre of mass, cut to the shown part of the plane.
FigureLines bounds_lines(const Bounds& bounds, const Bounds& shown) {
    FigureLines lines{"bounds of the problem", {}, {40, 40, 40}, 1.5, LineDash::dashed, false};
    const double x_low_m = std::max(bounds.x_low_m, shown.x_low_m),
                 x_high_m = std::min(bounds.x_high_m, shown.x_high_m);
    const double z_low_m = std::max(bounds.z_low_m, shown.z_low_m),
                 z_high_m = std::min(bounds.z_high_m, shown.z_high_m);
    if (x_low_m < x_high_m && z_low_m < z_high_m) {
        lines.pieces.push_back(
            {{x_low_m, z_low_m}, {x_high_m, z_low_m}, {x_high_m, z_high_m}, {x_low_m, z_high_m}, {x_low_m, z_low_m}});
    }
    return lines;
}

/// The number of a verdict on the scale of hold_figure(); a place that is not flyable has none.
double kind_of(HoldVerdict verdict) {
    return verdict == HoldVerdict::not_flyable
               ? undefined
               : static_cast<double>(verdict) - static_cast<double>(HoldVerdict::in_collision);
}

/// The verdict at a point: that of the nodes around it where they agree, else its own.
HoldVerdict verdict_at(const FlightModel& model, const HoldMap& map, double x_m, double z_m) {
    const auto cell = [&map](double at_m, double low_m, std::size_t nodes) {
        const double last = static_cast<double>(nodes) - 2;
        return static_cast<std::size_t>(std::clamp(std::floor((at_m - low_m) / map.step_m), 0.0, std::max(0.0, last)));
    };
    const std::size_t i = cell(x_m, map.x_low_m, map.columns);
    const std::size_t k = cell(z_m, map.z_low_m, map.rows);
    const HoldVerdict verdict = map.verdicts[k * map.columns + i];
    for (const std::size_t row : {k, std::min(k + 1, map.rows - 1)}) {
        for (const std::size_t column : {i, std::min(i + 1, map.columns - 1)}) {
            if (map.verdicts[row * map.columns + column] != verdict) {
                return analyse_hover(model, x_m, z_m, map.arm_rad).verdict;
            }
        }
    }
    return verdict;
}

}  // namespace

FieldFigure force_figure(const PlotRequest& request, const Problem& problem, const Bounds& extent) {
    FieldFigure figure = effect_figure(request, problem, make_flight_model(problem), extent,
                                       "Thrust of the whole vehicle at constant command", &VehicleEffect::force_factor);
    figure.scale = factor_scale("force factor", factor_range(figure, problem.bounds));
    return figure;
}

FieldFigure torque_figure(const PlotRequest& request, const Problem& problem, const Bounds& extent) {
    const auto model = make_flight_model(problem);
    FieldFigure figure =
        effect_figure(request, problem, model, extent, "Parasitic pitch torque at hover commands, positive nose down",
                      &VehicleEffect::pitch_torque_nm);
    figure.subtitle += fmt::format("; its factor is that over m g R = {:.4g} Nm", weight_times_radius_nm(*model));
    figure.scale = signed_scale("pitch torque [Nm]", std::max(max_size(figure), 1e-3));
    return figure;
}

FieldFigure hold_figure(const PlotRequest& request, const Problem& problem, const Bounds& extent) {
    constexpr double cells_across = 240;
    const double arm_rad = arm_option(request.arm_deg, problem);
    const auto model = make_flight_model(problem);
    FieldFigure figure =
        vehicle_figure(problem, *model, extent,
                       fmt::format("Can it hover here? Arm at {:.6g} degrees", arm_rad * degrees_per_radian), "");
    const double width_m = std::max(extent.x_high_m - extent.x_low_m, extent.z_high_m - extent.z_low_m);
    const auto map = std::make_shared<const HoldMap>(
        make_hold_map(*model, {extent.x_low_m, extent.x_high_m, extent.z_low_m, extent.z_high_m},
                      width_m / cells_across, arm_rad, default_threads()));
    figure.value = [model, map](double x_m, double z_m) { return kind_of(verdict_at(*model, *map, x_m, z_m)); };
    figure.scale =
        scale_of_kinds("hover", {"in collision", "no equilibrium", "unstable", "unknown: beyond the model", "stable"},
                       {{190, 190, 190}, {117, 72, 144}, {222, 119, 96}, {250, 222, 140}, {196, 226, 190}});
    figure.has_contour_lines = false;
    figure.lines.push_back(bounds_lines(problem.bounds, extent));
    FigureLines boundary{"stability boundary", {}, {140, 20, 20}, 2.5, LineDash::solid, false};
    for (const std::vector<HoldPoint>& line : stability_boundary(*model, *map)) {
        std::vector<PlanePoint>& piece = boundary.pieces.emplace_back();
        std::transform(line.begin(), line.end(), std::back_inserter(piece), [](const HoldPoint& at) {
            return PlanePoint{at.x_m, at.z_m};
        });
    }
    figure.lines.push_back(std::move(boundary));
    return figure;
}

}  // namespace downwash::cli

#include "downwash/report/run_figures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "downwash/base/angles.hpp"
#include "downwash/report/factor_field.hpp"
#include "downwash/report/figure_colors.hpp"
#include "downwash/report/flight_diagrams.hpp"
#include "downwash/report/obstacle_outline.hpp"
#include "downwash/report/plane_drawing.hpp"

namespace downwash {
namespace {

Ring way(const std::vector<double>& x_m, const std::vector<double>& z_m) {
    Ring points;
    for (std::size_t i = 0; i < x_m.size(); ++i) {
        points.push_back({x_m[i], z_m[i]});
    }
    return points;
}

/// The path of the reference without the final hover.
Ring planned_way(const RunRecord& run) {
    Ring points;
    if (!run.plan) {
        return points;
    }
    const auto add = [&points](const ReferencePoint& at) { points.push_back({at.position[0], at.position[1]}); };
    constexpr std::int64_t pieces = 50;  // of a segment
    for (const ReferenceSegment& segment : run.plan->segments()) {
        for (std::int64_t piece = 0; piece < pieces; ++piece) {
            add(segment.at_tick(segment.ticks() * piece / pieces));
        }
    }
    add(run.plan->reference.back().point);
    return points;
}

/// The extent of plan and flight, with a margin.
Bounds shown_extent(const RunRecord& run, const FlightColumns& flight) {
    const double room_m = 1.2 * run.problem.robot.arm.length_m;
    Bounds extent{HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};
    const auto include = [&](const std::vector<double>& x_m, const std::vector<double>& z_m) {
        for (std::size_t i = 0; i < x_m.size(); ++i) {
            extent.x_low_m = std::min(extent.x_low_m, x_m[i] - room_m);
            extent.x_high_m = std::max(extent.x_high_m, x_m[i] + room_m);
            extent.z_low_m = std::min(extent.z_low_m, z_m[i] - room_m);
            extent.z_high_m = std::max(extent.z_high_m, z_m[i] + room_m);
        }
    };
    for (const PlanePoint& point : planned_way(run)) {
        include({point.x_m}, {point.z_m});
    }
    include(flight["x_m"], flight["z_m"]);
    include(flight["ee_x_m"], flight["ee_z_m"]);
    widen_to_scale(extent);
    return extent;
}

}  // namespace

FieldFigure snapshot_figure(const RunRecord& run, const FlightModel& model) {
    require_flight(run.flight);
    const FlightColumns flight{run.flight};
    FieldFigure figure;
    figure.title = run.problem.name;
    const RobotDrawing robot(run.problem.robot);
    constexpr double min_count = 5, max_count = 16;
    const auto rows = snapshot_rows(flight, {"x_m", "z_m"}, robot.width_m(), min_count, max_count);
    figure.subtitle = fmt::format("{}, {}", name_of(run.problem.planner.variant), interval_text(flight, rows));
    figure.extent = shown_extent(run, flight);
    figure.obstacles = obstacle_outlines(model.effect(0).scene(), run.problem.plane, 0);
    figure.value = factor_field(model.layer(0), model.plane());
    figure.has_contour_lines = false;
    figure.scale = factor_scale("aero factor K of rotor 1 there",
                                factor_range(figure, rotor_extent(model.robot().rotors, run.problem.bounds)));

    std::vector<Ring> flown, planned;
    for (const std::size_t row : rows) {
        robot.add_to(planned, flight["ref_x_m"][row], flight["ref_z_m"][row], 0, flight["ref_arm_rad"][row]);
        robot.add_to(flown, flight["x_m"][row], flight["z_m"][row], flight["pitch_rad"][row], flight["arm_rad"][row]);
    }
    figure.lines = {{"planned: the reference, drawn level", planned, planned_color, 1.3, LineDash::dotted},
                    {"", {planned_way(run)}, planned_color, 1.3, LineDash::dotted},
                    {"way of the end effector",
                     {way(flight["ee_x_m"], flight["ee_z_m"])},
                     end_effector_color,
                     1.6,
                     LineDash::dash_dotted},
                    {"flown", flown, flown_color, 1.6},
                    {"", {way(flight["x_m"], flight["z_m"])}, flown_color, 1.2}};
    const Problem visited = in_order(run.problem, run.order);
    if (std::vector<Ring> regions = goal_regions(visited); !regions.empty()) {
        figure.lines.push_back({"tolerance of the goal", std::move(regions), goal_color, 1});
    }
    figure.points = goal_points(visited, goal_names(run.problem, run.order));
    return figure;
}

std::vector<CurveFigure> time_figures(const RunRecord& run) {
    require_flight(run.flight);
    const FlightColumns flight{run.flight};
    std::vector<CurveFigure> figures;
    figures.push_back(time_diagram("tracking error [m]",
                                   {{"position", over_time(flight, tracking_error_m(flight, {"x_m", "z_m"}))}}));
    figures.push_back(time_diagram("angle [deg]",
                                   {{"pitch, nose down", over_time(flight, flight["pitch_rad"], degrees_per_radian)},
                                    {"arm", over_time(flight, flight["arm_rad"], degrees_per_radian)},
                                    {"arm, reference", over_time(flight, flight["ref_arm_rad"], degrees_per_radian)}}));
    add_common_diagrams(figures, flight, run.problem.robot.rotors.positions_m.size(),
                        run.problem.planner.safety_margin_m, "rotors and arm");
    finish(figures, flight, run.problem.name, std::string(name_of(run.problem.planner.variant)));
    return figures;
}

}  // namespace downwash

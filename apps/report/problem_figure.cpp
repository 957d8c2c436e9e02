#include "downwash/report/problem_figure.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "downwash/problems/visit_order.hpp"
#include "downwash/report/factor_field.hpp"
#include "downwash/report/figure_colors.hpp"
#include "downwash/report/obstacle_outline.hpp"
#include "downwash/report/plane_drawing.hpp"

namespace downwash {
namespace {

/// In two pieces: names of obstacles keep out of a line that is closed, and have room within the bounds.
std::vector<Ring> sides_of(const Bounds& bounds) {
    const PlanePoint low{bounds.x_low_m, bounds.z_low_m}, high{bounds.x_high_m, bounds.z_high_m};
    return {{low, {high.x_m, low.z_m}, high}, {high, {low.x_m, high.z_m}, low}};
}

/// Bounds are those of the centre of mass: the arm and the rotors may reach beyond.
Bounds shown_extent(const Problem& problem, const RobotDrawing& robot) {
    const ArmParameters& arm = problem.robot.arm;
    const double room_m = std::max(1.2 * arm.length_m, robot.width_m());
    const Bounds& bounds = problem.bounds;
    Bounds extent{bounds.x_low_m - room_m, bounds.x_high_m + room_m, bounds.z_low_m - room_m, bounds.z_high_m + room_m};
    widen_to_scale(extent);
    return extent;
}

/// Goals of the vehicle: points, lines where a coordinate is free, and the robot where all of it is given.
struct VehicleGoals {
    FigurePoints points{"goal of the vehicle", {}, goal_color};
    FigureLines lines{"robot at a goal of the vehicle", {}, goal_color, 1.3, LineDash::dotted};
};

VehicleGoals vehicle_goals(const Problem& problem, const std::vector<std::string>& names, const RobotDrawing& robot) {
    VehicleGoals found;
    const Bounds& bounds = problem.bounds;
    std::size_t number = 0;
    for (const Goal& visited : goals_of(problem)) {
        const std::string& name = names[number++];
        for (const Goal& goal : alternatives(visited)) {
            if (part_of(goal) != GoalPart::vehicle) {
                continue;
            }
            const GoalDrawing drawing = drawing_of(goal);
            if (!drawing.x_m || !drawing.z_m) {
                if (drawing.x_m) {
                    found.lines.pieces.push_back({{*drawing.x_m, bounds.z_low_m}, {*drawing.x_m, bounds.z_high_m}});
                } else if (drawing.z_m) {
                    found.lines.pieces.push_back({{bounds.x_low_m, *drawing.z_m}, {bounds.x_high_m, *drawing.z_m}});
                }
                continue;
            }
            found.points.points.push_back({*drawing.x_m, *drawing.z_m});
            if (names.size() > 1) {
                found.points.labels.push_back(short_name(name));
            }
            if (const auto arm_rad = level_arm_rad(goal)) {
                robot.add_to(found.lines.pieces, *drawing.x_m, *drawing.z_m, 0, *arm_rad);
            }
        }
    }
    return found;
}

}  // namespace

FieldFigure problem_figure(const Problem& problem, const FlightModel& model) {
    FieldFigure figure;
    figure.title = problem.name;
    figure.subtitle = "before planning";
    const RobotDrawing robot(problem.robot);
    figure.extent = shown_extent(problem, robot);
    figure.obstacles = obstacle_outlines(model.scene(), problem.plane, 0);
    figure.value = factor_field(model.layer(0), model.plane());
    figure.has_contour_lines = false;
    figure.scale = factor_scale("aero factor K of rotor 1 there",
                                factor_range(figure, rotor_extent(model.robot().rotors, problem.bounds)));

    FigureLines at_start{"robot at the start", {}, flown_color, 1.6};
    robot.add_to(at_start.pieces, problem.start.at[plane::x], problem.start.at[plane::z], problem.start.pitch_rad,
                 problem.start.at[plane::arm]);
    const std::vector<std::string> names = goal_names(problem, std::nullopt);
    VehicleGoals of_vehicle = vehicle_goals(problem, names, robot);
    figure.lines = {{"bounds of the centre of mass", sides_of(problem.bounds), planned_color, 1.3, LineDash::dashed},
                    std::move(at_start)};
    if (!of_vehicle.lines.pieces.empty()) {
        figure.lines.push_back(std::move(of_vehicle.lines));
    }
    if (std::vector<Ring> regions = goal_regions(problem); !regions.empty()) {
        figure.lines.push_back({"tolerance of the goal", std::move(regions), goal_color, 1});
    }
    figure.points = goal_points(problem, names);
    if (!of_vehicle.points.points.empty()) {
        figure.points.push_back(std::move(of_vehicle.points));
    }
    return figure;
}

}  // namespace downwash

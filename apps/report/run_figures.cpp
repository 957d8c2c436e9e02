#include "downwash/report/run_figures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "downwash/base/angles.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/report/factor_field.hpp"
#include "downwash/report/figure_colors.hpp"
#include "downwash/report/obstacle_outline.hpp"

namespace downwash {
namespace {

using Pieces = std::vector<Ring>;

void require_flight(const RunRecord& run) {
    if (run.flight.rows() < 2) {
        throw_input_error(run.flight.rows() == 0 ? "this run contains no flight"
                                                 : "the flight has one row only, too little to draw");
    }
}

/// The columns of the flight by name; a RunRecord has all that are used here.
struct Flight {
    const NumberTable& table;

    [[nodiscard]] const std::vector<double>& operator[](std::string_view name) const { return *table.find(name); }
    [[nodiscard]] std::size_t rows() const { return table.rows(); }
};

/// The lines of vehicle and arm at a place.
class RobotDrawing {
 public:
    explicit RobotDrawing(const Robot& robot) : robot_(robot), bodies_(body_outlines(robot.body)) {}

    /// The width between the outer edges of the outermost rotors.
    [[nodiscard]] double width_m() const {
        double low_m = 0, high_m = 0;
        for (const Vector3& hub_m : robot_.rotors.positions_m) {
            low_m = std::min(low_m, hub_m[0] - robot_.rotors.radius_m);
            high_m = std::max(high_m, hub_m[0] + robot_.rotors.radius_m);
        }
        return high_m - low_m;
    }

    void add_to(Pieces& lines, double x_m, double z_m, double pitch_rad, double arm_rad) const {
        const double sine = std::sin(pitch_rad), cosine = std::cos(pitch_rad);
        const auto placed = [&](double forward_m, double up_m) {
            return PlanePoint{x_m + forward_m * cosine + up_m * sine, z_m - forward_m * sine + up_m * cosine};
        };
        for (const auto& body : bodies_) {
            auto& ring = lines.emplace_back();
            for (const PlanePoint& corner : body) {
                ring.push_back(placed(corner.x_m, corner.z_m));
            }
            ring.push_back(ring.front());
        }
        for (const Vector3& hub_m : robot_.rotors.positions_m) {
            lines.push_back({placed(hub_m[0] - robot_.rotors.radius_m, hub_m[2]),
                             placed(hub_m[0] + robot_.rotors.radius_m, hub_m[2])});
        }
        const PlanePoint joint = placed(robot_.arm.joint_x_m, robot_.arm.joint_z_m);
        const double direction_rad = pitch_rad + arm_rad;
        lines.push_back({joint,
                         {joint.x_m + robot_.arm.length_m * std::cos(direction_rad),
                          joint.z_m - robot_.arm.length_m * std::sin(direction_rad)}});
    }

 private:
    const Robot& robot_;
    Pieces bodies_;
};

Ring way(const std::vector<double>& x_m, const std::vector<double>& z_m) {
    Ring points;
    for (std::size_t i = 0; i < x_m.size(); ++i) {
        points.push_back({x_m[i], z_m[i]});
    }
    return points;
}

/// Rows at equal intervals of about one vehicle length, the last one included.
std::vector<std::size_t> snapshot_rows(const Flight& flight, double vehicle_m) {
    double length_m = 0;
    for (std::size_t i = 1; i < flight.rows(); ++i) {
        length_m += std::hypot(flight["x_m"][i] - flight["x_m"][i - 1], flight["z_m"][i] - flight["z_m"][i - 1]);
    }
    constexpr double min_count = 5, max_count = 16;
    const double count = std::clamp(std::round(length_m / (1.3 * vehicle_m)), min_count, max_count);
    std::vector<std::size_t> rows;
    const auto last = static_cast<double>(flight.rows() - 1);
    for (double i = 0; i <= count; ++i) {
        rows.push_back(static_cast<std::size_t>(std::lround(last * i / count)));
    }
    return rows;
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
Bounds shown_extent(const RunRecord& run, const Flight& flight) {
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
    // A drawing to scale needs sides of similar length.
    constexpr double max_ratio = 4;
    const auto widen = [](double& low, double& high, double other_side) {
        const double lacking_m = other_side / max_ratio - (high - low);
        if (lacking_m > 0) {
            low -= lacking_m / 2;
            high += lacking_m / 2;
        }
    };
    widen(extent.z_low_m, extent.z_high_m, extent.x_high_m - extent.x_low_m);
    widen(extent.x_low_m, extent.x_high_m, extent.z_high_m - extent.z_low_m);
    return extent;
}

/// A name as it stands beside its point: the number alone, which needs little room.
std::string short_name(const std::string& name) {
    const std::string last = name.substr(name.rfind(' ') + 1);
    return last.find_first_not_of("0123456789") == std::string::npos ? last : name;
}

/// The goals that are a point of the plane; several in turn with their numbers.
std::vector<FigurePoints> goal_points(const Problem& problem, const std::vector<std::string>& names) {
    FigurePoints goals{"goal of the end effector", {}, goal_color};
    std::size_t number = 0;
    for (const Goal& visited : goals_of(problem)) {
        const std::string& name = names[number++];
        for (const Goal& goal : alternatives(visited)) {
            const GoalDrawing drawing = drawing_of(goal);
            if (part_of(goal) != GoalPart::end_effector || !drawing.outline.empty()) {
                continue;
            }
            goals.points.push_back({drawing.x_m.value(), drawing.z_m.value()});
            if (names.size() > 1) {
                goals.labels.push_back(short_name(name));
            }
        }
    }
    if (goals.points.empty()) {
        return {};
    }
    return {std::move(goals)};
}

/// Where the end effector may be at such goals.
Pieces goal_regions(const Problem& problem) {
    constexpr int corners = 36;
    Pieces regions;
    for (const Goal& visited : goals_of(problem)) {
        for (const Goal& goal : alternatives(visited)) {
            if (part_of(goal) != GoalPart::end_effector) {
                continue;
            }
            const GoalDrawing drawing = drawing_of(goal);
            for (const std::vector<PlaneVector>& line : drawing.outline) {
                for (Ring& ring = regions.emplace_back(); const PlaneVector& point : line) {
                    ring.push_back({point.x, point.z});
                }
            }
            if (!drawing.outline.empty()) {
                continue;
            }
            const double x_m = drawing.x_m.value(), z_m = drawing.z_m.value();
            const GoalTolerance tolerance = tolerance_of(goal);
            Ring region;
            for (int i = 0; i <= corners && tolerance.is_disc; ++i) {
                const double angle_rad = 2 * std::numbers::pi * (i % corners) / corners;
                region.push_back(
                    {x_m + tolerance.x_m * std::cos(angle_rad), z_m + tolerance.z_m * std::sin(angle_rad)});
            }
            for (int i = 0; i <= 4 && !tolerance.is_disc; ++i) {
                const double side_x = i % 4 == 0 || i % 4 == 3 ? -1 : 1;
                const double side_z = i % 4 < 2 ? -1 : 1;
                region.push_back({x_m + side_x * tolerance.x_m, z_m + side_z * tolerance.z_m});
            }
            regions.push_back(std::move(region));
        }
    }
    return regions;
}

std::vector<DiagramPoint> over_time(const Flight& flight, const std::vector<double>& values, double factor = 1) {
    std::vector<DiagramPoint> points;
    for (std::size_t i = 0; i < values.size(); ++i) {
        points.push_back({flight["t_s"][i], factor * values[i]});
    }
    return points;
}

CurveFigure diagram(std::string y_label, std::vector<Curve> curves) {
    CurveFigure figure;
    figure.x_label = "time [s]";
    figure.y_label = std::move(y_label);
    figure.curves = std::move(curves);
    return figure;
}

/// One curve per rotor; rotors with equal values share one.
std::vector<Curve> rotor_curves(const Flight& flight, std::size_t rotors, const std::string& column) {
    std::vector<Curve> curves;
    std::vector<std::size_t> shown;
    for (std::size_t i = 1; i <= rotors; ++i) {
        const auto& values = flight[fmt::format("rotor_{}_{}", i, column)];
        bool is_shown = false;
        for (std::size_t k = 0; k < shown.size() && !is_shown; ++k) {
            if (flight[fmt::format("rotor_{}_{}", shown[k], column)] == values) {
                curves[k].name += fmt::format(", {}", i);
                is_shown = true;
            }
        }
        if (!is_shown) {
            shown.push_back(i);
            curves.push_back({fmt::format("rotor {}", i), over_time(flight, values)});
        }
    }
    return curves;
}

}  // namespace

FieldFigure snapshot_figure(const RunRecord& run, const FlightModel& model) {
    require_flight(run);
    const Flight flight{run.flight};
    FieldFigure figure;
    figure.title = run.problem.name;
    const RobotDrawing robot(run.problem.robot);
    const auto rows = snapshot_rows(flight, robot.width_m());
    figure.subtitle =
        fmt::format("{}, every {} s of {} s", name_of(run.problem.planner.variant),
                    to_text((flight["t_s"][rows[1]] - flight["t_s"][rows[0]]), 3), to_text(flight["t_s"].back(), 4));
    figure.extent = shown_extent(run, flight);
    figure.obstacles = obstacle_outlines(model.effect(0).scene(), run.problem.plane, 0);
    figure.value = factor_field(model.layer(0), model.plane());
    figure.has_contour_lines = false;
    figure.scale = factor_scale("aero factor K of rotor 1 there",
                                factor_range(figure, rotor_extent(model.robot().rotors, run.problem.bounds)));

    Pieces flown, planned;
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
    if (Pieces regions = goal_regions(visited); !regions.empty()) {
        figure.lines.push_back({"tolerance of the goal", std::move(regions), goal_color, 1});
    }
    figure.points = goal_points(visited, goal_names(run.problem, run.order));
    return figure;
}

std::vector<CurveFigure> time_figures(const RunRecord& run) {
    require_flight(run);
    const Flight flight{run.flight};
    std::vector<double> error_m;
    for (std::size_t i = 0; i < flight.rows(); ++i) {
        error_m.push_back(std::hypot(flight["x_m"][i] - flight["ref_x_m"][i], flight["z_m"][i] - flight["ref_z_m"][i]));
    }
    const std::size_t rotors = run.problem.robot.rotors.positions_m.size();
    std::vector<CurveFigure> figures;
    figures.push_back(diagram("tracking error [m]", {{"position", over_time(flight, error_m)}}));
    figures.push_back(
        diagram("angle [deg]", {{"pitch, nose down", over_time(flight, flight["pitch_rad"], degrees_per_radian)},
                                {"arm", over_time(flight, flight["arm_rad"], degrees_per_radian)},
                                {"arm, reference", over_time(flight, flight["ref_arm_rad"], degrees_per_radian)}}));
    figures.push_back(diagram("rotor command [N]", rotor_curves(flight, rotors, "cmd_n")));
    figures.push_back(diagram("aero factor", rotor_curves(flight, rotors, "aero_factor")));
    if (!std::isnan(flight["clearance_m"].front())) {
        figures.push_back(diagram("clearance [m]", {{"to obstacles", over_time(flight, flight["clearance_m"])}}));
        figures.back().level = run.problem.planner.safety_margin_m;
    }
    figures.push_back(diagram("power [W]", {{"rotors and arm", over_time(flight, flight["power_w"])}}));
    for (CurveFigure& figure : figures) {
        figure.x_range = AxisRange{flight["t_s"].front(), flight["t_s"].back()};
    }
    figures.front().title = run.problem.name;
    figures.front().subtitle = std::string(name_of(run.problem.planner.variant));
    return figures;
}

}  // namespace downwash

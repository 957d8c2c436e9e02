#include "downwash/report/space_problem_figure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "downwash/base/angles.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/controllers/space_segment.hpp"
#include "downwash/problems/visit_order.hpp"
#include "downwash/report/figure_colors.hpp"
#include "downwash/report/flight_diagrams.hpp"
#include "downwash/report/obstacle_outline.hpp"
#include "downwash/report/space_robot_drawing.hpp"
#include "downwash/report/space_start.hpp"
#include "downwash/simulation/space_robot_facts.hpp"

namespace downwash {
namespace {

PlanePoint seen(const Matrix3& view, const Vector3& p_m) {
    const Vector3 turned = view * p_m;
    return {turned[0], turned[2]};
}

/// What has places of the centre of mass in it: arm and rotors may reach beyond. No side is much shorter than another,
/// so that every view has room.
BoundingBox shown_box(const SpaceProblem& problem, BoundingBox box) {
    constexpr double least_share = 0.22;
    double longest_m = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        longest_m = std::max(longest_m, box.high_m[k] - box.low_m[k]);
    }
    const double reach_m = space_robot_facts(problem.robot).reach_m + problem.robot.rotor_radius_m;
    const double room_m = std::max(1.1 * reach_m, 0.06 * longest_m);
    longest_m += 2 * room_m;
    for (std::size_t k = 0; k < 3; ++k) {
        box.low_m[k] -= room_m;
        box.high_m[k] += room_m;
        const double missing_m = std::max(0., least_share * longest_m - (box.high_m[k] - box.low_m[k]));
        box.low_m[k] -= missing_m / 2;
        box.high_m[k] += missing_m / 2;
    }
    return box;
}

/// Where a goal of the end effector is, or its camera's target; empty for other goals.
struct PlaceOf {
    std::optional<Vector3> operator()(const SpaceEndEffectorGoal& goal) const { return goal.position_m; }
    std::optional<Vector3> operator()(const SpacePoseGoal& goal) const { return goal.position_m; }
    std::optional<Vector3> operator()(const SpaceCameraGoal& goal) const { return goal.target_m; }
    std::optional<Vector3> operator()(const SpaceContactGoal& goal) const { return goal.position_m; }
    std::optional<Vector3> operator()(const SpaceConfigurationGoal& goal) const {
        return goal.x_m && goal.y_m && goal.z_m ? std::optional(Vector3{*goal.x_m, *goal.y_m, *goal.z_m})
                                                : std::nullopt;
    }
};

struct ToleranceOf {
    double operator()(const SpaceCameraGoal& /*goal*/) const { return 0; }
    template <class Goal>
    double operator()(const Goal& goal) const {
        return goal.tolerance_m;
    }
};

/// The direction in which the tool must point there, if it must.
std::optional<Vector3> direction_of(const SpaceGoalKind& kind) {
    if (const auto* goal = std::get_if<SpaceEndEffectorGoal>(&kind)) {
        return goal->direction;
    }
    if (const auto* goal = std::get_if<SpaceCameraGoal>(&kind)) {
        return goal->direction;
    }
    return std::nullopt;
}

Ring circle_around(const PlanePoint& middle, double radius_m) {
    constexpr int corners = 64;
    constexpr double whole_turn_rad = 6.283185307179586;
    Ring ring;
    for (int i = 0; i <= corners; ++i) {
        const auto [sine, cosine] = lane::sin_cos(whole_turn_rad * i / corners);
        ring.push_back({middle.x_m + radius_m * cosine, middle.z_m + radius_m * sine});
    }
    return ring;
}

/// The points of goals with the lines around them: how far they reach, and the direction of the tool.
struct SeenGoals {
    FigurePoints points{"goal", {}, goal_color, {}};
    FigureLines tolerances{"tolerance of the goal", {}, goal_color, 1};
    FigureLines ranges{"range of the camera", {}, goal_color, 1, LineDash::dotted};
    FigureLines directions{"direction of the tool at the goal", {}, goal_color, 2, LineDash::solid, true};
};

SeenGoals seen_goals(const SpaceProblem& problem, const Matrix3& view, double arrow_m) {
    SeenGoals found;
    const std::vector<SpaceGoal> goals = goals_of(problem);
    const std::vector<std::string> names = goal_names(problem, std::nullopt);
    for (std::size_t i = 0; i < goals.size(); ++i) {
        const SpaceGoal& goal = goals[i];
        const std::string& name = names[i];
        const auto add = [&](const SpaceGoalKind& kind) {
            const std::optional<Vector3> place_m = std::visit(PlaceOf(), kind);
            if (!place_m) {
                return;
            }
            const PlanePoint at = seen(view, *place_m);
            found.points.points.push_back(at);
            found.points.labels.push_back(name);
            if (const auto* camera = std::get_if<SpaceCameraGoal>(&kind)) {
                found.ranges.pieces.push_back(circle_around(at, camera->nearest_m));
                found.ranges.pieces.push_back(circle_around(at, camera->farthest_m));
            } else {
                found.tolerances.pieces.push_back(circle_around(at, std::visit(ToleranceOf(), kind)));
            }
            if (const std::optional<Vector3> direction = direction_of(kind)) {
                const Vector3 from_m = *place_m - arrow_m / std::sqrt(dot(*direction, *direction)) * *direction;
                const PlanePoint from = seen(view, from_m);
                if (std::hypot(at.x_m - from.x_m, at.z_m - from.z_m) > 0.1 * arrow_m) {
                    found.directions.pieces.push_back({from, at});
                }
            }
        };
        if (goal.any_of.empty()) {
            add(goal.kind);
        }
        for (const SpaceGoal& alternative : goal.any_of) {
            add(alternative.kind);
        }
    }
    return found;
}

/// The sides of a rectangle, in two pieces: names may stand within it.
std::vector<Ring> rectangle(const PlanePoint& low, const PlanePoint& high) {
    return {{low, {high.x_m, low.z_m}, high}, {high, {low.x_m, high.z_m}, low}};
}

/// What a figure shows of a robot in a view.
struct SeenRobot {
    std::vector<FigureLines> lines;
    std::vector<FigurePoints> points;
};
using RobotInView = std::function<SeenRobot(const Matrix3& view)>;

SpaceView seen_from(const SpaceProblem& problem, const Scene& scene, const BoundingBox& shown, const Matrix3& view,
                    SpaceView drawn, const RobotInView& robot) {
    const PlanePoint low = seen(view, shown.low_m), high = seen(view, shown.high_m);
    drawn.extent = {low.x_m, high.x_m, low.z_m, high.z_m};
    drawn.obstacles = seen_outlines(scene, view);
    const double arrow_m = 0.07 * std::max(high.x_m - low.x_m, high.z_m - low.z_m);
    SeenGoals goals = seen_goals(problem, view, arrow_m);
    SeenRobot seen_robot = robot(view);
    drawn.lines = std::move(seen_robot.lines);
    for (FigureLines* lines : {&goals.tolerances, &goals.ranges, &goals.directions}) {
        drawn.lines.push_back(std::move(*lines));
    }
    std::erase_if(drawn.lines, [](const FigureLines& lines) { return lines.pieces.empty(); });
    drawn.points = std::move(seen_robot.points);
    if (!goals.points.points.empty()) {
        drawn.points.push_back(std::move(goals.points));
    }
    return drawn;
}

/// @param places that are shown
SpaceFigure three_views(const SpaceProblem& problem, std::string subtitle, const Scene& scene,
                        const BoundingBox& places, const RobotInView& robot) {
    const BoundingBox shown = shown_box(problem, places);
    const auto view = [&](const Matrix3& from, SpaceView drawn) {
        return seen_from(problem, scene, shown, from, std::move(drawn), robot);
    };
    return {problem.name, std::move(subtitle), view(seen_from_above, {"from above", "x [m]", "y [m]", {}}),
            view(seen_from_the_side, {"from the side", "x [m]", "z [m]", {}}),
            view(seen_from_the_front, {"from the front", "y [m]", "z [m]", {}})};
}

/// Points of a plan at equal intervals, without the final hover.
std::vector<Vector3> planned_places(const std::optional<SpacePlan>& plan) {
    std::vector<Vector3> places;
    constexpr std::int64_t pieces = 50;  // of a segment
    const auto add = [&places](const SpacePoint& at) {
        places.push_back({at.position[space::x], at.position[space::y], at.position[space::z]});
    };
    if (plan) {
        for (const SpaceSegment& segment : plan->segments()) {
            for (std::int64_t piece = 0; piece < pieces; ++piece) {
                add(segment.at_tick(segment.ticks() * piece / pieces));
            }
        }
        add(plan->reference.back().point);
    }
    return places;
}

/// Places in three columns of a flight.
std::vector<Vector3> flown_places(const FlightColumns& flight, const std::array<std::string_view, 3>& names) {
    std::vector<Vector3> places;
    for (std::size_t row = 0; row < flight.rows(); ++row) {
        places.push_back({flight[names[0]][row], flight[names[1]][row], flight[names[2]][row]});
    }
    return places;
}

Ring seen_way(const Matrix3& view, const std::vector<Vector3>& places) {
    Ring way;
    for (const Vector3& place_m : places) {
        way.push_back(seen(view, place_m));
    }
    return way;
}

SpacePose pose_in(const FlightColumns& flight, int joints, std::size_t row) {
    SpacePose pose{{flight["x_m"][row], flight["y_m"][row], flight["z_m"][row]},
                   {flight["qw"][row], flight["qx"][row], flight["qy"][row], flight["qz"][row]},
                   {}};
    for (int i = 0; i < joints; ++i) {
        pose.joints_rad[static_cast<std::size_t>(i)] = flight[fmt::format("joint_{}_rad", i + 1)][row];
    }
    return pose;
}

/// The angle between the vertical and the multirotor's, and the yaw, unwrapped to be near its reference [rad].
struct Attitude {
    std::vector<double> tilt_rad, yaw_rad;
};

Attitude attitude_of(const FlightColumns& flight) {
    constexpr double whole_turn_rad = 6.283185307179586;
    Attitude attitude;
    for (std::size_t row = 0; row < flight.rows(); ++row) {
        const Matrix3 axes = rotation_of(pose_in(flight, 0, row).attitude);
        attitude.tilt_rad.push_back(std::acos(std::clamp(axes[2][2], -1., 1.)));
        const double yaw_rad = std::atan2(axes[1][0], axes[0][0]), reference_rad = flight["ref_yaw_rad"][row];
        attitude.yaw_rad.push_back(yaw_rad + whole_turn_rad * std::round((reference_rad - yaw_rad) / whole_turn_rad));
    }
    return attitude;
}

}  // namespace

SpaceFigure space_problem_figure(const SpaceProblem& problem, const Scene& scene) {
    const SpacePose start = pose_at(problem.start);
    return three_views(problem, "before planning, in three views", scene, {problem.bounds.low_m, problem.bounds.high_m},
                       [&](const Matrix3& view) {
                           return SeenRobot{
                               {{"bounds of the centre of mass",
                                 rectangle(seen(view, problem.bounds.low_m), seen(view, problem.bounds.high_m)),
                                 planned_color, 1.3, LineDash::dashed},
                                {"robot at the start", robot_lines(problem.robot, start, view), flown_color, 1.6}},
                               {{"end effector at the start",
                                 {seen(view, end_effector_at(problem.robot, start))},
                                 end_effector_color,
                                 {"start"}}}};
                       });
}

SpaceFigure space_run_figure(const SpaceRunRecord& run, const Scene& scene) {
    require_flight(run.flight);
    const SpaceProblem& problem = run.problem;
    const FlightColumns flight{run.flight};
    const std::vector<Vector3> planned = planned_places(run.plan), flown = flown_places(flight, {"x_m", "y_m", "z_m"}),
                               tool = flown_places(flight, {"ee_x_m", "ee_y_m", "ee_z_m"});
    BoundingBox places{flown.front(), flown.front()};
    for (const auto* way : {&planned, &flown}) {
        for (const Vector3& place_m : *way) {
            places.include({place_m, place_m});
        }
    }
    const double vehicle_m = 2 * (space_robot_facts(problem.robot).reach_m + problem.robot.rotor_radius_m);
    constexpr double min_count = 6, max_count = 12;
    const auto rows = snapshot_rows(flight, {"x_m", "y_m", "z_m"}, vehicle_m, min_count, max_count);
    return three_views(
        problem, fmt::format("{}, {}", name_of(problem.planner.variant), interval_text(flight, rows)), scene, places,
        [&](const Matrix3& view) {
            std::vector<Ring> robots;
            for (const std::size_t row : rows) {
                std::ranges::move(robot_lines(problem.robot, pose_in(flight, problem.robot.joints(), row), view),
                                  std::back_inserter(robots));
            }
            return SeenRobot{
                {{"planned way", {seen_way(view, planned)}, planned_color, 1.3, LineDash::dotted},
                 {"way of the end effector", {seen_way(view, tool)}, end_effector_color, 1.6, LineDash::dash_dotted},
                 {"flown", std::move(robots), flown_color, 1.2},
                 {"", {seen_way(view, flown)}, flown_color, 1.2}},
                {}};
        });
}

std::vector<CurveFigure> time_figures(const SpaceRunRecord& run) {
    require_flight(run.flight);
    const FlightColumns flight{run.flight};
    const Attitude attitude = attitude_of(flight);
    const auto angle = [&](std::string name, const std::vector<double>& angles_rad) {
        return Curve{std::move(name), over_time(flight, angles_rad, degrees_per_radian)};
    };
    std::vector<CurveFigure> figures;
    figures.push_back(time_diagram("tracking error [m]",
                                   {{"position", over_time(flight, tracking_error_m(flight, {"x_m", "y_m", "z_m"}))}}));
    figures.push_back(time_diagram("angle [deg]", {angle("tilt", attitude.tilt_rad), angle("yaw", attitude.yaw_rad),
                                                   angle("yaw, reference", flight["ref_yaw_rad"])}));
    std::vector<Curve> joints;
    for (int i = 1; i <= run.problem.robot.joints(); ++i) {
        joints.push_back(angle(fmt::format("joint {}", i), flight[fmt::format("joint_{}_rad", i)]));
        joints.push_back(angle(fmt::format("joint {}, reference", i), flight[fmt::format("ref_joint_{}_rad", i)]));
    }
    if (!joints.empty()) {
        figures.push_back(time_diagram("joint [deg]", std::move(joints)));
    }
    add_common_diagrams(figures, flight, run.problem.robot.plant.rotors.size(), run.problem.planner.safety_margin_m,
                        "rotors and joints");
    finish(figures, flight, run.problem.name, std::string(name_of(run.problem.planner.variant)));
    return figures;
}

}  // namespace downwash

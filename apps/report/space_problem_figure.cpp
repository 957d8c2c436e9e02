#include "downwash/report/space_problem_figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "downwash/base/lane_math.hpp"
#include "downwash/problems/visit_order.hpp"
#include "downwash/report/figure_colors.hpp"
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

/// Bounds are those of the centre of mass: arm and rotors may reach beyond. No side is much shorter than another, so
/// that every view has room.
BoundingBox shown_box(const SpaceProblem& problem) {
    constexpr double least_share = 0.22;
    BoundingBox box{problem.bounds.low_m, problem.bounds.high_m};
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

SpaceView seen_from(const SpaceProblem& problem, const Scene& scene, const BoundingBox& shown, const Matrix3& view,
                    SpaceView drawn) {
    const PlanePoint low = seen(view, shown.low_m), high = seen(view, shown.high_m);
    drawn.extent = {low.x_m, high.x_m, low.z_m, high.z_m};
    drawn.obstacles = seen_outlines(scene, view);
    const SpacePose start = pose_at(problem.start);
    const double arrow_m = 0.07 * std::max(high.x_m - low.x_m, high.z_m - low.z_m);
    SeenGoals goals = seen_goals(problem, view, arrow_m);
    drawn.lines = {
        {"bounds of the centre of mass", rectangle(seen(view, problem.bounds.low_m), seen(view, problem.bounds.high_m)),
         planned_color, 1.3, LineDash::dashed},
        std::move(goals.tolerances),
        std::move(goals.ranges),
        std::move(goals.directions),
        {"robot at the start", robot_lines(problem.robot, start, view), flown_color, 1.6}};
    std::erase_if(drawn.lines, [](const FigureLines& lines) { return lines.pieces.empty(); });
    drawn.points = {{"end effector at the start",
                     {seen(view, end_effector_at(problem.robot, start))},
                     end_effector_color,
                     {"start"}}};
    if (!goals.points.points.empty()) {
        drawn.points.push_back(std::move(goals.points));
    }
    return drawn;
}

}  // namespace

SpaceFigure space_problem_figure(const SpaceProblem& problem, const Scene& scene) {
    const BoundingBox shown = shown_box(problem);
    return {problem.name, "before planning, in three views",
            seen_from(problem, scene, shown, seen_from_above, {"from above", "x [m]", "y [m]", {}}),
            seen_from(problem, scene, shown, seen_from_the_side, {"from the side", "x [m]", "z [m]", {}}),
            seen_from(problem, scene, shown, seen_from_the_front, {"from the front", "y [m]", "z [m]", {}})};
}

}  // namespace downwash

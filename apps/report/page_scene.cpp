#include "downwash/report/page_scene.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <variant>
#include <vector>

#include "downwash/base/parallel.hpp"
#include "downwash/report/color_scale.hpp"
#include "downwash/report/obstacle_outline.hpp"
#include "downwash/report/packed_numbers.hpp"
#include "downwash/report/page_solids.hpp"
#include "downwash/scene/obstacle_placement.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

Json ring_json(const Ring& ring) {
    Json points = Json::array();
    for (const PlanePoint& point : ring) {
        points.push_back({point.x_m, point.z_m});
    }
    return points;
}

Json rings_json(const std::vector<Ring>& rings) {
    Json all = Json::array();
    for (const Ring& ring : rings) {
        all.push_back(ring_json(ring));
    }
    return all;
}

Json optional_json(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

Json goal_json(const Goal& goal) {
    const GoalDrawing drawing = drawing_of(goal);
    const bool has_tip = part_of(goal) == GoalPart::end_effector;
    Json json{{"kind", has_tip ? "end_effector" : "state"},
              {"x_m", optional_json(drawing.x_m)},
              {"z_m", optional_json(drawing.z_m)},
              {has_tip ? "direction_rad" : "arm_rad", optional_json(level_arm_rad(goal))}};
    for (const std::vector<PlaneVector>& line : drawing.outline) {
        Json& points = json["outline"].emplace_back(Json::array());
        for (const PlaneVector& point : line) {
            points.push_back({point.x, point.z});
        }
    }
    const GoalTolerance tolerance = tolerance_of(goal);
    json["tolerance_x_m"] = tolerance.x_m;
    json["tolerance_z_m"] = tolerance.z_m;
    json["is_disc"] = tolerance.is_disc;
    json["hold_s"] = goal.hold_s;
    return json;
}

/// Bounds and obstacles: the section of each with the plane, its projection on the plane, and its solid.
Json scene_json(const Problem& problem, const Scene& scene) {
    const auto cuts = obstacle_outlines(scene, problem.plane, 0);
    const auto projections = projected_outlines(scene, problem.plane);
    Json obstacles = Json::array();
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        const Obstacle& obstacle = scene.obstacles()[i];
        obstacles.push_back({{"name", obstacle.name},
                             {"kind", kind_of(obstacle.shape)},
                             {"section", cuts[i].is_cut ? rings_json(cuts[i].rings) : Json::array()},
                             {"section_lines", rings_json(cuts[i].lines)},
                             {"projection", rings_json(projections[i].rings)},
                             {"solid", solid_json(obstacle, problem.plane)}});
    }
    const Bounds& bounds = problem.bounds;
    return {{"bounds", {{"x_m", {bounds.x_low_m, bounds.x_high_m}}, {"z_m", {bounds.z_low_m, bounds.z_high_m}}}},
            {"plane", {{"origin_m", problem.plane.origin_m()}, {"heading_rad", problem.plane.heading_rad()}}},
            {"obstacles", std::move(obstacles)}};
}

/// Bodies, rotors and arm, in the body frame.
Json robot_json(const Robot& robot) {
    const PlaneOfMotion body_plane;
    const auto outlines = body_outlines(robot.body);
    Json shapes = Json::array();
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        shapes.push_back(
            {{"outline", ring_json(outlines[i])}, {"solid", solid_json(as_obstacle(robot.body[i]), body_plane)}});
    }
    const ArmParameters& arm = robot.arm;
    return {
        {"name", robot.name},
        {"bodies", std::move(shapes)},
        {"rotors",
         {{"radius_m", robot.rotors.radius_m},
          {"positions_m", robot.rotors.positions_m},
          {"min_thrust_n", robot.rotors.min_thrust_n},
          {"max_thrust_n", robot.rotors.max_thrust_n}}},
        {"arm", {{"joint_m", {arm.joint_x_m, arm.joint_z_m}}, {"length_m", arm.length_m}, {"radius_m", arm.radius_m}}}};
}

/// Those that are visited, in their order, then those that are left out, which are held for no time.
Json goals_json(const Problem& problem, const std::optional<VisitOrder>& order) {
    const std::vector<std::string> names = goal_names(problem, order);
    const Problem flown = in_order(problem, order);
    const std::vector<Goal> visited = goals_of(flown);
    Json goals = Json::array();
    const auto add = [&](const Goal& target, const std::string& name, bool is_left_out) {
        for (const Goal& goal : alternatives(target)) {
            goals.push_back(goal_json(goal));
            if (!problem.targets.empty()) {
                goals.back()["name"] = name;
            }
            if (is_left_out) {
                goals.back()["hold_s"] = 0;
            }
        }
    };
    for (std::size_t i = 0; i < visited.size(); ++i) {
        add(visited[i], names[i], false);
    }
    if (order && flown.targets.empty() && !problem.targets.empty()) {
        for (const LeftOutTarget& each : order->left_out) {
            add(problem.targets[each.target], "target " + std::to_string(each.target + 1) + ", left out", true);
        }
    }
    return goals;
}

/// Whether goals are visited in turn or are alternatives.
std::string_view goal_order(const Problem& problem, const std::optional<VisitOrder>& order) {
    if (!problem.targets.empty()) {
        return in_order(problem, order).targets.empty() ? "in_turn" : "any_order";
    }
    return !problem.goals_before.empty() ? "in_turn" : alternatives(problem.goal).size() > 1 ? "any_of" : "single";
}

/// The classes of thrust ratios and their colours, as in pictures.
Json scale_json(const AxisRange& range) {
    const ColorScale scale = factor_scale("", range);
    Json colors = Json::array();
    for (const Color& color : scale.colors) {
        colors.push_back(fmt::format("#{:02x}{:02x}{:02x}", color.red, color.green, color.blue));
    }
    return {{"limits", scale.limits}, {"colors", std::move(colors)}};
}

/// The thrust ratio K of the first rotor over the bounds, in 255 steps from minimum to maximum. Evaluated directly: an
/// aero map may be off by as much as a class of the scale.
Json map_json(const Problem& problem, const FlightModel& model, int threads) {
    constexpr double max_points = 120'000;
    constexpr std::uint8_t not_flyable = 255;
    const Bounds& bounds = problem.bounds;
    const double width_m = bounds.x_high_m - bounds.x_low_m;
    const double height_m = bounds.z_high_m - bounds.z_low_m;
    const double cell_m = std::max(problem.aero.grid_m, std::sqrt(width_m * height_m / max_points));
    const auto columns = static_cast<std::size_t>(width_m / cell_m) + 1;
    const auto rows = static_cast<std::size_t>(height_m / cell_m) + 1;
    const DirectEffect& effect = model.effect(0);
    std::vector<double> factors(columns * rows, std::numeric_limits<double>::quiet_NaN());
    run_parallel(rows, threads, [&](std::size_t row) {
        const double z_m = bounds.z_low_m + cell_m * static_cast<double>(row);
        for (std::size_t column = 0; column < columns; ++column) {
            const double x_m = bounds.x_low_m + cell_m * static_cast<double>(column);
            const Vector3 hub_m = model.plane().to_world(x_m, model.rotor_lateral_m(0), z_m);
            if (effect.is_flyable(hub_m)) {
                factors[row * columns + column] = effect.factor(hub_m);
            }
        }
    });
    double low = 1, high = 1;
    for (const double factor : factors) {
        low = std::fmin(low, factor);  // of a number and NaN, the number
        high = std::fmax(high, factor);
    }
    constexpr double steps = 254;
    std::vector<std::uint8_t> levels(factors.size(), not_flyable);
    for (std::size_t i = 0; i < factors.size(); ++i) {
        if (!std::isnan(factors[i])) {
            levels[i] =
                high > low ? static_cast<std::uint8_t>(std::lround(steps * (factors[i] - low) / (high - low))) : 0;
        }
    }
    PackedNumbers packed;
    packed.add(levels);
    return {{"rotor", 1},
            {"lateral_m", model.rotor_lateral_m(0)},
            {"x_low_m", bounds.x_low_m},
            {"z_low_m", bounds.z_low_m},
            {"cell_m", cell_m},
            {"columns", columns},
            {"rows", rows},
            {"factor_low", low},
            {"factor_high", high},
            {"scale", scale_json({low, high})},
            {"levels", packed.text()}};
}

}  // namespace

void add_problem(Json& page, const Problem& problem, const std::optional<VisitOrder>& order, const FlightModel& model,
                 int threads) {
    page["description"] = problem.description;
    page["scene"] = scene_json(problem, model.effect(0).scene());
    page["robot"] = robot_json(problem.robot);
    page["start"] = {{"x_m", problem.start.at[plane::x]},
                     {"z_m", problem.start.at[plane::z]},
                     {"pitch_rad", problem.start.pitch_rad},
                     {"arm_rad", problem.start.at[plane::arm]}};
    page["goals"] = goals_json(problem, order);
    page["goal_order"] = goal_order(problem, order);
    page["limits"] = {
        {"safety_margin_m", problem.planner.safety_margin_m},
        {"max_tilt_rad", std::visit([](const auto& law) { return law.max_tilt_rad; }, problem.robot.controller.law)},
        {"max_joint_torque_nm", problem.robot.arm.max_torque_nm}};
    page["map"] = model.has_effects() ? map_json(problem, model, threads) : Json();
}

}  // namespace downwash

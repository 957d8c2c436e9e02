#include "downwash/report/space_page_scene.hpp"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "downwash/report/page_solids.hpp"
#include "downwash/report/space_start.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/simulation/space_robot_facts.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

template <class Value>
Json optional_json(const std::optional<Value>& value) {
    return value ? Json(*value) : Json();
}

Json scene_json(const SpaceProblem& problem) {
    const Scene scene(problem.obstacles);
    Json obstacles = Json::array();
    for (std::size_t i = 0; i < problem.obstacles.size(); ++i) {
        const Obstacle& obstacle = problem.obstacles[i];
        obstacles.push_back({{"name", obstacle.name},
                             {"kind", kind_of(obstacle.shape)},
                             {"low_m", scene.bounds(i).low_m},
                             {"high_m", scene.bounds(i).high_m},
                             {"solid", solid_json(obstacle, PlaneOfMotion())}});
    }
    return {{"bounds", {{"low_m", problem.bounds.low_m}, {"high_m", problem.bounds.high_m}}},
            {"obstacles", std::move(obstacles)}};
}

/// A solid in the frame of its body.
Json body_json(const SpaceBodyShape& body) {
    if (const auto* capsule = std::get_if<Capsule>(&body.shape)) {
        return {{"capsule",
                 {{"radius_m", capsule->radius_m},
                  {"from_m", body.center_m + capsule->from_m},
                  {"to_m", body.center_m + capsule->to_m}}}};
    }
    Obstacle solid{"", Sphere{}, body.center_m, {}};
    std::visit(
        [&solid](const auto& shape) {
            if constexpr (std::is_constructible_v<Shape, decltype(shape)>) {
                solid.shape = shape;
            }
        },
        body.shape);
    return solid_json(solid, PlaneOfMotion());
}

Json bodies_json(const std::vector<SpaceBodyShape>& bodies) {
    Json list = Json::array();
    for (const SpaceBodyShape& body : bodies) {
        list.push_back(body_json(body));
    }
    return list;
}

Json robot_json(const SpaceRobot& robot) {
    Json json = robot_drawing_json(robot);
    const SpaceRobotFacts facts = space_robot_facts(robot);
    json["facts"] = {{"mass_kg", facts.mass_kg},
                     {"thrust_to_weight", facts.thrust_to_weight},
                     {"reach_m", facts.reach_m},
                     {"hover_share", facts.hover_share}};
    return json;
}

Json start_json(const SpaceStart& start, int joints) {
    const SpacePose pose = pose_at(start);
    return {{"position_m", pose.position_m},
            {"attitude", pose.attitude},
            {"joints_rad", std::vector<double>(pose.joints_rad.begin(), pose.joints_rad.begin() + joints)}};
}

/// What goals of each kind say.
struct GoalText {
    Json operator()(const SpaceEndEffectorGoal& goal) const {
        return {{"kind", "end_effector"},
                {"position_m", goal.position_m},
                {"tolerance_m", goal.tolerance_m},
                {"direction", optional_json(goal.direction)},
                {"direction_tolerance_rad", goal.direction_tolerance_rad}};
    }
    Json operator()(const SpacePoseGoal& goal) const {
        return {{"kind", "pose"},
                {"position_m", goal.position_m},
                {"tolerance_m", goal.tolerance_m},
                {"rpy_rad", goal.rpy_rad},
                {"tolerance_rad", goal.tolerance_rad}};
    }
    Json operator()(const SpaceCameraGoal& goal) const {
        return {{"kind", "camera"},
                {"position_m", goal.target_m},
                {"distance_m", {goal.nearest_m, goal.farthest_m}},
                {"direction", optional_json(goal.direction)},
                {"view_cone_rad", goal.view_cone_rad},
                {"aim_tolerance_rad", goal.aim_tolerance_rad},
                {"sees", goal.sees}};
    }
    Json operator()(const SpaceConfigurationGoal& goal) const {
        return {{"kind", "configuration"},
                {"position_m", {optional_json(goal.x_m), optional_json(goal.y_m), optional_json(goal.z_m)}},
                {"tolerance_m", goal.tolerance_m},
                {"yaw_rad", optional_json(goal.yaw_rad)},
                {"joints_rad", goal.joints_rad.empty() ? Json() : Json(goal.joints_rad)},
                {"tolerance_rad", goal.tolerance_rad}};
    }
    Json operator()(const SpaceContactGoal& goal) const {
        return {{"kind", "contact"},
                {"position_m", optional_json(goal.position_m)},
                {"tolerance_m", goal.tolerance_m},
                {"obstacle", goal.obstacle},
                {"force_n", goal.force_n}};
    }
};

/// Those that are visited, in their order and by number, then those that are left out, without one.
Json goals_json(const SpaceProblem& problem, const std::optional<VisitOrder>& order) {
    const std::vector<std::string> names = goal_names(problem, order);
    const SpaceProblem flown = in_order(problem, order);
    const std::vector<SpaceGoal> visited = goals_of(flown);
    Json goals = Json::array();
    const auto add = [&](const SpaceGoal& goal, const std::string& name, std::size_t number) {
        const auto add_kind = [&](const SpaceGoalKind& kind, const std::string& called) {
            Json json{{"name", called}, {"number", number}, {"hold_s", goal.hold_s}};
            json.update(std::visit(GoalText(), kind));
            goals.push_back(std::move(json));
        };
        if (goal.any_of.empty()) {
            add_kind(goal.kind, name);
        }
        for (std::size_t k = 0; k < goal.any_of.size(); ++k) {
            add_kind(goal.any_of[k].kind, name + ", alternative " + std::to_string(k + 1));
        }
    };
    for (std::size_t i = 0; i < visited.size(); ++i) {
        add(visited[i], names[i], i + 1);
    }
    if (order && !flown.in_any_order) {
        for (const LeftOutTarget& each : order->left_out) {
            add(problem.goals[each.target], "target " + std::to_string(each.target + 1) + ", left out", 0);
        }
    }
    return goals;
}

/// In which order goals are visited.
std::string_view goal_order(const SpaceProblem& problem, const std::optional<VisitOrder>& order) {
    const SpaceProblem flown = in_order(problem, order);
    return flown.in_any_order ? "any_order" : flown.goals.size() == 1 ? "single" : "in_turn";
}

double max_tilt_rad(const SpaceController& controller) {
    return std::visit([](const auto& law) { return law.max_tilt_rad; }, controller.law);
}

}  // namespace

Json robot_drawing_json(const SpaceRobot& robot) {
    Json rotors = Json::array(), links = Json::array();
    for (std::size_t i = 0; i < robot.plant.rotors.size(); ++i) {
        const SpaceRotor& rotor = robot.plant.rotors[i];
        rotors.push_back({{"position_m", rotor.position_m},
                          {"axis", rotor.axis},
                          {"spin", rotor.spin},
                          {"min_thrust_n", robot.min_thrust_n[i]},
                          {"max_thrust_n", robot.max_thrust_n[i]}});
    }
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        const SpaceLink& link = robot.plant.links[i];
        const SpaceLinkLimits& limits = robot.links[i];
        links.push_back(
            {{"joint_m", link.joint_m},
             {"axis", link.axis},
             {"mass_kg", link.body.mass_kg},
             {"limits_rad", limits.is_limited ? Json({limits.lower_limit_rad, limits.upper_limit_rad}) : Json()},
             {"max_torque_nm", limits.max_torque_nm},
             {"bodies", bodies_json(limits.body)}});
    }
    return {{"name", robot.name},
            {"bodies", bodies_json(robot.body)},
            {"rotor_radius_m", robot.rotor_radius_m},
            {"rotors", std::move(rotors)},
            {"links", std::move(links)},
            {"end_effector_m", robot.plant.end_effector_m},
            {"tool_direction", robot.tool_direction}};
}

void add_space_problem(Json& page, const SpaceProblem& problem, const std::optional<VisitOrder>& order) {
    page["scene"] = scene_json(problem);
    page["robot"] = robot_json(problem.robot);
    page["start"] = start_json(problem.start, problem.robot.joints());
    page["goals"] = goals_json(problem, order);
    page["goal_order"] = goal_order(problem, order);
    page["limits"] = {{"safety_margin_m", problem.planner.safety_margin_m},
                      {"max_tilt_rad", max_tilt_rad(problem.robot.controller)},
                      {"max_speed_m_s", problem.motion.max_speed_m_s}};
}

}  // namespace downwash

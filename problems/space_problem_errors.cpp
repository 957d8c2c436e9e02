#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/base/angles.hpp"
#include "downwash/base/direction.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/buried_goals.hpp"
#include "downwash/problems/number_text.hpp"
#include "downwash/problems/shared_checks.hpp"
#include "downwash/problems/slip_warnings.hpp"
#include "downwash/problems/space_goal_parameters.hpp"
#include "downwash/problems/space_goal_warnings.hpp"
#include "downwash/problems/space_hover_warnings.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_parameters.hpp"
#include "downwash/scene/collision_checker.hpp"
#include "downwash/scene/line_of_sight.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/space_goal_reach.hpp"
#include "downwash/simulation/space_robot_parameters.hpp"
#include "downwash/simulation/space_statics.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash {
namespace {

using Errors = std::vector<KeyError>;

constexpr std::array<const char*, 3> axis_names{"x_m", "y_m", "z_m"};

using problems::rounded;

Errors reversed_bounds(const SpaceProblem& p) {
    Errors errors;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (p.bounds.low_m[axis] >= p.bounds.high_m[axis]) {
            errors.push_back(
                {std::string("environment.bounds.") + axis_names[axis], "is [low, high]: expected low below high"});
        }
    }
    return errors;
}

/// What shows when obstacles are placed: a mesh without area, a scale that makes it huge.
Errors unplaceable_obstacles(const SpaceProblem& p) {
    Errors errors;
    try {
        static_cast<void>(Scene(p.obstacles));
    } catch (const InputError& invalid) {
        for (const KeyError& error : invalid.errors()) {
            errors.push_back({"environment." + error.key, error.message});
        }
    }
    return errors;
}

std::string outside_text(double value, double low, double high) {
    return "is " + to_text(value) + ", outside the bounds: expected " + to_text(low) + " to " + to_text(high);
}

Errors start_outside_bounds(const SpaceProblem& p) {
    Errors errors;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double value = p.start.position_m[axis];
        if (value < p.bounds.low_m[axis] || value > p.bounds.high_m[axis]) {
            errors.push_back({std::string("start.") + axis_names[axis],
                              outside_text(value, p.bounds.low_m[axis], p.bounds.high_m[axis])});
        }
    }
    return errors;
}

/// @param key of the list   @param given numbers
Errors wrong_joint_count(const SpaceRobot& robot, std::size_t given, const std::string& key) {
    const auto joints = static_cast<std::size_t>(robot.joints());
    if (given == 0 || given == joints) {
        return {};
    }
    return {{key, "has " + std::to_string(given) + (given == 1 ? " number" : " numbers") + ": expected " +
                      std::to_string(joints) + ", one for each joint of the arm, or no such key"}};
}

/// Angles beyond the limits of their joints. @param key of the list   @param tolerance_rad by which they may be beyond
Errors joints_beyond_limits(const SpaceRobot& robot, const std::vector<double>& joints_rad, double tolerance_rad,
                            const std::string& key) {
    Errors errors;
    for (std::size_t i = 0; i < joints_rad.size(); ++i) {
        const SpaceLinkLimits& link = robot.links[i];
        if (link.is_limited && (joints_rad[i] < link.lower_limit_rad - tolerance_rad ||
                                joints_rad[i] > link.upper_limit_rad + tolerance_rad)) {
            errors.push_back({key, "has " + rounded(joints_rad[i] * degrees_per_radian) + " for joint " +
                                       std::to_string(i + 1) + ", beyond its limits: expected " +
                                       rounded(link.lower_limit_rad * degrees_per_radian) + " to " +
                                       rounded(link.upper_limit_rad * degrees_per_radian)});
        }
    }
    return errors;
}

/// The joints of a start; zeros where it says nothing.
std::vector<double> start_joints_rad(const SpaceProblem& p) {
    return p.start.joints_rad.empty() ? std::vector<double>(p.robot.links.size()) : p.start.joints_rad;
}

Errors misfit_start(const SpaceProblem& p) {
    constexpr double rounding_rad = 1e-9;
    constexpr double swing_rad = 0.05;  // of a joint in motion about a limit to which its reference leads
    Errors errors = start_errors(p.start, p.robot);
    if (wrong_joint_count(p.robot, p.start.joints_rad.size(), "").empty()) {
        const std::string key = p.start.joints_rad.empty() ? "start" : "start.joints_deg";
        append(errors,
               joints_beyond_limits(p.robot, start_joints_rad(p), p.start.reference ? swing_rad : rounding_rad, key));
    }
    if (p.start.attitude) {
        double square = 0;
        for (const double part : *p.start.attitude) {
            square += part * part;
        }
        constexpr double least_square = 1e-12;  // as of has_direction()
        if (square < least_square) {
            errors.push_back(
                {"start.attitude", "has no direction: expected a quaternion [w, x, y, z]; [1, 0, 0, 0] is level"});
        }
    }
    return errors;
}

/// Of a vehicle that begins to follow a reference, which has limits. One in flight is as fast as it is.
Errors start_too_fast(const SpaceProblem& p) {
    Errors errors;
    if (p.start.reference) {
        return errors;
    }
    const double speed = length_of(p.start.velocity_m_s);
    if (speed > p.motion.max_speed_m_s) {
        errors.push_back({"start.velocity_m_s", "makes a start speed of " + rounded(speed) +
                                                    " m/s: expected at most motion.max_speed_m_s, " +
                                                    to_text(p.motion.max_speed_m_s)});
    }
    for (const double rate : p.start.joint_rates_rad_s) {
        if (std::abs(rate) > p.motion.max_joint_rate_rad_s[0]) {
            errors.push_back({"start.joint_rates_rad_s",
                              "has " + rounded(rate) + ", faster than motion.max_joint_rate_deg_s: expected at most " +
                                  rounded(p.motion.max_joint_rate_rad_s[0]) + " in size"});
            break;
        }
    }
    return errors;
}

/// A vector in the body frame at the start as one in the world.
Vector3 in_world(const SpaceStart& start, const Vector3& v) {
    if (!start.attitude) {
        const double c = std::cos(start.yaw_rad), s = std::sin(start.yaw_rad);
        return {c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]};
    }
    const auto& [w, x, y, z] = *start.attitude;
    const Vector3 axis{x, y, z};
    const double square = w * w + dot(axis, axis);
    return v + (2 / square) * cross(axis, cross(axis, v) + w * v);
}

/// A body of a robot, for messages. @param number as in SpaceChecker::Bodies
std::string body_name(std::size_t number) {
    return number == 0 ? "the multirotor" : "link " + std::to_string(number);
}

Errors start_in_collision(const SpaceProblem& p) {
    const SpaceChecker checker(std::make_shared<const Scene>(p.obstacles), shape_of(p.robot),
                               p.planner.collision_checker);
    const SpaceMotion start = start_motion(p.start);
    const SpacePose pose{start.position_m, start.attitude, start.joints_rad};
    if (const auto touching = checker.touching_bodies(pose)) {
        return {{p.start.joints_rad.empty() ? "start" : "start.joints_deg",
                 "makes " + body_name(touching->second) + " touch " + body_name(touching->first) +
                     ": expected angles at which the robot does not touch itself"}};
    }
    return start_near_obstacle(p, checker, pose);
}

Errors start_not_flyable(const SpaceProblem& p) {
    if (!p.aero.enabled) {
        return {};
    }
    const auto scene = std::make_shared<const Scene>(p.obstacles);
    const DirectEffect effect(scene, p.aero, p.robot.rotor_radius_m);
    for (std::size_t k = 0; k < p.robot.plant.rotors.size(); ++k) {
        const Vector3 hub_m = p.start.position_m + in_world(p.start, p.robot.plant.rotors[k].position_m);
        if (!effect.is_flyable(hub_m)) {
            return {{"start", "is outside the flyable area: the disc of rotor " + std::to_string(k + 1) + " is " +
                                  rounded(disc_clearance_m(*scene, hub_m, p.robot.rotor_radius_m)) +
                                  " m from an obstacle; expected at least " +
                                  rounded(p.aero.min_distance_radii * p.robot.rotor_radius_m) +
                                  " m (aero.min_distance_radii times the rotor radius)"}};
        }
    }
    return {};
}

Errors unflyable_uncertainty(const SpaceProblem& p) {
    return p.uncertainty ? uncertainty_errors(*p.uncertainty, uncertain_parts_of(p.robot)) : Errors();
}

// What the values of a goal leave unclear, kind by kind. The key is that of the kind's group, reach_m arm_reach_m().

Errors directionless(const std::optional<Vector3>& direction, const std::string& key) {
    if (direction && !has_direction(*direction)) {
        return {{key + ".direction", "has no direction: expected a vector other than [0, 0, 0], or null"}};
    }
    return {};
}

Errors unclear(const SpaceConfigurationGoal& goal, const SpaceProblem& p, double /*reach_m*/, const std::string& key) {
    if (!goal.x_m && !goal.y_m && !goal.z_m && !goal.yaw_rad && goal.joints_rad.empty()) {
        return {{key, "is free in every coordinate: expected at least one of x_m, y_m, z_m, yaw_deg or joints_deg"}};
    }
    Errors errors = wrong_joint_count(p.robot, goal.joints_rad.size(), key + ".joints_deg");
    if (errors.empty()) {
        append(errors, joints_beyond_limits(p.robot, goal.joints_rad, goal.tolerance_rad, key + ".joints_deg"));
    }
    const std::array coordinates{goal.x_m, goal.y_m, goal.z_m};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double low = p.bounds.low_m[axis], high = p.bounds.high_m[axis];
        if (coordinates[axis] &&
            (*coordinates[axis] < low - goal.tolerance_m || *coordinates[axis] > high + goal.tolerance_m)) {
            errors.push_back({key + "." + axis_names[axis], outside_text(*coordinates[axis], low, high)});
        }
    }
    return errors;
}

/// A point that the end effector cannot get to from anywhere within the bounds.
Errors unreachable(const Vector3& at_m, double tolerance_m, const SpaceProblem& p, double reach_m,
                   const std::string& key) {
    Vector3 beyond_m{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        beyond_m[axis] = std::max({p.bounds.low_m[axis] - at_m[axis], at_m[axis] - p.bounds.high_m[axis], 0.0});
    }
    const double missing_m = length_of(beyond_m) - reach_m - tolerance_m;
    if (missing_m <= 0) {
        return {};
    }
    return {{key, "is out of reach: from anywhere within the bounds the end effector, which gets " + rounded(reach_m) +
                      " m from the multirotor's centre of mass, misses it by " + rounded(missing_m) +
                      " m; widen environment.bounds or move the goal"}};
}

/// A direction or an attitude that the joints do not allow.
Errors misaimed(const SpaceGoalKind& kind, const SpaceProblem& p, const std::string& key) {
    const std::optional<SpaceGoalObjection> objection = aim_objection(p.robot, {kind});
    return objection ? Errors{{key + "." + objection->key, objection->reason}} : Errors();
}

Errors unclear(const SpaceEndEffectorGoal& goal, const SpaceProblem& p, double reach_m, const std::string& key) {
    Errors errors = directionless(goal.direction, key);
    if (errors.empty()) {
        append(errors, misaimed(goal, p, key));
    }
    append(errors, unreachable(goal.position_m, goal.tolerance_m, p, reach_m, key + ".position_m"));
    return errors;
}

Errors unclear(const SpacePoseGoal& goal, const SpaceProblem& p, double reach_m, const std::string& key) {
    Errors errors = misaimed(goal, p, key);
    append(errors, unreachable(goal.position_m, goal.tolerance_m, p, reach_m, key + ".position_m"));
    return errors;
}

Errors unclear(const SpaceCameraGoal& goal, const SpaceProblem& p, double reach_m, const std::string& key) {
    Errors errors = directionless(goal.direction, key);
    if (errors.empty()) {
        append(errors, misaimed(goal, p, key));
    }
    if (goal.nearest_m >= goal.farthest_m) {
        errors.push_back({key + ".distance_m", "is [nearest, farthest]: expected the nearest below the farthest"});
    }
    append(errors, unreachable(goal.target_m, goal.farthest_m, p, reach_m, key + ".target_m"));
    return errors;
}

/// A place that is not on what should be touched there.
Errors place_off_obstacle(const SpaceContactGoal& goal, const SpaceProblem& p, double reach_m, const std::string& key) {
    if (!goal.position_m) {
        return {};
    }
    std::vector<Obstacle> named;
    std::copy_if(p.obstacles.begin(), p.obstacles.end(), std::back_inserter(named),
                 [&](const Obstacle& obstacle) { return obstacle.name == goal.obstacle; });
    if (is_line_clear(Scene(std::move(named)), *goal.position_m, *goal.position_m, goal.tolerance_m)) {
        return {{key + ".position_m", "is farther than tolerance_m, " + to_text(goal.tolerance_m) +
                                          ", from the obstacle '" + excerpt(goal.obstacle) +
                                          "': expected a point of its surface, or null for any"}};
    }
    return goal.part == TouchingPart::end_effector
               ? unreachable(*goal.position_m, goal.tolerance_m, p, reach_m, key + ".position_m")
               : Errors();
}

Errors unclear(const SpaceContactGoal& goal, const SpaceProblem& p, double reach_m, const std::string& key) {
    const bool is_known = std::any_of(p.obstacles.begin(), p.obstacles.end(),
                                      [&](const Obstacle& obstacle) { return obstacle.name == goal.obstacle; });
    if (!goal.obstacle.empty() && is_known) {
        return place_off_obstacle(goal, p, reach_m, key);
    }
    std::vector<std::string_view> names;
    for (const Obstacle& obstacle : p.obstacles) {
        if (!obstacle.name.empty()) {
            names.push_back(obstacle.name);
        }
    }
    return {
        {key + ".obstacle", "is '" + excerpt(goal.obstacle) + "', and no obstacle has that name: expected " +
                                (names.empty() ? "the name of an obstacle, and none has one" : joined_names(names))}};
}

Errors goal_count(const SpaceProblem& p) {
    if (p.goals.empty()) {
        return {{"goal", "is empty: expected one goal at least"}};
    }
    Errors errors;
    const auto check = [&errors](const std::string& key, std::size_t count, std::size_t most) {
        if (count > most) {
            errors.push_back(
                {key, "has " + std::to_string(count) + " goals: expected at most " + std::to_string(most)});
        }
    };
    const std::string list = p.in_any_order ? "goal.in_any_order" : "goal";
    check(list, p.goals.size(), p.in_any_order ? max_targets : max_goals);
    for (std::size_t i = 0; i < p.goals.size(); ++i) {
        const bool is_only = !p.in_any_order && p.goals.size() == 1;
        check(list + (is_only ? "" : "[" + std::to_string(i) + "]") + ".any_of", p.goals[i].any_of.size(), max_goals);
    }
    return errors;
}

Errors unclear_mission(const SpaceProblem& p) {
    if (!p.in_any_order && (p.return_to || p.energy_budget_j)) {
        return {{"goal", "has a place to return to or an energy budget, and no targets in any order"}};
    }
    if (p.return_to && !std::holds_alternative<SpaceConfigurationGoal>(p.return_to->kind)) {
        return {{"goal.return_to", "is no configuration: expected one"}};
    }
    return {};
}

Errors unclear_goals(const SpaceProblem& p) {
    Errors errors;
    const double reach_m = arm_reach_m(p.robot);  // takes longer than a goal does
    for_each_goal(p, [&](const SpaceGoal& goal, const std::string& key) {
        append(errors, std::visit([&](const auto& kind) { return unclear(kind, p, reach_m, key); }, goal.kind));
    });
    return errors;
}

/// A soft law takes up the force of a touch slowly.
Errors touches_that_settle_late(const SpaceProblem& p) {
    constexpr double longest_s = 60;
    bool asks_for_contact = false;
    for_each_goal(p, [&](const SpaceGoal& goal, const std::string& /*key*/) {
        asks_for_contact = asks_for_contact || std::holds_alternative<SpaceContactGoal>(goal.kind);
    });
    const double stiffness_1_s2 = std::visit(
        [](const auto& law) {
            return std::min(law.position_stiffness_1_s2(space::x), law.position_stiffness_1_s2(space::z));
        },
        p.robot.controller.law);
    const double settling_s = touch_settling_constants / (force_loop_share * std::sqrt(stiffness_1_s2));
    if (!asks_for_contact || settling_s <= longest_s) {
        return {};
    }
    return {{"robot.controller", "answers a metre of position error with " + rounded(stiffness_1_s2) +
                                     " m/s2: a touch would settle for more than " + rounded(longest_s) +
                                     " s; raise the gains of the position"}};
}

/// A vehicle in flight is not asked: an obstacle that turns out to stand at its goal is no reason to give it no answer.
constexpr std::string_view before_flight = "start";

const std::array<Check<SpaceProblem>, 20> checks{{
    {{"environment.bounds"}, reversed_bounds},
    {{"environment.obstacles"}, repeated_names<SpaceProblem>},
    {{"environment.obstacles"}, shapeless_cylinders<SpaceProblem>},
    {{"environment.obstacles"}, unplaceable_obstacles},
    {{"aero"}, incomplete_effects<SpaceProblem>},
    {{"environment.bounds", "start"}, start_outside_bounds},
    {{"start", "robot.arm"}, misfit_start},
    {{"start", "motion"}, start_too_fast},
    {{"environment.obstacles", "start", "robot.multirotor.body", "robot.arm", "planner.safety_margin_m"},
     start_in_collision},
    {{"environment.obstacles", "start", "robot.rotors", "aero"}, start_not_flyable},
    {{"uncertainty", "robot.uncertainty", "robot.rotors.time_constant_s", "robot.controller"}, unflyable_uncertainty},
    {{"planner.objective"}, weightless_objective<SpaceProblem>},
    {{"planner.variant", "planner.algorithm"}, algorithm_of_another_variant<SpaceProblem>},
    {{"planner.variant", "planner.worlds", "planner.max_saturation", "planner.max_pitch_rate_deg_s"},
     flights_without_flying<SpaceProblem>},
    {{"planner.parameters"}, split_whole_numbers<SpaceProblem>},
    {{"goal"}, goal_count},
    {{"goal"}, unclear_mission},
    {{"goal", "environment.bounds", "environment.obstacles", "robot.arm"}, unclear_goals},
    {{"goal", "environment.obstacles", "robot.multirotor.body", "robot.arm", before_flight}, buried_goals},
    {{"goal", "robot.controller"}, touches_that_settle_late},
}};

}  // namespace

Errors further_space_problem_errors(const SpaceProblem& problem, WrongKeys wrong) {
    Errors errors = value_errors(space_problem_parameters(), problem, "", wrong);
    append(errors, further_space_robot_errors(problem.robot, wrong, "robot."));
    append(errors, run_checks(std::span<const Check<SpaceProblem>>(checks), problem, "", wrong));
    return errors;
}

std::vector<SpaceGoal> goals_of(const SpaceProblem& problem) {
    std::vector<SpaceGoal> goals = problem.goals;
    if (problem.return_to) {
        goals.push_back(*problem.return_to);
    }
    return goals;
}

Errors start_errors(const SpaceStart& start, const SpaceRobot& robot) {
    Errors errors = wrong_joint_count(robot, start.joints_rad.size(), "start.joints_deg");
    append(errors, wrong_joint_count(robot, start.joint_rates_rad_s.size(), "start.joint_rates_rad_s"));
    const auto check = [&errors](const char* key, const std::vector<double>& given, std::size_t expected,
                                 const char* of_what) {
        if (given.size() != expected) {
            errors.push_back({key, "has " + std::to_string(given.size()) + " numbers: expected " +
                                       std::to_string(expected) + ", " + of_what});
        }
        if (!std::ranges::all_of(given, [](double number) { return std::isfinite(number); })) {
            errors.push_back({key, "has a number that is not finite: expected finite ones"});
        }
    };
    if (const std::vector<double>& given = start.carry.rotor_thrust_n; !given.empty()) {
        check("start.rotor_thrust_n", given, robot.plant.rotors.size(), "one for each rotor");
    }
    if (const std::vector<double>& given = start.carry.controller_memory; !given.empty()) {
        check("start.controller_memory", given,
              static_cast<std::size_t>(memory_size(robot.controller.law, robot.joints())),
              "as many as robot.controller remembers");
    }
    if (const auto& reference = start.reference) {
        const auto axes = static_cast<std::size_t>(space::first_joint + robot.joints());
        constexpr const char* for_each = "one for each of x, y, z, yaw and the joints";
        check("start.reference.position", reference->position, axes, for_each);
        check("start.reference.velocity", reference->velocity, axes, for_each);
        check("start.reference.acceleration", reference->acceleration, axes, for_each);
    }
    return errors;
}

Errors space_problem_errors(const SpaceProblem& problem) {
    return further_space_problem_errors(problem, {});
}

Errors space_problem_warnings(const SpaceProblem& problem) {
    Errors warnings = space_robot_warnings(problem.robot);
    append(warnings, robot_slips(problem.robot));
    for (KeyError& warning : warnings) {
        warning.key.insert(0, "robot.");
    }
    append(warnings, no_margin(problem));
    append(warnings, space_goal_warnings(problem));
    append(warnings, space_hover_warnings(problem));
    append(warnings, problem_slips(problem));
    return warnings;
}

}  // namespace downwash

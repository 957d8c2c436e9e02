#include "downwash/problems/goal_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/controllers/control_law.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/problems/goal_reach.hpp"
#include "downwash/problems/touch_places.hpp"
#include "downwash/simulation/contact_goal.hpp"

namespace downwash {
namespace {

std::string rounded(double value) {
    return to_text(value, 4);
}

constexpr std::string_view key_of_return = "goal.return_to";

/// Where the configuration of a goal stands in a file.
std::string pose_key(const std::string& goal_key) {
    return goal_key == key_of_return ? goal_key : goal_key + ".configuration";
}

/// Calls visit(goal, key) for every goal, alternatives one by one.
template <class Visit>
void for_each_goal(const Problem& p, const Visit& visit) {
    const auto name = [](std::string_view list, std::size_t i) {
        return std::string(list) + "[" + std::to_string(i) + "]";
    };
    for (std::size_t i = 0; i < p.targets.size(); ++i) {
        const std::string key = name("goal.in_any_order", i);
        if (p.targets[i].any_of.empty()) {
            visit(p.targets[i], key);
        }
        for (std::size_t k = 0; k < p.targets[i].any_of.size(); ++k) {
            visit(p.targets[i].any_of[k], name(key + ".any_of", k));
        }
    }
    if (p.return_to) {
        visit(*p.return_to, std::string(key_of_return));
    }
    if (!p.targets.empty()) {
        return;
    }
    for (std::size_t i = 0; i < p.stops.size(); ++i) {
        visit(p.stops[i], name("goal", i));
    }
    if (p.goal.contact) {  // its alternatives stand in no file
        return;
    }
    if (!p.stops.empty()) {
        visit(p.goal, name("goal", p.stops.size()));
    } else if (p.goal.any_of.empty()) {
        visit(p.goal, "goal");
    }
    for (std::size_t i = 0; i < p.goal.any_of.size() && p.stops.empty(); ++i) {
        visit(p.goal.any_of[i], name("goal.any_of", i));
    }
}

/// The errors that a rule finds in each goal.
template <class Rule>
std::vector<KeyError> in_each_goal(const Problem& p, const Rule& rule) {
    std::vector<KeyError> errors;
    for_each_goal(p, [&](const Goal& goal, const std::string& key) { append(errors, rule(goal, key)); });
    return errors;
}

std::vector<KeyError> too_many_goals(const Problem& p) {
    std::vector<KeyError> errors;
    const auto check = [&](const std::string& key, std::size_t count, std::size_t most) {
        if (count > most) {
            errors.push_back(
                {key, "has " + std::to_string(count) + " goals: expected at most " + std::to_string(most)});
        }
    };
    check("goal.in_any_order", p.targets.size(), max_targets);
    for (std::size_t i = 0; i < p.targets.size(); ++i) {
        check("goal.in_any_order[" + std::to_string(i) + "].any_of", p.targets[i].any_of.size(), max_goals);
    }
    check("goal", p.stops.size() + 1, max_goals);
    check("goal.any_of", p.goal.any_of.size(), max_goals);
    return errors;
}

std::vector<KeyError> unclear_goals(const Problem& p) {
    const bool may_choose = p.stops.empty();
    const auto names_a_place = [](const Goal& goal) { return goal.end_effector || goal.configuration; };
    std::vector<KeyError> errors;
    if (p.targets.empty() && (p.return_to || p.energy_budget_j)) {
        errors.push_back({"goal", "has a place to return to or an energy budget, and no targets in any order"});
    }
    for (std::size_t i = 0; i < p.targets.size(); ++i) {
        const Goal& target = p.targets[i];
        const std::string key = "goal.in_any_order[" + std::to_string(i) + "]";
        if (!target.any_of.empty() && names_a_place(target)) {
            errors.push_back({key, "needs exactly one of end_effector, configuration or any_of"});
        }
    }
    if (may_choose && (p.goal.contact || !p.goal.any_of.empty()) && names_a_place(p.goal)) {
        errors.push_back({"goal", "needs exactly one of end_effector, configuration, any_of or contact"});
    }
    if (p.goal.contact && !(p.stops.empty() && p.targets.empty())) {
        errors.push_back({"goal", "asks for contact as one of several goals: expected contact for the only goal"});
    }
    append(
        errors, in_each_goal(p, [&](const Goal& goal, const std::string& key) -> std::vector<KeyError> {
            if (goal.contact) {
                return {{key, "asks for contact as one of several goals: expected contact for the only goal"}};
            }
            if (!goal.any_of.empty()) {
                return {{key, "has alternatives: expected any_of for the only goal, and not within any_of"}};
            }
            if (goal.end_effector.has_value() == goal.configuration.has_value()) {
                return {{key, "needs exactly one of end_effector or configuration"}};
            }
            const auto& pose = goal.configuration;
            if (pose && !pose->x_m && !pose->z_m && !pose->arm_rad) {
                return {{pose_key(key), "is free in every coordinate: expected at least one of x_m, z_m or arm_deg"}};
            }
            if (pose && ((pose->tolerance_x_m && !pose->x_m) || (pose->tolerance_z_m && !pose->z_m))) {
                const std::string axis = pose->tolerance_x_m && !pose->x_m ? "x_m" : "z_m";
                return {{pose_key(key) + ".tolerance_" + axis, "has a meaning only with " + axis + ": remove it"}};
            }
            return {};
        }));
    return errors;
}

std::vector<KeyError> holds_beyond_longest_plan(const Problem& p) {
    const double max_s = static_cast<double>(max_plan_ticks) / p.robot.controller.rate_hz;
    std::vector<KeyError> errors = in_each_goal(p, [&](const Goal& goal, const std::string& key) {
        return goal.hold_s <= max_s
                   ? std::vector<KeyError>()
                   : std::vector<KeyError>{{key + ".hold_s", "is " + to_text(goal.hold_s) + ": expected at most " +
                                                                 to_text(max_s) + " s, " +
                                                                 std::to_string(max_plan_ticks) + " control ticks"}};
    });
    double sum_s = 0;
    for (const Goal& stop : p.stops) {
        sum_s += stop.hold_s;
    }
    if (!p.targets.empty()) {
        return errors;  // the longest plan limits how many of them are visited
    }
    if (sum_s >= max_s) {
        errors.push_back({"goal", "is held for " + to_text(sum_s) + " s before its last entry: expected less than " +
                                      to_text(max_s) + " s, " + std::to_string(max_plan_ticks) +
                                      " control ticks, in one plan"});
    }
    return errors;
}

std::vector<KeyError> configurations_outside_bounds(const Problem& p) {
    return in_each_goal(p, [&](const Goal& goal, const std::string& goal_key) {
        std::vector<KeyError> errors;
        if (!goal.configuration) {
            return errors;
        }
        const auto check = [&](const char* key, const std::optional<double>& value, double tolerance_m, double low,
                               double high) {
            if (value && (*value < low - tolerance_m || *value > high + tolerance_m)) {
                errors.push_back({pose_key(goal_key) + key, "is " + to_text(*value) +
                                                                ", outside the bounds: expected " + to_text(low) +
                                                                " to " + to_text(high)});
            }
        };
        const GoalTolerance tolerance = tolerance_of(goal);
        check(".x_m", goal.configuration->x_m, tolerance.x_m, p.bounds.x_low_m, p.bounds.x_high_m);
        check(".z_m", goal.configuration->z_m, tolerance.z_m, p.bounds.z_low_m, p.bounds.z_high_m);
        return errors;
    });
}

std::vector<KeyError> configurations_beyond_arm_limits(const Problem& p) {
    return in_each_goal(p, [&](const Goal& goal, const std::string& key) -> std::vector<KeyError> {
        if (!goal.configuration || !goal.configuration->arm_rad ||
            arm_can_turn_to(p.robot.arm, *goal.configuration->arm_rad, tolerance_of(goal).usable().angle_rad)) {
            return {};
        }
        return {{pose_key(key) + ".arm_deg", "is beyond the arm's limits: expected " + arm_limits_text(p.robot.arm)}};
    });
}

std::vector<KeyError> configurations_in_collision(const ProblemCheck& check) {
    return in_each_goal(check, [&](const Goal& goal, const std::string& key) -> std::vector<KeyError> {
        if (!goal.configuration || reach_of(check, goal) != Reach::blocked) {
            return {};
        }
        return {{pose_key(key),
                 "is in collision with an obstacle or nearer to it than planner.safety_margin_m, "
                 "anywhere within its tolerances: move the goal or the obstacle"}};
    });
}

/// The name of a box, cylinder or sphere around a point of the plane of motion; empty if there is none.
std::string obstacle_around(const ProblemCheck& check, double x_m, double z_m) {
    const Vector3 at_m = check.problem().plane.to_world(x_m, 0, z_m);
    std::size_t part = 0;  // those of primitives come first, in the order of the obstacles
    for (const Obstacle& obstacle : check.problem().obstacles) {
        if (std::holds_alternative<Mesh>(obstacle.shape) || std::holds_alternative<Octomap>(obstacle.shape)) {
            continue;
        }
        const Interval inside = check.scene()->vertical_extent(part++, at_m[0], at_m[1]);
        if (inside.low <= at_m[2] && at_m[2] <= inside.high) {
            return obstacle.name;
        }
    }
    return "";
}

std::vector<KeyError> end_effector_out_of_reach(const ProblemCheck& check, const Goal& goal, const std::string& key) {
    const Problem& p = check.problem();
    if (!goal.end_effector) {
        return {};
    }
    const double missing_m = missing_reach_m(p, goal);
    if (missing_m > 0) {
        return {{key, "is out of reach: from anywhere within the bounds the arm of " + to_text(p.robot.arm.length_m) +
                          " m misses it by " + rounded(missing_m) + " m; widen environment.bounds or move the goal"}};
    }
    switch (reach_of(check, goal)) {
        case Reach::clear:
            return {};
        case Reach::none:
            return {{key,
                     "is out of reach: the limits of the arm, the wanted direction and the bounds "
                     "leave no pose that gets there"}};
        case Reach::blocked:
            break;
    }
    const std::string around = obstacle_around(check, goal.end_effector->x_m, goal.end_effector->z_m);
    const std::string where = around.empty() ? "" : "; it is inside the obstacle '" + excerpt(around) + "'";
    return {{key,
             "is out of reach: in every pose that gets there the robot touches an obstacle or is "
             "nearer to it than planner.safety_margin_m" +
                 where}};
}

std::vector<KeyError> end_effectors_out_of_reach(const ProblemCheck& check) {
    return in_each_goal(check, [&](const Goal& goal, const std::string& key) {
        return end_effector_out_of_reach(check, goal, key + ".end_effector");
    });
}

std::vector<KeyError> contacts_without_place(const ProblemCheck& check) {
    const Problem& p = check.problem();
    if (!p.goal.contact) {
        return {};
    }
    std::vector<std::string_view> names;
    for (const Obstacle& obstacle : p.obstacles) {
        names.push_back(obstacle.name);
    }
    const std::string& wanted = p.goal.contact->obstacle;
    if (std::find(names.begin(), names.end(), wanted) == names.end()) {
        return {{"goal.contact.obstacle",
                 "is '" + excerpt(wanted) + "': expected the name of an obstacle" + did_you_mean(wanted, names)}};
    }
    const std::string reason = find_touches(check).reason;
    return reason.empty() ? std::vector<KeyError>() : std::vector<KeyError>{{"goal.contact", reason}};
}

/// A soft law takes up the force of a touch slowly.
std::vector<KeyError> touches_that_settle_late(const ProblemCheck& check) {
    const Problem& p = check.problem();
    constexpr double longest_s = 60;
    const double stiffness_1_s2 = std::visit(
        [](const auto& law) { return std::min(law.position_stiffness_1_s2(0), law.position_stiffness_1_s2(1)); },
        controllers::flown_law(p.robot.controller.law));
    const double settling_s = touch_settling_constants / (force_loop_share * std::sqrt(stiffness_1_s2));
    if (!p.goal.contact || settling_s <= longest_s) {
        return {};
    }
    return {{"robot.controller", "answers a metre of position error with " + rounded(stiffness_1_s2) +
                                     " m/s2: a touch would settle for more than " + rounded(longest_s) +
                                     " s; raise the gains of the position"}};
}

const std::array<Check<ProblemCheck>, 9> checks{{
    {{"goal"}, too_many_goals},
    {{"goal"}, unclear_goals},
    {{"goal", "robot.controller"}, holds_beyond_longest_plan},
    {{"goal", "environment.bounds"}, configurations_outside_bounds},
    {{"goal", "robot.arm"}, configurations_beyond_arm_limits},
    {{"goal", "environment", "robot.multirotor.body", "robot.arm", "planner.safety_margin_m"},
     configurations_in_collision},
    {{"goal", "environment", "robot.multirotor.body", "robot.arm", "planner.safety_margin_m"},
     end_effectors_out_of_reach},
    {{"goal", "start", "environment", "robot", "aero", "planner.safety_margin_m"}, contacts_without_place},
    {{"goal", "robot.controller"}, touches_that_settle_late},
}};

}  // namespace

std::span<const Check<ProblemCheck>> goal_checks() {
    return checks;
}

std::string arm_limits_text(const ArmParameters& arm) {
    return rounded(arm.lower_limit_rad * degrees_per_radian) + " to " +
           rounded(arm.upper_limit_rad * degrees_per_radian);
}

}  // namespace downwash

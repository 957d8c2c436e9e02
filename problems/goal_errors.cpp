#include "downwash/problems/goal_errors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/controllers/control_law.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/problems/goal_kinds.hpp"
#include "downwash/problems/number_text.hpp"
#include "downwash/problems/touch_places.hpp"
#include "downwash/simulation/contact_goal.hpp"

namespace downwash {
namespace {

using problems::rounded;

constexpr std::string_view key_of_return = "goal.return_to";

/// Where the keys of a goal's kind stand in a file.
std::string kind_key(const Goal& goal, const std::string& goal_key) {
    return goal_key == key_of_return ? goal_key : goal_key + "." + std::string(name_of(goal.kind));
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
    for (std::size_t i = 0; i < p.goals_before.size(); ++i) {
        visit(p.goals_before[i], name("goal", i));
    }
    if (!p.goals_before.empty()) {
        visit(p.goal, name("goal", p.goals_before.size()));
    } else if (p.goal.any_of.empty()) {
        visit(p.goal, "goal");
    }
    for (std::size_t i = 0; i < p.goal.any_of.size() && p.goals_before.empty(); ++i) {
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
    check("goal", p.goals_before.size() + 1, max_goals);
    check("goal.any_of", p.goal.any_of.size(), max_goals);
    return errors;
}

std::vector<KeyError> unclear_goals(const Problem& p) {
    std::vector<KeyError> errors;
    if (p.targets.empty() && (p.return_to || p.energy_budget_j)) {
        errors.push_back({"goal", "has a place to return to or an energy budget, and no targets in any order"});
    }
    if (p.return_to && !std::holds_alternative<ConfigurationGoal>(p.return_to->kind)) {
        return {{std::string(key_of_return), "is no configuration: expected one"}};
    }
    append(errors, in_each_goal(p, [&](const Goal& goal, const std::string& key) -> std::vector<KeyError> {
               if (!goal.any_of.empty()) {
                   return {{key, "has alternatives: expected any_of for the only goal, and not within any_of"}};
               }
               return unclear_values(goal, kind_key(goal, key));
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
    for (const Goal& stop : p.goals_before) {
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

std::vector<KeyError> goals_outside_bounds(const Problem& p) {
    return in_each_goal(p, [&](const Goal& goal, const std::string& key) {
        return places_outside_bounds(goal, p, kind_key(goal, key));
    });
}

std::vector<KeyError> goals_beyond_arm_limits(const Problem& p) {
    return in_each_goal(p, [&](const Goal& goal, const std::string& key) {
        return angles_beyond_limits(goal, p, kind_key(goal, key));
    });
}

std::vector<KeyError> goals_out_of_reach(const ProblemCheck& check) {
    return in_each_goal(check, [&](const Goal& goal, const std::string& key) {
        return goal_out_of_reach(goal, check, kind_key(goal, key));
    });
}

std::vector<KeyError> contacts_without_place(const ProblemCheck& check) {
    std::vector<std::string_view> names;
    for (const Obstacle& obstacle : check.problem().obstacles) {
        names.push_back(obstacle.name);
    }
    return in_each_goal(check, [&](const Goal& goal, const std::string& key) -> std::vector<KeyError> {
        if (!asks_for_contact(goal)) {
            return {};
        }
        const std::string& wanted = std::get<ContactGoal>(goal.kind).obstacle;
        if (std::ranges::find(names, wanted) == names.end()) {
            return {{kind_key(goal, key) + ".obstacle",
                     "is '" + excerpt(wanted) + "': expected the name of an obstacle" + did_you_mean(wanted, names)}};
        }
        const std::string reason = find_touches(check, goal).reason;
        return reason.empty() ? std::vector<KeyError>() : std::vector<KeyError>{{kind_key(goal, key), reason}};
    });
}

/// A soft law takes up the force of a touch slowly.
std::vector<KeyError> touches_that_settle_late(const ProblemCheck& check) {
    const Problem& p = check.problem();
    constexpr double longest_s = 60;
    const double stiffness_1_s2 = std::visit(
        [](const auto& law) { return std::min(law.position_stiffness_1_s2(0), law.position_stiffness_1_s2(1)); },
        controllers::flown_law(p.robot.controller.law));
    const double settling_s = touch_settling_constants / (force_loop_share * std::sqrt(stiffness_1_s2));
    bool touches = false;
    for_each_goal(p, [&](const Goal& goal, const std::string& /*key*/) { touches = touches || may_touch(goal); });
    if (!touches || settling_s <= longest_s) {
        return {};
    }
    return {{"robot.controller", "answers a metre of position error with " + rounded(stiffness_1_s2) +
                                     " m/s2: a touch would settle for more than " + rounded(longest_s) +
                                     " s; raise the gains of the position"}};
}

const Check<ProblemCheck> checks_of_goals[] = {
    {{"goal"}, too_many_goals},
    {{"goal"}, unclear_goals},
    {{"goal", "robot.controller"}, holds_beyond_longest_plan},
    {{"goal", "environment.bounds"}, goals_outside_bounds},
    {{"goal", "robot.arm"}, goals_beyond_arm_limits},
    {{"goal", "environment", "robot.multirotor.body", "robot.arm", "planner.safety_margin_m"}, goals_out_of_reach},
    {{"goal", "start", "environment", "robot", "aero", "planner.safety_margin_m"}, contacts_without_place},
    {{"goal", "robot.controller"}, touches_that_settle_late},
};

}  // namespace

std::span<const Check<ProblemCheck>> goal_checks() {
    return checks_of_goals;
}

}  // namespace downwash

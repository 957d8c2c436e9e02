#include "downwash/problems/goal_parameters.hpp"

#include <algorithm>
#include <string>
#include <variant>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/problems/goal_kinds.hpp"
#include "downwash/problems/mission_rows.hpp"

namespace downwash {
namespace {

using Rows = std::vector<Parameter<Problem>>;

bool has_targets(const Problem& p, std::size_t /*index*/) {
    return !p.targets.empty();
}

/// Every kind of goal, of which exactly one is given.
/// @param goal names the Goal that has them
template <class GoalMember>
void add_kinds(Rows& rows, const std::string& path, GoalMember goal) {
    for (const Parameter<Goal>& row : goal_kind_rows()) {
        rows.push_back(parameters::nested<Problem>(row, path + ".", goal));
    }
}

/// Every kind of goal for the only goal, which is there unless targets replace it.
template <class GoalMember>
void add_kinds_of_only(Rows& rows, const std::string& path, GoalMember goal) {
    const auto first = static_cast<std::ptrdiff_t>(rows.size());
    add_kinds(rows, path, goal);
    std::for_each(rows.begin() + first, rows.end(), [](Parameter<Problem>& row) {
        if (row.count) {
            row.count = [count = row.count](const Problem& p, std::size_t i) {
                return has_targets(p, i) ? 0 : count(p, i);
            };
        }
    });
}

template <class GoalMember>
Parameter<Problem> hold(const std::string& path, GoalMember goal) {
    return parameters::number<Problem>(
               path + ".hold_s",
               "how long it is held", [goal](auto& p, std::size_t i) -> auto& { return goal(p, i).hold_s; })
        .at_least(1)
        .at_most(3600);
}

Parameter<Problem> goal_group() {
    auto goal =
        parameters::group<Problem>("goal", "where the flight must end and stay; a list: where it must stay in turn")
            .is_required();
    goal.can_be_list = true;
    goal.count = [](const Problem& p, std::size_t) { return p.goals_before.size() + 1; };
    goal.resize = [](Problem& p, std::size_t, std::size_t count) {
        p.goals_before.assign(count - 1, Goal{});
        p.goal = Goal{};
        p.targets.clear();
        p.return_to.reset();
        p.energy_budget_j.reset();
    };
    return goal;
}

/// A choice of several goals.
/// @param goal names the Goal that has them
template <class GoalMember>
void add_choice(Rows& rows, const std::string& path, GoalMember goal) {
    rows.push_back(
        parameters::list<Problem>(
            path + ".any_of",
            "goals of which any will do", [goal](auto& p, std::size_t i) -> auto& { return goal(p, i).any_of; })
            .is_exclusive());
    const auto alternative = [goal](auto& p, std::size_t i) -> auto& {
        return goal(p, outer_element(i)).any_of[inner_element(i)];
    };
    add_kinds(rows, path + ".any_of[]", alternative);
    rows.push_back(hold(path + ".any_of[]", alternative));
}

void add_any_order(Rows& rows) {
    const auto target = [](auto& p, std::size_t i) -> auto& {
        return p.targets[i];
    };
    rows.push_back(parameters::list<Problem>(
                       "goal.in_any_order",
                       "targets: the planner chooses in which order the flight stays at them, and at which alternative",
                       [](auto& p) -> auto& { return p.targets; })
                       .is_exclusive());
    add_kinds(rows, "goal.in_any_order[]", target);
    add_choice(rows, "goal.in_any_order[]", target);
    rows.push_back(
        hold("goal.in_any_order[]", target).only("without any_of", [target](const Problem& p, std::size_t i) {
            return target(p, i).any_of.empty();
        }));
    const auto return_to = [](auto& p, std::size_t) -> auto& {
        return *p.return_to;
    };
    add_mission_rows<ConfigurationGoal>(rows, configuration_rows(), hold("goal.return_to", return_to), has_targets);
}

}  // namespace

void add_goal_rows(Rows& rows) {
    const auto only = [](auto& p, std::size_t) -> auto& {
        return p.goal;
    };
    rows.push_back(goal_group());
    add_kinds_of_only(rows, "goal", only);
    add_choice(rows, "goal", only);
    add_any_order(rows);
    rows.push_back(hold("goal", only).only("without any_of and in_any_order", [](const Problem& p, std::size_t) {
        return p.goal.any_of.empty() && p.targets.empty();
    }));

    const auto in_turn = [](auto& p, std::size_t i) -> auto& {
        return i < p.goals_before.size() ? p.goals_before[i] : p.goal;
    };
    add_kinds(rows, "goal[]", in_turn);
    rows.push_back(hold("goal[]", in_turn));
}

}  // namespace downwash

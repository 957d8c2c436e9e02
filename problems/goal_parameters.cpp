#include "downwash/problems/goal_parameters.hpp"

#include <string>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/problems/obstacle_parameters.hpp"

namespace downwash {
namespace {

using Rows = std::vector<Parameter<Problem>>;

template <class Member>
Parameter<Problem> position(const std::string& path, std::string_view description, Member member) {
    return parameters::number<Problem>(path, description, member).at_least(-farthest_m).at_most(farthest_m);
}
template <class Member>
Parameter<Problem> angle(const std::string& path, std::string_view description, Member member) {
    return parameters::number<Problem>(path, description, member).at_least(-3600).at_most(3600);
}
template <class Member>
Parameter<Problem> tolerance(const std::string& path, std::string_view description, double most, Member member) {
    return parameters::number<Problem>(path, description, member).above(0).at_most(most);
}

/// @param kind names the EndEffectorGoal or ConfigurationGoal
template <class Kind>
void add_point_tolerances(Rows& rows, const std::string& path, Kind kind) {
    rows.push_back(tolerance(
        path + ".tolerance_m", "distance that is near enough",
        100, [kind](auto& p, std::size_t i) -> auto& { return kind(p, i).tolerance_m; }));
    rows.push_back(tolerance(
        path + ".tolerance_x_m",
        "where one of the two is given, x and z are judged one by one: of x; null: tolerance_m",
        100, [kind](auto& p, std::size_t i) -> auto& { return kind(p, i).tolerance_x_m; }));
    rows.push_back(tolerance(
        path + ".tolerance_z_m", "of z; null: tolerance_m",
        100, [kind](auto& p, std::size_t i) -> auto& { return kind(p, i).tolerance_z_m; }));
}

/// @param goal names the Goal
template <class GoalMember>
void add_end_effector(Rows& rows, const std::string& path, GoalMember goal) {
    rows.push_back(
        parameters::optional_group<Problem>(
            path,
            "the end effector at a point", [goal](auto& p, std::size_t i) -> auto& { return goal(p, i).end_effector; })
            .is_exclusive());
    const auto tip = [goal](auto& p, std::size_t i) -> auto& {
        return *goal(p, i).end_effector;
    };
    rows.push_back(
        position(
            path + ".x_m", "along the plane", [tip](auto& p, std::size_t i) -> auto& { return tip(p, i).x_m; })
            .is_required());
    rows.push_back(position(
                       path + ".z_m", "upwards", [tip](auto& p, std::size_t i) -> auto& { return tip(p, i).z_m; })
                       .is_required());
    add_point_tolerances(rows, path, tip);
    rows.push_back(angle(
        path + ".direction_deg",
        "direction of the arm in the plane, down is 90; null for any", [tip](auto& p, std::size_t i) -> auto& {
            return tip(p, i).direction_rad;
        }));
    rows.push_back(tolerance(
        path + ".direction_tolerance_deg", "deviation that is near enough",
        180, [tip](auto& p, std::size_t i) -> auto& { return tip(p, i).direction_tolerance_rad; }));
}

/// The keys of a ConfigurationGoal.
/// @param pose names it
template <class PoseMember>
void add_pose(Rows& rows, const std::string& path, PoseMember pose) {
    rows.push_back(position(
        path + ".x_m",
        "along the plane; null for any", [pose](auto& p, std::size_t i) -> auto& { return pose(p, i).x_m; }));
    rows.push_back(position(
        path + ".z_m", "upwards; null for any", [pose](auto& p, std::size_t i) -> auto& { return pose(p, i).z_m; }));
    rows.push_back(angle(
        path + ".arm_deg",
        "arm from the vehicle's nose, modulo a turn; null for any", [pose](auto& p, std::size_t i) -> auto& {
            return pose(p, i).arm_rad;
        }));
    add_point_tolerances(rows, path, pose);
    rows.push_back(tolerance(
        path + ".tolerance_deg", "deviation of the arm that is near enough",
        180, [pose](auto& p, std::size_t i) -> auto& { return pose(p, i).tolerance_rad; }));
}

/// @param goal names the Goal
template <class GoalMember>
void add_configuration(Rows& rows, const std::string& path, GoalMember goal) {
    rows.push_back(
        parameters::optional_group<Problem>(
            path,
            "the vehicle and its arm", [goal](auto& p, std::size_t i) -> auto& { return goal(p, i).configuration; })
            .is_exclusive());
    add_pose(
        rows, path, [goal](auto& p, std::size_t i) -> auto& { return *goal(p, i).configuration; });
}

/// Every kind of goal, of which exactly one is given.
/// @param goal names the Goal
template <class GoalMember>
void add_kinds(Rows& rows, const std::string& path, GoalMember goal) {
    add_end_effector(rows, path + ".end_effector", goal);
    add_configuration(rows, path + ".configuration", goal);
}

/// A goal that asks for contact; only where it is the only one.
void add_contact(Rows& rows) {
    rows.push_back(parameters::optional_group<Problem>(
                       "goal.contact", "a surface to touch and press on for hold_s, from where the robot fits best",
                       [](auto& p, std::size_t) -> auto& { return p.goal.contact; })
                       .is_exclusive());
    const auto contact = [](auto& p, std::size_t) -> auto& {
        return *p.goal.contact;
    };
    const auto length = [&](std::string_view name, std::string_view description, auto member) {
        return parameters::number<Problem>("goal.contact." + std::string(name), description, member);
    };
    rows.push_back(
        parameters::text<Problem>(
            "goal.contact.obstacle",
            "name of the obstacle", [contact](auto& p, std::size_t i) -> auto& { return contact(p, i).obstacle; })
            .is_required());
    rows.push_back(
        length(
            "force_n",
            "normal force that is held", [contact](auto& p, std::size_t i) -> auto& { return contact(p, i).force_n; })
            .above(0)
            .at_most(1000)
            .is_required());
    rows.push_back(parameters::choice<Problem, TouchingPart>(
        "goal.contact.part",
        "what touches: the top of the multirotor, from below, or the end of the arm, along the arm",
        {{TouchingPart::frame, "frame"}, {TouchingPart::end_effector, "end_effector"}},
        [contact](auto& p, std::size_t i) -> auto& { return contact(p, i).part; }));
    rows.push_back(position(
        "goal.contact.x_m",
        "where on an underside or a top; null: anywhere", [contact](auto& p, std::size_t i) -> auto& {
            return contact(p, i).x_m;
        }));
    rows.push_back(position(
        "goal.contact.z_m",
        "where on a side; null: anywhere", [contact](auto& p, std::size_t i) -> auto& { return contact(p, i).z_m; }));
    rows.push_back(tolerance(
        "goal.contact.tolerance_m", "of the place from which it touches",
        100, [contact](auto& p, std::size_t i) -> auto& { return contact(p, i).tolerance_m; }));
    rows.push_back(length(
                       "force_tolerance_n", "what the mean force of a second may be off by; null: a fifth of force_n",
                       [contact](auto& p, std::size_t i) -> auto& { return contact(p, i).force_tolerance_n; })
                       .above(0)
                       .at_most(1000));
    rows.push_back(length(
                       "standoff_m", "distance from the surface before and after",
                       [contact](auto& p, std::size_t i) -> auto& { return contact(p, i).standoff_m; })
                       .above(0)
                       .at_most(10));
    rows.push_back(
        length(
            "speed_m_s",
            "of approach and leaving", [contact](auto& p, std::size_t i) -> auto& { return contact(p, i).speed_m_s; })
            .above(0)
            .at_most(1));
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
    goal.count = [](const Problem& p, std::size_t) { return p.stops.size() + 1; };
    goal.resize = [](Problem& p, std::size_t, std::size_t count) {
        p.stops.assign(count - 1, Goal{});
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
    auto any_of =
        parameters::list<Problem>(
            path + ".any_of",
            "goals of which any will do", [goal](auto& p, std::size_t i) -> auto& { return goal(p, i).any_of; })
            .is_exclusive();
    any_of.count = [goal](const Problem& p, std::size_t i) {
        return goal(p, i).contact ? 0 : goal(p, i).any_of.size();
    };
    rows.push_back(std::move(any_of));
    const auto alternative = [goal](auto& p, std::size_t i) -> auto& {
        return goal(p, outer_element(i)).any_of[inner_element(i)];
    };
    add_kinds(rows, path + ".any_of[]", alternative);
    rows.push_back(hold(path + ".any_of[]", alternative));
}

bool has_targets(const Problem& p, std::size_t /*index*/) {
    return !p.targets.empty();
}

void add_any_order(Rows& rows) {
    constexpr std::string_view with_targets = "with in_any_order";
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
    rows.push_back(parameters::group<Problem>(
                       "goal.return_to", "where the flight must end and stay after the last target",
                       [](const Problem& p, std::size_t) { return p.return_to.has_value(); },
                       [](Problem& p, std::size_t, bool is_there) {
                           p.return_to.reset();
                           if (is_there) {
                               p.return_to.emplace().configuration.emplace();
                           }
                       })
                       .only(with_targets, has_targets));
    add_pose(
        rows, "goal.return_to", [](auto& p, std::size_t) -> auto& { return *p.return_to->configuration; });
    rows.push_back(hold(
        "goal.return_to", [](auto& p, std::size_t) -> auto& { return *p.return_to; }));
    rows.push_back(parameters::number<Problem>(
                       "goal.energy_budget_j",
                       "energy that no flight may exceed: targets for which it is not enough are left out",
                       [](auto& p, std::size_t) -> auto& { return p.energy_budget_j; })
                       .above(0)
                       .at_most(1e12)
                       .only(with_targets, has_targets));
}

}  // namespace

void add_goal_rows(Rows& rows) {
    const auto only = [](auto& p, std::size_t) -> auto& {
        return p.goal;
    };
    rows.push_back(goal_group());
    add_kinds(rows, "goal", only);
    add_contact(rows);
    add_choice(rows, "goal", only);
    add_any_order(rows);
    rows.push_back(hold("goal", only).only("without any_of and in_any_order", [](const Problem& p, std::size_t) {
        return (p.goal.any_of.empty() || p.goal.contact) && p.targets.empty();
    }));

    const auto in_turn = [](auto& p, std::size_t i) -> auto& {
        return i < p.stops.size() ? p.stops[i] : p.goal;
    };
    add_kinds(rows, "goal[]", in_turn);
    rows.push_back(hold("goal[]", in_turn));
}

}  // namespace downwash

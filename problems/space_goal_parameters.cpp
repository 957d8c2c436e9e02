#include "downwash/problems/space_goal_parameters.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/problems/mission_rows.hpp"
#include "downwash/problems/obstacle_parameters.hpp"
#include "downwash/problems/space_rows.hpp"

namespace downwash {
namespace {

using Row = Parameter<SpaceGoal>;
using Rows = std::vector<Row>;

constexpr double largest_angle_deg = 180;
constexpr std::string_view key_of_return = "goal.return_to";

constexpr std::string_view kind_name(const SpaceConfigurationGoal* /*kind*/) {
    return "configuration";
}
constexpr std::string_view kind_name(const SpaceEndEffectorGoal* /*kind*/) {
    return "end_effector";
}
constexpr std::string_view kind_name(const SpacePoseGoal* /*kind*/) {
    return "pose";
}
constexpr std::string_view kind_name(const SpaceCameraGoal* /*kind*/) {
    return "camera";
}
constexpr std::string_view kind_name(const SpaceContactGoal* /*kind*/) {
    return "contact";
}

/// The rows of one kind of goal.
template <class Kind>
class KindRows {
 public:
    KindRows(Rows& rows, std::string_view description)
        : rows_(rows), path_(kind_name(static_cast<const Kind*>(nullptr))) {
        rows_.push_back(parameters::alternative<Kind, SpaceGoal>(
            path_, description, [](auto& goal) -> auto& { return goal.kind; }));
        rows_.back().count = [](const SpaceGoal& goal, std::size_t) -> std::size_t {
            return std::holds_alternative<Kind>(goal.kind) && goal.any_of.empty() ? 1 : 0;
        };
    }

    void add(Row row) { rows_.push_back(std::move(row)); }
    template <class Type>
    [[nodiscard]] Row number(std::string_view name, std::string_view description, Type Kind::*member) const {
        return parameters::number<SpaceGoal>(path(name), description, of(member));
    }
    template <class Type>
    [[nodiscard]] Row size(std::string_view name, std::string_view description, double most, Type Kind::*member) const {
        return number(name, description, member).above(0).at_most(most);
    }
    template <class Type>
    [[nodiscard]] Row place(std::string_view name, std::string_view description, Type Kind::*member) const {
        return space_vector<SpaceGoal>(path(name), description, of(member)).between(-farthest_m, farthest_m);
    }
    template <class Type>
    [[nodiscard]] Row direction(std::string_view description, Type Kind::*member) const {
        return space_vector<SpaceGoal>(path("direction"), description, of(member)).between(-1e5, 1e5);
    }

    [[nodiscard]] std::string path(std::string_view name) const { return path_ + "." + std::string(name); }
    template <class Type>
    [[nodiscard]] static auto of(Type Kind::*member) {
        return [member](auto& goal) -> auto& {
            return std::get<Kind>(goal.kind).*member;
        };
    }

 private:
    Rows& rows_;
    std::string path_;
};

void add_configuration(Rows& all) {
    using G = SpaceConfigurationGoal;
    KindRows<G> rows(all, "the multirotor and its arm; what is left out is free");
    const auto position = [&](std::string_view name, std::string_view description, std::optional<double> G::*member) {
        rows.add(rows.number(name, description, member).between(-farthest_m, farthest_m));
    };
    position("x_m", "of the multirotor's centre of mass; null for any", &G::x_m);
    position("y_m", "the same; null for any", &G::y_m);
    position("z_m", "upwards; null for any", &G::z_m);
    rows.add(rows.number("yaw_deg", "from the world's x to its y, modulo a turn; null for any", &G::yaw_rad)
                 .between(-3600, 3600));
    rows.add(number_list<SpaceGoal>(rows.path("joints_deg"), "one angle for each joint; left out: any",
                                    KindRows<G>::of(&G::joints_rad))
                 .between(-3600, 3600));
    rows.add(rows.size("tolerance_m", "distance that is near enough", 100, &G::tolerance_m));
    rows.add(rows.size("tolerance_deg", "deviation of yaw and of each joint that is near enough", largest_angle_deg,
                       &G::tolerance_rad));
}

void add_end_effector(Rows& all) {
    using G = SpaceEndEffectorGoal;
    KindRows<G> rows(all, "the end effector at a point");
    rows.add(rows.place("position_m", "the point, in the world", &G::position_m).is_required());
    rows.add(rows.size("tolerance_m", "distance that is near enough", 100, &G::tolerance_m));
    rows.add(rows.direction("where it points, in the world; null for any", &G::direction));
    rows.add(rows.size("direction_tolerance_deg", "half angle of the cone around it", largest_angle_deg,
                       &G::direction_tolerance_rad));
}

void add_pose(Rows& all) {
    using G = SpacePoseGoal;
    KindRows<G> rows(all, "the end effector at a point, with all of its attitude");
    rows.add(rows.place("position_m", "the point, in the world", &G::position_m).is_required());
    rows.add(parameters::vector<SpaceGoal>(rows.path("rpy_deg"),
                                           "attitude of the last link's axes, R = Rz(yaw) Ry(pitch) Rx(roll)",
                                           {"roll", "pitch", "yaw"}, KindRows<G>::of(&G::rpy_rad))
                 .between(-360, 360)
                 .is_required());
    rows.add(rows.size("tolerance_m", "distance that is near enough", 100, &G::tolerance_m));
    rows.add(rows.size("tolerance_deg", "turn that is near enough", largest_angle_deg, &G::tolerance_rad));
}

void add_camera(Rows& all) {
    using G = SpaceCameraGoal;
    KindRows<G> rows(all, "a camera, the end effector, that looks at a point");
    rows.add(rows.place("target_m", "what it looks at, in the world", &G::target_m).is_required());
    rows.add(parameters::pair<SpaceGoal>(rows.path("distance_m"), "from the end effector to the target",
                                         {"nearest", "farthest"}, KindRows<G>::of(&G::nearest_m),
                                         KindRows<G>::of(&G::farthest_m))
                 .between(0, 1000)
                 .is_required());
    rows.add(rows.direction("in which it should look, in the world; null for any", &G::direction));
    rows.add(rows.size("view_cone_deg", "greatest angle between that direction and the line to the target",
                       largest_angle_deg, &G::view_cone_rad));
    rows.add(rows.size("aim_tolerance_deg", "greatest angle between where the end effector points and that line",
                       largest_angle_deg, &G::aim_tolerance_rad));
    rows.add(parameters::flag<SpaceGoal>(rows.path("sees"), "no obstacle stands between camera and target",
                                         KindRows<G>::of(&G::sees)));
}

void add_contact(Rows& all) {
    using G = SpaceContactGoal;
    KindRows<G> rows(all, "a surface to touch along its normal and to press on for hold_s");
    rows.add(parameters::text<SpaceGoal>(rows.path("obstacle"), "name of the obstacle", KindRows<G>::of(&G::obstacle))
                 .is_required());
    rows.add(rows.size("force_n", "normal force that is held", 1000, &G::force_n).is_required());
    rows.add(parameters::choice<SpaceGoal, TouchingPart>(
        rows.path("part"), "what touches: the top of the multirotor, from below, or the end of the arm",
        {{TouchingPart::frame, "frame"}, {TouchingPart::end_effector, "end_effector"}}, KindRows<G>::of(&G::part)));
    rows.add(rows.place("position_m", "point near which it touches; null for anywhere", &G::position_m));
    rows.add(rows.size("tolerance_m", "distance from that point", 100, &G::tolerance_m));
    rows.add(rows.size("force_tolerance_n", "what the mean force of a second may be off by; null: a fifth of force_n",
                       1000, &G::force_tolerance_n));
    rows.add(rows.size("standoff_m", "distance from the surface before and after", 10, &G::standoff_m));
    rows.add(rows.size("speed_m_s", "of approach and leaving", 1, &G::speed_m_s));
}

Rows kind_rows() {
    Rows rows;
    add_configuration(rows);
    add_end_effector(rows);
    add_pose(rows);
    add_camera(rows);
    add_contact(rows);
    return rows;
}

/// The keys of a configuration without the name of its kind.
Rows configuration_rows() {
    constexpr std::string_view prefix = "configuration.";
    Rows rows;
    add_configuration(rows);
    rows.erase(rows.begin());
    for (Row& row : rows) {
        row.path.erase(0, prefix.size());
    }
    return rows;
}

using ProblemRows = std::vector<Parameter<SpaceProblem>>;

/// @param goal names the SpaceGoal that has the keys
template <class GoalMember>
Parameter<SpaceProblem> hold(const std::string& path, GoalMember goal) {
    return parameters::number<SpaceProblem>(
               path + ".hold_s",
               "how long it is held", [goal](auto& p, std::size_t i) -> auto& { return goal(p, i).hold_s; })
        .between(1, 3600);
}

template <class GoalMember>
void add_kinds(ProblemRows& rows, const std::string& path, GoalMember goal) {
    for (const Row& row : kind_rows()) {
        rows.push_back(parameters::nested<SpaceProblem>(row, path + ".", goal));
    }
}

/// Every kind of goal, and a choice of several.
template <class GoalMember>
void add_goal(ProblemRows& rows, const std::string& path, GoalMember goal) {
    add_kinds(rows, path, goal);
    rows.push_back(
        parameters::list<SpaceProblem>(
            path + ".any_of",
            "goals of which any will do", [goal](auto& p, std::size_t i) -> auto& { return goal(p, i).any_of; })
            .is_exclusive());
    const auto alternative = [goal](auto& p, std::size_t i) -> auto& {
        return goal(p, outer_element(i)).any_of[inner_element(i)];
    };
    add_kinds(rows, path + ".any_of[]", alternative);
    rows.push_back(hold(path + ".any_of[]", alternative));
}

}  // namespace

void add_space_goal_rows(ProblemRows& rows) {
    const auto goal = [](auto& p, std::size_t i) -> auto& {
        return p.goals[i];
    };
    auto group = parameters::group<SpaceProblem>(
                     "goal", "where the flight must end and stay; a list: where it must stay in turn")
                     .is_required();
    group.can_be_list = true;
    group.count = [](const SpaceProblem& p, std::size_t) { return p.in_any_order ? std::size_t{1} : p.goals.size(); };
    group.resize = [](SpaceProblem& p, std::size_t, std::size_t count) {
        p.goals.assign(count, {});
        p.in_any_order = false;
        p.return_to.reset();
        p.energy_budget_j.reset();
    };
    rows.push_back(std::move(group));

    const auto first = static_cast<std::ptrdiff_t>(rows.size());
    add_goal(rows, "goal", goal);
    // Goals in any order stand below a key of their own.
    std::for_each(rows.begin() + first, rows.end(), [](Parameter<SpaceProblem>& row) {
        if (row.exclusive && parent_path(row.path) == "goal") {
            row.count = [count = row.count](const SpaceProblem& p, std::size_t i) {
                return p.in_any_order ? std::size_t{0} : count(p, i);
            };
        }
    });
    auto any_order = parameters::row<SpaceProblem>(ParameterKind::list, "goal.in_any_order",
                                                   "targets: the planner chooses their order")
                         .is_exclusive();
    any_order.count = [](const SpaceProblem& p, std::size_t) { return p.in_any_order ? p.goals.size() : 0; };
    any_order.resize = [](SpaceProblem& p, std::size_t, std::size_t count) {
        p.goals.assign(count, {});
        p.in_any_order = true;
    };
    rows.push_back(std::move(any_order));
    const auto has_no_choice = [goal](const SpaceProblem& p, std::size_t i) { return goal(p, i).any_of.empty(); };
    add_goal(rows, "goal.in_any_order[]", goal);
    rows.push_back(hold("goal.in_any_order[]", goal).only("without any_of", has_no_choice));
    const auto return_to = [](auto& p, std::size_t) -> auto& {
        return *p.return_to;
    };
    add_mission_rows<SpaceConfigurationGoal>(rows, configuration_rows(), hold(std::string(key_of_return), return_to),
                                             [](const SpaceProblem& p, std::size_t) { return p.in_any_order; });
    rows.push_back(hold("goal", goal)
                       .only("without any_of and in_any_order", [has_no_choice](const SpaceProblem& p, std::size_t i) {
                           return !p.in_any_order && has_no_choice(p, i);
                       }));
    add_goal(rows, "goal[]", goal);
    rows.push_back(hold("goal[]", goal).only("without any_of", has_no_choice));
}

std::string_view name_of(const SpaceGoalKind& kind) {
    return std::visit([](const auto& each) { return kind_name(&each); }, kind);
}

void for_each_goal(const SpaceProblem& problem,
                   const std::function<void(const SpaceGoal& goal, const std::string& key)>& visit) {
    const auto indexed = [](const std::string& list, std::size_t i) { return list + "[" + std::to_string(i) + "]"; };
    const auto visit_kind = [&](const SpaceGoal& goal, const std::string& key) {
        visit(goal, key + "." + std::string(name_of(goal.kind)));
    };
    for (std::size_t i = 0; i < problem.goals.size(); ++i) {
        const SpaceGoal& goal = problem.goals[i];
        const std::string key = problem.in_any_order       ? indexed("goal.in_any_order", i)
                                : problem.goals.size() > 1 ? indexed("goal", i)
                                                           : "goal";
        if (goal.any_of.empty()) {
            visit_kind(goal, key);
        }
        for (std::size_t k = 0; k < goal.any_of.size(); ++k) {
            visit_kind(goal.any_of[k], indexed(key + ".any_of", k));
        }
    }
    if (problem.return_to) {
        visit(*problem.return_to, std::string(key_of_return));
    }
}

}  // namespace downwash

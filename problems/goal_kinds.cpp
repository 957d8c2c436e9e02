#include "downwash/problems/goal_kinds.hpp"

#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "downwash/base/angles.hpp"
#include "downwash/base/parameter_factories.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/goal_reach.hpp"
#include "downwash/problems/obstacle_parameters.hpp"

namespace downwash {
namespace {

using GoalRows = std::vector<Parameter<Goal>>;
using Errors = std::vector<KeyError>;

/// The rows of one kind.
template <class Kind>
class KindRows {
 public:
    /// @param path of what has the keys, with a dot behind it; empty: they stand by themselves
    KindRows(GoalRows& rows, std::string path) : rows_(rows), path_(std::move(path)) {}
    /// Rows below the kind's group of keys, which comes first.
    KindRows(GoalRows& rows, std::string_view name, std::string_view description)
        : KindRows(rows, std::string(name) + ".") {
        add(parameters::alternative<Kind, Goal>(
            name, description, [](auto& goal) -> auto& { return goal.kind; }));
        rows_.back().count = [](const Goal& goal, std::size_t) -> std::size_t {
            return std::holds_alternative<Kind>(goal.kind) && goal.any_of.empty() ? 1 : 0;
        };
    }

    void add(Parameter<Goal> row) { rows_.push_back(std::move(row)); }
    /// The tolerances of a place, together and one by one.
    void add_tolerances() {
        add(size("tolerance_m", "distance that is near enough", 100, &Kind::tolerance_m));
        add(size("tolerance_x_m",
                 "where one of the two is given, x and z are judged one by one: of x; null: tolerance_m", 100,
                 &Kind::tolerance_x_m));
        add(size("tolerance_z_m", "of z; null: tolerance_m", 100, &Kind::tolerance_z_m));
    }

    template <class Type>
    [[nodiscard]] Parameter<Goal> number(std::string_view name, std::string_view description,
                                         Type Kind::*member) const {
        return parameters::number<Goal>(path(name), description, in(member));
    }
    template <class Type>
    [[nodiscard]] Parameter<Goal> position(std::string_view name, std::string_view description,
                                           Type Kind::*member) const {
        return number(name, description, member).at_least(-farthest_m).at_most(farthest_m);
    }
    template <class Type>
    [[nodiscard]] Parameter<Goal> angle(std::string_view name, std::string_view description, Type Kind::*member) const {
        return number(name, description, member).at_least(-3600).at_most(3600);
    }
    template <class Type>
    [[nodiscard]] Parameter<Goal> size(std::string_view name, std::string_view description, double most,
                                       Type Kind::*member) const {
        return number(name, description, member).above(0).at_most(most);
    }

    [[nodiscard]] std::string path(std::string_view name) const { return path_ + std::string(name); }
    /// Names a member of the kind in a Goal.
    template <class Type>
    [[nodiscard]] static auto in(Type Kind::*member) {
        return [member](auto& goal) -> auto& {
            return std::get<Kind>(goal.kind).*member;
        };
    }

 private:
    GoalRows& rows_;
    std::string path_;
};

// A configuration.

constexpr std::string_view name(const ConfigurationGoal* /*kind*/) {
    return "configuration";
}

void add_pose(KindRows<ConfigurationGoal> rows) {
    using G = ConfigurationGoal;
    rows.add(rows.position("x_m", "along the plane; null for any", &G::x_m));
    rows.add(rows.position("z_m", "upwards; null for any", &G::z_m));
    rows.add(rows.angle("arm_deg", "arm from the vehicle's nose, modulo a turn; null for any", &G::arm_rad));
    rows.add_tolerances();
    rows.add(rows.size("tolerance_deg", "deviation of the arm that is near enough", 180, &G::tolerance_rad));
}

void add_keys(GoalRows& rows, const ConfigurationGoal* kind) {
    add_pose({rows, name(kind), "the vehicle and its arm"});
}

Errors unclear(const ConfigurationGoal& pose, const std::string& key) {
    if (!pose.x_m && !pose.z_m && !pose.arm_rad) {
        return {{key, "is free in every coordinate: expected at least one of x_m, z_m or arm_deg"}};
    }
    if ((pose.tolerance_x_m && !pose.x_m) || (pose.tolerance_z_m && !pose.z_m)) {
        const std::string axis = pose.tolerance_x_m && !pose.x_m ? "x_m" : "z_m";
        return {{key + ".tolerance_" + axis, "has a meaning only with " + axis + ": remove it"}};
    }
    return {};
}

Errors outside(const ConfigurationGoal& pose, const GoalTolerance& tolerance, const Bounds& bounds,
               const std::string& key) {
    Errors errors;
    const auto check = [&](const char* name, const std::optional<double>& value, double tolerance_m, double low,
                           double high) {
        if (value && (*value < low - tolerance_m || *value > high + tolerance_m)) {
            errors.push_back({key + name, "is " + to_text(*value) + ", outside the bounds: expected " + to_text(low) +
                                              " to " + to_text(high)});
        }
    };
    check(".x_m", pose.x_m, tolerance.x_m, bounds.x_low_m, bounds.x_high_m);
    check(".z_m", pose.z_m, tolerance.z_m, bounds.z_low_m, bounds.z_high_m);
    return errors;
}

Errors beyond_limits(const ConfigurationGoal& pose, const GoalTolerance& tolerance, const ArmParameters& arm,
                     const std::string& key) {
    if (!pose.arm_rad || arm_can_turn_to(arm, *pose.arm_rad, tolerance.usable().angle_rad)) {
        return {};
    }
    return {{key + ".arm_deg", "is beyond the arm's limits: expected " + arm_limits_text(arm)}};
}

Errors out_of_reach(const ConfigurationGoal& pose, const Goal& goal, const ProblemCheck& check,
                    const std::string& key) {
    const bool is_free = !pose.x_m || !pose.z_m || !pose.arm_rad;  // too many poses to try
    if (is_free || reach_of(check, goal) != Reach::blocked) {
        return {};
    }
    return {{key,
             "is in collision with an obstacle or nearer to it than planner.safety_margin_m, "
             "anywhere within its tolerances: move the goal or the obstacle"}};
}

// The end effector at a point.

constexpr std::string_view name(const EndEffectorGoal* /*kind*/) {
    return "end_effector";
}

void add_keys(GoalRows& all, const EndEffectorGoal* kind) {
    using G = EndEffectorGoal;
    KindRows<G> rows(all, name(kind), "the end effector at a point");
    rows.add(rows.position("x_m", "along the plane", &G::x_m).is_required());
    rows.add(rows.position("z_m", "upwards", &G::z_m).is_required());
    rows.add_tolerances();
    rows.add(
        rows.angle("direction_deg", "direction of the arm in the plane, down is 90; null for any", &G::direction_rad));
    rows.add(rows.size("direction_tolerance_deg", "deviation that is near enough", 180, &G::direction_tolerance_rad));
}

Errors unclear(const EndEffectorGoal& /*at*/, const std::string& /*key*/) {
    return {};
}

/// The vehicle has to be within the bounds, and the arm reaches beyond them: see out_of_reach().
Errors outside(const EndEffectorGoal& /*at*/, const GoalTolerance& /*tolerance*/, const Bounds& /*bounds*/,
               const std::string& /*key*/) {
    return {};
}

Errors beyond_limits(const EndEffectorGoal& /*at*/, const GoalTolerance& /*tolerance*/, const ArmParameters& /*arm*/,
                     const std::string& /*key*/) {
    return {};
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

Errors out_of_reach(const EndEffectorGoal& at, const Goal& goal, const ProblemCheck& check, const std::string& key) {
    const Problem& p = check.problem();
    const double missing_m = missing_reach_m(p, at, tolerance_of(goal));
    if (missing_m > 0) {
        return {{key, "is out of reach: from anywhere within the bounds the arm of " + to_text(p.robot.arm.length_m) +
                          " m misses it by " + to_text(missing_m, 4) +
                          " m; widen environment.bounds or move the goal"}};
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
    const std::string around = obstacle_around(check, at.x_m, at.z_m);
    return {{key,
             "is out of reach: in every pose that gets there the robot touches an obstacle or is "
             "nearer to it than planner.safety_margin_m" +
                 (around.empty() ? "" : "; it is inside the obstacle '" + excerpt(around) + "'")}};
}

// A contact, whose places goal_errors.cpp looks for.

constexpr std::string_view name(const ContactGoal* /*kind*/) {
    return "contact";
}

void add_keys(GoalRows& all, const ContactGoal* kind) {
    using G = ContactGoal;
    KindRows<G> rows(all, name(kind), "a surface to touch and press on for hold_s, from where the robot fits best");
    rows.add(parameters::text<Goal>(rows.path("obstacle"), "name of the obstacle", KindRows<G>::in(&G::obstacle))
                 .is_required());
    rows.add(rows.size("force_n", "normal force that is held", 1000, &G::force_n).is_required());
    rows.add(parameters::choice<Goal, TouchingPart>(
        rows.path("part"), "what touches: the top of the multirotor, from below, or the end of the arm, along the arm",
        {{TouchingPart::frame, "frame"}, {TouchingPart::end_effector, "end_effector"}}, KindRows<G>::in(&G::part)));
    rows.add(rows.position("x_m", "where on an underside or a top; null: anywhere", &G::x_m));
    rows.add(rows.position("z_m", "where on a side; null: anywhere", &G::z_m));
    rows.add(rows.size("tolerance_m", "of the place from which it touches", 100, &G::tolerance_m));
    rows.add(rows.size("force_tolerance_n", "what the mean force of a second may be off by; null: a fifth of force_n",
                       1000, &G::force_tolerance_n));
    rows.add(rows.size("standoff_m", "distance from the surface before and after", 10, &G::standoff_m));
    rows.add(rows.size("speed_m_s", "of approach and leaving", 1, &G::speed_m_s));
}

Errors unclear(const ContactGoal& /*contact*/, const std::string& /*key*/) {
    return {};
}

Errors outside(const ContactGoal& /*contact*/, const GoalTolerance& /*tolerance*/, const Bounds& /*bounds*/,
               const std::string& /*key*/) {
    return {};
}

Errors beyond_limits(const ContactGoal& /*contact*/, const GoalTolerance& /*tolerance*/, const ArmParameters& /*arm*/,
                     const std::string& /*key*/) {
    return {};
}

Errors out_of_reach(const ContactGoal& /*contact*/, const Goal& /*goal*/, const ProblemCheck& /*check*/,
                    const std::string& /*key*/) {
    return {};
}

template <class... Kinds>
void add_all(GoalRows& rows, const std::variant<Kinds...>* /*kind*/) {
    (add_keys(rows, static_cast<const Kinds*>(nullptr)), ...);
}

}  // namespace

std::vector<Parameter<Goal>> goal_kind_rows() {
    GoalRows rows;
    add_all(rows, static_cast<const GoalKind*>(nullptr));
    return rows;
}

std::vector<Parameter<Goal>> configuration_rows() {
    GoalRows rows;
    add_pose({rows, ""});
    return rows;
}

std::string_view name_of(const GoalKind& kind) {
    return std::visit([](const auto& each) { return name(&each); }, kind);
}

Errors unclear_values(const Goal& goal, const std::string& key) {
    return std::visit([&](const auto& kind) { return unclear(kind, key); }, goal.kind);
}

Errors places_outside_bounds(const Goal& goal, const Problem& problem, const std::string& key) {
    return std::visit([&](const auto& kind) { return outside(kind, tolerance_of(goal), problem.bounds, key); },
                      goal.kind);
}

Errors angles_beyond_limits(const Goal& goal, const Problem& problem, const std::string& key) {
    return std::visit([&](const auto& kind) { return beyond_limits(kind, tolerance_of(goal), problem.robot.arm, key); },
                      goal.kind);
}

Errors goal_out_of_reach(const Goal& goal, const ProblemCheck& check, const std::string& key) {
    return std::visit([&](const auto& kind) { return out_of_reach(kind, goal, check, key); }, goal.kind);
}

std::string arm_limits_text(const ArmParameters& arm) {
    return to_text(arm.lower_limit_rad * degrees_per_radian, 4) + " to " +
           to_text(arm.upper_limit_rad * degrees_per_radian, 4);
}

}  // namespace downwash

#include "downwash/results/plan_reader.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/controllers/space_axes.hpp"

namespace downwash::problems {
namespace {

constexpr double tick_tolerance = 1e-9;  // of numbers that should be equal

/// The control tick at which a knot stands; nothing when it stands between two.
std::optional<std::int64_t> tick_of(double t_s, double tick_s) {
    const double ticks = std::round(t_s / tick_s);
    if (!(ticks >= 0 && ticks <= static_cast<double>(max_plan_ticks)) ||
        std::abs(ticks * tick_s - t_s) > tick_tolerance * std::max(t_s, tick_s)) {
        return std::nullopt;
    }
    return static_cast<std::int64_t>(ticks);
}

/// @param axes of the plan   @param may_rest whether rates and accelerations that are missing are 0
template <class Knot>
Knot read_knot(JsonReader& reader, const Node& node, double tick_s, std::span<const Axis> axes, bool may_rest) {
    const auto derivative = [&](std::string_view name) {
        return may_rest && !JsonReader::member(node, name) ? 0 : reader.required_number(node, name);
    };
    Knot knot;
    const double t_s = reader.required_number(node, "t_s");
    if (const auto tick = tick_of(t_s, tick_s)) {
        knot.tick = *tick;
    } else {
        reader.report(node, "t_s is " + to_text(t_s) + ", expected a whole number of the robot's control ticks of " +
                                to_text(tick_s) + " s, from 0 to " + std::to_string(max_plan_ticks) + " of them");
    }
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const Axis& axis = axes[i];
        knot.point.position[i] = reader.required_number(node, axis.position);
        knot.point.velocity[i] = derivative(axis.velocity);
        knot.point.acceleration[i] = derivative(axis.acceleration);
    }
    return knot;
}

/// @param read_one reads a knot
template <class Knot, class ReadOne>
void read_reference(JsonReader& reader, const Node& list, std::vector<Knot>& reference, const ReadOne& read_one) {
    for (const Node& node : reader.groups(list)) {
        if (reader.has_enough()) {
            return;
        }
        const Knot knot = read_one(node);
        if (reference.empty() ? knot.tick != 0 : knot.tick <= reference.back().tick) {
            reader.report(node, reference.empty() ? "the first knot must stand at t_s 0"
                                                  : "t_s must be greater than that of the knot before");
        }
        reference.push_back(knot);
    }
}

/// The group `plan`; nothing, and an error, where the file holds none.
std::optional<Node> plan_node(JsonReader& reader, const Node& root) {
    auto node = reader.required(root, "plan");
    if (node && !node->json->is_object()) {
        reader.report(*node, node->json->is_null() ? "the file holds no plan: the search found none"
                                                   : "expected a group with `waypoints` and `reference`");
        return std::nullopt;
    }
    return node;
}

/// Whether the first group of a list has a key.
bool has_key(const Node& list, std::string_view name) {
    return list.json->is_array() && !list.json->empty() && list.json->front().is_object() &&
           list.json->front().contains(name);
}

constexpr std::string_view key_of_space = "y_m", key_of_plane = "arm_rad";

/// Every key of a knot or a waypoint has a meaning. @param joints of the robot
void require_known_keys(JsonReader& reader, const Node& node, const std::vector<std::string_view>& known, int joints) {
    for (const auto& [key, value] : node.json->items()) {
        if (std::ranges::find(known, std::string_view(key)) != known.end()) {
            continue;
        }
        const bool is_of_joint = std::ranges::any_of(all_space_axes, [&key = key](const Axis& axis) {
            return axis.group == AxisGroup::joint &&
                   (key == axis.position || key == axis.velocity || key == axis.acceleration);
        });
        const std::string hint = did_you_mean(key, known);
        reader.report(
            node, "'" + excerpt(key) + "' is no key here" +
                      (is_of_joint ? ": the robot has " + std::to_string(joints) + (joints == 1 ? " joint" : " joints")
                       : !hint.empty() ? hint
                                       : ": expected " + joined_names(known)));
    }
}

}  // namespace

Configuration read_configuration(JsonReader& reader, const Node& group, std::span<const Axis> axes) {
    Configuration at;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        at[i] = reader.required_number(group, axes[i].position);
    }
    return at;
}

SpaceConfiguration read_space_configuration(JsonReader& reader, const Node& group, int joints) {
    const std::span<const Axis> axes = axes_in_space(joints);
    SpaceConfiguration at;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        at[i] = reader.required_number(group, axes[i].position);
    }
    return at;
}

namespace {

std::vector<Configuration> read_waypoints(JsonReader& reader, const Node& list, std::span<const Axis> axes) {
    std::vector<Configuration> waypoints;
    for (const Node& node : reader.groups(list)) {
        if (reader.has_enough()) {
            break;
        }
        waypoints.push_back(read_configuration(reader, node, axes));
    }
    return waypoints;
}

std::vector<SpacePoint> read_space_waypoints(JsonReader& reader, const Node& list, int joints) {
    const std::span<const Axis> axes = axes_in_space(joints);
    std::vector<std::string_view> known;
    for (const Axis& axis : axes) {
        known.push_back(axis.position);
    }
    std::vector<SpacePoint> waypoints;
    for (const Node& node : reader.groups(list)) {
        if (reader.has_enough()) {
            break;
        }
        require_known_keys(reader, node, known, joints);
        SpacePoint& at = waypoints.emplace_back();
        for (std::size_t i = 0; i < axes.size(); ++i) {
            at.position[i] = reader.required_number(node, axes[i].position);
        }
    }
    return waypoints;
}

}  // namespace

PlanText read_plan(JsonReader& reader, const Node& root, const Problem& problem) {
    PlanText text;
    text.plan.tick_s = 1 / problem.robot.controller.rate_hz;
    text.plan.axes = problem.axes();
    const auto node = plan_node(reader, root);
    if (!node) {
        return text;
    }
    if (const auto reference = JsonReader::member(*node, "reference"); reference && has_key(*reference, key_of_space)) {
        reader.report(reference->at(0),
                      "has y_m: this is a plan in space, and the problem is one in a vertical plane; `downwash "
                      "execute` and `validate` fly it with its own problem, whose bounds have y_m");
        return text;
    }
    text.waypoints_node = reader.required(*node, "waypoints");
    text.reference_node = reader.required(*node, "reference");
    if (text.waypoints_node && text.reference_node) {
        read_reference(reader, *text.reference_node, text.plan.reference, [&](const Node& each) {
            return read_knot<ReferenceKnot>(reader, each, text.plan.tick_s, text.plan.axes, false);
        });
        text.waypoints = read_waypoints(reader, *text.waypoints_node, text.plan.axes);
    }
    if (reader.errors().empty() && text.plan.reference.empty()) {
        reader.report(*text.reference_node, "expected at least one knot");
    }
    return text;
}

SpacePlanText read_plan(JsonReader& reader, const Node& root, const SpaceProblem& problem) {
    SpacePlanText text;
    text.plan.tick_s = 1 / problem.robot.controller.rate_hz;
    text.plan.joints = problem.robot.joints();
    const std::span<const Axis> axes = axes_in_space(text.plan.joints);
    const auto node = plan_node(reader, root);
    if (!node) {
        return text;
    }
    text.waypoints_node = JsonReader::member(*node, "waypoints");
    text.reference_node = reader.required(*node, "reference");
    if (!text.reference_node) {
        return text;
    }
    if (has_key(*text.reference_node, key_of_plane)) {
        reader.report(text.reference_node->at(0),
                      "has arm_rad: this is a plan in a vertical plane, and the problem is one in space; expected "
                      "x_m, y_m, z_m, yaw_rad and joint_1_rad, with their rates and accelerations");
        return text;
    }
    std::vector<std::string_view> known{"t_s"};
    for (const Axis& axis : axes) {
        known.insert(known.end(), {axis.position, axis.velocity, axis.acceleration});
    }
    read_reference(reader, *text.reference_node, text.plan.reference, [&](const Node& each) {
        require_known_keys(reader, each, known, text.plan.joints);
        return read_knot<SpaceKnot>(reader, each, text.plan.tick_s, axes, true);
    });
    if (text.waypoints_node) {
        text.waypoints = read_space_waypoints(reader, *text.waypoints_node, text.plan.joints);
    }
    if (reader.errors().empty() && text.plan.reference.empty()) {
        reader.report(*text.reference_node, "expected at least one knot");
    }
    return text;
}

}  // namespace downwash::problems

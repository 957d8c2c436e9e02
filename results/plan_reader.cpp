#include "downwash/results/plan_reader.hpp"

#include <cmath>

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

ReferenceKnot read_knot(JsonReader& reader, const Node& node, const Plan& plan) {
    ReferenceKnot knot;
    const double t_s = reader.required_number(node, "t_s");
    if (const auto tick = tick_of(t_s, plan.tick_s)) {
        knot.tick = *tick;
    } else {
        reader.report(node, "t_s is " + to_text(t_s) + ", expected a whole number of the robot's control ticks of " +
                                to_text(plan.tick_s) + " s, from 0 to " + std::to_string(max_plan_ticks) + " of them");
    }
    for (std::size_t i = 0; i < plan.axes.size(); ++i) {
        const Axis& axis = plan.axes[i];
        knot.point.position[i] = reader.required_number(node, axis.position);
        knot.point.velocity[i] = reader.required_number(node, axis.velocity);
        knot.point.acceleration[i] = reader.required_number(node, axis.acceleration);
    }
    return knot;
}

void read_reference(JsonReader& reader, const Node& list, Plan& plan) {
    for (const Node& node : reader.groups(list)) {
        if (reader.has_enough()) {
            return;
        }
        const ReferenceKnot knot = read_knot(reader, node, plan);
        if (plan.reference.empty() ? knot.tick != 0 : knot.tick <= plan.reference.back().tick) {
            reader.report(node, plan.reference.empty() ? "the first knot must stand at t_s 0"
                                                       : "t_s must be greater than that of the knot before");
        }
        plan.reference.push_back(knot);
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

}  // namespace

PlanText read_plan(JsonReader& reader, const Node& root, const Problem& problem) {
    PlanText text;
    text.plan.tick_s = 1 / problem.robot.controller.rate_hz;
    text.plan.axes = problem.axes();
    const auto node = reader.required(root, "plan");
    if (!node) {
        return text;
    }
    if (!node->json->is_object()) {
        reader.report(*node, node->json->is_null() ? "the file holds no plan: the search found none"
                                                   : "expected a group with `waypoints` and `reference`");
        return text;
    }
    text.waypoints_node = reader.required(*node, "waypoints");
    text.reference_node = reader.required(*node, "reference");
    if (text.waypoints_node && text.reference_node) {
        read_reference(reader, *text.reference_node, text.plan);
        text.waypoints = read_waypoints(reader, *text.waypoints_node, text.plan.axes);
    }
    if (reader.errors().empty() && text.plan.reference.empty()) {
        reader.report(*text.reference_node, "expected at least one knot");
    }
    return text;
}

}  // namespace downwash::problems

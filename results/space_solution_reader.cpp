#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/controllers/space_axes.hpp"
#include "downwash/controllers/space_limits.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/results/order_reader.hpp"
#include "downwash/results/plan_reader.hpp"
#include "downwash/results/solution_document.hpp"
#include "downwash/results/space_solution_file.hpp"

namespace downwash {
namespace {

using problems::JsonReader;
using problems::Node;

constexpr double tolerance = 1e-9;  // of numbers that should be equal

bool is_near(double a, double b) {
    return std::abs(a - b) <= tolerance * std::max({1.0, std::abs(a), std::abs(b)});
}

bool is_at(const SpacePoint& a, const SpacePoint& b) {
    return std::ranges::equal(a.position, b.position, is_near);
}

/// Where a plan has to begin. @param plan whose yaw any start with a given attitude takes
SpacePoint begin_of(const SpaceStart& start, const SpacePlan& plan) {
    if (start.reference) {
        return reference_at(start);
    }
    SpacePoint begin;
    std::copy(start.position_m.begin(), start.position_m.end(), begin.position);
    begin.position[space::yaw] = start.attitude ? plan.reference.front().point.position[space::yaw] : start.yaw_rad;
    std::copy(start.joints_rad.begin(), start.joints_rad.end(), begin.position + space::first_joint);
    return begin;
}

std::string place_text(const SpacePoint& point, int joints) {
    const std::span<const Axis> axes = axes_in_space(joints);
    std::string text;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        text += (i > 0 ? ", " : "") + std::string(axes[i].position) + ' ' + to_text(point.position[i]);
    }
    return text;
}

void check_start(JsonReader& reader, const Node& reference, const SpacePlan& plan, const SpaceStart& start) {
    const SpacePoint begin = begin_of(start, plan);
    const SpacePoint& first = plan.reference.front().point;
    if (!is_at(begin, first)) {
        reader.report(reference.at(0), "the plan begins at " + place_text(first, plan.joints) +
                                           ", but the problem starts at " + place_text(begin, plan.joints) +
                                           "; is it the plan of another problem?");
    }
}

/// Waypoints, if there are any, and reference must tell the same story.
void compare_waypoints(JsonReader& reader, const problems::SpacePlanText& text) {
    if (!text.waypoints_node) {
        return;
    }
    const std::vector<SpaceKnot>& knots = text.plan.reference;
    if (text.waypoints.size() != knots.size()) {
        reader.report(*text.waypoints_node, "there are " + std::to_string(text.waypoints.size()) + " waypoints, but " +
                                                std::to_string(knots.size()) + " knots of the reference");
        return;
    }
    for (std::size_t i = 0; i < knots.size(); ++i) {
        if (!is_at(text.waypoints[i], knots[i].point)) {
            reader.report(text.waypoints_node->at(i),
                          "this waypoint is not where plan.reference[" + std::to_string(i) + "] is");
        }
    }
}

/// Limits that nothing reaches.
SpaceMotionLimits no_limits() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    SpaceMotionLimits limits;
    limits.max_speed_m_s = limits.max_acceleration_m_s2 = limits.max_jerk_m_s3 = infinity;
    limits.max_yaw_rate_rad_s = limits.max_yaw_acceleration_rad_s2 = infinity;
    limits.max_joint_rate_rad_s = limits.max_joint_acceleration_rad_s2 = SpaceMotionLimits::every(infinity);
    return limits;
}

/// Which limits of `motion` a piece of a reference breaks and how far: "max_speed_m_s 1.2 times".
std::string broken_limits(const SpaceSegment& segment, const SpaceMotionLimits& limits) {
    std::string text;
    const auto ask = [&](const char* key, const auto& limit_alone) {
        SpaceMotionLimits alone = no_limits();
        limit_alone(alone);
        if (!keeps_limits(segment, alone)) {
            const double use = use_of_limits(segment, alone);
            text += (text.empty() ? "" : ", ") + std::string(key) +
                    (std::isfinite(use) ? " (" + to_text(std::max(1.0, use), 4) + " times)" : "");
        }
    };
    ask("max_speed_m_s", [&](SpaceMotionLimits& alone) { alone.max_speed_m_s = limits.max_speed_m_s; });
    ask("max_acceleration_m_s2",
        [&](SpaceMotionLimits& alone) { alone.max_acceleration_m_s2 = limits.max_acceleration_m_s2; });
    ask("max_jerk_m_s3", [&](SpaceMotionLimits& alone) { alone.max_jerk_m_s3 = limits.max_jerk_m_s3; });
    ask("max_thrust_ratio", [&](SpaceMotionLimits& alone) { alone.max_thrust_ratio = limits.max_thrust_ratio; });
    ask("max_tilt_rate_deg_s",
        [&](SpaceMotionLimits& alone) { alone.max_tilt_rate_rad_s = limits.max_tilt_rate_rad_s; });
    ask("max_yaw_rate_deg_s", [&](SpaceMotionLimits& alone) { alone.max_yaw_rate_rad_s = limits.max_yaw_rate_rad_s; });
    ask("max_yaw_acceleration_deg_s2",
        [&](SpaceMotionLimits& alone) { alone.max_yaw_acceleration_rad_s2 = limits.max_yaw_acceleration_rad_s2; });
    ask("max_joint_rate_deg_s",
        [&](SpaceMotionLimits& alone) { alone.max_joint_rate_rad_s = limits.max_joint_rate_rad_s; });
    ask("max_joint_acceleration_deg_s2",
        [&](SpaceMotionLimits& alone) { alone.max_joint_acceleration_rad_s2 = limits.max_joint_acceleration_rad_s2; });
    return text;
}

/// What of a reference can be flown and yet is no plan for the problem.
void warn_of_reference(JsonReader& reader, const Node& reference, const SpacePlan& plan, const SpaceProblem& problem) {
    const std::span<const Axis> axes = axes_in_space(plan.joints);
    const auto outside = [&](std::size_t knot, std::size_t axis, double low, double high, const std::string& what) {
        const double value = plan.reference[knot].point.position[axis];
        if (value < low - tolerance || value > high + tolerance) {
            reader.warn(reference.at(knot), std::string(axes[axis].position) + " is " + to_text(value) + ", beyond " +
                                                what + ", " + to_text(low) + " to " + to_text(high));
        }
    };
    for (std::size_t i = 0; i < plan.reference.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            outside(i, axis, problem.bounds.low_m[axis], problem.bounds.high_m[axis], "environment.bounds");
        }
        for (std::size_t joint = 0; joint < problem.robot.links.size(); ++joint) {
            const SpaceLinkLimits& link = problem.robot.links[joint];
            if (link.is_limited) {
                outside(i, space::first_joint + joint, link.lower_limit_rad, link.upper_limit_rad,
                        "the limits of the joint");
            }
        }
        if (i > 0) {
            const SpaceSegment segment = plan.segment_to(i);
            if (!keeps_limits(segment, problem.motion)) {
                reader.warn(reference.at(i), "the way here from the knot before breaks limits of `motion`: " +
                                                 broken_limits(segment, problem.motion));
            }
        }
    }
    if (!is_at_rest(plan.reference.back().point)) {
        reader.warn(reference.at(plan.reference.size() - 1),
                    "the reference ends in motion: expected a knot at rest, where the vehicle hovers");
    }
}

void read_head(JsonReader& reader, const Node& root, SpaceSolution& solution) {
    reader.read_choice(root, "status", std::array{Status::none, Status::approximate, Status::solved}, solution.status);
    reader.read_flag(root, "interrupted", solution.interrupted);
    reader.read_choice(root, "variant", all_variants, solution.variant);
    problems::read_objective(reader, root, solution.objective);
    reader.read_count(root, "seed", solution.seed);
    reader.read_count(root, "threads", solution.threads);
}

}  // namespace

SpaceSolution read_solution(const std::string& path, const SpaceProblem& problem,
                            const std::function<void(const LocatedError&)>& on_warning) {
    SpaceSolution solution;
    solution.variant = problem.planner.variant;
    solution.algorithm = problem.planner.algorithm;
    solution.objective = problem.planner.objective;
    solution.seed = problem.planner.seed;
    const auto read = [&](JsonReader& reader, const Node& root) {
        read_head(reader, root, solution);
        problems::SpacePlanText text = problems::read_plan(reader, root, problem);
        if (reader.errors().empty()) {
            compare_waypoints(reader, text);
            check_start(reader, *text.reference_node, text.plan, problem.start);
        }
        if (reader.errors().empty()) {
            warn_of_reference(reader, *text.reference_node, text.plan, problem);
        }
        problems::read_stops(reader, root, text.plan.tick_s, solution.safe_stops, [&](const Node& rest) {
            return problems::read_space_configuration(reader, rest, text.plan.joints);
        });
        solution.plan = std::move(text.plan);
        solution.order = problems::read_order(reader, root, problem);
    };
    problems::read_document(path, read, on_warning);
    return solution;
}

}  // namespace downwash

#include "downwash/search/kept_yaw.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/space_configuration.hpp"
#include "downwash/simulation/space_tool.hpp"

namespace downwash::planning {
namespace {

/// About what a robot at a goal can be turned so that it still meets the goal; nothing where the goal asks for a yaw.
struct Pivot {
    const SpaceRobot& robot;
    const SpacePose& pose;

    std::optional<Vector3> operator()(const SpaceConfigurationGoal& goal) const {
        return goal.yaw_rad ? std::nullopt : std::optional(pose.position_m);
    }
    std::optional<Vector3> operator()(const SpaceEndEffectorGoal& goal) const {
        return goal.direction ? std::nullopt : std::optional(tool_at(robot, pose).position_m);
    }
    std::optional<Vector3> operator()(const SpacePoseGoal& /*goal*/) const { return std::nullopt; }
    std::optional<Vector3> operator()(const SpaceCameraGoal& goal) const {
        return goal.direction ? std::nullopt : std::optional(goal.target_m);
    }
    std::optional<Vector3> operator()(const SpaceContactGoal& goal) const {
        return goal.part == TouchingPart::frame ? std::optional(pose.position_m) : std::nullopt;
    }
};

/// A robot that is turned about the vertical through a pivot.
SpacePoint turned(SpacePoint point, const Vector3& pivot_m, double by_rad) {
    const auto [sine, cosine] = lane::sin_cos(by_rad);
    const double x_m = point.position[space::x] - pivot_m[0], y_m = point.position[space::y] - pivot_m[1];
    point.position[space::x] = pivot_m[0] + cosine * x_m - sine * y_m;
    point.position[space::y] = pivot_m[1] + sine * x_m + cosine * y_m;
    point.position[space::yaw] += by_rad;
    return point;
}

}  // namespace

SpacePoint KeptYaw::looking(const SpacePoint& before, const SpacePoint& point, double usable_share) const {
    if (is_free()) {
        return point;
    }
    const std::vector<SpaceGoalError> errors = goals_.errors_at(0, configuration_of(point));
    const auto nearest = std::ranges::min_element(errors, is_less);
    if (is_at_rest(point) && !nearest->is_hidden && nearest->used_share <= usable_share) {
        return at_goal(before, point, static_cast<std::size_t>(nearest - errors.begin()), usable_share);
    }
    return by_rule(before, point);
}

SpacePoint KeptYaw::by_rule(const SpacePoint& before, const SpacePoint& point) const {
    return with_yaw({{0, before}, {1, point}}, 1, rule_).back().point;
}

SpacePoint KeptYaw::at_goal(const SpacePoint& before, const SpacePoint& point, std::size_t alternative,
                            double usable_share) const {
    constexpr int most_turns = 60;
    constexpr double settled_rad = 1e-12, rounding = 1e-9;
    const SpaceGoal& goal = goals_.goals().front();
    const SpacePose pose = level_at(configuration_of(point));
    const std::optional<Vector3> pivot_m =
        std::visit(Pivot{robot_, pose}, (goal.any_of.empty() ? goal : goal.any_of[alternative]).kind);
    if (!pivot_m) {
        return point;
    }
    // Turned, the robot is elsewhere, and may have to look elsewhere.
    SpacePoint at = point;
    for (int i = 0; i < most_turns; ++i) {
        const double by_rad = lane::wrap_angle(by_rule(before, at).position[space::yaw] - at.position[space::yaw]);
        at = turned(at, *pivot_m, by_rad);
        if (std::abs(by_rad) <= settled_rad) {
            at.position[space::yaw] = by_rule(before, at).position[space::yaw];
            const SpaceGoalError error = goals_.error_at(0, configuration_of(at));
            return error.used_share <= usable_share + rounding && !error.is_hidden ? at : point;
        }
    }
    return point;
}

}  // namespace downwash::planning

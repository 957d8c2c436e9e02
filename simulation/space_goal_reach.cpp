#include "downwash/simulation/space_goal_reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <variant>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/base/text.hpp"
#include "downwash/simulation/goal.hpp"
#include "downwash/simulation/space_arm_angles.hpp"
#include "downwash/simulation/space_goal_error.hpp"
#include "downwash/simulation/space_statics.hpp"
#include "downwash/simulation/space_tool.hpp"

namespace downwash {
namespace {

/// Angles that miss a tolerance by less are rounding.
constexpr double rounding_rad = 1e-6;

std::string degrees(double angle_rad) {
    constexpr double tenths = 10;
    return to_text(std::round(angle_rad * degrees_per_radian * tenths) / tenths + 0.0);  // no -0
}

std::string vector_text(const Vector3& v) {
    constexpr double thousandths = 1000;
    return "[" +
           joined(v, ", ", [](double part) { return to_text(std::round(part * thousandths) / thousandths + 0.0); }) +
           "]";
}

/// The greatest elevation of a vector of the hand of a level robot, and where its joints are then.
WorstPose highest(const SpaceRobot& robot, const SpaceArmAngles& arm, const Vector3& of_hand) {
    WorstPose found = worst_pose(robot, [&](const std::vector<double>& joints_rad) {
        JointAngles at{};
        std::copy(joints_rad.begin(), joints_rad.end(), at.begin());
        return arm.outward(at, of_hand)[2];
    });
    JointAngles at{};
    std::copy(found.joints_rad.begin(), found.joints_rad.end(), at.begin());
    found.value = arm.elevation_rad(at, of_hand);
    return found;
}

/// @param direction that is wanted   @param cone_rad about it
std::optional<SpaceGoalObjection> objection_to(const SpaceRobot& robot, const Vector3& direction, double cone_rad) {
    const SpaceArmAngles arm(robot);
    const double level = lane::sqrt(direction[0] * direction[0] + direction[1] * direction[1]);
    const double wanted_rad = lane::atan2(direction[2], level);
    const double high_rad = highest(robot, arm, arm.tool()).value;
    const double low_rad = -highest(robot, arm, -1 * arm.tool()).value;
    const double nearest_rad = std::clamp(wanted_rad, low_rad, high_rad);
    if (std::abs(wanted_rad - nearest_rad) <= cone_rad + rounding_rad) {
        return std::nullopt;
    }
    const auto [sine, cosine] = lane::sin_cos(nearest_rad);
    const Vector3 ahead = level > 0 ? Vector3{direction[0] / level, direction[1] / level, 0} : Vector3{1, 0, 0};
    const std::string reached = robot.joints() == 0 ? degrees(low_rad) : degrees(low_rad) + " to " + degrees(high_rad);
    return SpaceGoalObjection{
        "direction",
        "is " + degrees(wanted_rad) + " degrees above the level, give or take " + degrees(cone_rad) + ": " +
            (robot.joints() == 0 ? "without an arm the end effector of the level robot points "
                                 : "with its joints within their limits the end effector of the level robot points ") +
            reached + " degrees above it; the nearest direction is " +
            vector_text(cosine * ahead + Vector3{0, 0, sine}) + ", or give the arm other joints or limits"};
}

std::optional<SpaceGoalObjection> objection_to(const SpaceRobot& robot, const SpacePoseGoal& goal) {
    const SpaceArmAngles arm(robot);
    const Matrix3 wanted = rotation_of(attitude_of(goal.rpy_rad));
    // Yaw turns about the vertical: what it cannot do is the angle between the vertical and that of the wanted
    // attitude, both seen from the hand.
    const WorstPose best = highest(robot, arm, wanted[2]);
    const double off_rad = 0.5 * 3.141592653589793 - best.value;
    if (off_rad <= goal.tolerance_rad + rounding_rad) {
        return std::nullopt;
    }
    JointAngles at{};
    std::copy(best.joints_rad.begin(), best.joints_rad.end(), at.begin());
    const Vector3 axes[] = {arm.outward(at, {1, 0, 0}), arm.outward(at, {0, 1, 0}), arm.outward(at, {0, 0, 1})};
    double along = 0, beside = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        along += axes[i][0] * wanted[0][i] + axes[i][1] * wanted[1][i];
        beside += axes[i][0] * wanted[1][i] - axes[i][1] * wanted[0][i];
    }
    const auto [sine, cosine] = lane::sin_cos(lane::atan2(beside, along));
    const double forward_x = cosine * axes[0][0] - sine * axes[0][1],
                 forward_y = sine * axes[0][0] + cosine * axes[0][1];
    const double flat = lane::sqrt(forward_x * forward_x + forward_y * forward_y);
    const std::array rpy_rad{lane::atan2(axes[1][2], axes[2][2]), lane::atan2(-axes[0][2], flat),
                             lane::atan2(forward_y, forward_x)};
    return SpaceGoalObjection{"rpy_deg",
                              "is an attitude that the level robot misses by " + degrees(off_rad) +
                                  " degrees at any yaw, with its joints within their limits; the nearest one is [" +
                                  joined(rpy_rad, ", ", [](double rad) { return degrees(rad); }) +
                                  "]; ask for that, for a direction alone, or raise tolerance_deg"};
}

/// What moves along when a goal is moved, coordinate by coordinate; nothing of goals without a place of their own.
struct Movable {
    std::array<bool, 3> axes{};
    Vector3 place_m{};
    std::string key;
};

Movable movable(const SpaceGoalKind& kind) {
    constexpr std::array all{true, true, true};
    if (const auto* end = std::get_if<SpaceEndEffectorGoal>(&kind)) {
        return {all, end->position_m, "position_m"};
    }
    if (const auto* pose = std::get_if<SpacePoseGoal>(&kind)) {
        return {all, pose->position_m, "position_m"};
    }
    if (const auto* camera = std::get_if<SpaceCameraGoal>(&kind)) {
        return {all, camera->target_m, "target_m"};
    }
    if (const auto* at = std::get_if<SpaceConfigurationGoal>(&kind)) {
        return {{at->x_m.has_value(), at->y_m.has_value(), at->z_m.has_value()},
                {at->x_m.value_or(0), at->y_m.value_or(0), at->z_m.value_or(0)},
                "the place"};
    }
    return {};
}

/// A goal that no configuration met, and what was tried.
struct Failed {
    const SpaceRobot& robot;
    const SpaceBounds& bounds;
    const Scene& scene;
    const SpaceChecker& checker;
    double margin_m;
    const SpaceGoal& goal;
    const SpaceGoalSample& tries;
    const std::vector<SpaceGoalPlace>& places;

    [[nodiscard]] bool is_free(SpaceConfiguration at, const Vector3& by_m) const {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at[axis] += by_m[axis];
            if (!(at[axis] >= bounds.low_m[axis] && at[axis] <= bounds.high_m[axis])) {
                return false;
            }
        }
        const SpacePose pose = level_at(at);
        if (checker.is_nearer_than(pose, margin_m)) {
            return false;
        }
        const auto* camera = std::get_if<SpaceCameraGoal>(&goal.kind);
        return camera == nullptr || !camera->sees ||
               sees(scene, tool_at(robot, pose).position_m, camera->target_m + by_m);
    }

    /// The least of some ways by which the goal can be moved so that a configuration is free.
    [[nodiscard]] std::optional<Vector3> way_out_m(const std::array<bool, 3>& axes) const {
        constexpr std::size_t most_places = 40;
        for (const double far_m : {0.05, 0.1, 0.2, 0.4, 0.8, 1.6}) {
            for (int number = 0; number < 27; ++number) {
                Vector3 way{};
                for (std::size_t axis = 0, digits = static_cast<std::size_t>(number); axis < 3; ++axis, digits /= 3) {
                    way[axis] = axes[axis] ? static_cast<double>(digits % 3) - 1 : 0;
                }
                const double length = length_of(way);
                if (length == 0) {
                    continue;
                }
                const Vector3 by_m = (far_m / length) * way;
                for (std::size_t i = 0; i < std::min(places.size(), most_places); ++i) {
                    if (is_free(places[i].at, by_m)) {
                        return by_m;
                    }
                }
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] std::string label(std::size_t obstacle) const {
        return "'" + label_of(scene.obstacles(), obstacle) + "'";
    }

    /// The obstacle that is in the way most often; nothing if there is none.
    template <class Obstacle>
    [[nodiscard]] std::string most_often(SpaceGoalFlaw flaw, const SpaceGoalSampler& sampler,
                                         const Obstacle& obstacle_at) const {
        std::map<std::size_t, int> times;
        for (const SpaceGoalPlace& place : places) {
            if (sampler.flaw(place) == flaw) {
                if (const std::optional<std::size_t> found = obstacle_at(place)) {
                    ++times[*found];
                }
            }
        }
        const auto most = std::max_element(times.begin(), times.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
        return most == times.end() ? "" : (times.size() == 1 ? " (" : " (most often ") + label(most->first) + ")";
    }

    [[nodiscard]] std::string near_text(const SpaceGoalSampler& sampler) const {
        return most_often(SpaceGoalFlaw::near_obstacle, sampler, [&](const SpaceGoalPlace& place) {
            return checker.nearest_obstacle(level_at(place.at), margin_m + 1e-6);
        });
    }

    [[nodiscard]] std::string hiding_text(const SpaceGoalSampler& sampler) const {
        const auto& camera = std::get<SpaceCameraGoal>(goal.kind);
        std::vector<Scene> alone;
        for (const Obstacle& obstacle : scene.obstacles()) {
            alone.emplace_back(std::vector{obstacle});
        }
        return most_often(SpaceGoalFlaw::hidden, sampler, [&](const SpaceGoalPlace& place) {
            const Vector3 camera_m = tool_at(robot, level_at(place.at)).position_m;
            const auto hides = std::find_if(alone.begin(), alone.end(), [&](const Scene& scene_of_one) {
                return !sees(scene_of_one, camera_m, camera.target_m);
            });
            return hides == alone.end() ? std::nullopt : std::optional(static_cast<std::size_t>(hides - alone.begin()));
        });
    }

    [[nodiscard]] std::string outside_text() const {
        double least_m = HUGE_VAL;
        for (const SpaceGoalPlace& place : places) {
            Vector3 beyond_m{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                beyond_m[axis] =
                    std::max({bounds.low_m[axis] - place.at[axis], place.at[axis] - bounds.high_m[axis], 0.0});
            }
            const double far_m = length_of(beyond_m);
            least_m = far_m > 0 ? std::min(least_m, far_m) : least_m;
        }
        return " (by " + to_text(least_m, 3) + " m at least)";
    }

    [[nodiscard]] std::string itself_text() const {
        for (const SpaceGoalPlace& place : places) {
            if (const auto bodies = checker.touching_bodies(level_at(place.at))) {
                return (bodies->first == 0 ? " (the multirotor" : " (link " + std::to_string(bodies->first)) +
                       " and link " + std::to_string(bodies->second) + ")";
            }
        }
        return "";
    }

    [[nodiscard]] SpaceGoalObjection objection(const SpaceGoalSampler& sampler) const {
        if (places.empty()) {
            const auto* contact = std::get_if<SpaceContactGoal>(&goal.kind);
            return {"", contact != nullptr
                            ? "has no place to touch: none of " + std::to_string(tries.tries) +
                                  " that were tried on '" + contact->obstacle + "' is flat and faces " +
                                  (contact->part == TouchingPart::frame ? "down, as the top of the multirotor needs"
                                                                        : "the end effector at angles of its joints")
                            : "is met by no joint angles of " + std::to_string(tries.tries) +
                                  " tries; move the goal, or raise its tolerances"};
        }
        std::vector<std::string> parts;
        const auto add = [&](SpaceGoalFlaw flaw, const std::string& what, const auto& more) {
            const int count = tries.flaws[static_cast<std::size_t>(flaw)];
            if (count > 0) {
                parts.push_back(std::to_string(count) + what + more());
            }
        };
        add(SpaceGoalFlaw::outside, " are outside environment.bounds", [&] { return outside_text(); });
        add(SpaceGoalFlaw::touches_itself, " touch the robot itself", [&] { return itself_text(); });
        add(SpaceGoalFlaw::near_obstacle, " are nearer than " + to_text(margin_m) + " m to an obstacle",
            [&] { return near_text(sampler); });
        add(SpaceGoalFlaw::hidden, " do not see the target", [&] { return hiding_text(sampler); });
        std::string reason = "is met by no configuration of " + std::to_string(places.size()) +
                             " that were tried, at yaws and joint angles all over their ranges: " +
                             joined(parts, ", ", [](const std::string& part) { return part; });
        const Movable goal_place = movable(goal.kind);
        if (goal_place.axes != std::array{false, false, false}) {
            const std::optional<Vector3> by_m = way_out_m(goal_place.axes);
            reason += by_m ? "; the nearest goal found is " + to_text(length_of(*by_m), 3) + " m away, with " +
                                 goal_place.key + " " + vector_text(goal_place.place_m + *by_m)
                           : "; no goal up to 1.6 m away was better";
        }
        return {"", reason};
    }
};

}  // namespace

std::optional<SpaceGoalObjection> aim_objection(const SpaceRobot& robot, const SpaceGoal& goal) {
    if (const auto* end = std::get_if<SpaceEndEffectorGoal>(&goal.kind); end != nullptr && end->direction) {
        return objection_to(robot, *end->direction, end->direction_tolerance_rad);
    }
    if (const auto* camera = std::get_if<SpaceCameraGoal>(&goal.kind); camera != nullptr && camera->direction) {
        return objection_to(robot, *camera->direction, camera->view_cone_rad + camera->aim_tolerance_rad);
    }
    if (const auto* pose = std::get_if<SpacePoseGoal>(&goal.kind)) {
        return objection_to(robot, *pose);
    }
    return std::nullopt;
}

SpaceGoalReach goal_reach(const SpaceRobot& robot, const SpaceBounds& bounds, const std::shared_ptr<const Scene>& scene,
                          const SpaceChecker& checker, double margin_m, const SpaceGoal& goal) {
    SpaceGoalReach reach;
    reach.objection = aim_objection(robot, goal);
    if (reach.objection) {
        return reach;
    }
    constexpr int max_tries = 400;
    const SpaceGoalSampler sampler(robot, bounds, scene, checker, margin_m, goal);
    Random random(1);
    std::vector<SpaceGoalPlace> places;
    SpaceGoalSample& tries = reach.tries;
    while (tries.tries < max_tries) {
        const double share = tries.tries++ % 2 == 0 ? 0 : usable_tolerance_share;
        const std::optional<SpaceGoalPlace> place = sampler.drawn(random, share);
        if (!place) {
            ++tries.without_aim;
            continue;
        }
        const SpaceGoalFlaw flaw = sampler.flaw(*place);
        ++tries.flaws[static_cast<std::size_t>(flaw)];
        if (flaw == SpaceGoalFlaw::none) {
            tries.place = place;
            return reach;
        }
        places.push_back(*place);
    }
    reach.objection = Failed{robot, bounds, *scene, checker, margin_m, goal, tries, places}.objection(sampler);
    return reach;
}

}  // namespace downwash

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "../support/random.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/space_hover.hpp"
#include "downwash/simulation/space_tool.hpp"
#include "downwash/simulation/space_touch_place.hpp"

// What holds of the problems in space before anything is planned: robots start clear of obstacles, and there is a pose
// at every goal in which they are clear and hover. The way between is the planner's business.

using namespace downwash;

namespace {

namespace fs = std::filesystem;

constexpr double pi = std::numbers::pi;

std::vector<fs::path> problems_in(const fs::path& folder) {
    std::set<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() == ".yaml") {
            files.insert(entry.path());
        }
    }
    return {files.begin(), files.end()};
}

SpacePose level(const Vector3& position_m, double yaw_rad, const std::array<double, max_links>& joints_rad) {
    return {position_m, {std::cos(0.5 * yaw_rad), 0, 0, std::sin(0.5 * yaw_rad)}, joints_rad};
}

double length_of(const Vector3& v) {
    return std::sqrt(dot(v, v));
}

/// A vector at most an angle away from a direction, even over the solid angle.
Vector3 in_cone(test::Random& random, const Vector3& direction, double half_angle_rad) {
    const Vector3 axis = (1 / length_of(direction)) * direction;
    const Vector3 beside = std::abs(axis[0]) < 0.5 ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
    Vector3 u = cross(axis, beside);
    u = (1 / length_of(u)) * u;
    const Vector3 v = cross(axis, u);
    const double cosine = random.uniform(std::cos(half_angle_rad), 1), turn_rad = random.uniform(0, 2 * pi);
    const double sine = std::sqrt(1 - cosine * cosine);
    return cosine * axis + (sine * std::cos(turn_rad)) * u + (sine * std::sin(turn_rad)) * v;
}

/// A problem in space with what its poses are asked.
struct Asked {
    explicit Asked(const fs::path& file)
        : problem(read_space_problem(file)),
          scene(std::make_shared<const Scene>(problem.obstacles)),
          checker(scene, shape_of(problem.robot)),
          hover(problem.robot, scene, problem.aero),
          surfaces(hover.direct_effect()) {}

    SpaceProblem problem;
    std::shared_ptr<const Scene> scene;
    SpaceChecker checker;
    SpaceHover hover;
    std::unique_ptr<simulation::SpaceEffect> surfaces;

    [[nodiscard]] bool is_within_bounds(const Vector3& at_m) const {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (at_m[axis] < problem.bounds.low_m[axis] || at_m[axis] > problem.bounds.high_m[axis]) {
                return false;
            }
        }
        return true;
    }

    /// Whether the robot hovers there and is clear of obstacles as it leans then.
    [[nodiscard]] bool hovers_clear(const SpacePose& pose) const {
        const double margin_m = problem.planner.safety_margin_m;
        if (!is_within_bounds(pose.position_m) || checker.is_nearer_than(pose, margin_m)) {
            return false;
        }
        SpacePoint place;
        std::copy(pose.position_m.begin(), pose.position_m.end(), place.position);
        place.position[space::yaw] = yaw_of(pose.attitude);
        std::copy_n(pose.joints_rad.begin(), problem.robot.joints(), place.position + space::first_joint);
        const SpaceHoverAnalysis analysis = hover.at(place, *surfaces);
        if (analysis.verdict != HoldVerdict::stable) {
            return false;
        }
        const SpaceMotion& motion = analysis.trim.motion;
        return !checker.is_nearer_than({motion.position_m, motion.attitude, motion.joints_rad}, margin_m);
    }

    [[nodiscard]] std::array<double, max_links> any_joints(test::Random& random) const {
        std::array<double, max_links> joints_rad{};
        for (std::size_t i = 0; i < problem.robot.links.size(); ++i) {
            const SpaceLinkLimits& link = problem.robot.links[i];
            joints_rad[i] =
                link.is_limited ? random.uniform(link.lower_limit_rad, link.upper_limit_rad) : random.uniform(-pi, pi);
        }
        return joints_rad;
    }
};

/// A random robot level at the origin, and its tool.
struct Try {
    SpacePose pose;
    SpaceToolPose tool;

    Try(const Asked& asked, test::Random& random)
        : pose(level({}, random.uniform(-pi, pi), asked.any_joints(random))),
          tool(tool_at(asked.problem.robot, pose)) {}

    /// The same robot with its tool at a point.
    [[nodiscard]] SpacePose with_tool_at(const Vector3& at_m) const {
        SpacePose moved = pose;
        moved.position_m = at_m - tool.position_m;
        return moved;
    }
    /// The same with the tool anywhere in a ball.
    [[nodiscard]] SpacePose with_tool_near(const Vector3& at_m, double radius_m, test::Random& random) const {
        return with_tool_at(at_m + random.uniform(0, radius_m) * in_cone(random, {0, 0, 1}, pi));
    }
};

// A pose that may meet a goal, of a random yaw and random joints.

std::optional<SpacePose> pose_for(const SpaceConfigurationGoal& goal, const Asked& asked, test::Random& random) {
    Try any(asked, random);
    const std::array given{goal.x_m, goal.y_m, goal.z_m};
    Vector3 at_m{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        at_m[axis] = given[axis] ? *given[axis]
                                 : random.uniform(asked.problem.bounds.low_m[axis], asked.problem.bounds.high_m[axis]);
    }
    std::array<double, max_links> joints_rad = any.pose.joints_rad;
    std::copy(goal.joints_rad.begin(), goal.joints_rad.end(), joints_rad.begin());
    return level(at_m, goal.yaw_rad.value_or(yaw_of(any.pose.attitude)), joints_rad);
}

std::optional<SpacePose> pose_for(const SpaceEndEffectorGoal& goal, const Asked& asked, test::Random& random) {
    return Try(asked, random).with_tool_near(goal.position_m, goal.tolerance_m, random);
}

std::optional<SpacePose> pose_for(const SpacePoseGoal& goal, const Asked& asked, test::Random& random) {
    return Try(asked, random).with_tool_near(goal.position_m, goal.tolerance_m, random);
}

std::optional<SpacePose> pose_for(const SpaceCameraGoal& goal, const Asked& asked, test::Random& random) {
    const Try any(asked, random);
    if (goal.direction && angle_between_rad(*goal.direction, any.tool.direction) > goal.view_cone_rad) {
        return std::nullopt;
    }
    const double away_m = random.uniform(goal.nearest_m, goal.farthest_m);
    const Vector3 look = in_cone(random, any.tool.direction, 0.5 * goal.aim_tolerance_rad);
    return any.with_tool_at(goal.target_m - away_m * look);
}

/// The obstacle of a name, alone.
Scene alone(const SpaceProblem& problem, const std::string& name) {
    std::vector<Obstacle> named;
    std::copy_if(problem.obstacles.begin(), problem.obstacles.end(), std::back_inserter(named),
                 [&](const Obstacle& each) { return each.name == name; });
    return Scene(std::move(named));
}

std::optional<SpacePose> pose_for(const SpaceContactGoal& goal, const Asked& asked, test::Random& random) {
    const Try any(asked, random);
    if (goal.part != TouchingPart::end_effector || !goal.position_m) {
        return std::nullopt;
    }
    // As far in front of the place as it waits, against where the tool points, and its tip's radius more or less.
    return any.with_tool_at(*goal.position_m - (goal.standoff_m + random.uniform(-0.05, 0.05)) * any.tool.direction);
}

bool meets(const SpaceGoal& goal, const Asked& asked, const SpacePose& pose) {
    if (const auto* contact = std::get_if<SpaceContactGoal>(&goal.kind)) {
        const FoundTouch found =
            find_touch(*contact, goal.hold_s, asked.problem.robot, pose, alone(asked.problem, contact->obstacle));
        return found.touch && is_met(goal_error(*found.touch, asked.problem.robot, pose));
    }
    return is_met(goal_error(goal, asked.problem.robot, pose, *asked.scene));
}

/// A pose at a goal in which the robot hovers and is clear of obstacles; empty where none of many random ones is.
std::optional<SpacePose> place_at(const SpaceGoal& goal, const Asked& asked) {
    test::Random random(7);
    for (int tries = 0; tries < 200000; ++tries) {
        const auto pose = std::visit([&](const auto& kind) { return pose_for(kind, asked, random); }, goal.kind);
        if (pose && meets(goal, asked, *pose) && asked.hovers_clear(*pose)) {
            return pose;
        }
    }
    return std::nullopt;
}

/// Checks one problem. @returns the kinds of its goals
std::set<std::size_t> look_at(const fs::path& file) {
    const Asked asked(file);
    CAPTURE(asked.problem.name);
    const SpaceMotion start = start_motion(asked.problem.start);
    CHECK(asked.hovers_clear({start.position_m, start.attitude, start.joints_rad}));
    std::set<std::size_t> kinds;
    for (const SpaceGoal& goal : asked.problem.goals) {
        const std::vector<SpaceGoal> all = goal.any_of.empty() ? std::vector{goal} : goal.any_of;
        for (const SpaceGoal& each : all) {
            CAPTURE(&goal - asked.problem.goals.data(), each.kind.index());
            CHECK(place_at(each, asked));
            kinds.insert(each.kind.index());
        }
    }
    return kinds;
}

}  // namespace

TEST_CASE("Robots of the problems in space start clear of obstacles, and each goal has a place to hover") {
    const std::vector<fs::path> files = problems_in(DOWNWASH_PROBLEMS "/space");
    CHECK(files.size() == 13);  // eight structures, one of them in two more forms, and the example of a reference
    std::set<std::size_t> kinds;
    for (const fs::path& file : files) {
        kinds.merge(look_at(file));
    }
    CHECK(kinds.size() == std::variant_size_v<SpaceGoalKind>);
}

TEST_CASE("Robots of random girder bays and pipe racks start clear of obstacles, and each goal has a place to hover") {
    const std::vector<fs::path> files = problems_in(DOWNWASH_RANDOM_PROBLEMS "/space");
    CHECK(files.size() == 10);
    for (const fs::path& file : files) {
        look_at(file);
    }
}

TEST_CASE("The gauge is pressed on the tank as hard as the problem asks, from a place at its goal") {
    const Asked asked(DOWNWASH_PROBLEMS "/space/tank_shell.yaml");
    const auto pose = place_at(asked.problem.goals.at(0), asked);
    REQUIRE(pose);
    SpacePose ahead = *pose;  // outside the wind girder, in front of the place
    ahead.position_m = pose->position_m - 2.0 * tool_at(asked.problem.robot, *pose).direction;
    const SpaceMotion start = start_motion(asked.problem.start);
    SpacePlan plan;
    plan.tick_s = 1 / asked.problem.robot.controller.rate_hz;
    plan.joints = asked.problem.robot.joints();
    for (const SpacePose& at : {SpacePose{start.position_m, start.attitude, start.joints_rad}, ahead, *pose}) {
        SpaceKnot& knot = plan.reference.emplace_back();
        knot.tick = static_cast<std::int64_t>(2500 * (plan.reference.size() - 1));
        std::copy(at.position_m.begin(), at.position_m.end(), knot.point.position);
        // The start looks at the tank by 180 degrees: the same turn for all.
        knot.point.position[space::yaw] = std::fmod(yaw_of(at.attitude) + 2 * pi, 2 * pi);
        std::copy_n(at.joints_rad.begin(), plan.joints, knot.point.position + space::first_joint);
    }
    const SpaceFlight flight = SpaceProblemModel(asked.problem).execute(plan);
    CHECK(flight.outcome == Outcome::ok);
    REQUIRE(flight.goals.size() == 1);
    REQUIRE(flight.goals[0].touch);
    CHECK(flight.goals[0].touch->end == SpaceTouchEnd::met);
    CHECK(flight.goals[0].is_met);
}

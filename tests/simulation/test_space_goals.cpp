#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>

#include "../support/space_robots.hpp"
#include "downwash/simulation/space_goal_rule.hpp"
#include "downwash/simulation/space_press.hpp"
#include "downwash/simulation/space_statics.hpp"
#include "downwash/simulation/space_tool.hpp"
#include "downwash/simulation/space_touch_place.hpp"

// Goals in space: each kind met and just not met, by cases worked out by hand.

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// An arm of 0.5 m, 0.1 m below the multirotor. It points ahead at an angle of zero and turns down with it.
SpaceRobot pointing_robot() {
    SpaceRobot robot = space_robot(1);
    SpaceLink& link = robot.plant.links[0];
    link.joint_m = {0, 0, -0.1};
    link.axis = {0, 2, 0};
    robot.plant.end_effector_m = {0.5, 0, 0};
    robot.tool_direction = {1, 0, 0};
    robot.links[0].body = {{Capsule{0.02, {0, 0, 0}, {0.5, 0, 0}}, {}}};
    robot.body = {{Box{{0.4, 0.4, 0.1}}, {0, 0, 0.03}}};
    return robot;
}

/// At (1, 2, 3), to the left: the end effector is at (1, 2.5, 2.9) and points along y.
SpacePose to_the_left(double joint_rad = 0) {
    SpacePose pose;
    pose.position_m = {1, 2, 3};
    pose.attitude = {std::cos(std::numbers::pi / 4), 0, 0, std::sin(std::numbers::pi / 4)};
    pose.joints_rad[0] = joint_rad;
    return pose;
}

Scene scene_of(const std::vector<Obstacle>& obstacles) {
    return Scene(obstacles);
}

SpaceGoalError error_of(const SpaceGoalKind& kind, const SpacePose& pose, const std::vector<Obstacle>& obstacles = {},
                        const SpaceWorld& world = {}) {
    return goal_error({kind, 5, {}}, pointing_robot(), pose, scene_of(obstacles), world);
}

bool is_met_at(const SpaceGoalKind& kind, const SpacePose& pose, const std::vector<Obstacle>& obstacles = {},
               const SpaceWorld& world = {}) {
    return is_met(error_of(kind, pose, obstacles, world));
}

Obstacle turned_box(const std::string& name, const Vector3& size_m, const Vector3& center_m,
                    const Vector3& rpy_rad = {}) {
    return {name, Box{size_m}, center_m, rpy_rad};
}

SpacePoint point_at(const Vector3& position_m, double yaw_rad, double joint_rad = 0) {
    SpacePoint point;
    std::copy(position_m.begin(), position_m.end(), point.position);
    point.position[space::yaw] = yaw_rad;
    point.position[space::first_joint] = joint_rad;
    return point;
}

}  // namespace

TEST_CASE("The end effector of a robot in space is where its joints take it") {
    const SpaceRobot robot = pointing_robot();
    const SpaceToolPose ahead = tool_at(robot, to_the_left());
    const SpaceToolPose down = tool_at(robot, to_the_left(std::numbers::pi / 2));
    const Vector3 at[] = {ahead.position_m, ahead.direction, down.position_m, down.direction};
    const Vector3 expected[] = {{1, 2.5, 2.9}, {0, 1, 0}, {1, 2, 2.4}, {0, 0, -1}};
    for (int i = 0; i < 4; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            CHECK(at[i][axis] == Approx(expected[i][axis]).margin(1e-14));
        }
    }
    CHECK(yaw_of(to_the_left().attitude) == Approx(90 * degree));
    CHECK(angle_between_rad({1e-200, 0, 0}, {0, 1e200, 0}) == Approx(90 * degree));
    CHECK(angle_between_rad({1, 0, 0}, {-2, 0, 0}) == Approx(std::numbers::pi));
}

TEST_CASE("A goal of the end effector is met within its distance and its cone") {
    SpaceEndEffectorGoal goal{{1, 2.5, 3.0}, 0.1001, {}, 5 * degree};
    CHECK(is_met_at(goal, to_the_left()));
    CHECK(error_of(goal, to_the_left()).distance_m == Approx(0.1));
    goal.tolerance_m = 0.0999;
    CHECK_FALSE(is_met_at(goal, to_the_left()));

    goal = {{1, 2.5, 2.9}, 0.1, Vector3{0, 3, 0}, 5 * degree};
    CHECK(is_met_at(goal, to_the_left(4.99 * degree)));
    CHECK_FALSE(is_met_at(goal, to_the_left(5.01 * degree)));
    CHECK(error_of(goal, to_the_left(5.01 * degree)).angle_rad == Approx(5.01 * degree));
    goal.direction = Vector3{0, -1, 0};
    CHECK(error_of(goal, to_the_left()).angle_rad == Approx(std::numbers::pi));
}

TEST_CASE("A full pose is met within a distance and one turn") {
    // R = Rz(90 deg) Ry(joint): the link's own attitude.
    SpacePoseGoal goal{{1, 2.5, 2.9}, {0, 0, 90 * degree}, 0.1, 5 * degree};
    CHECK(error_of(goal, to_the_left()).angle_rad == Approx(0).margin(1e-12));
    CHECK(is_met_at(goal, to_the_left(4.99 * degree)));
    CHECK_FALSE(is_met_at(goal, to_the_left(5.01 * degree)));
    // What a direction leaves free: a turn about the tool itself.
    goal.rpy_rad = {5.01 * degree, 0, 90 * degree};
    CHECK_FALSE(is_met_at(goal, to_the_left()));
    goal.rpy_rad = {4.99 * degree, 0, 450 * degree};
    CHECK(is_met_at(goal, to_the_left()));
    goal.rpy_rad = {3 * degree, 4.5 * degree, 90 * degree};  // the turns add up: 5.4 degrees
    CHECK_FALSE(is_met_at(goal, to_the_left()));
    CHECK(error_of(goal, to_the_left()).angle_rad == Approx(5.4078 * degree).epsilon(1e-4));
}

TEST_CASE("A configuration is met in the coordinates that it names, angles modulo a turn") {
    SpaceConfigurationGoal goal;
    goal.yaw_rad = (90 - 360) * degree;
    CHECK(is_met_at(goal, to_the_left()));
    goal.yaw_rad = 95.01 * degree;
    CHECK_FALSE(is_met_at(goal, to_the_left()));
    goal.yaw_rad = {};
    goal.x_m = 1.06;
    goal.z_m = 3.08;
    CHECK(error_of(goal, to_the_left()).distance_m == Approx(0.1));
    goal.tolerance_m = 0.0999;
    CHECK_FALSE(is_met_at(goal, to_the_left()));
    goal.z_m = {};
    CHECK(is_met_at(goal, to_the_left()));
    goal.joints_rad = {4.99 * degree};
    CHECK(is_met_at(goal, to_the_left(2 * std::numbers::pi)));
    goal.joints_rad = {5.01 * degree};
    CHECK_FALSE(is_met_at(goal, to_the_left()));
}

TEST_CASE("A camera has to be near enough, to aim, to look in the direction and to see") {
    // The camera is at (1, 2.5, 2.9) and points along y at a target 1 m away.
    SpaceCameraGoal goal{{1, 3.5, 2.9}, 0.5, 1.001, Vector3{0, 1, 0}, 30 * degree, 5 * degree, true};
    CHECK(is_met_at(goal, to_the_left()));
    goal.farthest_m = 0.999;
    CHECK_FALSE(is_met_at(goal, to_the_left()));
    CHECK(error_of(goal, to_the_left()).distance_m == Approx(0.001));
    goal.nearest_m = 1.001;
    goal.farthest_m = 2;
    CHECK_FALSE(is_met_at(goal, to_the_left()));
    goal.nearest_m = 0.999;
    CHECK(is_met_at(goal, to_the_left()));

    goal.direction = Vector3{0, std::cos(29.9 * degree), std::sin(29.9 * degree)};
    CHECK(is_met_at(goal, to_the_left()));
    goal.direction = Vector3{0, std::cos(30.1 * degree), std::sin(30.1 * degree)};
    CHECK_FALSE(is_met_at(goal, to_the_left()));
    goal.direction = {};
    // Aside by tan(5 degrees) a metre away.
    goal.target_m = {1 + std::tan(4.99 * degree), 3.5, 2.9};
    CHECK(is_met_at(goal, to_the_left()));
    goal.target_m = {1 + std::tan(5.01 * degree), 3.5, 2.9};
    CHECK_FALSE(is_met_at(goal, to_the_left()));

    goal.target_m = {1, 3.5, 2.9};
    const std::vector<Obstacle> plate = {turned_box("plate", {0.4, 0.01, 0.4}, {1.2011, 3, 2.9})};
    CHECK(is_met_at(goal, to_the_left(), plate));  // it ends 1.1 mm beside the line
    const std::vector<Obstacle> nearer = {turned_box("plate", {0.4, 0.01, 0.4}, {1.2009, 3, 2.9})};
    CHECK_FALSE(is_met_at(goal, to_the_left(), nearer));
    CHECK(error_of(goal, to_the_left(), nearer).is_hidden);
    goal.sees = false;
    CHECK(is_met_at(goal, to_the_left(), nearer));
}

TEST_CASE("A target belongs to what it lies on, up to two centimetres deep, and goes with the scene") {
    const SpaceCameraGoal goal{{1, 3.5, 2.9}, 0.5, 1.5, {}, 1, 5 * degree, true};
    const auto wall = [](double face_m) {
        return std::vector<Obstacle>{turned_box("wall", {4, 1, 4}, {1, face_m + 0.5, 3})};
    };
    CHECK(is_met_at(goal, to_the_left(), wall(3.5)));
    CHECK(is_met_at(goal, to_the_left(), wall(3.482)));  // less the beam's own millimetre
    CHECK_FALSE(is_met_at(goal, to_the_left(), wall(3.478)));
    SpaceWorld world;
    world.scene_m = {0, -0.1, 0};
    CHECK(is_met_at(goal, to_the_left(), wall(3.5), world));
    world.scene_m = {0, 0.52, 0};  // the target is 1.52 m away
    CHECK_FALSE(is_met_at(goal, to_the_left(), wall(3.5), world));
    // Turned about the origin, the target is at R (1, 3.5, 2.9); the camera then looks past it.
    world = {};
    world.scene_yaw_rad = 2 * degree;
    CHECK_FALSE(is_met_at(goal, to_the_left(), wall(3.5), world));
    CHECK(error_of(goal, to_the_left(), wall(3.5), world).angle_rad ==
          Approx(std::atan2(1 - (std::cos(2 * degree) - 3.5 * std::sin(2 * degree)),
                            std::sin(2 * degree) + 3.5 * std::cos(2 * degree) - 2.5)));
    // Other goals stay where they are.
    CHECK(is_met_at(SpaceEndEffectorGoal{{1, 2.5, 2.9}, 0.01, {}, 1}, to_the_left(), {}, world));
}

TEST_CASE("What a robot lacks to press is what statics by hand say") {
    SpaceRobot robot = pointing_robot();
    robot.plant.end_effector_m = {0.5, 0, 0.2};  // at (1, 2.5, 3.1)
    robot.links[0].max_torque_nm = 1e3;
    robot.min_thrust_n.assign(robot.min_thrust_n.size(), 0);
    SpaceContactGoal goal;
    goal.obstacle = "wall";
    const FoundTouch found =
        find_touch(goal, 3, robot, to_the_left(), scene_of({turned_box("wall", {4, 1, 4}, {1, 3.32, 3})}));
    REQUIRE(found.touch);
    const auto lack = [&](double force_n) {
        SpaceTouch touch = *found.touch;
        touch.force_n = force_n;
        return lacks_to_press(robot, to_the_left(), touch);
    };
    using Catch::Contains;
    using Catch::StartsWith;
    const double weight_n = robot.mass_kg() * standard_gravity_m_s2;
    const double rotors = static_cast<double>(robot.max_thrust_n.size());
    CHECK(lack(0).empty());
    // Thrust carries the weight and leans against the wall.
    robot.max_thrust_n.assign(robot.max_thrust_n.size(), 2 * weight_n / rotors);
    const double whole_n = weight_n * std::sqrt(3.0);
    CHECK_THAT(lack(1.001 * whole_n), Contains(" N of thrust, and its rotors give "));
    CHECK_THAT(lack(0.999 * whole_n), StartsWith("takes a tilt of 60 degrees, and its controller allows "));
    auto& law = std::get<SpaceInversion>(robot.controller.law);
    law.max_tilt_rad = 50 * degree;
    robot.max_thrust_n.assign(robot.max_thrust_n.size(), 100 * weight_n);
    const double leaning_n = weight_n * std::tan(50 * degree);
    CHECK_THAT(lack(1.001 * leaning_n), StartsWith("takes a tilt of 50 degrees"));
    CHECK_THAT(lack(0.999 * leaning_n), !Contains("tilt"));
    // The force is 0.2 m above the joint, which holds the weight of its link besides.
    const SpacePose pose = to_the_left();
    const ArmPose arm = arm_pose(robot, {pose.joints_rad.begin(), pose.joints_rad.begin() + robot.joints()});
    const double weighs_nm = std::abs(holding_torque_nm(robot, arm, 0));
    robot.links[0].max_torque_nm = 1;
    law.max_tilt_rad = 89 * degree;
    robot.min_thrust_n.assign(robot.min_thrust_n.size(), -100 * weight_n);
    const double held_n = (1 + weighs_nm) / 0.2;
    CHECK_THAT(lack(1.001 * held_n), StartsWith("takes 1 N m of joint 1, which gives 1 N m at most"));
    CHECK(lack(0.999 * held_n).empty());
    // All rotors together have enough, but the moments of arm and force take more of some of them.
    robot.links[0].max_torque_nm = 1e3;
    robot.max_thrust_n.assign(robot.max_thrust_n.size(), 1.05 * std::hypot(weight_n, 0.5 * weight_n) / rotors);
    CHECK_THAT(lack(0.5 * weight_n), Contains(" N of rotor "));
}

TEST_CASE("A robot touches the nearest point of an obstacle along its normal") {
    const SpaceRobot robot = pointing_robot();
    SpaceContactGoal goal;
    goal.obstacle = "wall";
    const Scene wall = scene_of({turned_box("wall", {4, 1, 4}, {1, 3.32, 3})});  // its face is at y = 2.82
    const FoundTouch found = find_touch(goal, 3, robot, to_the_left(), wall);
    REQUIRE(found.touch);
    const SpaceTouch& touch = *found.touch;
    CHECK(touch.normal[1] == Approx(-1));
    CHECK(touch.surface_m[1] == Approx(2.8));  // the capsule ends 2 cm beyond the end effector
    CHECK(touch.waiting_m[1] == Approx(2.5));
    CHECK(touch.waiting_m[2] == Approx(2.9));
    CHECK(touch.hold_s == 3);
    CHECK(touch.force_tolerance_n == Approx(1));
    CHECK(goal_error(touch, robot, to_the_left()).distance_m == Approx(0).margin(1e-6));

    const auto reason = [&](const SpaceContactGoal& at, const SpacePose& pose, const Scene& scene) {
        const FoundTouch none = find_touch(at, 3, robot, pose, scene);
        CHECK_FALSE(none.touch);
        return none.reason;
    };
    using Catch::Matchers::Contains;
    CHECK_THAT(reason(goal, to_the_left(6 * degree), wall), Contains("points 6 degrees off"));
    CHECK_THAT(reason(goal, to_the_left(), scene_of({turned_box("wall", {0.15, 1, 4}, {1, 3.32, 3})})),
               Contains("not flat"));
    CHECK_THAT(reason(goal, to_the_left(), scene_of({{"wall", Cylinder{0.5, 4}, {1, 3.32, 3}, {}}})),
               Contains("not flat"));
    CHECK_THAT(reason(goal, to_the_left(), scene_of({turned_box("wall", {4, 1, 4}, {1, 2.9, 3})})), Contains("inside"));
    goal.position_m = Vector3{1.05, 2.82, 2.95};
    const FoundTouch wanted = find_touch(goal, 3, robot, to_the_left(), wall);
    REQUIRE(wanted.touch);
    CHECK(wanted.touch->waiting_m[0] == Approx(1.05));
    CHECK(goal_error(*wanted.touch, robot, to_the_left()).distance_m == Approx(std::hypot(0.05, 0.05)));
    goal.position_m = Vector3{1, 2.6, 2.9};
    CHECK_THAT(reason(goal, to_the_left(), wall), Contains("0.22 m off the surface"));

    // Its top is a box of 0.4 m, 0.08 m up.
    goal = {};
    goal.part = TouchingPart::frame;
    const FoundTouch top =
        find_touch(goal, 3, robot, to_the_left(), scene_of({turned_box("deck", {4, 4, 1}, {1, 2, 3.9})}));
    REQUIRE(top.touch);
    CHECK(top.touch->points.size() == 4);
    CHECK(top.touch->normal[2] == Approx(-1));
    CHECK(top.touch->surface_m[2] == Approx(3.4));
    CHECK(top.touch->waiting_m[2] == Approx(3.1));
    CHECK_THAT(reason(goal, to_the_left(), wall), Contains("points 90 degrees off"));
}

TEST_CASE("A plan hovers for its goals where it stays long enough, in their order or in any") {
    const SpaceRobot robot = pointing_robot();
    const auto scene = std::make_shared<const Scene>(std::vector<Obstacle>{turned_box("deck", {4, 4, 1}, {0, 0, 3.9})});
    const auto at_x = [](double x_m) {
        SpaceConfigurationGoal goal;
        goal.x_m = x_m;
        return SpaceGoal{goal, 2, {}};
    };
    SpacePlan plan;
    plan.tick_s = 0.01;
    plan.joints = 1;
    plan.reference = {{0, point_at({0, 0, 3}, 0)},   {300, point_at({1, 0, 3}, 0)}, {500, point_at({1, 0, 3}, 0)},
                      {800, point_at({2, 0, 3}, 0)}, {999, point_at({2, 0, 3}, 0)}, {1200, point_at({3, 0, 3}, 0)}};
    const auto hovers = [&](const std::vector<SpaceGoal>& goals, bool in_any_order = false) {
        return SpaceGoalRule(robot, scene, goals, in_any_order).hovers(plan);
    };
    const auto ordered = hovers({at_x(1), at_x(3)});
    REQUIRE(ordered.size() == 2);
    CHECK(ordered[0].end_tick == 500);
    CHECK(ordered[1].end_tick == 1400);
    // It stays at 2 m for a tick too few: the hover behind the last knot counts for the first goal without one.
    const auto hasty = hovers({at_x(1), at_x(2), at_x(3)});
    REQUIRE(hasty.size() == 2);
    CHECK(hasty[1].goal == 1);
    CHECK(hasty[1].end_tick == 1400);
    plan.reference[4].tick = 1000;
    CHECK(hovers({at_x(1), at_x(2), at_x(3)}).size() == 3);
    CHECK(hovers({at_x(3), at_x(1)}).size() == 1);
    const auto any = hovers({at_x(3), at_x(2), at_x(1)}, true);
    REQUIRE(any.size() == 3);
    CHECK(any[0].goal == 2);
    CHECK(any[1].goal == 1);
    CHECK(any[2].goal == 0);
    // Among alternatives the one that the reference meets says how long it is held.
    SpaceGoal choice = at_x(7);
    choice.any_of = {at_x(9), at_x(3)};
    choice.any_of[1].hold_s = 3;
    CHECK(hovers({choice})[0].end_tick == 1500);

    // A contact: a hover of two seconds under the deck, then the touch.
    SpaceContactGoal contact;
    contact.obstacle = "deck";
    contact.part = TouchingPart::frame;
    plan.reference = {{0, point_at({0, 0, 3.02}, 0)}};
    const SpaceGoalRule rule(robot, scene, {SpaceGoal{contact, 4, {}}});
    const auto touching = rule.hovers(plan);
    REQUIRE(touching[0].touch);
    CHECK(touching[0].end_tick == 200);
    CHECK(touching[0].touch->hold_s == 4);
    SpaceMotion motion = motion_at_rest(plan.at(0));
    CHECK(meets_goal(rule.error(touching[0], motion), motion));
    motion.velocity_m_s = {0, 0.04, 0.04};
    CHECK_FALSE(meets_goal(rule.error(touching[0], motion), motion));
    plan.reference = {{0, point_at({5, 0, 3.02}, 0)}};
    CHECK_FALSE(rule.hovers(plan)[0].touch);
    CHECK_FALSE(rule.hovers(plan)[0].reason.empty());
}

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>

#include "../support/count_allocations.hpp"
#include "downwash/simulation/space_arm_angles.hpp"
#include "downwash/simulation/space_goal_error.hpp"
#include "downwash/simulation/space_goal_reach.hpp"
#include "downwash/simulation/space_goal_sampler.hpp"
#include "downwash/simulation/space_touch_place.hpp"

// Configurations at goals in space: how much of the tolerances they use, what they keep clear of, and why there are
// none. tests/simulation/test_space_goals_against_kdl.cpp compares many arms with another library.

using namespace downwash;
using Catch::Contains;

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr SpaceBounds wide{{-10, -10, -10}, {10, 10, 10}};

/// A robot with an arm of up to six joints about y, z, y, x, y and z, of links of 0.15 m. It points ahead at angles of
/// zero.
SpaceRobot robot_with(int joints, double limit_rad = 100 * degree) {
    SpaceRobot robot;
    robot.body = {{Box{{0.4, 0.4, 0.1}}, {0, 0, 0.03}}};
    const Vector3 axes[] = {{0, 1, 0}, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < joints; ++i) {
        SpaceLink link;
        link.joint_m = i == 0 ? Vector3{0, 0, -0.1} : Vector3{0.15, 0, 0};
        link.axis = axes[i];
        robot.plant.links.push_back(link);
        SpaceLinkLimits limits;
        limits.is_limited = true;
        limits.lower_limit_rad = -limit_rad;
        limits.upper_limit_rad = limit_rad;
        limits.body = {{Capsule{0.02, {0, 0, 0}, {0.15, 0, 0}}, {}}};
        robot.links.push_back(limits);
    }
    robot.plant.end_effector_m = {0.15, 0, 0};
    robot.tool_direction = {1, 0, 0};
    return robot;
}

Obstacle box(const std::string& name, const Vector3& size_m, const Vector3& center_m) {
    return {name, Box{size_m}, center_m, {}};
}

/// A robot among obstacles.
struct Place {
    SpaceRobot robot;
    std::shared_ptr<const Scene> scene;
    SpaceChecker checker;
    SpaceBounds bounds;
    double margin_m;

    explicit Place(const SpaceRobot& of, const std::vector<Obstacle>& obstacles = {}, const SpaceBounds& within = wide,
                   double margin = 0.05)
        : robot(of),
          scene(std::make_shared<const Scene>(obstacles)),
          checker(scene, shape_of(robot)),
          bounds(within),
          margin_m(margin) {}

    [[nodiscard]] SpaceGoalSampler sampler(const SpaceGoal& goal) const {
        return {robot, bounds, scene, checker, margin_m, goal};
    }
    [[nodiscard]] SpaceGoalReach reach(const SpaceGoal& goal) const {
        return goal_reach(robot, bounds, scene, checker, margin_m, goal);
    }
    /// The share of a goal's tolerances that a configuration uses; of contacts at the hover before the touch.
    [[nodiscard]] double used_share(const SpaceGoal& goal, const SpaceConfiguration& at) const {
        if (const auto* contact = std::get_if<SpaceContactGoal>(&goal.kind)) {
            const FoundTouch found = find_touch(*contact, 1, robot, level_at(at), *scene);
            return found.touch ? goal_error(*found.touch, robot, level_at(at)).used_share : HUGE_VAL;
        }
        return goal_error(goal, robot, level_at(at), *scene).used_share;
    }
};

/// Goals of each kind that an arm of so many joints can meet exactly.
std::vector<SpaceGoal> goals_for(int joints) {
    SpaceConfigurationGoal configuration;
    configuration.x_m = 1;
    configuration.z_m = 2;
    configuration.yaw_rad = 3;
    configuration.joints_rad.assign(static_cast<std::size_t>(joints), 0.7);
    SpaceConfigurationGoal yaw_alone;
    yaw_alone.yaw_rad = -2;
    const double pitch = joints > 0 ? -30 * degree : 0, roll = joints > 1 ? 20 * degree : 0;
    std::vector<SpaceGoal> goals;
    goals.push_back({configuration, 5, {}});
    goals.push_back({yaw_alone, 5, {}});
    goals.push_back({SpaceEndEffectorGoal{{1, 2, 3}, 0.1, {}, 0.1}, 5, {}});
    goals.push_back({SpaceEndEffectorGoal{{1, 2, 3}, 0.1, Vector3{-3, 1, joints > 0 ? 2.0 : 0.0}, 0.1}, 5, {}});
    goals.push_back({SpaceEndEffectorGoal{{1, 2, 3}, 0.1, Vector3{0, 0, joints > 0 ? -1.0 : 0.02}, 1.57}, 5, {}});
    goals.push_back({SpacePoseGoal{{1, 2, 3}, {roll, pitch, 100 * degree}, 0.1, 0.2}, 5, {}});
    goals.push_back({SpaceCameraGoal{{1, 2, 3}, 0.5, 1.5, Vector3{0, 1, 0}, 0.5, 0.1, true}, 5, {}});
    goals.push_back({SpaceCameraGoal{{1, 2, 3}, 0.5, 1.5, {}, 0.5, 0.1, true}, 5, {}});
    return goals;
}

/// Largest of the way in metres and the turns in radians.
double apart(const SpaceConfiguration& from, const SpaceConfiguration& to) {
    double turn = 0, square = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        i < 3 ? void(square += (to[i] - from[i]) * (to[i] - from[i]))
              : void(turn = std::max(turn, std::abs(to[i] - from[i])));
    }
    return std::max(std::sqrt(square), turn);
}

bool is_within_limits(const SpaceRobot& robot, const SpaceConfiguration& at) {
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        const double q = at[space::first_joint + i];
        if (robot.links[i].is_limited &&
            !(q >= robot.links[i].lower_limit_rad && q <= robot.links[i].upper_limit_rad)) {
            return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("A configuration drawn for a goal in space uses no more of its tolerances than it may") {
    for (int joints = 0; joints <= 6; ++joints) {
        const Place place(robot_with(joints));
        const std::vector<SpaceGoal> goals = goals_for(joints);
        for (std::size_t number = 0; number < goals.size(); ++number) {
            const SpaceGoalSampler sampler = place.sampler(goals[number]);
            Random random(number);
            for (const double share : {0.0, 0.5, 0.9}) {
                int found = 0;
                double most = 0;
                for (int i = 0; i < 300; ++i) {
                    if (const std::optional<SpaceGoalPlace> drawn = sampler.drawn(random, share)) {
                        ++found;
                        most = std::max(most, place.used_share(goals[number], drawn->at));
                        CHECK(is_within_limits(place.robot, drawn->at));
                    }
                }
                CAPTURE(joints, number, share, found, most);
                // Downwards without an arm is beyond what the tolerance leaves at these shares.
                const bool is_possible = joints > 0 || number != 4;
                CHECK((found >= 10) == is_possible);
                CHECK(most <= share + 1e-11);
                CHECK(most >= (is_possible ? 0.5 * share : 0));  // it is spread over the share
            }
        }
    }
}

TEST_CASE("Samples of a goal keep clear of obstacles and of the robot, and tries are bounded and counted") {
    // A plate 0.25 m behind the goal: the robot has to reach from one side.
    const Place place(robot_with(3, 170 * degree), {box("plate", {0.1, 4, 4}, {1.3, 2, 3})});
    const SpaceGoal goal{SpaceEndEffectorGoal{{1, 2, 3}, 0.1, {}, 0.1}, 5, {}};
    const SpaceGoalSampler sampler = place.sampler(goal);
    Random random(3), same(3);
    int near = 0, itself = 0;
    for (int i = 0; i < 200; ++i) {
        const SpaceGoalSample sample = sampler.sample(random, 0.9);
        REQUIRE(sample.place);
        CHECK(sampler.sample(same, 0.9).place->at == sample.place->at);
        const SpacePose pose = level_at(sample.place->at);
        CHECK(place.checker.clearance_m(pose) >= 0.05);
        CHECK(place.checker.self_clearance_m(pose) > 0);
        near += sample.flaws[static_cast<std::size_t>(SpaceGoalFlaw::near_obstacle)];
        itself += sample.flaws[static_cast<std::size_t>(SpaceGoalFlaw::touches_itself)];
    }
    CHECK(near > 20);
    CHECK(itself > 5);

    const Place shut(robot_with(3), {box("block", {3, 3, 3}, {1, 2, 3})});
    const SpaceGoalSample none = shut.sampler(goal).sample(random, 0.9, 70);
    CHECK_FALSE(none.place);
    CHECK(none.tries == 70);
    CHECK(none.flaws[static_cast<std::size_t>(SpaceGoalFlaw::near_obstacle)] > 0);
    CHECK(none.flaws[static_cast<std::size_t>(SpaceGoalFlaw::near_obstacle)] +
              none.flaws[static_cast<std::size_t>(SpaceGoalFlaw::touches_itself)] ==
          70);

    const SpaceGoal upward{SpaceEndEffectorGoal{{1, 2, 3}, 0.1, Vector3{0, 0, 1}, 0.1}, 5, {}};
    const SpaceGoalSample unaimed = place.sampler(upward).sample(random, 0.9);
    CHECK(unaimed.place);
    const Place armless(robot_with(0));
    const SpaceGoalSample never = armless.sampler(upward).sample(random, 0.9, 30);
    CHECK(never.without_aim == 30);
}

TEST_CASE("Drawing a configuration allocates nothing") {
    const Place place(robot_with(4));
    for (const SpaceGoal& goal : goals_for(4)) {
        const SpaceGoalSampler sampler = place.sampler(goal);
        Random random(8);
        const long before = test::allocations;
        for (int i = 0; i < 50; ++i) {
            static_cast<void>(sampler.drawn(random, 0.9));
        }
        CHECK(test::allocations == before);
    }
}

TEST_CASE("The nearest configuration at a goal is the given one where that meets it, and few drawn ones are nearer") {
    int drawn_ones = 0, nearer = 0;
    for (int joints = 0; joints <= 6; ++joints) {
        const Place place(robot_with(joints));
        for (const SpaceGoal& goal : goals_for(joints)) {
            const SpaceGoalSampler sampler = place.sampler(goal);
            Random random(12);
            for (int i = 0; i < 20; ++i) {
                SpaceConfiguration from{};
                for (std::size_t axis = 0; axis < static_cast<std::size_t>(4 + joints); ++axis) {
                    from[axis] = axis < 3 ? random.uniform(-3, 3) : random.uniform(-1.5, 1.5);
                }
                from[space::yaw] += 8 * std::numbers::pi;  // angles are unwrapped
                const std::optional<SpaceGoalPlace> nearest = sampler.nearest(from, apart, 0.9);
                CAPTURE(joints, goal.kind.index(), i);
                if (!nearest) {
                    CHECK(joints == 0);
                    continue;
                }
                CHECK(place.used_share(goal, nearest->at) <= 0.9 + 1e-11);
                CHECK(is_within_limits(place.robot, nearest->at));
                CHECK(std::abs(nearest->at[space::yaw] - from[space::yaw]) <= std::numbers::pi + 1e-9);
                const std::optional<SpaceGoalPlace> again = sampler.nearest(nearest->at, apart, 0.9 + 1e-9);
                REQUIRE(again);
                CHECK(apart(nearest->at, again->at) < 1e-9);
                for (int k = 0; k < 30; ++k) {
                    if (std::optional<SpaceGoalPlace> one = sampler.drawn(random, 0.9)) {
                        one->at[space::yaw] +=
                            std::round((from[space::yaw] - one->at[space::yaw]) / (2 * std::numbers::pi)) * 2 *
                            std::numbers::pi;
                        ++drawn_ones;
                        nearer += apart(from, one->at) < apart(from, nearest->at) ? 1 : 0;
                    }
                }
            }
        }
    }
    CAPTURE(drawn_ones, nearer);
    CHECK(drawn_ones > 10000);
    CHECK(nearer < 0.01 * drawn_ones);
}

TEST_CASE("Of alternatives each is drawn, and the nearest of all is found") {
    const Place place(robot_with(2));
    SpaceGoal goal;
    goal.any_of = {{SpaceEndEffectorGoal{{-4, 0, 1}, 0.1, {}, 0.1}, 5, {}},
                   {SpaceEndEffectorGoal{{4, 0, 1}, 0.1, {}, 0.1}, 5, {}}};
    const SpaceGoalSampler sampler = place.sampler(goal);
    Random random(1);
    int first = 0;
    for (int i = 0; i < 200; ++i) {
        const std::optional<SpaceGoalPlace> drawn = sampler.drawn(random, 0.5);
        REQUIRE(drawn);
        first += drawn->alternative == 0 ? 1 : 0;
        CHECK(place.used_share(goal.any_of[drawn->alternative], drawn->at) <= 0.5 + 1e-11);
    }
    CHECK(first > 60);
    CHECK(first < 140);
    SpaceConfiguration from{};
    from[0] = 1;
    CHECK(sampler.nearest(from, apart, 0.5)->alternative == 1);
}

TEST_CASE("The robot waits in front of a surface that it touches with its tip or its top") {
    const Place place(robot_with(2, 120 * degree),
                      {box("wall", {4, 1, 4}, {1, 3.32, 3}), box("deck", {4, 4, 0.5}, {-4, 0, 6})});
    SpaceContactGoal tip;
    tip.obstacle = "wall";
    tip.part = TouchingPart::end_effector;
    SpaceContactGoal at_a_place = tip;
    at_a_place.position_m = Vector3{1.5, 2.82, 3.5};
    SpaceContactGoal top;
    top.obstacle = "deck";
    top.part = TouchingPart::frame;
    for (const SpaceContactGoal& contact : {tip, at_a_place, top}) {
        // The touched obstacle alone, as the rule of goals has it.
        const Place alone(place.robot,
                          {contact.obstacle == "wall" ? place.scene->obstacles()[0] : place.scene->obstacles()[1]});
        const SpaceGoal goal{contact, 5, {}};
        const SpaceGoalSampler sampler = place.sampler(goal);
        Random random(6);
        int found = 0;
        for (int i = 0; i < 200; ++i) {
            const std::optional<SpaceGoalPlace> drawn = sampler.drawn(random, 0.5);
            if (!drawn) {
                continue;
            }
            ++found;
            const FoundTouch touch = find_touch(contact, 1, alone.robot, level_at(drawn->at), *alone.scene);
            REQUIRE(touch.touch);
            CHECK(goal_error(*touch.touch, alone.robot, level_at(drawn->at)).used_share <= 0.5 + 1e-9);
            const Vector3 middle_m = middle_of(*touch.touch, alone.robot, level_at(drawn->at));
            if (contact.part == TouchingPart::frame) {
                CHECK(middle_m[2] == Approx(5.75 - contact.standoff_m).epsilon(1e-9));
            }
            if (contact.position_m) {
                CHECK(middle_m[0] == Approx(1.5).epsilon(1e-9));
                CHECK(middle_m[2] == Approx(3.5).epsilon(1e-9));
            }
        }
        CHECK(found > 20);
        SpaceConfiguration from{};
        from[2] = 3;
        const std::optional<SpaceGoalPlace> nearest = sampler.nearest(from, apart, 0.5);
        REQUIRE(nearest);
        CHECK(alone.used_share(goal, nearest->at) <= 0.5 + 1e-9);
    }
}

TEST_CASE("A direction or attitude that the joints do not allow is told with what they do") {
    const SpaceRobot robot = robot_with(1, 30 * degree);
    const SpaceGoal upward{SpaceEndEffectorGoal{{1, 2, 3}, 0.1, Vector3{0, 2, 2}, 5 * degree}, 5, {}};
    const std::optional<SpaceGoalObjection> objection = aim_objection(robot, upward);
    REQUIRE(objection);
    CHECK(objection->key == "direction");
    CHECK(objection->reason ==
          "is 45 degrees above the level, give or take 5: with its joints within their limits the end effector of the "
          "level robot points -30 to 30 degrees above it; the nearest direction is [0, 0.866, 0.5], or give the arm "
          "other joints or limits");
    CHECK_FALSE(aim_objection(robot_with(1, 40.1 * degree), upward));
    const SpaceGoal steep{
        SpaceCameraGoal{{1, 2, 3}, 0.5, 1.5, Vector3{0, 0, -1}, 50 * degree, 9 * degree, true}, 5, {}};
    REQUIRE(aim_objection(robot, steep));
    CHECK_THAT(aim_objection(robot, steep)->reason, Contains("is -90 degrees above the level, give or take 59: "));
    CHECK_FALSE(aim_objection(robot_with(1, 31.1 * degree), steep));

    const SpaceGoal rolled{SpacePoseGoal{{1, 2, 3}, {15 * degree, 20 * degree, 40 * degree}, 0.1, 5 * degree}, 5, {}};
    REQUIRE(aim_objection(robot, rolled));
    CHECK(aim_objection(robot, rolled)->key == "rpy_deg");
    // Of g = R^T (0, 0, 1) = (-sin p, sin r cos p, cos r cos p) the arm reaches the part without y.
    CHECK_THAT(aim_objection(robot, rolled)->reason,
               Contains("is an attitude that the level robot misses by 14.1 degrees at any yaw"));
    CHECK_FALSE(aim_objection(robot_with(2, 100 * degree), rolled));
}

TEST_CASE("A goal that no configuration meets freely is told with what is in the way and where one would") {
    const SpaceGoal goal{SpaceEndEffectorGoal{{1, 2, 3}, 0.1, Vector3{0, 1, 0}, 5 * degree}, 5, {}};
    CHECK_FALSE(Place(robot_with(2)).reach(goal).objection);
    CHECK(Place(robot_with(2)).reach(goal).tries.place);

    // The multirotor is 0.15 to 0.3 m behind its tip, where the block is.
    const Place blocked(robot_with(2), {box("far", {1, 1, 1}, {5, 5, 5}), box("block", {3, 0.5, 3}, {1, 1.7, 3})});
    const SpaceGoalReach no_room = blocked.reach(goal);
    REQUIRE(no_room.objection);
    CHECK(no_room.tries.tries == 400);
    CHECK_THAT(no_room.objection->reason,
               Contains("to an obstacle ('block')") && Contains("; the nearest goal found is 0."));

    const Place low(robot_with(2), {}, {{-10, -10, -10}, {10, 10, 2.5}});
    const SpaceGoalReach outside = low.reach(goal);
    REQUIRE(outside.objection);
    CHECK_THAT(outside.objection->reason, Contains("are outside environment.bounds (by 0."));

    const SpaceGoal camera{SpaceCameraGoal{{1, 2, 3}, 0.5, 1, Vector3{0, 1, 0}, 20 * degree, 5 * degree, true}, 5, {}};
    const Place hidden(robot_with(2), {box("screen", {1, 0.02, 1}, {1, 1.9, 3})});
    const SpaceGoalReach unseen = hidden.reach(camera);
    REQUIRE(unseen.objection);
    CHECK_THAT(unseen.objection->reason, Contains(" do not see the target ('screen')"));

    SpaceContactGoal contact;
    contact.obstacle = "ball";
    const Place round(robot_with(2), {{"ball", Sphere{0.5}, {1, 2, 3}, {}}});
    const SpaceGoalReach none = round.reach({contact, 5, {}});
    REQUIRE(none.objection);
    CHECK_THAT(none.objection->reason, Contains("has no place to touch"));
}

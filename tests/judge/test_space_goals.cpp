#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "../support/space_robots.hpp"
#include "downwash/judge/space_goals.hpp"
#include "downwash/simulation/space_goal_rule.hpp"
#include "downwash/simulation/space_tool.hpp"

// Goals in space by the rules of both: the judge's formulas are its own.

using namespace downwash;
using namespace downwash::test;

namespace {

/// What both say of a goal at a motion.
struct Verdicts {
    SpaceGoalError flown;
    judge::SpaceGoalDistance judged;
};

/// Robots, goals and poses by chance, about the origin.
class Chance {
 public:
    explicit Chance(unsigned seed) : random_(seed) {}

    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    bool once_in(int many) { return std::uniform_int_distribution<int>(1, many)(random_) == 1; }
    int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(random_); }
    Vector3 vector(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
    Vector3 direction() {
        for (;;) {
            const Vector3 v = vector(1);
            if (dot(v, v) > 0.01) {
                return v;
            }
        }
    }
    SpaceMotion motion(int joints) {
        SpaceMotion motion;
        motion.position_m = vector(0.4);
        std::array<double, 4> q{between(-1, 1), between(-1, 1), between(-1, 1), between(0.1, 1)};
        if (once_in(2)) {  // nearly level
            q = {std::cos(q[0]), 0.05 * q[1], 0.05 * q[2], std::sin(q[0])};
        }
        motion.attitude = normalised(q);
        for (int i = 0; i < joints; ++i) {
            motion.joints_rad[static_cast<std::size_t>(i)] = between(-4, 4);
        }
        return motion;
    }

 private:
    std::mt19937_64 random_;
};

/// A goal that the motion meets nearly, or does not by a little more.
SpaceGoalKind goal_near(Chance& chance, const SpaceRobot& robot, const SpaceMotion& motion) {
    const SpacePose pose{motion.position_m, motion.attitude, motion.joints_rad};
    const SpaceToolPose tool = tool_at(robot, pose);
    switch (chance.below(4)) {
        case 0: {
            SpaceConfigurationGoal goal;
            goal.tolerance_m = 0.1;
            goal.tolerance_rad = 0.1;
            std::optional<double>* const places[] = {&goal.x_m, &goal.y_m, &goal.z_m};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (chance.once_in(2)) {
                    *places[axis] = motion.position_m[axis] + chance.between(-0.07, 0.07);
                }
            }
            if (chance.once_in(2)) {
                goal.yaw_rad = yaw_of(motion.attitude) + chance.between(-0.15, 0.15) + 2 * std::numbers::pi;
            }
            if (chance.once_in(2)) {
                for (int i = 0; i < robot.joints(); ++i) {
                    goal.joints_rad.push_back(motion.joints_rad[static_cast<std::size_t>(i)] +
                                              chance.between(-0.12, 0.12));
                }
            }
            return goal;
        }
        case 1: {
            SpaceEndEffectorGoal goal{tool.position_m + chance.vector(0.08), 0.1, {}, 0.3};
            if (chance.once_in(2)) {
                goal.direction = 3 * (tool.direction + 0.3 * chance.vector(1));
            }
            return goal;
        }
        case 2: {
            SpacePoseGoal goal{tool.position_m + chance.vector(0.07), {}, 0.1, 0.3};
            const Matrix3 r = rotation_of(tool.attitude);
            goal.rpy_rad = Vector3{std::atan2(r[2][1], r[2][2]), -std::asin(r[2][0]), std::atan2(r[1][0], r[0][0])} +
                           chance.vector(0.25);
            return goal;
        }
        default: {
            const double away_m = chance.between(0.3, 1.2);
            SpaceCameraGoal goal;
            goal.target_m = tool.position_m + away_m * tool.direction + chance.vector(0.1);
            goal.nearest_m = 0.4;
            goal.farthest_m = 1.1;
            goal.aim_tolerance_rad = 0.2;
            goal.view_cone_rad = 0.5;
            if (chance.once_in(2)) {
                goal.direction = tool.direction + 0.4 * chance.vector(1);
            }
            goal.sees = !chance.once_in(4);
            return goal;
        }
    }
}

Verdicts verdicts(const SpaceRobot& robot, const std::vector<Obstacle>& obstacles, const judge::SpaceObstacles& solids,
                  const Scene& scene, const SpaceGoal& goal, const SpaceMotion& motion, const SpaceWorld& world) {
    const judge::SpaceGoals goals(robot, obstacles, solids, {goal}, false);
    return {goal_error(goal, robot, {motion.position_m, motion.attitude, motion.joints_rad}, scene, world),
            goals.distance({0, 0, {}},
                           {motion.position_m, motion.attitude, motion.joints_rad, motion.velocity_m_s,
                            motion.body_rates_rad_s, motion.joint_rates_rad_s},
                           world)};
}

std::vector<Obstacle> some_obstacles() {
    return {{"box", Box{{0.5, 0.6, 0.4}}, {0.7, -0.3, 0.3}, {0.3, 0.2, 0.9}},
            {"can", Cylinder{0.2, 1.2, {0.2, 1, 0.3}}, {-0.7, 0.5, -0.4}, {0, 0, 0.5}},
            {"ball", Sphere{0.3}, {0.5, 0.8, 0.2}, {}},
            {"slab", Box{{3, 3, 0.1}}, {0, 0, -0.9}, {}}};
}

}  // namespace

TEST_CASE("The judge and an execution agree on thousands of goals, seen or hidden, met or not") {
    Chance chance(11);
    const std::vector<Obstacle> obstacles = some_obstacles();
    const Scene scene(obstacles);
    int met = 0, missed = 0, hidden = 0;
    for (int joints = 0; joints <= 3; ++joints) {
        SpaceRobot robot = space_robot(joints);
        robot.tool_direction = {0.1, 0.2, -1};
        const judge::SpaceObstacles solids(obstacles, robot);
        for (int i = 0; i < 1500; ++i) {
            CAPTURE(joints, i);
            const SpaceMotion motion = chance.motion(joints);
            SpaceWorld world;
            if (chance.once_in(3)) {
                world.scene_m = chance.vector(0.05);
                world.scene_yaw_rad = chance.between(-0.05, 0.05);
                world.center_of_mass_m = chance.vector(0.01);  // changes no goal
            }
            const SpaceGoal goal{goal_near(chance, robot, motion), 5, {}};
            const auto [flown, judged] = verdicts(robot, obstacles, solids, scene, goal, motion, world);
            CHECK(flown.distance_m == Approx(judged.distance_m).margin(1e-10));
            if (flown.is_hidden || std::isinf(judged.used_share)) {
                CHECK(std::isinf(judged.used_share) == flown.is_hidden);
            } else {
                CHECK(flown.used_share == Approx(judged.used_share).margin(1e-6));
            }
            ++(flown.is_hidden ? hidden : is_met(flown) ? met : missed);
        }
    }
    CHECK(met > 1000);
    CHECK(missed > 1000);
    CHECK(hidden > 100);
}

TEST_CASE("The judge and an execution find the same touches and the same hovers") {
    Chance chance(3);
    SpaceRobot robot = space_robot(2);
    robot.tool_direction = {0, 0, -1};
    robot.plant.end_effector_m = {0, 0, -0.12};
    robot.links[1].body = {{Capsule{0.02, {0, 0, 0}, {0, 0, -0.11}}, {}}};
    robot.body = {{Box{{0.4, 0.4, 0.1}}, {0, 0, 0.03}}, {Cylinder{0.05, 0.04}, {0, 0, 0.1}}};
    const std::vector<Obstacle> obstacles = {{"deck", Box{{3, 3, 0.4}}, {0, 0, 1.5}, {0.01, -0.02, 0.3}},
                                             {"ramp", Box{{3, 3, 0.4}}, {0, 0, -1.3}, {0.03, 0.05, 1}},
                                             {"ball", Sphere{0.5}, {0, 2, 0}, {}}};
    const judge::SpaceObstacles solids(obstacles, robot);
    const auto scene = std::make_shared<const Scene>(obstacles);
    int found = 0;
    for (int i = 0; i < 400; ++i) {
        CAPTURE(i);
        SpaceContactGoal contact;
        contact.part = chance.once_in(2) ? TouchingPart::frame : TouchingPart::end_effector;
        contact.obstacle = contact.part == TouchingPart::frame ? "deck" : chance.once_in(5) ? "ball" : "ramp";
        SpacePlan plan;
        plan.tick_s = 0.01;
        plan.joints = 2;
        SpacePoint point;
        const Vector3 at_m = chance.vector(0.9);
        std::copy(at_m.begin(), at_m.end(), point.position);
        point.position[space::z] *= 0.5;
        point.position[space::yaw] = chance.between(-3, 3);
        point.position[space::first_joint] = chance.between(-0.04, 0.04);
        point.position[space::first_joint + 1] = chance.between(-0.04, 0.04);
        plan.reference = {{0, point}};
        if (chance.once_in(2)) {
            contact.position_m = Vector3{at_m[0], at_m[1], contact.part == TouchingPart::frame ? 1.3 : -1.1};
        }
        const std::vector<SpaceGoal> goals = {{contact, 4, {}}};
        const SpaceGoalHover flown = SpaceGoalRule(robot, scene, goals).hovers(plan)[0];
        const judge::SpaceStay judged = judge::SpaceGoals(robot, obstacles, solids, goals, false).stays(plan)[0];
        REQUIRE(flown.touch.has_value() == judged.touch.has_value());
        CHECK(flown.end_tick == judged.end);
        if (flown.touch) {
            ++found;
            CHECK(flown.touch->points.size() == judged.touch->points.size());
            CHECK(flown.touch->wanted_m.has_value() == judged.touch->wanted_m.has_value());
            const Vector3 apart[] = {flown.touch->normal - judged.touch->normal,
                                     flown.touch->surface_m - judged.touch->surface_m,
                                     flown.touch->waiting_m - judged.touch->waiting_m};
            for (const Vector3& each : apart) {
                CHECK(std::sqrt(dot(each, each)) < 1e-4);
            }
        }
    }
    CHECK(found > 100);
    CHECK(found < 390);
}

TEST_CASE("The judge and an execution find the same order of hovers") {
    Chance chance(8);
    const SpaceRobot robot = space_robot(0);
    const judge::SpaceObstacles solids({}, robot);
    const auto scene = std::make_shared<const Scene>(std::vector<Obstacle>{});
    for (int i = 0; i < 300; ++i) {
        CAPTURE(i);
        SpacePlan plan;
        plan.tick_s = 0.01;
        std::int64_t tick = 0;
        for (int k = 0; k < 6; ++k) {
            SpacePoint point;
            point.position[0] = chance.below(3);
            plan.reference.push_back({tick, point});
            tick += 100 + chance.below(3) * 100;
            if (chance.once_in(2)) {
                plan.reference.push_back({tick, point});
                tick += 200;
            }
        }
        std::vector<SpaceGoal> goals;
        for (int k = 0; k < 3; ++k) {
            SpaceConfigurationGoal goal;
            goal.x_m = chance.below(3);
            goals.push_back({goal, 1.0 + chance.below(2), {}});
            if (chance.once_in(3)) {
                goal.x_m = chance.below(3);
                goals.back() = {{}, 5, {goals.back(), {goal, 1.5, {}}}};
            }
        }
        const bool in_any_order = chance.once_in(2);
        const auto flown = SpaceGoalRule(robot, scene, goals, in_any_order).hovers(plan);
        const auto judged = judge::SpaceGoals(robot, {}, solids, goals, in_any_order).stays(plan);
        REQUIRE(flown.size() == judged.size());
        for (std::size_t k = 0; k < flown.size(); ++k) {
            CHECK(flown[k].goal == judged[k].goal);
            CHECK(flown[k].end_tick == judged[k].end);
        }
    }
}

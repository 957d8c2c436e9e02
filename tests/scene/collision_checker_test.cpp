#include "downwash/scene/collision_checker.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <thread>

#include "../support/error_of.hpp"
#include "reference.hpp"

using namespace downwash;
using reference::about;
using reference::checker_of;

namespace {

constexpr double quarter = 1.57079632679489661923;
const double infinity = std::numeric_limits<double>::infinity();

/// A box 0.4 x 0.3 x 0.1 m about the centre of mass and an arm of 0.5 m.
RobotShape plain_robot() {
    return {{{Box{{0.4, 0.3, 0.1}}, {}}}, 0, 0, 0.5, 0.02};
}

}  // namespace

TEST_CASE("A robot without obstacles has infinite clearance, one with unusable sizes leads to every error") {
    const CollisionChecker checker = checker_of({}, plain_robot());
    CHECK(checker.clearance_m({}) == infinity);
    CHECK_FALSE(checker.is_nearer_than({}, 1e9));
    RobotShape robot{{{Box{{1, 1, -1}}, {}}, {Sphere{0}, {}}}, 0, 0, 0, std::nan("")};
    CHECK(
        test::wrong_keys([&] { return checker_of({}, robot); }) ==
        std::vector<std::string>{"bodies[0].box.size_m", "bodies[1].sphere.radius_m", "arm_length_m", "arm_radius_m"});
}

TEST_CASE("Clearances computed by hand are found") {
    struct Case {
        const char* name;
        Obstacle obstacle;
        PlanarPose pose;
        double clearance_m;
    };
    const Obstacle floor{"", Box{{4, 4, 1}}, {0, 0, -0.5}, {}};
    const double q = 0.3;
    const Case cases[] = {
        {"level body over a floor, the arm straight up", floor, {0, 1, 0, -quarter}, 0.95},
        {"the arm straight down", floor, {0, 1, 0, quarter}, 0.48},
        {"pitch is nose down and carries the arm with it", floor, {0, 1, q, 0}, 1 - 0.5 * std::sin(q) - 0.02},
        {"the nose", floor, {0, 1, q, 3.0}, 1 - 0.2 * std::sin(q) - 0.05 * std::cos(q)},
        {"a sphere beyond the corner of the body",
         {"", Sphere{0.1}, {-0.5, 0.55, 0.05 + 0.6}, {}},
         {},
         std::hypot(0.3, 0.4, 0.6) - 0.1},
        {"a pipe across the plane below the tip of the arm",
         {"", Cylinder{0.1, 3, {0, 1, 0}}, {0.8, 0, -0.4}, {}},
         {},
         0.5 - 0.12},
        {"the edge of a box turned by 45 degrees before the tip of the arm",
         {"", Box{{1, 1, 3}}, {2, 0, 0}, {0, 0, quarter / 2}},
         {},
         2 - std::sqrt(0.5) - 0.52},
    };
    for (const auto& [name, obstacle, pose, clearance_m] : cases) {
        CAPTURE(name);
        CHECK(checker_of({obstacle}, plain_robot()).clearance_m(pose) == about(clearance_m));
    }
}

TEST_CASE("The joint turns with the body") {
    RobotShape robot = plain_robot();
    robot.bodies.clear();
    robot.joint_x_m = 0.1;
    robot.joint_z_m = -0.2;
    const CollisionChecker checker = checker_of({{"", Box{{9, 9, 2}}, {0, 0, -1}, {}}}, robot);
    const double q = 0.4;
    const double joint_z = -0.1 * std::sin(q) - 0.2 * std::cos(q);
    const double tip_z = joint_z - 0.5 * std::sin(q + 0.6);
    CHECK(checker.clearance_m({0, 2, q, 0.6}) == about(2 + tip_z - 0.02));
}

TEST_CASE("Contact has a clearance of zero or below and is nearer than any margin") {
    const CollisionChecker checker = checker_of({{"", Box{{1, 1, 1}}, {}, {}},
                                                 {"", Sphere{0.5}, {3, 0, 0}, {}},
                                                 {"", Cylinder{0.5, 1, {1, 1, 1}}, {6, 0, 0}, {}}},
                                                plain_robot());
    for (const double x : {0.0, 0.6, 3.0, 3.6, 6.0, 6.5}) {
        CAPTURE(x);
        CHECK(checker.clearance_m({x, 0, 0.1, 1}) <= 0);
        CHECK(checker.is_nearer_than({x, 0, 0.1, 1}, 0));
        CHECK(checker.is_nearer_than({x, 0, 0.1, 1}, 0.05));
    }
}

TEST_CASE("A pose that is not finite is in contact") {
    const CollisionChecker checker = checker_of({{"", Sphere{1}, {1e3, 0, 0}, {}}}, plain_robot());
    for (const double bad : {std::nan(""), infinity, -infinity}) {
        for (const PlanarPose& pose :
             {PlanarPose{bad, 0, 0, 0}, PlanarPose{0, bad, 0, 0}, PlanarPose{0, 0, bad, 0}, PlanarPose{0, 0, 0, bad}}) {
            CHECK(checker.is_nearer_than(pose, 0));
            CHECK(checker.clearance_m(pose) == -infinity);
        }
    }
}

TEST_CASE("Clearance agrees with alternating projections in random scenes") {
    reference::Dice dice(2);
    int undecided = 0;
    for (int round = 0; round < 300; ++round) {
        const std::vector<Obstacle> obstacles = dice.obstacles(2);
        const RobotShape robot = dice.robot();
        const PlaneOfMotion plane = dice.plane();
        const CollisionChecker checker = checker_of(obstacles, robot, plane);
        const PlanarPose pose = dice.pose();
        const reference::Enclosure truth = reference::clearance(reference::robot_at(pose, plane, robot), obstacles);
        undecided += truth.high - truth.low > 1e-6;
        CAPTURE(round, truth.low, truth.high, checker.clearance_m(pose));
        REQUIRE(truth.holds(checker.clearance_m(pose)));
    }
    CHECK(undecided < 15);
}

TEST_CASE("Clearance agrees with alternating projections where solids stand square and diagonal to one another") {
    reference::Dice dice(9);
    for (int round = 0; round < 5000; ++round) {
        const std::vector<Obstacle> obstacles{dice.gridded_obstacle()};
        const Obstacle body = dice.gridded_obstacle();
        const RobotShape robot{{{reference::primitive_of(body.shape), {0, 0, 0}}}, 0, 0, 0.25, 0.01};
        const PlaneOfMotion plane(body.center_world_m, body.rpy_rad[2]);
        const PlanarPose pose{0, 0, body.rpy_rad[1], body.rpy_rad[0]};
        const reference::Enclosure truth = reference::clearance(reference::robot_at(pose, plane, robot), obstacles);
        const double clearance = checker_of(obstacles, robot, plane).clearance_m(pose);
        CAPTURE(round, truth.low, truth.high, clearance);
        REQUIRE(truth.holds(clearance, 1e-8));
    }
    // A ball straight before the face of a diagonal post is measured to that face.
    const RobotShape robot{{{Sphere{0.125}, {}}}, 0, 0, 0.3, 0.01};
    const Obstacle post{"", Cylinder{0.625, 0.25, {-1, -1, 0}}, {-0.5, -1, -0.75}, {}};
    const CollisionChecker checker = checker_of({post}, robot, {{0, -0.25, 0}, 0});
    CHECK(checker.clearance_m({0.25, -1.25, 0, 0}) == about(0.75 * std::sqrt(2.0) - 0.25));
}

TEST_CASE("Being nearer than a margin is what the clearance says") {
    reference::Dice dice(4);
    int near = 0;
    for (int round = 0; round < 300; ++round) {
        const CollisionChecker checker = checker_of(dice.obstacles(3), dice.robot(), dice.plane());
        for (int i = 0; i < 50; ++i) {
            const PlanarPose pose = dice.pose();
            const double clearance = checker.clearance_m(pose);
            CAPTURE(round, i, clearance);
            REQUIRE(checker.is_nearer_than(pose, 0) == (clearance <= 0));
            const double margin =
                dice.coin() ? dice.between(0, 0.5) : std::max(0.0, clearance) + dice.between(-1e-6, 1e-6);
            if (margin >= 0 && std::abs(clearance - margin) > 1e-9) {
                REQUIRE(checker.is_nearer_than(pose, margin) == (clearance < margin || clearance <= 0));
                near += clearance < margin;
            }
        }
    }
    CHECK(near > 1000);
}

TEST_CASE("Moving scene and plane together changes no clearance") {
    reference::Dice dice(5);
    for (int round = 0; round < 200; ++round) {
        std::vector<Obstacle> obstacles = dice.obstacles(3);
        const RobotShape robot = dice.robot();
        const PlaneOfMotion plane = dice.plane();
        const CollisionChecker before = checker_of(obstacles, robot, plane);

        const PlaneOfMotion motion(dice.vector(-3, 3), dice.between(-4, 4));
        for (Obstacle& obstacle : obstacles) {
            const Vector3& c = obstacle.center_world_m;
            obstacle.center_world_m = motion.to_world(c[0], c[1], c[2]);
            obstacle.rpy_rad[2] += motion.heading_rad();
        }
        const Vector3& origin = plane.origin_m();
        const PlaneOfMotion moved_plane(motion.to_world(origin[0], origin[1], origin[2]),
                                        plane.heading_rad() + motion.heading_rad());
        const CollisionChecker after = checker_of(obstacles, robot, moved_plane);
        for (int i = 0; i < 20; ++i) {
            const PlanarPose pose = dice.pose();
            CAPTURE(round, i);
            REQUIRE(after.clearance_m(pose) == about(before.clearance_m(pose)));
        }
    }
}

TEST_CASE("Clearance changes no faster than the robot moves") {
    reference::Dice dice(6);
    for (int round = 0; round < 200; ++round) {
        const CollisionChecker checker = checker_of(dice.obstacles(3), dice.robot(), dice.plane());
        for (int i = 0; i < 50; ++i) {
            const PlanarPose pose = dice.pose();
            PlanarPose moved = pose;
            const double size = std::pow(10, dice.between(-6, 0));
            moved.x_m += dice.between(-size, size);
            moved.z_m += dice.between(-size, size);
            const double way = std::hypot(moved.x_m - pose.x_m, moved.z_m - pose.z_m);
            const double change = std::max(0.0, checker.clearance_m(moved)) - std::max(0.0, checker.clearance_m(pose));
            CAPTURE(round, i);
            REQUIRE(std::abs(change) <= way + 1e-9);
        }
    }
}

TEST_CASE("A robot beside its plane is as far from everything as one in a plane that lies there, for both checkers") {
    reference::Dice dice(12);
    for (int round = 0; round < 100; ++round) {
        const std::vector<Obstacle> obstacles = dice.obstacles(3);
        const RobotShape robot = dice.robot();
        const PlaneOfMotion plane = dice.plane();
        const double lateral_m = dice.between(-0.5, 0.5);
        const PlaneOfMotion beside(plane.to_world(0, lateral_m, 0), plane.heading_rad());
        const PlanarPose pose = dice.pose();
        PlanarPose moved = pose;
        moved.lateral_m = lateral_m;
        CAPTURE(round, lateral_m);
        const auto scene = std::make_shared<const Scene>(obstacles);
        for (const CollisionCheckerKind kind : all_collision_checkers) {
            const CollisionChecker checker(scene, plane, robot, kind);
            const double clearance_m = CollisionChecker(scene, beside, robot, kind).clearance_m(pose);
            const double margin_m = kind == CollisionCheckerKind::own ? 1e-8 : 1e-3;
            CHECK(std::max(0.0, checker.clearance_m(moved)) == Approx(std::max(0.0, clearance_m)).margin(margin_m));
            CHECK(checker.is_nearer_than(moved, std::max(0.0, clearance_m) + 2 * margin_m));
            CHECK_FALSE((clearance_m > 3 * margin_m && checker.is_nearer_than(moved, clearance_m - 2 * margin_m)));
        }
    }
    // By hand: a wall 1 m to the left of the plane, and a body 0.3 m wide.
    const Obstacle wall{"", Box{{4, 1, 4}}, {0, 1.5, 0}, {}};
    const CollisionChecker checker = checker_of({wall}, plain_robot());
    CHECK(checker.clearance_m({0, 0, 0, 0, 0.3}) == about(0.55));
    CHECK(checker.clearance_m({0, 0, 0, 0, -0.3}) == about(1.15));
    CHECK(checker.is_nearer_than({0, 0, 0, 0, std::nan("")}, 0));
}

TEST_CASE("Whole turns of the arm and the order of the obstacles change nothing") {
    reference::Dice dice(7);
    for (int round = 0; round < 100; ++round) {
        std::vector<Obstacle> obstacles = dice.obstacles(4);
        const RobotShape robot = dice.robot();
        const CollisionChecker checker = checker_of(obstacles, robot);
        std::reverse(obstacles.begin(), obstacles.end());
        const CollisionChecker reversed = checker_of(obstacles, robot);
        const PlanarPose pose = dice.pose();
        PlanarPose turned = pose;
        turned.arm_rad += 8 * quarter;
        const double clearance = checker.clearance_m(pose);
        CHECK(checker.clearance_m(turned) == about(clearance));
        CHECK(std::max(0.0, reversed.clearance_m(pose)) == about(std::max(0.0, clearance)));
    }
}

TEST_CASE("Thin and large solids are measured as well as others") {
    const RobotShape robot{{{Box{{0.5, 0.5, 0.001}}, {}}}, 0, 0, 0.5, 0.001};
    const Obstacle sheet{"", Box{{100, 100, 0.001}}, {0, 0, -0.0005}, {}};
    const Obstacle wire{"", Cylinder{0.0005, 50, {0, 1, 0}}, {0.25, 0, 2}, {}};
    const CollisionChecker checker = checker_of({sheet, wire}, robot);
    CHECK(checker.clearance_m({0, 0.3, 0, 0}) == about(0.299));
    CHECK(checker.clearance_m({0, 1.9, 0, 0}) == about(0.0985));
    CHECK(checker.is_nearer_than({0, 0.0009, 0, 0}, 0));
}

TEST_CASE("Threads that share a checker get the answers of one thread") {
    reference::Dice dice(8);
    const CollisionChecker checker = checker_of(dice.obstacles(5), dice.robot(), dice.plane());
    std::vector<PlanarPose> poses;
    std::vector<double> expected;
    std::vector<bool> contact;
    for (int i = 0; i < 2000; ++i) {
        poses.push_back(dice.pose());
        expected.push_back(checker.clearance_m(poses.back()));
        contact.push_back(checker.is_nearer_than(poses.back(), 0));
    }
    std::array<int, 4> differences{};
    std::vector<std::thread> threads;
    for (int& count : differences) {
        threads.emplace_back([&] {
            for (std::size_t i = 0; i < poses.size(); ++i) {
                count += checker.clearance_m(poses[i]) != expected[i];
                count += checker.is_nearer_than(poses[i], 0) != contact[i];
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    CHECK(differences == std::array<int, 4>{});
}

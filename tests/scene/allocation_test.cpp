#include <catch2/catch.hpp>

#include "../support/count_allocations.hpp"
#include "../support/meshes.hpp"
#include "reference.hpp"

using namespace downwash;
using test::allocations;

TEST_CASE("No query allocates") {
    reference::Dice dice(21);
    std::vector<Obstacle> obstacles = dice.obstacles(5);
    obstacles.push_back({"", test::pipe_mesh(0.3, 1, 40, 10), {1, 0, 1}, {0.1, 0.2, 0.3}});
    const auto is_in_ball = [](const Vector3& p) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2] < 0.2; };
    obstacles.push_back({"", test::octree_of(is_in_ball, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 0.125), {-1, 0, 1}, {}});
    const auto scene = std::make_shared<const Scene>(std::move(obstacles));
    const CollisionChecker checker(scene, {}, dice.robot());
    int apart = 0;
    for (int i = 0; i < 5000; ++i) {
        const PlanarPose pose = dice.pose();
        const long before = allocations;
        const double clearance = checker.clearance_m(pose);
        const bool is_near = checker.is_nearer_than(pose, 0) || checker.is_nearer_than(pose, 0.3);
        const bool is_clear = disc_is_clear(*scene, {pose.x_m, 0, pose.z_m}, 0.2, 0.1) &&
                              horizontal_clearance_m(*scene, {pose.x_m, 0, pose.z_m}) > 0;
        const long made = allocations - before;
        apart += clearance > 0 && (is_near || is_clear);
        REQUIRE(made == 0);
    }
    CHECK(apart > 500);
}

TEST_CASE("No query of a robot in space allocates") {
    reference::Dice dice(22);
    std::vector<Obstacle> obstacles = dice.obstacles(5);
    obstacles.push_back({"", test::pipe_mesh(0.3, 1, 40, 10), {1, 0, 1}, {0.1, 0.2, 0.3}});
    const SpaceChecker checker(std::make_shared<const Scene>(std::move(obstacles)), dice.space_robot(3));
    int apart = 0;
    for (int i = 0; i < 5000; ++i) {
        const SpacePose pose = dice.space_pose(), next = dice.space_pose();
        const long before = allocations;
        const double clearance = checker.clearance_m(pose);
        const bool is_near = checker.is_nearer_than(pose, 0.3) || checker.comes_nearer_between(pose, next, 0.05) ||
                             checker.free_motion(pose, 0.1, 1).is_none();
        const bool is_known = checker.nearest_obstacle(pose, 1).has_value() || checker.self_clearance_m(pose) > 0 ||
                              checker.touching_bodies(pose).has_value();
        const long made = allocations - before;
        apart += clearance > 0 && is_near && is_known;
        REQUIRE(made == 0);
    }
    CHECK(apart > 500);
}

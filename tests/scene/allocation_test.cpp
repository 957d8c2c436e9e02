#include <catch2/catch.hpp>

#include "../support/count_allocations.hpp"
#include "reference.hpp"

using namespace downwash;
using test::allocations;

TEST_CASE("No query allocates while nothing touches") {
    reference::Dice dice(21);
    const auto scene = std::make_shared<const Scene>(dice.obstacles(5));
    const CollisionChecker checker(scene, {}, dice.robot());
    int apart = 0;
    for (int i = 0; i < 5000; ++i) {
        const PlanarPose pose = dice.pose();
        const long before = allocations;
        const double clearance = checker.clearance_m(pose);
        const bool is_near = checker.is_nearer_than(pose, 0) || checker.is_nearer_than(pose, 0.3);
        const bool is_clear = disc_is_clear(*scene, {pose.x_m, 0, pose.z_m}, 0.2, 0.1);
        const long made = allocations - before;
        apart += clearance > 0 && (is_near || is_clear);
        if (clearance > 0) {
            REQUIRE(made == 0);
        }
    }
    CHECK(apart > 500);
}

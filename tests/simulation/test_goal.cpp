#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"

using namespace downwash;
using test::configuration_goal;
using test::tip_goal;

namespace {

/// The model of the ceiling problem.
struct Fixture {
    std::shared_ptr<const FlightModel> model = make_flight_model(test::ceiling_problem());
    const PlantModel& plant = model->tick().plant;
};

}  // namespace

TEST_CASE_METHOD(Fixture, "goal errors of an end effector and of a configuration by hand") {
    Goal goal = tip_goal(1, 2);
    const PlanarPose forward{-0.2, 2.3, 0, 0};  // tip at (1.0, 2.3)
    CHECK(goal_error(goal, plant, forward).distance_m == Approx(0.3));
    test::end_effector(goal).direction_rad = 0.2;
    CHECK(goal_error(goal, plant, forward).angle_rad == Approx(0.2));
    const PlanarPose turned{-0.2, 2.3, 0, 2 * 3.14159265358979323846};
    CHECK(goal_error(goal, plant, turned).angle_rad == Approx(0.2));

    Goal configured = configuration_goal({}, 2);
    CHECK(goal_error(configured, plant, forward).distance_m == Approx(0.3));
    CHECK(goal_error(configured, plant, forward).angle_rad == 0);
    test::configuration(configured).x_m = 0.2;
    CHECK(goal_error(configured, plant, forward).distance_m == Approx(0.5));
    test::configuration(configured).arm_rad = -0.4;
    CHECK(goal_error(configured, plant, turned).angle_rad == Approx(0.4));
    CHECK_FALSE(is_met(goal_error(configured, plant, forward)));
}

TEST_CASE_METHOD(Fixture, "tolerances of x and z by themselves make a rectangle of the disc") {
    Goal goal = configuration_goal(0, 2);  // within 0.1 m
    const auto share_at = [&](double x_m, double z_m) { return goal_error(goal, plant, {x_m, z_m, 0, 0}).used_share; };
    CHECK(share_at(0.06, 2.08) == Approx(1));
    CHECK(share_at(0.09, 2.09) == Approx(0.9 * std::sqrt(2.0)));
    test::configuration(goal).tolerance_x_m = 0.5;
    CHECK(share_at(0.25, 2.09) == Approx(0.9));  // z keeps tolerance_m
    CHECK(share_at(-0.45, 1.95) == Approx(0.9));
    CHECK(share_at(0, 2.2) == Approx(2));
    test::configuration(goal).tolerance_z_m = 0.05;
    CHECK(share_at(0.25, 2.04) == Approx(0.8));
    CHECK(goal_error(goal, plant, {0.3, 2.4, 0, 0}).distance_m == Approx(0.5));  // Euclidean, whatever the tolerances

    Goal tip = tip_goal(1.2, 2);
    test::end_effector(tip).tolerance_z_m = 0.4;
    CHECK(goal_error(tip, plant, {0.05, 2.1, 0, 0}).used_share == Approx(0.5));  // tip at (1.25, 2.1)
}

TEST_CASE_METHOD(Fixture, "of several goals the nearest by its own tolerances counts, with its own hold") {
    Goal strict = configuration_goal(0, {});  // within 0.1 m
    strict.hold_s = 3;
    Goal loose = configuration_goal(2, {});
    test::configuration(loose).tolerance_m = 1;
    loose.hold_s = 7;
    Goal goal;
    goal.any_of = {strict, loose};
    const PlanarPose between{0.5, 0, 0, 0};  // five tolerances from one, one and a half from the other
    CHECK(goal_error(goal, plant, between).distance_m == Approx(1.5));
    CHECK(goal_error(goal, plant, between).used_share == Approx(1.5));
    CHECK_FALSE(is_met(goal_error(goal, plant, between)));
    const PlanarPose beside{0.05, 0, 0, 0};
    CHECK(nearest_goal(goal, plant, beside).hold_s == 3);
    CHECK(is_met(goal_error(goal, plant, beside)));
    CHECK(hold_ticks(goal, *model, at_rest({1.5, 0, 0})) == 700);
    CHECK(hold_ticks(goal, *model, at_rest({0.05, 0, 0})) == 300);
}

TEST_CASE_METHOD(Fixture, "within the motion that a goal leaves it stays met, and not much more would do") {
    const double reach_m = model->collisions().body_reach_m();
    const double joint_reach_m = std::hypot(plant.joint_x_m, plant.joint_z_m);
    test::Random random(3);
    const auto coin = [&random] { return random.integer(0, 1) == 0; };
    int met = 0, lost = 0;
    for (int n = 0; n < 20000; ++n) {
        Goal goal;
        if (coin()) {
            goal = tip_goal(1.2, 0);
            test::end_effector(goal).direction_rad = coin() ? std::optional(0.0) : std::nullopt;
            test::end_effector(goal).tolerance_x_m = coin() ? std::optional(0.2) : std::nullopt;
        } else {
            goal = configuration_goal(0, 0, coin() ? std::optional(0.0) : std::nullopt);
        }
        const PlanarPose q{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.05),
                           random.uniform(-0.05, 0.05)};
        const double motion_m = motion_within_goal_m(goal, plant, q, reach_m);
        REQUIRE((motion_m >= 0) == is_met(goal_error(goal, plant, q)));
        if (motion_m < 0) {
            continue;
        }
        // The bound of the flights' kernel: how far the point of the robot that moves most may have moved.
        const auto moved = [&](double share) {
            const double way_m = share * motion_m * random.uniform(0, 1);
            const double angle = random.uniform(-4, 4);
            const double left_m = share * motion_m - way_m;
            const double pitch = left_m / std::max(reach_m, joint_reach_m) * random.uniform(-1, 1);
            const double arm = (left_m - joint_reach_m * std::abs(pitch)) / plant.arm_length_m * random.uniform(-1, 1);
            const PlanarPose to{q.x_m + way_m * std::cos(angle), q.z_m + way_m * std::sin(angle), q.pitch_rad + pitch,
                                q.arm_rad + arm - pitch};
            return is_met(goal_error(goal, plant, to));
        };
        REQUIRE(moved(1 - 1e-9));
        ++met;
        lost += moved(4) ? 0 : 1;
    }
    CHECK(met > 2000);
    CHECK(lost > 500);
}

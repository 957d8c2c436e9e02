#include <catch2/catch.hpp>
#include <cmath>

#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"

using namespace downwash;

TEST_CASE("goal errors of an end effector and of a configuration by hand") {
    const Problem problem = test::ceiling_problem();
    const auto model = make_flight_model(problem);
    const PlantModel& plant = model->tick().plant;
    Goal goal;
    goal.end_effector = EndEffectorGoal{};
    goal.end_effector->x_m = 1;
    goal.end_effector->z_m = 2;
    const double forward[4] = {-0.2, 2.3, 0, 0};  // tip at (1.0, 2.3)
    CHECK(goal_error(goal, plant, forward).distance_m == Approx(0.3));
    goal.end_effector->direction_rad = 0.2;
    CHECK(goal_error(goal, plant, forward).angle_rad == Approx(0.2));
    const double turned[4] = {-0.2, 2.3, 0, 2 * 3.14159265358979323846};
    CHECK(goal_error(goal, plant, turned).angle_rad == Approx(0.2));

    Goal configured;
    configured.configuration = ConfigurationGoal{};
    configured.configuration->z_m = 2;
    CHECK(goal_error(configured, plant, forward).distance_m == Approx(0.3));
    CHECK(goal_error(configured, plant, forward).angle_rad == 0);
    configured.configuration->x_m = 0.2;
    CHECK(goal_error(configured, plant, forward).distance_m == Approx(0.5));
    configured.configuration->arm_rad = -0.4;
    CHECK(goal_error(configured, plant, turned).angle_rad == Approx(0.4));
    CHECK_FALSE(is_met(goal_error(configured, plant, forward)));
}

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "../support/test_files.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/simulation/space_world_parameters.hpp"
#include "space_files.hpp"

// A problem in space as its flights see it.

using namespace downwash;

namespace {

SpaceProblem space_problem_of_files() {
    const test::TestFolder folder;
    return test::read_good_space_problem(folder);
}

/// From the start of a problem straight to a place, at rest at both ends.
SpacePlan straight(const SpaceProblem& problem, const Vector3& to_m, std::int64_t ticks) {
    SpacePlan plan;
    plan.tick_s = 1 / problem.robot.controller.rate_hz;
    plan.joints = problem.robot.joints();
    plan.reference.resize(2);
    plan.reference[1].tick = ticks;
    for (SpaceKnot& knot : plan.reference) {
        const Vector3& at_m = knot.tick == 0 ? problem.start.position_m : to_m;
        std::copy(at_m.begin(), at_m.end(), knot.point.position);
        knot.point.position[space::yaw] = problem.start.yaw_rad;
        std::copy(problem.start.joints_rad.begin(), problem.start.joints_rad.end(),
                  knot.point.position + space::first_joint);
    }
    return plan;
}

/// The flight of that plan, whose end is the goal.
SpaceFlight flown(SpaceProblem problem, const Vector3& to_m, std::int64_t ticks,
                  const SpaceExecutionSettings& settings = {}) {
    SpaceConfigurationGoal goal;
    goal.x_m = to_m[0];
    goal.y_m = to_m[1];
    goal.z_m = to_m[2];
    problem.goals = {{goal, 5, {}}};
    return SpaceProblemModel(problem).execute(straight(problem, to_m, ticks), settings);
}

}  // namespace

TEST_CASE("The start of a problem in space is a motion") {
    SpaceStart start;
    start.position_m = {1, 2, 3};
    start.yaw_rad = 1;
    start.joints_rad = {0.1, 0.2};
    SpaceMotion motion = start_motion(start);
    CHECK(motion.position_m == Vector3{1, 2, 3});
    CHECK(motion.attitude[0] == Approx(std::cos(0.5)));
    CHECK(motion.attitude[3] == Approx(std::sin(0.5)));
    CHECK(motion.joints_rad[1] == 0.2);
    CHECK(is_at_rest(start));
    start.attitude = {2, 0, 0, 2};  // level, of another length
    CHECK(is_at_rest(start));
    CHECK(start_motion(start).attitude[3] == Approx(std::sqrt(0.5)));
    start.attitude = {1, 0.1, 0, 0};
    CHECK_FALSE(is_at_rest(start));
    start.attitude.reset();
    start.joint_rates_rad_s = {0, 0};
    CHECK(is_at_rest(start));
    start.joint_rates_rad_s = {0, 0.1};
    CHECK_FALSE(is_at_rest(start));
    CHECK(start_motion(start).joint_rates_rad_s[1] == 0.1);
}

TEST_CASE("Plans of a problem in space are executed among its obstacles and surfaces") {
    SpaceProblem problem = space_problem_of_files();
    SECTION("through free air") {
        const SpaceFlight flight = flown(problem, {-3, 0, 2.5}, 400);
        CHECK(flight.outcome == Outcome::ok);
        CHECK(flight.rows.size() == 901);
        CHECK(flight.min_clearance_m > 1);
        CHECK(std::isfinite(flight.min_clearance_m));
        REQUIRE(flight.goals.size() == 1);
        CHECK(flight.goals[0].is_met);
    }
    SECTION("to another place than the goal") {
        const SpaceFlight flight = SpaceProblemModel(problem).execute(straight(problem, {-3, 0, 2.5}, 400));
        CHECK(flight.outcome == Outcome::goal_missed);
        CHECK(flight.goals[0].error_m > 5);
    }
    SECTION("into a pole") {
        const SpaceFlight flight = flown(problem, {4, 3, 2}, 2000);
        CHECK(flight.outcome == Outcome::collision);
        CHECK(flight.min_clearance_m <= 0);
    }
    SECTION("faster than it can") {
        const SpaceFlight flight = flown(problem, {60, 1, 2}, 100);
        CHECK(flight.outcome == Outcome::unstable);
    }
    SECTION("near the ground, which carries it and ends where rotors may fly") {
        const Vector3 low_m = {-4, 1, 0.45};
        const SpaceFlight with = flown(problem, low_m, 600);
        CHECK(with.outcome == Outcome::ok);
        CHECK(with.rows.back().rotor_factor[0] > 1.001);
        SpaceExecutionSettings settings;
        settings.aero = false;
        const SpaceFlight without = flown(problem, low_m, 600, settings);
        CHECK(without.rows.back().rotor_factor[0] == 1);
        CHECK(without.energy_j > with.energy_j);
    }
    SECTION("in a world, in which a vehicle at rest has hovered") {
        problem.uncertainty = Uncertainty{};
        SpaceExecutionSettings settings;
        settings.world = draw_space_world(*problem.uncertainty, problem.robot, 1, 3);
        const Vector3 to_m = {-3, 0, 2.5};
        const SpaceFlight flight = flown(problem, to_m, 400, settings);
        const SpaceFlight again = flown(problem, to_m, 400, settings);
        REQUIRE(flight.rows.size() == again.rows.size());
        CHECK(flight.rows.back().motion == again.rows.back().motion);
        CHECK_FALSE(flight.rows.front().motion.position_m == problem.start.position_m);
        CHECK_FALSE(flight.rows.back().motion == flown(problem, to_m, 400).rows.back().motion);
        // One that starts tilted begins as it is.
        problem.start.attitude = {1, 0.2, 0, 0};
        const SpaceFlight tilted = flown(problem, to_m, 400, settings);
        CHECK(tilted.rows.front().motion.position_m == problem.start.position_m);
    }
    SECTION("and interrupted on demand") {
        SpaceExecutionSettings settings;
        settings.is_over = [] { return true; };
        CHECK_THROWS_AS(flown(problem, {-3, 0, 2.5}, 400, settings), WorkStopped);
    }
}

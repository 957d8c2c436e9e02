#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/free_air_cost.hpp"
#include "downwash/planner/search_space.hpp"
#include "downwash/planner/solve.hpp"

using namespace downwash;
using planning::Configuration;

namespace {

constexpr double pi = 3.141592653589793;

struct Fixture {
    explicit Fixture(Problem given)
        : problem(std::move(given)), model(make_flight_model(problem)), space(problem, *model) {}

    Problem problem;
    std::shared_ptr<const FlightModel> model;
    planning::SearchSpace space;
};

Problem with_configuration_goal() {
    Problem problem = test::ceiling_problem();
    problem.goal.end_effector.reset();
    problem.goal.configuration = ConfigurationGoal{2.0, 3.0, std::nullopt, 0.5, 0.1};
    return problem;
}

}  // namespace

TEST_CASE("moved into the goal's middle, the tip of the arm is there and the arm keeps its angle") {
    const Fixture f(test::ceiling_problem());  // the tip to (3, 4.8), an arm of 1.2 m
    const Configuration up = f.space.moved_into_goal({1, 1, -pi / 2}, 0);
    CHECK(up.x_m == Approx(3));
    CHECK(up.z_m == Approx(3.6));
    CHECK(up.arm_rad == -pi / 2);
    const Configuration forward = f.space.moved_into_goal({1, 1, 0}, 0);
    CHECK(forward.x_m == Approx(1.8));
    CHECK(forward.z_m == Approx(4.8));
}

TEST_CASE("moved into the goal's tolerance, a configuration stays as near as the tolerance allows") {
    const Fixture f(with_configuration_goal());  // (2, 3) within 0.5 m, any arm
    const Configuration c = f.space.moved_into_goal({2, 7, 1.25}, 0.5);
    CHECK(c.x_m == Approx(2));
    CHECK(c.z_m == Approx(3.25));
    CHECK(c.arm_rad == 1.25);
    const Configuration inside = f.space.moved_into_goal({2.1, 3.1, 1.25}, 0.5);
    CHECK(inside.x_m == Approx(2.1));
    CHECK(inside.z_m == Approx(3.1));
}

TEST_CASE("the wanted direction of the arm is taken on to within the tolerance") {
    Problem problem = test::ceiling_problem();
    problem.goal.end_effector->direction_rad = -pi / 2;
    problem.goal.end_effector->direction_tolerance_rad = 0.2;
    const Fixture f(problem);
    CHECK(f.space.moved_into_goal({0, 2, 0}, 0).arm_rad == Approx(-pi / 2));
    CHECK(f.space.moved_into_goal({0, 2, 0}, 1).arm_rad == Approx(-pi / 2 + 0.2));
    CHECK(f.space.moved_into_goal({0, 2, pi}, 1).arm_rad == Approx(-pi / 2 - 0.2));
    CHECK(f.space.moved_into_goal({0, 2, -1.6}, 1).arm_rad == Approx(-1.6));
}

TEST_CASE("whatever is moved into the goal meets it") {
    for (const Problem& problem : {test::ceiling_problem(), with_configuration_goal()}) {
        const Fixture f(problem);
        planning::Random random(3);
        for (int i = 0; i < 200; ++i) {
            const Configuration c = f.space.sample(random);
            CHECK(f.space.is_near_goal(f.space.moved_into_goal(c, 0)));
            CHECK(f.space.is_near_goal(f.space.moved_into_goal(c, usable_tolerance_share)));
        }
    }
}

TEST_CASE("no motion is cheaper than the least that is said of it, however it is divided, nor a way to the goal") {
    for (const Objective objective : {Objective::energy, Objective::time, Objective::length, Objective::clearance}) {
        CAPTURE(name_of(objective));
        for (Problem problem : {test::ceiling_problem(), with_configuration_goal()}) {
            problem.planner.objective = objective;
            const Fixture f(problem);
            const planning::FreeAirCost cost(f.problem, *f.model, f.space);
            planning::Random random(5);
            double tightest = 0;
            for (int i = 0; i < 200; ++i) {
                const Configuration a = f.space.sample(random);
                const Configuration b = f.space.sample(random);
                const Configuration c = f.space.sample(random);
                const double least = cost.least_of_motion(a, c);
                CHECK(least <= cost.of_motion(a, c) * (1 + 1e-12));
                CHECK(least <= (cost.of_motion(a, b) + cost.of_motion(b, c)) * (1 + 1e-12));
                CHECK(least <= cost.least_of_motion(a, b) + cost.least_of_motion(b, c) + 1e-9);
                const auto goal = f.space.sample_goal(random);
                REQUIRE(goal);
                const double way = cost.of_motion(a, *goal) + cost.of_hold(*goal, problem.goal.hold_s);
                CHECK(cost.least_to_goal(a, problem.goal.hold_s) <= way * (1 + 1e-12));
                tightest = std::max(tightest, cost.least_to_goal(a, problem.goal.hold_s) / way);
            }
            CHECK((objective == Objective::clearance || tightest > 0.5));
        }
    }
}

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <variant>

#include "downwash/judge/space_plan_judge.hpp"
#include "downwash/planner/found.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/space_solution_file.hpp"

// No direction and no place is special: a flight that is turned about the vertical, and shifted, with all that is
// around it, is the same flight. bench/turned.py asks the same of searches.

using namespace downwash;

namespace {

/// A turn about the vertical through the origin, then a shift.
struct Move {
    double yaw_rad;
    Vector3 shift_m;

    [[nodiscard]] Vector3 direction(const Vector3& at) const {
        const double sine = std::sin(yaw_rad), cosine = std::cos(yaw_rad);
        return {cosine * at[0] - sine * at[1], sine * at[0] + cosine * at[1], at[2]};
    }
    [[nodiscard]] Vector3 place(const Vector3& at_m) const { return direction(at_m) + shift_m; }
};

SpaceProblem moved(SpaceProblem problem, const Move& by) {
    for (Obstacle& obstacle : problem.obstacles) {
        obstacle.center_world_m = by.place(obstacle.center_world_m);
        obstacle.rpy_rad[2] += by.yaw_rad;
    }
    problem.start.position_m = by.place(problem.start.position_m);
    problem.start.yaw_rad += by.yaw_rad;
    auto& tool = std::get<SpaceEndEffectorGoal>(problem.goals.front().kind);
    tool.position_m = by.place(tool.position_m);
    tool.direction = by.direction(*tool.direction);
    problem.bounds = {{-1e3, -1e3, -1e3}, {1e3, 1e3, 1e3}};  // which do not turn
    return problem;
}

SpacePlan moved(SpacePlan plan, const Move& by) {
    const auto turn = [&by](double* at, const Vector3& shift_m) {
        const Vector3 turned = by.direction({at[0], at[1], at[2]}) + shift_m;
        std::copy(turned.begin(), turned.end(), at);
    };
    for (SpaceKnot& knot : plan.reference) {
        turn(knot.point.position, by.shift_m);
        turn(knot.point.velocity, {});
        turn(knot.point.acceleration, {});
        knot.point.position[space::yaw] += by.yaw_rad;
    }
    return plan;
}

}  // namespace

TEST_CASE("a flight turned about the vertical or shifted is the same flight, for the execution and for the judge") {
    const SpaceProblem problem = read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
    const SpacePlan plan = *read_solution(DOWNWASH_PROBLEMS "/space/around_a_girder.json", problem).plan;
    const SpaceProblem unmoved = moved(problem, {0, {}});
    const SpaceFlight flight = SpaceProblemModel(unmoved).execute(plan);
    const judge::SpaceJudgedFlight judged = judge::SpacePlanJudge(unmoved).fly(plan);
    REQUIRE(flight.outcome == Outcome::ok);
    REQUIRE(judged.outcome == judge::Outcome::ok);
    constexpr double degree = std::numbers::pi / 180;
    constexpr double nearly = 1e-6;
    for (const Move& by : {Move{17 * degree, {}}, Move{90 * degree, {}}, Move{0, {103.7, -57.3, 12.9}},
                           Move{-133 * degree, {-11.1, 207.5, -3.3}}}) {
        CAPTURE(by.yaw_rad, by.shift_m[0]);
        const SpaceProblem elsewhere = moved(problem, by);
        const SpaceFlight same = SpaceProblemModel(elsewhere).execute(moved(plan, by));
        CHECK(same.outcome == flight.outcome);
        CHECK(same.min_clearance_m == Approx(flight.min_clearance_m).margin(nearly));
        CHECK(cost_of(same, problem.planner.objective) ==
              Approx(cost_of(flight, problem.planner.objective)).epsilon(nearly));
        CHECK(same.goals.front().error_m == Approx(flight.goals.front().error_m).margin(nearly));
        CHECK(same.rows.size() == flight.rows.size());

        const judge::SpaceJudgedFlight same_judged = judge::SpacePlanJudge(elsewhere).fly(moved(plan, by));
        CHECK(same_judged.outcome == judged.outcome);
        CHECK(same_judged.min_clearance_m == Approx(judged.min_clearance_m).margin(nearly));
        CHECK(same_judged.energy_j == Approx(judged.energy_j).epsilon(nearly));
    }
}

TEST_CASE("a flight that is not turned with what is around it is another one") {
    const SpaceProblem problem = read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
    const SpacePlan plan = *read_solution(DOWNWASH_PROBLEMS "/space/around_a_girder.json", problem).plan;
    const Move by{0.05, {}};
    SpaceProblem askew = moved(problem, by);
    askew.obstacles = problem.obstacles;
    const SpaceFlight flight = SpaceProblemModel(askew).execute(moved(plan, by));
    const SpaceFlight straight = SpaceProblemModel(moved(problem, {0, {}})).execute(plan);
    CHECK(std::abs(flight.min_clearance_m - straight.min_clearance_m) > 1e-4);
}

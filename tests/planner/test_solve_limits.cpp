#include <catch2/catch.hpp>
#include <stop_token>

#include "downwash/planner/solve.hpp"
#include "searched_problems.hpp"

using namespace downwash;
using namespace downwash::test;

TEST_CASE("a stop asked for before the search ends it at once") {
    std::stop_source source;
    source.request_stop();
    SolveOptions options;
    options.stop = source.get_token();
    for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_da}) {
        Problem problem = with(variant);
        problem.planner.max_iterations.reset();
        const Solution solution = solve(problem, options);
        CHECK(solution.interrupted);
        CHECK(solution.status != Status::solved);
        CHECK(solution.planning.iterations < 100);
    }
}

TEST_CASE("a stop asked for in mid-search keeps the best plan so far") {
    std::stop_source source;
    SolveOptions options;
    options.stop = source.get_token();
    options.on_progress = [&](const Progress& progress) {
        if (progress.best_cost) {
            source.request_stop();
        }
    };
    Problem problem = with(Variant::mp_arm_ada);
    problem.planner.max_iterations.reset();
    problem.planner.time_limit_s = 3600;  // longer than a test may take
    const Solution solution = solve(problem, options);
    CHECK(solution.interrupted);
    CHECK(solution.status == Status::solved);
}

TEST_CASE("flights of absurd length are rejected, not flown") {
    for (const Variant variant : variants) {
        CAPTURE(name_of(variant));
        Problem problem = with(variant, 50, 50);
        problem.motion.max_speed_m_s = 1e-6;
        const Solution solution = solve(problem);
        CHECK(solution.status == Status::none);
        CHECK_FALSE(solution.plan);
        CHECK(solution.planning.improvements.empty());
        if (variant != Variant::mp_arm) {
            CHECK(solution.planning.rejected.at("too_long") > 0);
            CHECK(solution.planning.simulated_s == 0);
        }
    }
}

TEST_CASE("the time limit is heeded within a long flight") {
    Problem problem = with(Variant::mp_arm_da);
    problem.motion.max_speed_m_s = 0.01;  // edges of ten minutes
    problem.robot.controller.rate_hz = 500;
    problem.planner.parameters = {{"first_batch_size", 1000.0}};
    problem.planner.max_iterations.reset();
    problem.planner.time_limit_s = 0.05;
    // The first batch alone would take some 10^8 ticks, which no processor simulates in a twentieth of a second.
    CHECK(solve(problem).planning.simulated_s * problem.robot.controller.rate_hz < 1e7);
}

TEST_CASE("the time limit is heeded within a long hold") {
    Problem problem = with(Variant::mp_arm_ada);
    problem.goal.hold_s = 360;
    problem.robot.controller.rate_hz = 1000;
    problem.planner.parameters = {{"first_batch_size", 1000.0}};
    problem.planner.max_iterations.reset();
    problem.planner.time_limit_s = 0.05;
    // A hold takes 360,000 ticks, and the first batch has a hundred: no processor simulates ten in a twentieth of a
    // second.
    CHECK(solve(problem).planning.simulated_s * problem.robot.controller.rate_hz < 3.6e6);
}

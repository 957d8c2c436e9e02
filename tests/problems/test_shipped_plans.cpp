// What holds of plans for the shipped problems.

#include <catch2/catch.hpp>
#include <string>

#include "../support/repetitions.hpp"
#include "../support/same_bytes.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/simulation/hover_analysis.hpp"

using namespace downwash;

namespace {

Problem shipped(const std::string& name, std::uint64_t iterations) {
    Problem problem = read_problem(std::string(DOWNWASH_PROBLEMS) + "/" + name + ".yaml");
    problem.planner.variant = Variant::mp_arm_ada;
    problem.planner.max_iterations = iterations;
    problem.planner.time_limit_s.reset();
    return problem;
}

}  // namespace

TEST_CASE("Twelve plans of four shipped problems end where hover is stable") {
    for (const char* name : {"bridge_inspection", "box_girder_bay", "culvert", "pipe_rack"}) {
        Problem problem = shipped(name, 300);
        problem.uncertainty.reset();
        const auto model = make_flight_model(problem);
        SolveOptions options;
        options.map = model->make_map(problem.bounds);
        for (const std::uint32_t seed : {1U, 2U, 3U}) {
            CAPTURE(name, seed);
            problem.planner.seed = seed;
            const Solution solution = solve(problem, options);
            REQUIRE(solution.status == Status::solved);
            REQUIRE(solution.execution->outcome == Outcome::ok);
            const double* q = solution.execution->rows.back().q;
            CHECK(analyse_hover(*model, q[0], q[1], q[3]).verdict == HoldVerdict::stable);
        }
    }
}

TEST_CASE("A search comes to the same bytes on one, three and five threads") {
    const Problem problem = shipped("box_girder_bay", static_cast<std::uint64_t>(test::repetitions(300, 1000)));
    SolveOptions options;
    options.map = make_flight_model(problem)->make_map(problem.bounds);
    options.keep_tree = true;
    const Solution one = solve(problem, options);
    REQUIRE(one.status == Status::solved);
    for (const int threads : {3, 5}) {
        CAPTURE(threads);
        options.threads = threads;
        const Solution other = solve(problem, options);
        REQUIRE(other.status == Status::solved);
        CHECK(other.cost == one.cost);
        CHECK(test::same_bytes(*other.plan, *one.plan));
        CHECK(test::same_bytes(*other.execution, *one.execution));
        CHECK(other.tree.size() == one.tree.size());
        CHECK(other.planning.improvements.size() == one.planning.improvements.size());
        CHECK(other.planning.edges_simulated == one.planning.edges_simulated);
        CHECK(other.planning.states_checked == one.planning.states_checked);
        CHECK(other.planning.rejected == one.planning.rejected);
    }
}

// What holds of plans for the shipped problems.

#include <catch2/catch.hpp>
#include <cstring>
#include <string>

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

bool is_same(const Plan& a, const Plan& b) {
    if (a.reference.size() != b.reference.size()) {
        return false;
    }
    for (std::size_t i = 0; i < a.reference.size(); ++i) {
        if (a.reference[i].tick != b.reference[i].tick || !(a.reference[i].point == b.reference[i].point)) {
            return false;
        }
    }
    return true;
}

bool is_same(const Execution& a, const Execution& b) {
    if (a.rows.size() != b.rows.size()) {
        return false;
    }
    for (std::size_t i = 0; i < a.rows.size(); ++i) {
        if (std::memcmp(a.rows[i].q, b.rows[i].q, sizeof(a.rows[i].q)) != 0 ||
            std::memcmp(a.rows[i].u, b.rows[i].u, sizeof(a.rows[i].u)) != 0 ||
            a.rows[i].energy_j != b.rows[i].energy_j) {
            return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("Twelve plans of four shipped problems end where hover is stable") {
    for (const char* name : {"bridge_inspection", "box_girder_bay", "culvert", "pipe_rack"}) {
        Problem problem = shipped(name, 300);
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

TEST_CASE("A thousand iterations come to the same bytes on one, three and five threads") {
    const Problem problem = shipped("box_girder_bay", 1000);
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
        CHECK(is_same(*other.plan, *one.plan));
        CHECK(is_same(*other.execution, *one.execution));
        CHECK(other.tree.size() == one.tree.size());
        CHECK(other.planning.improvements.size() == one.planning.improvements.size());
        CHECK(other.planning.edges_simulated == one.planning.edges_simulated);
        CHECK(other.planning.states_checked == one.planning.states_checked);
        CHECK(other.planning.rejected == one.planning.rejected);
    }
}

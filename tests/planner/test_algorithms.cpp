#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/same_bytes.hpp"
#include "../support/test_problem.hpp"
#include "downwash/base/text.hpp"
#include "downwash/planner/solve.hpp"
#include "searched_problems.hpp"

using namespace downwash;

namespace {

constexpr const char* planners_over_controls[] = {"rrt", "sst", "kpiece1", "est"};

SolveOptions until_first() {
    SolveOptions options;
    options.stop_at_first_solution = true;
    return options;
}

Problem with(Variant variant, std::string_view algorithm, Problem problem = test::ceiling_problem()) {
    problem.planner.variant = variant;
    problem.planner.algorithm = algorithm;
    problem.planner.max_iterations = 5000;
    return problem;
}

/// Every combination that exists.
template <class Check>
void for_all(const Check& check) {
    for (const Variant variant : test::variants) {
        for (const AlgorithmInfo& algorithm : algorithms()) {
            if (algorithm.plans_for(variant)) {
                CAPTURE(name_of(variant), algorithm.name);
                check(variant, algorithm);
            }
        }
    }
}

}  // namespace

TEST_CASE("every algorithm solves an easy problem from start to goal, twice with the same bytes") {
    for_all([](Variant variant, const AlgorithmInfo& algorithm) {
        const Problem problem = with(variant, algorithm.name);
        const Solution a = solve(problem, until_first());
        const Solution b = solve(problem, until_first());
        REQUIRE(a.status == Status::solved);
        REQUIRE(b.status == Status::solved);
        CHECK(test::same_bytes(*a.plan, *b.plan));
        CHECK(a.cost == b.cost);
        CHECK(a.planning.iterations == b.planning.iterations);
        CHECK(a.planning.rejected == b.planning.rejected);
        CHECK(a.execution_cost == b.execution_cost);
        CHECK(a.planning.first_solution_wall_s);
        CHECK(a.planning.improvements.size() == 1);
        CHECK(a.planning.improvements.back().cost == Approx(a.cost));
        CHECK(a.cost > 0);
        CHECK(a.planning.iterations <= *problem.planner.max_iterations);
        CHECK(a.plan->reference.front().tick == 0);
        CHECK(a.plan->first() == problem.start.at);
        CHECK(test::tip_error_m(problem, a.plan->last()) <= test::end_effector(problem.goal).tolerance_m);
        if (variant == Variant::mp_arm_ada) {
            CHECK(a.execution->outcome == Outcome::ok);
            CHECK(a.execution_cost == Approx(a.cost).epsilon(0.01));
        }
    });
}

TEST_CASE("every algorithm's tree hangs together, from the start on") {
    for_all([](Variant variant, const AlgorithmInfo& algorithm) {
        SolveOptions options = until_first();
        const Problem problem = with(variant, algorithm.name);
        CHECK(solve(problem, options).tree.empty());
        options.keep_tree = true;
        const Solution solution = solve(problem, options);
        REQUIRE(solution.tree.size() > 1);
        const auto is_root = [](const TreeNode& node) { return node.parent == TreeNode::no_parent; };
        const auto roots = std::count_if(solution.tree.begin(), solution.tree.end(), is_root);
        CHECK(roots >= 1);
        const bool grows_two = algorithm.name == "rrt-connect";
        CHECK(roots <= (grows_two ? static_cast<std::ptrdiff_t>(solution.tree.size()) - 1 : 1));
        CHECK(std::any_of(solution.tree.begin(), solution.tree.end(), [&](const TreeNode& node) {
            return is_root(node) && node.at[plane::x] == Approx(problem.start.at[plane::x]) &&
                   node.at[plane::z] == Approx(problem.start.at[plane::z]);
        }));
        for (const TreeNode& node : solution.tree) {
            int parent = node.parent;
            std::size_t steps = 0;
            while (parent != TreeNode::no_parent && steps <= solution.tree.size()) {
                REQUIRE(parent >= 0);
                REQUIRE(static_cast<std::size_t>(parent) < solution.tree.size());
                parent = solution.tree[static_cast<std::size_t>(parent)].parent;
                ++steps;
            }
            REQUIRE(steps <= solution.tree.size());
        }
    });
}

TEST_CASE("no algorithm calls a walled problem solved") {
    for_all([](Variant variant, const AlgorithmInfo& algorithm) {
        Problem problem = with(variant, algorithm.name, test::slit_problem());
        problem.planner.max_iterations = 200;
        const Solution solution = solve(problem);
        CHECK(solution.status != Status::solved);
        CHECK(solution.planning.improvements.empty());
        CHECK_FALSE(solution.planning.first_solution_wall_s);
        CHECK(solution.planning.iterations <= 200);
        REQUIRE(solution.nearest_approach_m.has_value());
        CHECK(*solution.nearest_approach_m > 0);
        // Our tree tries ways to the goal all along; OMPL's planners close a flight only from nearby.
        const bool tries_ways_to_goal = algorithm.name == "rrt-star";
        REQUIRE(solution.obstruction.has_value() == tries_ways_to_goal);
        if (tries_ways_to_goal) {
            CHECK(solution.obstruction->cause == "collision");
            CHECK(solution.obstruction->at[plane::x] < 0);  // on this side of the wall
            CHECK(solution.obstruction->goal_distance_m > 1);
        }
        CHECK((solution.status == Status::approximate) == solution.plan.has_value());
        if (solution.plan) {
            REQUIRE(solution.execution);
            CHECK(solution.execution->outcome != Outcome::ok);
            const ReferencePoint& end = solution.plan->reference.back().point;
            CHECK(std::all_of(end.velocity, end.velocity + 3, [](double speed) { return speed == 0; }));
        }
    });
}

TEST_CASE("where hardly any sample of the goal is clear, what is called solved ends there") {
    // The tip has to get into a slot of the ceiling, so that the arm has a few degrees to choose from.
    Problem problem = test::ceiling_problem();
    for (const double side : {-1.0, 1.0}) {
        problem.obstacles.push_back(test::box(side < 0 ? "left" : "right", {6, 8, 1}, {3 + 3.15 * side, 0, 4.5}));
    }
    problem.planner.variant = Variant::mp_arm;
    problem.planner.check_execution = false;  // flights into the slot fail
    problem.planner.max_iterations = 3000;
    for (const char* algorithm : {"rrt-connect", "bit-star"}) {  // they take samples of the goal at their word
        CAPTURE(algorithm);
        problem.planner.algorithm = algorithm;
        int solved = 0;
        for (problem.planner.seed = 1; problem.planner.seed <= 8; ++problem.planner.seed) {
            const Solution solution = solve(problem);
            if (solution.status == Status::solved) {
                ++solved;
                CHECK(test::tip_error_m(problem, solution.plan->last()) <=
                      test::end_effector(problem.goal).tolerance_m);
            }
        }
        CHECK(solved > 0);
    }
}

TEST_CASE("planners over controls keep the limits of the reference at every tick") {
    for (const char* algorithm : planners_over_controls) {
        CAPTURE(algorithm);
        const Solution solution = solve(with(Variant::mp_arm_da, algorithm), until_first());
        REQUIRE(solution.execution);
        double speed = 0;
        double acceleration = 0;
        double arm_rate = 0;
        for (const FlightRow& row : solution.execution->rows) {
            const ReferencePoint& at = row.reference;
            speed = std::max(speed, std::hypot(at.velocity[0], at.velocity[1]));
            acceleration = std::max(acceleration, std::hypot(at.acceleration[0], at.acceleration[1]));
            arm_rate = std::max(arm_rate, std::abs(at.velocity[2]));
        }
        CHECK(speed <= 1.0 * 1.003);
        CHECK(acceleration <= 0.5 * 1.003);
        CHECK(arm_rate <= 0.7853981633974483 * 1.003);
        CHECK(speed > 0.3);
    }
}

TEST_CASE("SST goes on for better plans, whatever the objective") {
    for (const Objective objective : {Objective::energy, Objective::time, Objective::length, Objective::clearance}) {
        CAPTURE(name_of(objective));
        Problem problem = with(Variant::mp_arm_da, "sst");
        problem.planner.objective = objective;
        problem.planner.max_iterations = objective == Objective::clearance ? 1500 : 4000;
        const Solution solution = solve(problem);
        REQUIRE(solution.status == Status::solved);
        const auto& improvements = solution.planning.improvements;
        for (std::size_t i = 1; i < improvements.size(); ++i) {
            CHECK(improvements[i].cost < improvements[i - 1].cost);
        }
        CHECK(improvements.back().cost == solution.cost);
        CHECK(solution.planning.iterations == *problem.planner.max_iterations);
    }
}

TEST_CASE("every algorithm comes to a good end when its time is over") {
    for_all([](Variant variant, const AlgorithmInfo& algorithm) {
        for (Problem problem : {test::ceiling_problem(), test::slit_problem()}) {
            problem = with(variant, algorithm.name, problem);
            problem.planner.max_iterations.reset();
            problem.planner.time_limit_s = 0.1;
            const Solution solution = solve(problem);  // how soon it ends, bench/speed.sh measures
            CHECK_FALSE(solution.interrupted);
            CHECK(solution.execution.has_value() == solution.plan.has_value());
        }
    });
}

TEST_CASE("an algorithm that does not plan for the variant is an error, and another is named") {
    const auto error_of = [](Variant variant, std::string_view algorithm) {
        const std::vector<KeyError> errors = problem_errors(with(variant, algorithm));
        REQUIRE(errors.size() == 1);
        CHECK(errors.front().key == "planner.algorithm");
        return errors.front().message;
    };
    for (const Variant variant : test::variants) {
        std::vector<std::string_view> planning;
        for (const AlgorithmInfo& algorithm : algorithms()) {
            CAPTURE(name_of(variant), algorithm.name);
            CHECK(problem_errors(with(variant, algorithm.name)).empty() == algorithm.plans_for(variant));
            if (algorithm.plans_for(variant)) {
                planning.push_back(algorithm.name);
            }
        }
        const std::string wrong = variant == Variant::mp_arm ? "kpiece1" : "bit-star";
        CHECK(error_of(variant, wrong) == "is '" + wrong + "', which does not plan for " +
                                              std::string(name_of(variant)) + ": expected " + joined_names(planning) +
                                              "; did you mean 'rrt-star'?");
    }
    CHECK_THROWS_AS(static_cast<void>(solve(with(Variant::mp_arm, "est"))), InputError);
}

TEST_CASE("a start that already meets the goal needs no search, whatever plans") {
    for (const char* algorithm : {"rrt-star", "rrt", "sst", "kpiece1", "est"}) {
        CAPTURE(algorithm);
        Problem problem = with(Variant::mp_arm_ada, algorithm);
        problem.start.at[plane::x] = 3 - 0.6;
        problem.start.at[plane::z] = 4.8 - 1.2 * 0.8660254037844386;
        problem.start.at[plane::arm] = -1.0471975511965976;
        problem.planner.max_iterations = 1;
        const Solution solution = solve(problem);
        REQUIRE(solution.status == Status::solved);
        CHECK(solution.execution->outcome == Outcome::ok);
        if (algorithm == std::string_view("rrt-star")) {  // it holds there from the beginning
            CHECK(solution.plan->reference.size() == 1);
            CHECK(solution.execution->duration_s == Approx(problem.goal.hold_s));
        }
        CHECK(solution.execution->duration_s < problem.goal.hold_s + 1);
    }
}

TEST_CASE("planners over controls start in motion, and reject flights of absurd length") {
    for (const char* algorithm : planners_over_controls) {
        CAPTURE(algorithm);
        Problem problem = with(Variant::mp_arm_da, algorithm);
        problem.start.velocity[plane::x] = 0.5;
        problem.start.at[plane::x] = problem.bounds.x_high_m - 0.1;  // it cannot but overshoot the bound
        Problem slow = with(Variant::mp_arm_da, algorithm);
        slow.motion.max_speed_m_s = 1e-6;
        for (Problem* impossible : {&problem, &slow}) {
            impossible->planner.max_iterations = 50;
            CHECK(solve(*impossible).status != Status::solved);
        }
    }
}

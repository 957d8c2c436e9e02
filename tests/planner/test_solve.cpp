#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <vector>

#include "../support/error_of.hpp"
#include "../support/same_bytes.hpp"
#include "../support/scratch_folder.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/direct_flight.hpp"
#include "downwash/planner/solve.hpp"
#include "searched_problems.hpp"

using namespace downwash;
using namespace downwash::test;

TEST_CASE("an aerodynamics-aware plan is reported only with a flight that held at the goal under direct aerodynamics") {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        Problem problem = with(Variant::mp_arm_ada);
        problem.planner.seed = seed;
        const Solution solution = solve(problem);
        REQUIRE(solution.status == Status::solved);
        CHECK(solution.execution->aero);
        CHECK(solution.execution->outcome == Outcome::ok);
        CHECK(solution.execution->min_clearance_m >= problem.planner.safety_margin_m);
        CHECK(solution.execution->goal_error_m <= test::end_effector(problem.goal).tolerance_m);
        CHECK(solution.execution->duration_s ==
              Approx(solution.plan->duration_s() + problem.goal.hold_s).margin(0.011));
        // The map is within 0.01 of the direct effect, so the flights differ little.
        CHECK(solution.execution_cost == Approx(solution.cost).epsilon(0.01));
    }
}

TEST_CASE("the same seed and iteration budget give the same bytes, whatever the threads") {
    for (const Variant variant : variants) {
        CAPTURE(name_of(variant));
        Problem problem = with(variant, 800, 80);
        const Solution a = solve(problem);
        REQUIRE(a.plan);
        for (const int threads : {2, 5}) {
            SolveOptions options;
            options.threads = threads;
            const Solution b = solve(problem, options);
            REQUIRE(b.plan);
            CHECK(a.cost == b.cost);
            CHECK(test::same_bytes(*a.plan, *b.plan));
            CHECK(test::same_bytes(*a.execution, *b.execution));
            CHECK(a.planning.edges_simulated == b.planning.edges_simulated);
            CHECK(a.planning.states_checked == b.planning.states_checked);
            CHECK(a.planning.rejected == b.planning.rejected);
        }
        SolveOptions none;  // no threads are as good as one
        none.threads = 0;
        const Solution alone = solve(problem, none);
        CHECK(alone.threads == 1);
        CHECK(alone.cost == a.cost);
        problem.planner.seed = 2;
        CHECK_FALSE(test::same_bytes(*a.plan, *solve(problem).plan));
    }
}

TEST_CASE("a search fills the part of the map that its flights ask for, and says how long that took") {
    Problem problem = with(Variant::mp_arm_ada);
    problem.planner.max_iterations = 1;
    const Solution solution = solve(problem);
    REQUIRE(solution.map);
    CHECK(solution.map->filled_share() > 0);
    CHECK(solution.map->filled_share() < 0.7);
    CHECK(solution.planning.map_wall_s >= solution.map->filling_s());
    CHECK(solution.map->filling_s() > 0);

    // The plans are those through a map that was full before, of which nothing is left to fill.
    problem.planner.max_iterations = 200;
    SolveOptions options;
    options.map = make_flight_model(problem)->make_whole_map(problem.bounds);
    const double whole_s = options.map->filling_s();
    const Solution full = solve(problem, options);
    const Solution filling = solve(problem);
    REQUIRE(full.plan);
    REQUIRE(filling.plan);
    CHECK(test::same_bytes(*full.plan, *filling.plan));
    CHECK(options.map->filling_s() == whole_s);
    CHECK(full.planning.map_wall_s < 0.1 * whole_s);
    CHECK_FALSE(solve(with(Variant::mp_arm_da, problem), options).map);
}

TEST_CASE("a search keeps in the cache what it filled") {
    const test::ScratchFolder folder;
    Problem problem = with(Variant::mp_arm_ada);
    problem.planner.max_iterations = 50;
    SolveOptions options;
    options.map_cache = folder / "maps";
    const Solution first = solve(problem, options);
    const auto kept = make_flight_model(problem)->make_map(problem.bounds, options.map_cache);
    CHECK(kept->to_bytes() == first.map->to_bytes());
    const Solution again = solve(problem, options);
    CHECK(again.map->filling_s() == 0);
    CHECK(again.map->to_bytes() == first.map->to_bytes());
    CHECK(test::same_bytes(*first.plan, *again.plan));
}

TEST_CASE("every better plan is handed over as soon as it counts") {
    for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_ada}) {
        CAPTURE(name_of(variant));
        std::vector<double> costs;
        Plan last;
        SolveOptions options;
        options.on_plan = [&](const FoundPlan& found) {
            costs.push_back(found.cost);
            last = found.plan;
        };
        const Solution solution = solve(with(variant, 1000, 100), options);
        REQUIRE(solution.status == Status::solved);
        REQUIRE(!costs.empty());
        CHECK(costs.back() == solution.cost);
        CHECK(test::same_bytes(last, *solution.plan));
        if (variant == Variant::mp_arm_ada) {
            CHECK(costs.size() == solution.planning.improvements.size());
        }
    }
}

TEST_CASE("improvements only ever get cheaper and the last one is the plan's cost") {
    for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_ada}) {
        for (const Objective objective :
             {Objective::energy, Objective::time, Objective::length, Objective::clearance}) {
            CAPTURE(name_of(variant), name_of(objective));
            Problem problem = with(variant, 1000, 60);
            problem.planner.objective = objective;
            const Solution solution = solve(problem);
            REQUIRE(solution.status == Status::solved);
            const auto& improvements = solution.planning.improvements;
            REQUIRE(!improvements.empty());
            CHECK(test::tip_error_m(problem, solution.plan->last()) <= test::end_effector(problem.goal).tolerance_m);
            for (std::size_t i = 1; i < improvements.size(); ++i) {
                CHECK(improvements[i].cost <= improvements[i - 1].cost);
                if (variant == Variant::mp_arm_ada) {
                    CHECK(improvements[i].flown_cost < improvements[i - 1].flown_cost);
                }
            }
            CHECK(improvements.back().cost == Approx(solution.cost).epsilon(1e-12));
            if (variant == Variant::mp_arm_ada) {
                CHECK(solution.execution_cost == Approx(solution.cost).epsilon(0.01));
            }
        }
    }
}

TEST_CASE("a goal on a bound or an arm limit is reached from inside, within its tolerance") {
    Problem problem = with(Variant::mp_arm_ada);
    problem.goal = test::configuration_goal(problem.bounds.x_high_m, 2.5, -1.4);
    test::limit_arm(problem.robot, -1.4, 1.7);
    problem.planner.max_iterations = 400;
    const Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    CHECK(solution.execution->outcome == Outcome::ok);
}

TEST_CASE("a goal point that only its tolerance makes reachable is reached") {
    // The tip cannot come nearer to the ceiling than the arm's radius and the margin: 0.08 m.
    for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_ada}) {
        CAPTURE(name_of(variant));
        Problem problem = with(variant, 3000, 400);
        test::end_effector(problem.goal).z_m = 4.985;
        CHECK(solve(problem).status == Status::solved);
    }
}

TEST_CASE("without surface effects the aware planner is the dynamics-aware one") {
    Problem problem = with(Variant::mp_arm_ada);
    problem.aero.enabled = false;
    problem.planner.max_iterations = 60;
    const Solution aware = solve(problem);
    problem.planner.variant = Variant::mp_arm_da;
    const Solution dynamic = solve(problem);
    REQUIRE(aware.plan);
    REQUIRE(dynamic.plan);
    CHECK_FALSE(aware.execution->aero);
    CHECK(aware.planning.edges_simulated == dynamic.planning.edges_simulated);
    CHECK(test::same_bytes(*aware.plan, *dynamic.plan));
}

TEST_CASE("a flight may begin in motion") {
    Problem problem = with(Variant::mp_arm_ada);
    problem.start.velocity[plane::x] = 0.5;
    problem.start.velocity[plane::z] = 0.1;
    problem.start.velocity[plane::arm] = 0.2;
    const Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    CHECK(solution.plan->reference.front().point.velocity[0] == 0.5);
    CHECK(solution.execution->outcome == Outcome::ok);
    CHECK(solution.execution->rows.front().u[0] == 0.5);
}

TEST_CASE("arm limits are kept in the plan and in the flight") {
    for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_ada}) {
        Problem problem = with(variant, 1500, 100);
        test::limit_arm(problem.robot, -1.4, 1.7);
        const Solution solution = solve(problem);
        REQUIRE(solution.status == Status::solved);
        for (const ReferenceKnot& knot : solution.plan->reference) {
            CHECK(knot.point.position[2] >= -1.4);
            CHECK(knot.point.position[2] <= 1.7);
        }
    }
}

TEST_CASE("a robot with rotor lag is planned for and flown") {
    Problem problem = with(Variant::mp_arm_ada);
    problem.robot.rotors.time_constant_s = 0.03;
    const Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    CHECK(solution.execution->has_rotor_lag);
    CHECK(solution.execution->outcome == Outcome::ok);
}

TEST_CASE("a problem that cannot be planned leads to every error") {
    Problem problem = test::ceiling_problem();
    problem.start.at[plane::z] = 5.4;
    problem.robot.rotors.max_thrust_n = 5;
    CHECK(test::errors_of([&] { return solve(problem); }).size() >= 2);
}

TEST_CASE("a map of another scene, vehicle, model or place is refused") {
    const Problem problem = with(Variant::mp_arm_ada);
    const auto changed = [&](const auto& change) {
        Problem other = problem;
        change(other);
        SolveOptions options;
        options.map = make_flight_model(other)->make_map(other.bounds);
        return options;
    };
    CHECK_THROWS_AS(solve(problem, changed([](Problem& other) { other.obstacles[0].center_world_m[2] += 0.001; })),
                    std::invalid_argument);
    CHECK_THROWS_AS(solve(problem, changed([](Problem& other) { other.robot.rotors.radius_m *= 1.01; })),
                    std::invalid_argument);
    CHECK_THROWS_AS(solve(problem, changed([](Problem& other) { other.bounds.x_high_m += 1; })), std::invalid_argument);
    CHECK_THROWS_AS(solve(problem, changed([](Problem& other) { other.aero.grid_m *= 0.5; })), std::invalid_argument);
    CHECK(solve(problem, changed([](Problem& other) { other.planner.seed = 7; })).status == Status::solved);
}

TEST_CASE("a plan that is cheaper in the planner's model only, and not when flown, is no improvement") {
    // Under the ceiling a hover needs less than elsewhere; the planner believes here that it does near the ground.
    Problem problem = test::with_place(3, 3.2);
    test::configuration(problem.goal).tolerance_z_m = 1.3;
    problem.goal.hold_s = 20;
    problem.planner.max_iterations = 800;
    std::size_t compared = 0;
    for (problem.planner.seed = 1; problem.planner.seed <= 3; ++problem.planner.seed) {
        CAPTURE(problem.planner.seed);
        const planning::SearchResult result = solve_deceived(problem, {test::box("ground", {30, 20, 1}, {0, 0, 1.1})});
        const Found& found = result.found;
        REQUIRE(found.status == Status::solved);
        const auto& improvements = result.record.improvements;
        for (std::size_t i = 1; i < improvements.size(); ++i, ++compared) {
            CHECK(improvements[i].flown_cost < improvements[i - 1].flown_cost);
        }
        CHECK(improvements.back().flown_cost == cost_of(*found.execution, problem.planner.objective));
        CHECK(improvements.back().cost == found.cost);
    }
    CHECK(compared > 0);
}

TEST_CASE("where a surface saves energy the aware planner flies and holds along it, and that pays") {
    Problem problem = test::with_place(3, 3.3);  // the deck's lower side at 5 m
    test::configuration(problem.goal).tolerance_z_m = 1.5;
    problem.goal.hold_s = 60;
    problem.planner.max_iterations = 4000;
    std::vector<double> aware_j, unaware_j;
    int below_the_deck = 0;
    for (problem.planner.seed = 1; problem.planner.seed <= 3; ++problem.planner.seed) {
        const Solution aware = solve(with(Variant::mp_arm_ada, problem));
        const Solution unaware = solve(with(Variant::mp_arm_da, problem));
        REQUIRE(aware.execution);
        REQUIRE(unaware.execution);
        CHECK(aware.execution->outcome == Outcome::ok);
        aware_j.push_back(aware.execution->energy_j);
        unaware_j.push_back(unaware.execution->energy_j);
        below_the_deck += aware.plan->last()[plane::z] > 4.4 ? 1 : 0;
    }
    std::sort(aware_j.begin(), aware_j.end());
    std::sort(unaware_j.begin(), unaware_j.end());
    CHECK(below_the_deck >= 2);
    CHECK(aware_j[1] < 0.99 * unaware_j[1]);  // medians
}

TEST_CASE("a search whose start meets the goal goes on without a plan to refine") {
    Problem problem = with(Variant::mp_arm_ada);
    problem.goal = test::configuration_goal(problem.start.at[plane::x], problem.start.at[plane::z]);
    problem.goal.hold_s = 1;
    SolveOptions options;
    options.finds_stops = true;  // of which there is one: where it is
    for (const bool in_worlds : {false, true}) {
        problem.planner.max_iterations = in_worlds ? 50 : 1500;  // every chance of one in twenty comes
        problem.uncertainty = in_worlds ? std::optional<Uncertainty>(Uncertainty{}) : std::nullopt;
        const Solution solution = solve(problem, options);
        CHECK(solution.status == Status::solved);
        CHECK(solution.plan->reference.size() == 1);
        REQUIRE(solution.safe_stops);
        CHECK(solution.safe_stops->moments.size() == 1);
        CHECK(solution.safe_stops->share_without == 0);
    }
}

TEST_CASE("A plan counts if its direct flight reaches the goal and keeps the margin") {
    Execution flight;
    flight.outcome = Outcome::ok;
    flight.min_clearance_m = 0.05;
    CHECK(planning::is_good(flight, 0.05));
    CHECK_FALSE(planning::is_good(flight, 0.051));
    flight.min_clearance_m = std::numeric_limits<double>::infinity();  // without obstacles
    CHECK(planning::is_good(flight, 0.05));
    flight.min_clearance_m = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(planning::is_good(flight, 0));
    flight.min_clearance_m = 1;
    for (const Outcome outcome :
         {Outcome::collision, Outcome::unstable, Outcome::left_flyable_area, Outcome::goal_missed}) {
        flight.outcome = outcome;
        CHECK_FALSE(planning::is_good(flight, 0.05));
    }
}

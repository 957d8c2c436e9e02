#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "../support/error_of.hpp"
#include "../support/same_bytes.hpp"
#include "../support/test_problem.hpp"
#include "downwash/base/quantile.hpp"
#include "downwash/planner/certificate.hpp"
#include "downwash/planner/goal_search.hpp"
#include "downwash/planner/goal_sequence.hpp"
#include "downwash/planner/remedies.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/planner/world_flights.hpp"
#include "downwash/planner/worlds.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/simulation/world_parameters.hpp"

// What plans are worth in other worlds than the nominal one.

using namespace downwash;
using namespace downwash::test;

namespace {

/// The uncertain problem with a wall along the plane, so far to the left of the rotors. It begins after the start.
Problem beside_a_wall(double gap_m) {
    Problem problem = uncertain_problem();
    problem.obstacles.push_back(box("wall", {12, 0.2, 12}, {3.5, 0.5105 + gap_m + 0.1, 0}));
    problem.aero.min_distance_radii = 0.1;
    problem.planner.safety_margin_m = 0.04;
    problem.robot.multirotor.drag = {0.3, 0.02};
    return problem;
}

/// Nothing displaces the vehicle beside its plane.
void keep_in_plane(Problem& problem) {
    Uncertainty& uncertainty = *problem.uncertainty;
    uncertainty.scene_y_m = uncertainty.lateral_error_m = uncertainty.wind_y_m_s = uncertainty.gust_m_s = {};
    uncertainty.position_bias_m = {};  // x and z, too
}

}  // namespace

TEST_CASE("A search that is stopped while a plan is certified does not call it solved") {
    const Problem problem = uncertain_problem();
    std::stop_source source;
    source.request_stop();
    SolveOptions options;
    options.stop = source.get_token();
    const Solution solution = solve(problem, options);
    CHECK(solution.status != Status::solved);
    CHECK_FALSE((solution.certificate && solution.certificate->is_given));
}

TEST_CASE("A plan is solved with its certificate, the same on any number of threads") {
    const Problem problem = uncertain_problem();
    SolveOptions options;
    const Solution one = solve(problem, options);
    REQUIRE(one.status == Status::solved);
    REQUIRE(one.certificate);
    CHECK(one.certificate->is_given);
    CHECK(one.certificate->worlds >= 72);  // 0 failures at half of 5 %
    CHECK(one.certificate->failure_probability.high < 0.1);
    CHECK(one.certificate->clearance_m.p01 > 0);
    CHECK(one.certificate->clearance_m.p50 > one.certificate->clearance_m.p01);
    CHECK(one.certificate->worst.size() == 10);
    CHECK(one.planning.first_certified_wall_s > one.planning.first_solution_wall_s);
    // With 32 threads chunks of worlds are flown before it is known whether they are wanted.
    for (const int threads : {3, 32}) {
        options.threads = threads;
        const Solution more = solve(problem, options);
        CHECK(more.cost == one.cost);
        CHECK(more.certificate->worlds == one.certificate->worlds);
        CHECK(more.certificate->failures == one.certificate->failures);
        CHECK(more.certificate->attempts == one.certificate->attempts);
        CHECK(more.certificate->clearance_m.p01 == one.certificate->clearance_m.p01);
        CHECK(same_bytes(*more.plan, *one.plan));
        CHECK(same_bytes(*more.execution, *one.execution));
    }
}

TEST_CASE(
    "Beside a wall along the plane the clearance differs from world to world, as far as the vehicle is beside it") {
    constexpr double gap_m = 0.22;
    const Problem problem = beside_a_wall(gap_m);
    const std::shared_ptr<const FlightModel> model = make_flight_model(problem);
    WorldFlights flights(problem, model, model->make_map(problem.bounds), 1, ClearanceError{0, 0});
    Plan plan;
    plan.tick_s = model->tick().tick_s;
    plan.reference = {{0, at_rest(problem.start.at)}, {600, at_rest({-1, 2.5, 0.5})}};
    std::vector<FlownWorld> worlds;
    for (std::uint64_t index = 1; index <= 100; ++index) {
        worlds.push_back(make_world(problem.robot, draw_world(*problem.uncertainty, problem.robot, 1, index)));
    }
    std::vector<double> clearances_m;
    const std::vector<WorldFlight> flown = flights.fly(plan, 1, worlds);
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        CAPTURE(i, worlds[i].lateral_m);
        CHECK_FALSE(flown[i].is_lateral_collision);
        CHECK(flown[i].min_clearance_m == Approx(gap_m - worlds[i].lateral_m).margin(1e-6));
        clearances_m.push_back(flown[i].min_clearance_m);
    }
    CHECK(quantile(clearances_m, 0.01) < gap_m - 0.035);
    CHECK(quantile(clearances_m, 0.5) == Approx(gap_m).margin(0.02));
    CHECK(quantile(clearances_m, 0.99) > gap_m + 0.035);
}

TEST_CASE("A plan 22 cm beside a wall gets its certificate, one 5 cm beside it only if nothing displaces the vehicle") {
    const Solution apart = solve(beside_a_wall(0.22));
    REQUIRE(apart.certificate);
    CHECK(apart.certificate->is_given);
    CHECK(apart.certificate->clearance_m.p01 < apart.certificate->clearance_m.p10 - 0.01);
    CHECK(apart.certificate->clearance_m.p10 < apart.certificate->clearance_m.p50 - 0.01);

    Problem near = beside_a_wall(0.05);
    near.planner.worlds = 1;  // the search does not know: the certificate has to
    near.uncertainty->scene_y_m = Spread::of_sd(0.05);
    const Solution refused = solve(near);
    CHECK(refused.status == Status::approximate);
    REQUIRE(refused.certificate);
    CHECK_FALSE(refused.certificate->is_given);
    CHECK(refused.certificate->causes.contains("lateral_collision"));

    near = beside_a_wall(0.05);
    keep_in_plane(near);
    const Solution kept = solve(near);
    REQUIRE(kept.certificate);
    CHECK(kept.certificate->is_given);
    CHECK(kept.certificate->clearance_m.p01 == Approx(0.05).margin(1e-6));
    CHECK(kept.certificate->clearance_m.p50 == Approx(0.05).margin(1e-6));
}

TEST_CASE("A search in worlds finds no way that only a vehicle in its plane gets through") {
    Problem problem = beside_a_wall(0.05);
    const Solution solution = solve(problem);
    CHECK(solution.status != Status::solved);
    CHECK(solution.planning.candidates.checked == 0);
    keep_in_plane(problem);
    CHECK(solve(problem).planning.candidates.checked > 0);
}

TEST_CASE("The clearances of a certificate are those of flights with direct aerodynamics") {
    const Problem problem = uncertain_problem();
    const Solution solution = solve(problem);
    REQUIRE(solution.certificate);
    const auto model = make_flight_model(problem);
    for (const WorldSample& sample : solution.certificate->worst) {
        INFO("world " << sample.world);
        const FlownWorld world = make_world(
            problem.robot, draw_world(*problem.uncertainty, problem.robot, problem.planner.seed, sample.world));
        const FlightWorld in{&world};
        const auto start = hovering_start(*model, start_state(*model, problem.start), true, in);
        REQUIRE(start);
        const Execution flight = execute(*model, *start, solution.plan->reference, goals_of(problem), true, in);
        CHECK(flight.outcome == sample.outcome);
        CHECK(sample.min_clearance_m ==
              Approx(flight.min_clearance_m).margin(1e-3 + ClearanceError{}.at_m(flight.min_clearance_m)));
    }
}

TEST_CASE("plans of every variant count with their certificate, or without one where it is not asked for") {
    Problem problem = uncertain_problem();
    problem.planner.variant = GENERATE(Variant::mp_arm, Variant::mp_arm_da, Variant::mp_arm_ada);
    problem.planner.worlds = plans_flights(problem.planner.variant) ? 4 : PlannerSettings{}.worlds;
    problem.planner.max_failure_probability = 0.2;
    problem.planner.max_iterations = 300;
    const Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    REQUIRE(solution.certificate);
    CHECK(solution.certificate->is_given);
    CHECK(solution.planning.first_certified_wall_s);
    problem.planner.certify = false;
    const Solution uncertified = solve(problem);
    REQUIRE(uncertified.status == Status::solved);
    CHECK_FALSE(uncertified.certificate);
    CHECK(uncertified.planning.candidates.failed_certificate == 0);
}

TEST_CASE("a certificate of MP-ARM-DA is flown near surfaces, of which its own worlds know nothing") {
    Problem problem = ceiling_problem();
    problem.uncertainty.emplace();
    problem.planner.max_failure_probability = 0.05;
    problem.planner.variant = Variant::mp_arm_da;
    problem.planner.check_execution = false;
    problem.planner.max_iterations = 150;
    problem.uncertainty->ceiling_scale =
        Spread::over(0.7, 0.9);  // which kills flights near the ceiling, and those alone
    const Solution solution = solve(problem);
    REQUIRE(solution.plan);
    CHECK(solution.status != Status::solved);
    CHECK(solution.planning.candidates.failed_certificate > 0);
    REQUIRE(solution.certificate);
    CHECK(solution.certificate->failures > 0);
}

TEST_CASE("Goals in turn are certified as a whole, from start to end") {
    Problem problem = uncertain_problem();
    problem.goals_before = {tip_goal(-1, 4.2)};
    problem.goals_before[0].hold_s = 1;
    problem.planner.max_iterations = 300;
    const Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    REQUIRE(solution.certificate);
    CHECK(solution.certificate->is_given);
    CHECK(solution.execution->goals.size() == 2);
}

TEST_CASE("Flights of a plan that fail say on the way to which goal, as direct flights do") {
    const std::size_t weak = GENERATE(std::size_t{0}, std::size_t{1});  // the part that comes too near to the ceiling
    Problem problem = ceiling_problem();
    problem.goals_before = {tip_goal(-1, weak == 0 ? 4.8 : 4.65)};
    problem.goals_before[0].hold_s = 1;
    problem.planner.max_iterations = 300;
    const Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    problem.uncertainty.emplace();
    const std::shared_ptr<const FlightModel> model = make_flight_model(problem);
    WorldFlights flights(problem, model, model->make_map(problem.bounds), 1, ClearanceError{});
    std::vector<FlownWorld> worlds;
    for (std::uint64_t i = 1; i <= 60; ++i) {
        worlds.push_back(make_world(problem.robot, draw_world(*problem.uncertainty, problem.robot, 1, i)));
    }
    const std::vector<WorldFlight> flown = flights.fly(*solution.plan, 2, worlds);
    // Vehicles that are known already, and flights that find no clearance, change nothing else.
    WorldFlights without_clearance(problem, model, model->make_map(problem.bounds));
    const std::vector<std::optional<FlightState>> starts = without_clearance.starts_in(worlds);
    for (int times = 0; times < 2; ++times) {
        const std::vector<WorldFlight> again = without_clearance.fly_from(starts, *solution.plan, 2, worlds);
        for (std::size_t i = 0; i < worlds.size(); ++i) {
            CHECK(again[i].rejection == flown[i].rejection);
            CHECK(again[i].goal == flown[i].goal);
        }
    }
    int failed = 0;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        INFO("world " << i);
        const FlightWorld in{&worlds[i]};
        const auto start = hovering_start(*model, start_state(*model, problem.start), true, in);
        if (flown[i].rejection == Rejection::none || !start) {
            continue;
        }
        const Execution flight = execute(*model, *start, solution.plan->reference, goals_of(problem), true, in);
        if (flight.outcome == outcome_of(flown[i].rejection)) {
            CHECK_FALSE(flight.goals[flown[i].goal].is_met);
            CHECK(flight.goals[0].is_met == (flown[i].goal == 1));
            failed += flown[i].goal == weak ? 1 : 0;
        }
    }
    CHECK(failed > 0);
}

TEST_CASE("A search whose certificates fail on the way to an earlier goal names that goal and ends") {
    Problem problem = uncertain_problem();
    problem.goals_before = {tip_goal(-1, 4.2)};
    test::end_effector(problem.goals_before[0]).tolerance_m = 0.03;
    problem.goals_before[0].hold_s = 1;
    problem.uncertainty->position_bias_m = Spread::of_sd(0.03);
    test::end_effector(problem.goal).tolerance_m = 0.5;
    problem.planner.max_iterations = 300;
    SolveOptions options;
    options.stop_at_first_solution = true;
    const std::shared_ptr<const FlightModel> flight_model = make_flight_model(problem);
    const planning::PlannerModel model{problem.planner.variant, flight_model, flight_model->make_map(problem.bounds)};
    planning::ProblemWorlds worlds(problem, model, options);
    std::vector<std::optional<std::size_t>> named;
    planning::GoalSequence sequence(problem, model, options, {}, 0);
    while (const auto part = sequence.next()) {
        // The way to the first goal is good in the nominal world, and it stays so.
        planning::ProblemWorlds* survived = part->before->goals.empty() ? nullptr : &worlds;
        planning::SearchResult result =
            planning::search_goal(part->problem, problem, model, *part->before, {survived}, part->options);
        if (survived != nullptr) {
            named.push_back(result.weak_goal);
        }
        sequence.add(std::move(result));
    }
    CHECK(std::move(sequence).result().found.status == Status::approximate);
    REQUIRE_FALSE(named.empty());
    CHECK(named.front() == std::optional<std::size_t>(0));
}

TEST_CASE("A plan that ends at the first of two goals has no certificate") {
    Problem problem = uncertain_problem();
    problem.goals_before = {tip_goal(-1, 4.2)};
    problem.goals_before[0].hold_s = 1;
    add_wall_with_slit(problem, 1.5);  // the second goal is behind it
    problem.planner.max_iterations = 60;
    const Solution solution = solve(problem);
    CHECK(solution.status == Status::approximate);
    CHECK(solution.execution->goals[0].error_m < 0.1);
    CHECK_FALSE(solution.certificate);
}

TEST_CASE("Without uncertainty no plan has a certificate, and knobs of worlds change nothing") {
    Problem problem = ceiling_problem();
    const Solution plain = solve(problem);
    CHECK_FALSE(plain.certificate);
    problem.planner.worlds = 3;
    CHECK(same_bytes(*solve(problem).plan, *plain.plan));
}

TEST_CASE("A plan that only works in the nominal world is approximate, with the share of worlds in which it fails") {
    Problem problem = uncertain_problem();
    problem.planner.worlds = 1;
    problem.planner.max_failure_probability = 0.001;
    test::end_effector(problem.goal).tolerance_m = 0.03;
    problem.uncertainty->position_bias_m = Spread::of_sd(0.03);
    const Solution solution = solve(problem);
    CHECK(solution.status == Status::approximate);
    REQUIRE(solution.certificate);
    CHECK_FALSE(solution.certificate->is_given);
    CHECK(solution.certificate->failures > CertificateTest::most_failures);
    CHECK(solution.certificate->causes.contains("goal_missed"));
    CHECK(solution.certificate->worst.front().world > 0);
    CHECK(solution.certificate->worst.front().outcome == Outcome::goal_missed);
    CHECK(solution.plan.has_value());
}

TEST_CASE("An uncertainty so wide that the vehicle cannot even hover at its start is said so at once") {
    Problem problem = uncertain_problem();
    problem.robot.rotors.time_constant_s = 0.02;
    problem.uncertainty->rotor_time_constant_s = Spread::over(0.02, 0.9);
    const std::string error = error_of([&] { static_cast<void>(solve(problem)); });
    CHECK_THAT(error, Catch::Contains("uncertainty") && Catch::Contains("cannot hover at its start"));
}

TEST_CASE("Remedies are changes that were tried: what helps got a certificate, and nothing else is said to") {
    Problem problem = uncertain_problem();
    problem.uncertainty->position_bias_m = Spread::of_sd(0.03);  // against a tolerance of 10 cm
    problem.planner.max_failure_probability = 0.02;
    std::vector<std::string> told;
    const std::vector<Remedy> remedies =
        try_remedies(problem, {}, 20, [&told](const Remedy& remedy) { told.push_back(remedy.change); });
    REQUIRE(remedies.size() == told.size());
    CHECK(remedies.size() >= 6);
    for (std::size_t i = 0; i < remedies.size(); ++i) {
        const Remedy& remedy = remedies[i];
        CHECK(remedy.change == told[i]);
        CHECK(remedy.helps == (remedy.certificate && remedy.certificate->is_given));
        CHECK((remedy.error.empty() || !remedy.helps));
    }
    const auto named = [&](std::string_view part) {
        return *std::find_if(remedies.begin(), remedies.end(),
                             [part](const Remedy& remedy) { return remedy.change.find(part) != std::string::npos; });
    };
    CHECK(named("known twice as well").helps);
}

TEST_CASE("A remedy that cannot be planned says why, and who wants no more gets those tried so far") {
    Problem problem = uncertain_problem();
    problem.goal = configuration_goal(3, 0.55);  // with the least height of 0.5 m
    problem.planner.max_iterations = 1;
    std::stop_source stop;
    SolveOptions options;
    options.stop = stop.get_token();
    const auto remedies = try_remedies(problem, options, 10, [&stop](const Remedy& remedy) {
        if (remedy.change == "the goal 0.2 m lower") {
            stop.request_stop();
        }
    });
    REQUIRE(remedies.size() == 2);
    CHECK_THAT(remedies[1].error, Catch::Contains("goal"));
    CHECK_FALSE(remedies[1].helps);

    problem.goals_before = {problem.goal};
    problem.goal = configuration_goal(3, 2);
    std::stop_source after_one;
    options.stop = after_one.get_token();
    const auto of_several = try_remedies(problem, options, 10, [&](const Remedy&) { after_one.request_stop(); });
    REQUIRE(of_several.size() == 1);
    CHECK(of_several[0].change == "all goals 0.1 m lower");

    problem.targets = {problem.goals_before.front(), std::exchange(problem.goal, {})};
    problem.goals_before.clear();
    std::stop_source after_two;
    options.stop = after_two.get_token();
    const auto of_targets = try_remedies(problem, options, 10, [&](const Remedy& remedy) {
        if (remedy.change == "all goals 0.2 m lower") {
            after_two.request_stop();
        }
    });
    REQUIRE(of_targets.size() == 2);
    CHECK_THAT(of_targets[1].error, Catch::StartsWith("goal.in_any_order[0].configuration.z_m is 0.35"));
}

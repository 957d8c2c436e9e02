#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "../support/error_of.hpp"
#include "../support/same_bytes.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/planner.hpp"
#include "downwash/simulation/execution.hpp"

using namespace downwash;

namespace {

/// A flight of 7 m between ground and ceiling to a place in the middle of the air.
Problem long_flight() {
    Problem problem = test::with_place(4, 2.5);
    problem.bounds = {-6, 6, 0.5, 5};
    problem.start.at[plane::z] = 2.5;
    problem.planner.max_iterations = 300;
    return problem;
}

ReplanOptions iterations(std::uint64_t number) {
    ReplanOptions options;
    options.max_iterations = number;
    return options;
}

/// The vehicle in the middle of the planner's plan.
Start midway(const Planner& planner, std::int64_t& tick) {
    tick = planner.plan()->reference.back().tick / 2;
    return planner.predicted(planner.problem().start, *planner.plan(), tick);
}

Execution flown(const Planner& planner, const Answer& answer) {
    return execute(planner.model(), start_state(planner.model(), planner.problem().start), answer.plan.reference,
                   goals_of(planner.problem()), true);
}

}  // namespace

TEST_CASE("a vehicle in the middle of a flight flies on from its start as it would have flown") {
    Planner planner(long_flight());
    REQUIRE(planner.solve().status == Status::solved);
    const Plan plan = *planner.plan();
    const FlightModel& model = planner.model();
    const FlightState start = start_state(model, planner.problem().start);
    // At a knot: in between the quintic that is left is the same but for its last bits.
    const std::size_t knot = plan.reference.size() / 2;
    const std::int64_t tick = plan.reference[knot].tick;
    FlightState there = start;
    REQUIRE(fly_along(model, planner.map(), plan, tick, there));
    const Start from = start_of(model, there, plan.reference[knot].point);
    const FlightState again = start_state(model, from);
    CHECK(std::memcmp(&again.plant.q, &there.plant.q, sizeof(there.plant.q)) == 0);
    CHECK(std::memcmp(&again.plant.u, &there.plant.u, sizeof(there.plant.u)) == 0);
    CHECK(std::memcmp(&again.plant.thrust_n, &there.plant.thrust_n, sizeof(there.plant.thrust_n)) == 0);
    CHECK(std::memcmp(&again.memory, &there.memory, sizeof(there.memory)) == 0);

    const std::int64_t rest = plan.reference.back().tick - tick;
    FlightState whole = start;
    FlightState continued = again;
    REQUIRE(fly_along(model, planner.map(), plan, tick + rest, whole));
    REQUIRE(fly_along(model, planner.map(), plan.rest_after(tick), rest, continued));
    CHECK(std::memcmp(&whole.plant.q, &continued.plant.q, sizeof(whole.plant.q)) == 0);
    // A vehicle that forgot what its controller knows flies another way.
    Start forgetful = from;
    forgetful.controller_memory.clear();
    FlightState other = start_state(model, forgetful);
    REQUIRE(fly_along(model, planner.map(), plan.rest_after(tick), rest, other));
    CHECK(std::memcmp(&whole.plant.q, &other.plant.q, sizeof(whole.plant.q)) != 0);
}

TEST_CASE("nothing has changed: a stop, then the last plan, then one that is no more expensive") {
    Planner planner(long_flight());
    REQUIRE(planner.solve().status == Status::solved);
    std::int64_t tick = 0;
    const Start here = midway(planner, tick);
    std::vector<Advice> advice;
    std::vector<double> costs;
    ReplanOptions options = iterations(200);
    options.on_answer = [&](const Answer& answer) {
        advice.push_back(answer.advice);
        costs.push_back(answer.cost);
    };
    const Answer answer = planner.replan(here, tick, {}, options);
    REQUIRE(advice.size() >= 2);
    CHECK(advice[0] == Advice::stop);
    CHECK(advice[1] == Advice::keep);
    CHECK(std::is_sorted(costs.rbegin(), costs.rend() - 1));
    CHECK(flown(planner, answer).outcome == Outcome::ok);
    REQUIRE(planner.latest());
    CHECK(test::same_bytes(planner.latest()->plan, answer.plan));
}

TEST_CASE("a plan around what came into the way is safe, and the same on any number of threads") {
    std::vector<Answer> answers;
    for (const int threads : {1, 2}) {
        SolveOptions with_threads;
        with_threads.threads = threads;
        Planner planner(long_flight(), with_threads);
        REQUIRE(planner.solve().status == Status::solved);
        std::int64_t tick = 0;
        const Start here = midway(planner, tick);
        SceneChange change;
        change.put.push_back(test::box("block", {0.5, 3, 3}, {2.2, 0, 1.5}));
        answers.push_back(planner.replan(here, tick, change, iterations(300)));
        REQUIRE(answers.back().advice == Advice::follow);
        const Execution flight = flown(planner, answers.back());
        CHECK(flight.outcome == Outcome::ok);
        CHECK(flight.min_clearance_m >= planner.problem().planner.safety_margin_m);
        CHECK(answers.back().cost == Approx(cost_of(flight, planner.problem().planner.objective)));
        CHECK(test::same_bytes(*planner.plan(), answers.back().plan));
    }
    CHECK(test::same_bytes(answers[0].plan, answers[1].plan));
}

TEST_CASE("where nothing but a stop is safe it stops, and where nothing is it says so") {
    const double room_m = GENERATE(3.0, 1.1);
    CAPTURE(room_m);
    Problem problem = long_flight();
    problem.motion.max_speed_m_s = 1.5;
    Planner planner(problem);
    REQUIRE(planner.solve().status == Status::solved);
    std::int64_t tick = 0;
    const Start here = midway(planner, tick);
    SceneChange change;  // a wall from the ground to the ceiling
    change.put.push_back(test::box("wall", {0.4, 6, 4.9}, {here.at[plane::x] + room_m + 0.2, 0, 2.5}));
    const Answer answer = planner.replan(here, tick, change, iterations(100));
    Goal anywhere = test::configuration_goal(answer.plan.last()[plane::x], answer.plan.last()[plane::z]);
    test::configuration(anywhere).tolerance_m = 1;
    const Execution flight =
        execute(planner.model(), start_state(planner.model(), here), answer.plan.reference, anywhere, true);
    if (room_m > 2) {
        CHECK(answer.advice == Advice::stop);
        CHECK(flight.outcome == Outcome::ok);
        CHECK_FALSE(planner.plan());
    } else {
        CHECK(answer.advice == Advice::none);
        CHECK(flight.outcome == Outcome::collision);
    }
}

TEST_CASE("a change that is wrong changes nothing") {
    Planner planner(long_flight());
    REQUIRE(planner.solve().status == Status::solved);
    const Plan plan = *planner.plan();
    std::int64_t tick = 0;
    const Start here = midway(planner, tick);
    SceneChange change;
    change.put.push_back(test::box("block", {0.5, 3, 3}, {2.2, 0, 1.5}));
    change.removed.emplace_back("walkway");
    const std::vector<KeyError> errors = test::errors_of([&] { return planner.replan(here, tick, change); });
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].message.find("no obstacle 'walkway'") != std::string::npos);
    change.removed.clear();
    change.put[0].shape = Box{{0.5, -1, 3}};
    CHECK_THROWS_AS(planner.replan(here, tick, change), InputError);
    CHECK(planner.problem().obstacles.size() == long_flight().obstacles.size());
    CHECK(test::same_bytes(*planner.plan(), plan));
    Start misfit = here;
    misfit.controller_memory.pop_back();
    CHECK_THROWS_AS(planner.replan(misfit, tick, {}), InputError);
    Start unknown = here;
    unknown.velocity[plane::x] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(planner.replan(unknown, tick, {}), InputError);
    CHECK(test::same_bytes(*planner.plan(), plan));
    // However fast the vehicle is said to be, there is an answer.
    Start runaway = here;
    runaway.reference->velocity[0] = 1e4;
    CHECK(planner.replan(runaway, tick, {}, iterations(10)).advice == Advice::none);
}

TEST_CASE("obstacles that went, and goals that moved, are planned for") {
    Problem problem = long_flight();
    problem.obstacles.push_back(test::box("block", {0.5, 3, 3}, {1, 0, 1.5}));
    Planner planner(problem);
    REQUIRE(planner.solve().status == Status::solved);
    SceneChange change;
    change.removed.emplace_back("block");
    const Answer shorter = planner.replan(problem.start, 0, change, iterations(300));
    REQUIRE(shorter.advice == Advice::follow);
    CHECK(shorter.cost < planner.solve().execution_cost * 1.05);
    SceneChange goal;
    goal.goal = test::configuration_goal(-1, 3);
    std::int64_t tick = 0;
    const Start here = midway(planner, tick);
    const Answer elsewhere = planner.replan(here, tick, goal, iterations(300));
    REQUIRE(elsewhere.advice == Advice::follow);
    CHECK(std::abs(elsewhere.plan.last()[plane::x] + 1) < 0.2);
}

TEST_CASE("goals that were visited are not visited again") {
    Problem problem = long_flight();
    problem.goals_before.push_back(test::configuration_goal(-1, 2.5));
    problem.goals_before.back().hold_s = 1;
    Planner planner(problem);
    REQUIRE(planner.solve().status == Status::solved);
    const Plan plan = *planner.plan();
    const std::int64_t hover = plan.reference[hover_ends(planner.model(), plan.reference, goals_of(problem))[0]].tick;
    const Start here = planner.predicted(problem.start, plan, hover + 50);
    const Answer answer = planner.replan(here, hover + 50, {}, iterations(100));
    CHECK(planner.problem().goals_before.empty());
    CHECK(answer.advice != Advice::none);
    CHECK(flown(planner, answer).outcome == Outcome::ok);
}

TEST_CASE("another thread sees the answers as they come") {
    Planner planner(long_flight());
    REQUIRE(planner.solve().status == Status::solved);
    std::int64_t tick = 0;
    const Start here = midway(planner, tick);
    std::atomic<bool> is_over = false;
    std::size_t seen = 0;
    std::thread watcher([&] {
        while (!is_over) {
            if (const auto answer = planner.latest(); answer && !answer->plan.reference.empty()) {
                ++seen;
            }
            std::this_thread::yield();
        }
    });
    planner.replan(here, tick, {}, iterations(100));
    is_over = true;
    watcher.join();
    CHECK(planner.latest());
}

TEST_CASE("in worlds a plan with a certificate replaces one that was kept, flown in worlds that no search has seen") {
    Problem problem = long_flight();
    problem.uncertainty.emplace();
    problem.uncertainty->mass_scale = Spread::of_sd(0.01);
    problem.planner.worlds = 3;
    problem.planner.max_failure_probability = 0.2;
    Planner planner(problem);
    const Solution first = planner.solve();
    REQUIRE(first.status == Status::solved);
    std::int64_t tick = 0;
    const Start here = midway(planner, tick);
    std::vector<Advice> advice;
    ReplanOptions options = iterations(300);
    options.on_answer = [&](const Answer& answer) { advice.push_back(answer.advice); };
    const Answer answer = planner.replan(here, tick, {}, options);
    REQUIRE(std::find(advice.begin(), advice.end(), Advice::keep) != advice.end());
    REQUIRE(answer.advice == Advice::follow);
    REQUIRE(answer.solution);
    CHECK(answer.solution->certificate->is_given);
    CHECK(answer.solution->seed != first.seed);
    CHECK(planner.replan(here, 0, {}, iterations(300)).solution->seed != answer.solution->seed);
}

TEST_CASE("an energy budget is for the first plan: replanning does not know what is left of it") {
    Problem problem = long_flight();
    problem.targets = {problem.goal, test::configuration_goal(-1, 2.5)};
    problem.goal = {};
    problem.planner.max_iterations = 600;
    problem.energy_budget_j = 1e6;
    Planner planner(problem);
    REQUIRE(planner.solve().status == Status::solved);
    std::int64_t tick = 0;
    const Start here = midway(planner, tick);
    SceneChange change;
    change.put.push_back(test::box("pebble", {0.1, 0.1, 0.1}, {0, 3, 0.05}));
    const Answer answer = planner.replan(here, tick, change, iterations(100));
    CHECK((answer.advice == Advice::keep || answer.advice == Advice::follow));
    CHECK(flown(planner, answer).outcome == Outcome::ok);
}

TEST_CASE("obstacles without a name come beside all others, and none is named by nothing") {
    Problem problem = long_flight();
    problem.obstacles.push_back(test::box("", {0.1, 0.1, 0.1}, {-5, 3, 0.05}));
    Planner planner(problem);
    SceneChange change;
    change.put.push_back(test::box("", {0.1, 0.1, 0.1}, {0, 3, 0.05}));
    change.put.push_back(test::box("", {0.1, 0.1, 0.1}, {1, 3, 0.05}));
    static_cast<void>(planner.replan(problem.start, 0, change, iterations(1)));
    CHECK(planner.problem().obstacles.size() == problem.obstacles.size() + 2);
    SceneChange none;
    none.removed.emplace_back();
    CHECK_THROWS_AS(planner.replan(problem.start, 0, none, iterations(1)), InputError);
    SceneChange twice;
    twice.put.push_back(test::box("stone", {0.1, 0.1, 0.1}, {2, 3, 0.05}));
    twice.put.push_back(test::box("stone", {0.1, 0.1, 0.1}, {3, 3, 0.05}));
    CHECK_THROWS_AS(planner.replan(problem.start, 0, twice, iterations(1)), InputError);
    CHECK(planner.problem().obstacles.size() == problem.obstacles.size() + 2);
}

TEST_CASE("limits of replanning have those of a search, and a stop ends it once it is known how to stop") {
    Planner planner(long_flight());
    const Start start = planner.problem().start;
    ReplanOptions options;
    options.time_limit_s = 2e6;
    CHECK_THROWS_AS(planner.replan(start, 0, {}, options), InputError);
    options.time_limit_s = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(planner.replan(start, 0, {}, options), InputError);
    CHECK_THROWS_AS(planner.replan(start, 0, {}, iterations(2'000'000'000'000'000)), InputError);
    std::stop_source stop;
    stop.request_stop();
    ReplanOptions stopped = iterations(100);
    stopped.stop = stop.get_token();
    CHECK(planner.replan(start, 0, {}, stopped).advice == Advice::stop);
    CHECK(planner.map() == nullptr);
    // With a map of the scene before, a stopped call leaves the new one to the next.
    REQUIRE(planner.solve().status == Status::solved);
    SceneChange change;
    change.put.push_back(test::box("block", {0.5, 3, 3}, {2.2, 0, 1.5}));
    CHECK(planner.replan(start, 0, change, stopped).advice == Advice::stop);
    CHECK(planner.solve().status == Status::solved);
    CHECK(planner.model().matches(*planner.map(), planner.problem().bounds));
}

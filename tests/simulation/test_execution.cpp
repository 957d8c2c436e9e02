#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/simulation/execution.hpp"

using namespace downwash;

namespace {

std::vector<ReferenceKnot> from_start(const Problem& problem, const Configuration& to, std::int64_t ticks) {
    return {{0, at_rest(problem.start.at)}, {ticks, at_rest(to)}};
}

Execution flown(const Problem& problem, const std::vector<ReferenceKnot>& knots, bool aero = true) {
    const auto model = make_flight_model(problem);
    return execute(*model, start_state(*model, problem.start), knots, problem.goal, aero);
}

}  // namespace

TEST_CASE("a plan far from surfaces ends at its goal and logs a row per tick, hold included") {
    const Problem problem = test::with_place(2, 2.5);
    const Execution e = flown(problem, from_start(problem, {2, 2.5, 1}, 1300));
    CHECK(e.outcome == Outcome::ok);
    CHECK(e.goal_error_m < 0.02);
    CHECK(e.rows.size() == 1300 + 500 + 1);
    CHECK(e.duration_s == Approx(18.0));
    CHECK(e.rows.back().t_s == e.duration_s);
    CHECK(e.max_saturation < 1);
    CHECK(e.max_tracking_error_m < 0.1);
    // Its energy is the integral of its power.
    double integral_j = 0;
    for (std::size_t i = 1; i < e.rows.size(); ++i) {
        integral_j += e.rows[i - 1].power_w * 0.01;
    }
    CHECK(e.energy_j == Approx(integral_j).epsilon(1e-4));
    CHECK(e.rows.back().energy_j == e.energy_j);
    // Without obstacles the clearance is infinite and nothing collides.
    Problem open = test::with_place(2, 2.5);
    open.obstacles.clear();
    const Execution free = flown(open, from_start(open, {2, 2.5, 1}, 1300));
    CHECK(free.outcome == Outcome::ok);
    CHECK(free.min_clearance_m == std::numeric_limits<double>::infinity());
}

TEST_CASE("an execution that is over before its end is no execution") {
    const Problem problem = test::with_place(2, 2.5);
    const auto model = make_flight_model(problem);
    int questions = 0;
    const auto after = [&](int count) {
        questions = 0;
        return [&questions, count] { return ++questions > count; };
    };
    const auto fly_until = [&](const StopCondition& is_over) {
        return execute(*model, start_state(*model, problem.start), from_start(problem, {2, 2.5, 1}, 1300),
                       std::span(&problem.goal, 1), true, {}, is_over);
    };
    CHECK_THROWS_AS(fly_until(after(2)), WorkStopped);
    CHECK(questions == 3);
    CHECK(fly_until(after(100000)).outcome == Outcome::ok);
    CHECK(questions > 100);
}

TEST_CASE("an executed flight counts its ticks in space that no sensor saw") {
    Problem problem = test::with_place(2, 2.5);
    const auto knots = from_start(problem, {2, 2.5, 1}, 1300);
    CHECK_FALSE(flown(problem, knots).unseen_share);
    // A cube far away; beyond x = 0 nothing was seen.
    OccupancyTree tree{1, {{{0, 50.5, 0.5}, 1}}, {{{10, 0, 5}, {20, 8, 20}}}, {}, 0.5, true};
    const auto with_octree = [&](UnknownSpace unknown) {
        Problem scanned = problem;
        scanned.obstacles.push_back(
            {"scan", Octomap{"", std::make_shared<const OccupancyTree>(tree), unknown}, {}, {}});
        return flown(scanned, knots);
    };
    const Execution free = with_octree(UnknownSpace::free);
    CHECK(free.outcome == Outcome::ok);
    const double reach_m = make_flight_model(problem)->collisions().robot_reach_m();
    const auto beyond = [&](double x_m) {
        const auto count =
            std::count_if(free.rows.begin(), free.rows.end(), [x_m](const FlightRow& row) { return row.q[0] >= x_m; });
        return static_cast<double>(count) / static_cast<double>(free.rows.size());
    };
    REQUIRE(free.unseen_share);
    CHECK(*free.unseen_share >= beyond(0));  // the centre is in it, or another part of the robot
    CHECK(*free.unseen_share <= beyond(-reach_m));
    CHECK(beyond(0) > 0.3);
    CHECK(beyond(-reach_m) < 0.95);
    const Execution filled = with_octree(UnknownSpace::occupied);
    CHECK(filled.outcome != Outcome::ok);
    CHECK_FALSE(filled.unseen_share);
    tree.has_free_leaf = false;
    CHECK_FALSE(with_octree(UnknownSpace::free).unseen_share);
}

TEST_CASE("a reference through a wall ends in a collision, or before it where a rotor disc leaves the flyable area") {
    Problem problem = test::walled_problem();
    problem.goal = test::configuration_goal(2, 2);
    const auto through = from_start(problem, {2, 2, 1.57}, 1300);
    const Execution hit = flown(problem, through, false);
    CHECK(hit.outcome == Outcome::collision);
    CHECK(hit.rows.back().clearance_m <= 0);
    for (std::size_t i = 0; i + 1 < hit.rows.size(); ++i) {
        REQUIRE(hit.rows[i].clearance_m > 0);
    }
    CHECK(hit.min_clearance_m == hit.rows.back().clearance_m);
    CHECK(hit.duration_s < 18);

    const Execution near = flown(problem, through);
    CHECK(near.outcome == Outcome::left_flyable_area);
    CHECK(near.rows.back().clearance_m > 0);
    CHECK(near.rows.back().clearance_m < 0.3 * problem.robot.rotors.radius_m + 0.01);
}

TEST_CASE("a part of a flight goes as it does in the whole flight, up to where it touches something") {
    Problem problem = test::walled_problem();
    problem.goal = test::configuration_goal(2, 2);
    const auto model = make_flight_model(problem);
    const auto through = from_start(problem, {2, 2, 1.57}, 1300);
    const Plan parts = Plan{through, model->tick().tick_s}.divided(100);
    const bool aero = GENERATE(true, false);
    const Execution whole = flown(problem, through, aero);
    const FlightState start = start_state(*model, problem.start);
    const FlightPart all = execute_part(*model, start, parts.segments(), aero, {});
    CHECK(outcome_of(all.rejection) == whole.outcome);
    CHECK(all.min_clearance_m == Approx(whole.min_clearance_m).margin(1e-9));
    const FlightPart begin = execute_part(*model, start, std::vector{parts.segment_to(1)}, aero, {});
    CHECK(begin.rejection == Rejection::none);
    CHECK(begin.min_clearance_m ==
          Approx(std::min_element(whole.rows.begin(), whole.rows.begin() + 101,
                                  [](const FlightRow& a, const FlightRow& b) { return a.clearance_m < b.clearance_m; })
                     ->clearance_m)
              .margin(1e-9));
    CHECK_THROWS_AS(execute_part(*model, start, parts.segments(), aero, {}, [] { return true; }), WorkStopped);
}

TEST_CASE("a plan that ends elsewhere misses the goal, and so does one that nothing can follow") {
    const Problem problem = test::with_place(2, 2.5);
    const Execution elsewhere = flown(problem, from_start(problem, {1.5, 2.5, 1}, 1300));
    CHECK(elsewhere.outcome == Outcome::goal_missed);
    CHECK(elsewhere.goal_error_m == Approx(0.5).margin(0.02));
    const Execution too_fast = flown(problem, from_start(problem, {2, 2.5, 1}, 60));
    CHECK(too_fast.outcome != Outcome::ok);
    CHECK(too_fast.max_saturation > 1);
}

TEST_CASE("a ceiling pulls a hovering vehicle in that stays away from it without surface effects") {
    Problem problem = test::with_place(-4, 4.7);
    problem.start.at[plane::z] = 4.7;
    problem.goal.hold_s = 20;
    const std::vector<ReferenceKnot> hover{{0, at_rest({-4, 4.7, problem.start.at[plane::arm]})}};
    const Execution blind = flown(problem, hover, false);
    CHECK(blind.outcome == Outcome::ok);
    CHECK_FALSE(blind.aero);
    const Execution real = flown(problem, hover, true);
    CHECK(real.outcome != Outcome::ok);
    CHECK(real.rows.back().q[1] > 4.7);
    CHECK(real.rows.front().rotor_factor[0] > 1.05);
}

TEST_CASE("surfaces save energy where the vehicle can hold near them") {
    Problem problem = test::with_place(-4, 0.7);
    problem.start.at[plane::z] = 0.7;
    problem.start.at[plane::arm] = 0;
    const std::vector<ReferenceKnot> hover{{0, at_rest({-4, 0.7, 0})}};
    const Execution in_effect = flown(problem, hover, true);
    const Execution out_of_effect = flown(problem, hover, false);
    REQUIRE(in_effect.outcome == Outcome::ok);
    CHECK(in_effect.energy_j < out_of_effect.energy_j);
}

TEST_CASE("the flight through the map stays beside the flight with direct aerodynamics") {
    const Problem problem = test::with_place(2, 4.0);
    const auto model = make_flight_model(problem);
    const auto map = model->make_map(problem.bounds);
    FlightRules rules;
    rules.bounds = problem.bounds;
    FlightState state = start_state(*model, problem.start);
    const auto knots = from_start(problem, {2, 4.0, 1}, 1500);
    const SegmentFlight flight =
        fly(*model, map.get(), rules, ReferenceSegment(knots[0].point, knots[1].point, 1500, 0.01), state);
    CHECK(flight.rejection == Rejection::none);
    CHECK(flight.ticks == 1500);
    const Execution e = flown(problem, knots);
    for (int i = 0; i < 4; ++i) {
        CHECK(state.plant.q[i] == Approx(e.rows[1500].q[i]).margin(2e-3));
    }
}

TEST_CASE("goals on the way count as met only when the reference stands at them for their hold, in their order") {
    const Problem problem = test::with_place(-2, 2);  // from (-4, 2)
    const auto model = make_flight_model(problem);
    Goal stop = problem.goal;
    test::configuration(stop).x_m = -3;
    stop.hold_s = 2;
    const double down = problem.start.at[plane::arm];
    const ReferencePoint start = at_rest({-4, 2, down}), middle = at_rest({-3, 2, down}), end = at_rest({-2, 2, down});
    const auto flown_by = [&](const std::vector<ReferenceKnot>& knots, const std::vector<Goal>& goals) {
        return execute(*model, start_state(*model, problem.start), knots, goals, true);
    };
    const std::vector<ReferenceKnot> held{{0, start}, {400, middle}, {600, middle}, {1000, end}};

    const Execution good = flown_by(held, {stop, problem.goal});
    CHECK(good.outcome == Outcome::ok);
    REQUIRE(good.goals.size() == 2);
    CHECK(good.goals[0].is_met);
    CHECK(good.goals[1].is_met);
    CHECK(good.goal_error_m == std::max(good.goals[0].error_m, good.goals[1].error_m));
    CHECK(good.duration_s == Approx(15));

    const std::vector<ReferenceKnot> hasty{{0, start}, {400, middle}, {599, middle}, {1000, end}};
    const Execution early = flown_by(hasty, {stop, problem.goal});
    CHECK(early.outcome == Outcome::goal_missed);
    CHECK_FALSE(early.goals[0].is_met);
    CHECK_FALSE(early.goals[1].is_met);                       // it is not its turn yet
    CHECK(early.goals[0].error_m == Approx(1).margin(0.02));  // measured where the flight ended

    const Execution reversed = flown_by(held, {problem.goal, stop});
    CHECK(reversed.outcome == Outcome::goal_missed);
    CHECK(reversed.goals[0].is_met);  // after the last knot
    CHECK_FALSE(reversed.goals[1].is_met);

    // Two goals at one place need two holds.
    CHECK(flown_by(held, {stop, stop, problem.goal}).outcome == Outcome::goal_missed);
    const std::vector<ReferenceKnot> twice{{0, start}, {400, middle}, {600, middle}, {800, middle}, {1200, end}};
    CHECK(flown_by(twice, {stop, stop, problem.goal}).outcome == Outcome::ok);

    // A plan that ends at the first goal holds it, for as long as that one asks.
    const Execution first_only = flown_by({{0, start}, {400, middle}}, {stop, problem.goal});
    CHECK(first_only.outcome == Outcome::goal_missed);
    CHECK(first_only.goals[0].is_met);
    CHECK_FALSE(first_only.goals[1].is_met);
    CHECK(first_only.goals[1].error_m == Approx(1).margin(0.02));
    CHECK(first_only.duration_s == Approx(6));
}

TEST_CASE("a goal is met only by a vehicle that stays within its tolerance for the last second") {
    Problem problem = test::with_place(-3, 2);  // from (-4, 2)
    test::configuration(problem.goal).tolerance_m = 0.05;
    const std::vector<ReferenceKnot> quick = from_start(problem, {-3, 2, problem.start.at[plane::arm]}, 200);
    const auto error_m = [](const FlightRow& row) { return std::hypot(row.q[0] + 3, row.q[1] - 2); };
    problem.goal.hold_s = 0.5;
    const Execution early = flown(problem, quick);
    REQUIRE(error_m(early.rows.back()) < 0.05);
    REQUIRE(std::hypot(early.rows.back().u[0], early.rows.back().u[1]) < 0.1);
    REQUIRE(error_m(early.rows[early.rows.size() - 1 - 95]) > 0.05);
    CHECK(early.outcome == Outcome::goal_missed);
    CHECK_FALSE(early.goals[0].is_met);
    CHECK(early.goal_error_m > 0.05);
    problem.goal.hold_s = 4;
    CHECK(flown(problem, quick).outcome == Outcome::ok);
}

TEST_CASE("FCL decides contact in an executed flight, whatever computes clearances") {
    // The vehicle's box reaches 0.06 m down. Five nanometres above the ground it is in contact to us, but not to FCL.
    const auto at_height = [](double z_m) { return PlanarPose{0, 0.06 + z_m, 0, -test::quarter_turn}; };
    const PlanarPose above = at_height(5e-9), in = at_height(-1e-3), free = at_height(1e-3);
    const auto model = make_flight_model(test::with_place(2, 2.5));
    CHECK(model->collisions().clearance_m(above) <= 0);
    CHECK(model->executed_clearance_m(above) > 0);
    CHECK(model->executed_clearance_m(above) < 1e-7);
    CHECK(model->executed_clearance_m(in) <= 0);
    CHECK(model->executed_clearance_m(free) == model->collisions().clearance_m(free));
    CHECK(model->executed_clearance_m({0, std::nan(""), 0, 0}) <= 0);
}

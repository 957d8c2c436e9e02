#include <ompl/control/spaces/RealVectorControlSpace.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/flight_fixture.hpp"
#include "downwash/ompl_planners/control_planners.hpp"
#include "downwash/ompl_planners/flight_controls.hpp"

using namespace downwash;
using planning::Closing;
using planning::FlightPoint;

namespace {

struct Fixture : test::FlightFixture {
    using FlightFixture::FlightFixture;

    planning::SteeredFlights steered{flights};
};

/// The vehicle hanging still 0.3 m away from the goal (tip at (3, 4.8), arm up at 60 degrees).
constexpr Configuration near_goal{3 - 0.6 - 0.3, 4.8 - 1.2 * 0.8660254037844386, -1.0471975511965976};

constexpr double forward[3] = {1, 0, 0};

}  // namespace

TEST_CASE("a step is a pure function, and flies as the same segment does") {
    const Fixture f;
    const double obliquely[3] = {0.8, 0.1, 0.3};
    const FlightPoint start = f.steered.start();
    const FlightPoint a = f.steered.stepped(f.steered.stepped(start, obliquely), obliquely);
    const FlightPoint b = f.steered.stepped(f.steered.stepped(start, obliquely), obliquely);
    REQUIRE(a.is_valid);
    CHECK(is_same_moment(a, b));
    CHECK(a.cost == b.cost);
    CHECK(a.ticks == 100);

    FlightState state = start.vehicle;
    const FlightPoint middle = f.steered.stepped(start, obliquely);
    for (const auto& [from, to] : {std::pair(start.reference, middle.reference), {middle.reference, a.reference}}) {
        const ReferenceSegment segment(from, to, 50, 0.01);
        CHECK(
            fly(*f.model, f.map.get(), planning::planning_rules(f.task.problem, true, {}), segment, state).rejection ==
            Rejection::none);
    }
    CHECK(is_same(state, a.vehicle));
    CHECK(a.cost == Approx(state.plant.energy_j).epsilon(1e-12));
}

TEST_CASE("a step into an obstacle is rejected and counted") {
    const Fixture f(test::walled_problem());  // a wall at x = 0
    FlightPoint point = planning::resting_at(*f.model, {-1.2, 2, test::quarter_turn});
    int steps = 0;
    while (point.is_valid && steps < 20) {
        point = f.steered.stepped(point, forward);
        ++steps;
    }
    CHECK_FALSE(point.is_valid);
    CHECK(f.flights.statistics().rejected.at("flyable_area") == 1);  // rotors come first
}

TEST_CASE("a step from which the reference could not stop inside the bounds is not flown") {
    const Fixture f;  // x up to 6
    FlightPoint point = planning::resting_at(*f.model, {5.9, 2, test::quarter_turn});
    point = f.steered.stepped(point, forward);
    REQUIRE(point.is_valid);
    const std::uint64_t ticks = f.flights.statistics().ticks;
    point = f.steered.stepped(point, forward);
    CHECK_FALSE(point.is_valid);
    CHECK(point.reference.position[0] < 6.1);
    CHECK(f.flights.statistics().ticks == ticks);
    CHECK(f.flights.statistics().rejected.at("bounds") == 1);
}

TEST_CASE("a moment beyond the longest plan is rejected") {
    const Fixture f;
    FlightPoint point = f.steered.start();
    const double still[3] = {0, 0, 0};
    point.ticks = max_plan_ticks - 50;
    CHECK(f.steered.stepped(point, still).is_valid);
    point.ticks = max_plan_ticks - 49;
    CHECK_FALSE(f.steered.stepped(point, still).is_valid);
    CHECK(f.flights.statistics().rejected.at("too_long") == 1);
}

TEST_CASE("a flight closes from nearby, at rest within the goal, hold included") {
    Problem problem = test::ceiling_problem();
    problem.start.at[plane::x] = near_goal[plane::x];
    problem.start.at[plane::z] = near_goal[plane::z];
    problem.start.at[plane::arm] = near_goal[plane::arm];
    const Fixture f(problem);
    const double upwards[3] = {0.2, 0.05, 0};
    const std::vector<FlightPoint> moments{f.steered.start(), f.steered.stepped(f.steered.start(), upwards)};
    REQUIRE(f.steered.is_worth_closing(moments.back()));
    const std::optional<Closing> end = f.steered.closing(moments.back());
    REQUIRE(end);
    CHECK(meets_goal(f.problem.goal, f.model->tick().plant, end->end));
    CHECK(end->cost == Approx(end->end.plant.energy_j).epsilon(1e-12));
    const Plan plan = f.steered.plan(moments, end);
    REQUIRE(plan.reference.size() == 3);
    CHECK(plan.reference[1].tick == 50);
    CHECK_NOTHROW(f.steered.verify(moments, *end));

    SECTION("the reported flight of that plan is the same flight, to what the map and one step a tick leave out") {
        const Execution flight = execute(*f.model, f.steered.start().vehicle, plan.reference, f.problem.goal, true);
        CHECK(flight.outcome == Outcome::ok);
        CHECK(flight.rows[50].q[0] == Approx(moments.back().vehicle.plant.q[0]).margin(1e-4));
        CHECK(flight.energy_j == Approx(end->cost).epsilon(1e-2));
    }
    SECTION("a vehicle that differs in one bit is noticed") {
        std::vector<FlightPoint> wrong = moments;
        double& remembered = wrong.back().vehicle.memory.number[3];
        remembered = std::nextafter(remembered, 1);
        CHECK_THROWS_AS(f.steered.verify(wrong, *end), std::logic_error);
        Closing wrong_end = *end;
        wrong_end.end.plant.q[2] = std::nextafter(wrong_end.end.plant.q[2], 1);
        CHECK_THROWS_AS(f.steered.verify(moments, wrong_end), std::logic_error);
    }
    SECTION("far away it is not tried") {
        CHECK_FALSE(f.steered.is_worth_closing(planning::resting_at(*f.model, {-4, 2, 1.5})));
    }
}

TEST_CASE("a plan without an end is braked to rest") {
    const Fixture f;
    const double swinging[3] = {1, 0, 0.5};
    std::vector<FlightPoint> moments{f.steered.start()};
    for (int i = 0; i < 4; ++i) {
        moments.push_back(f.steered.stepped(moments.back(), swinging));
    }
    const Plan plan = f.steered.plan(moments, {});
    CHECK(plan.reference.back().point.velocity[0] == 0);
    CHECK(plan.last()[plane::x] == Approx(moments.back().rest[plane::x]));
    CHECK(plan.last()[plane::arm] == Approx(moments.back().rest[plane::arm]));
}

TEST_CASE("OMPL propagates what steps fly, and ends before the step that is rejected") {
    const Fixture f(test::walled_problem());
    planning::Random random(1);
    const auto information = planning::make_flight_information(f.steered, random);
    ompl::base::State* from = information->allocState();
    ompl::base::State* to = information->allocState();
    ompl::control::Control* control = information->allocControl();
    planning::point_of(from) = planning::resting_at(*f.model, {-3, 2, test::quarter_turn});
    std::copy(forward, forward + 3, control->as<ompl::control::RealVectorControlSpace::ControlType>()->values);
    const unsigned int steps = information->propagateWhileValid(from, control, 100, to);
    FlightPoint point = planning::point_of(from);
    for (unsigned int i = 0; i < steps; ++i) {
        point = f.steered.stepped(point, forward);
    }
    CHECK(steps > 5);
    CHECK(steps < 100);
    CHECK(point.is_valid);
    CHECK(is_same_moment(point, planning::point_of(to)));
    CHECK_FALSE(f.steered.stepped(point, forward).is_valid);
    information->freeControl(control);
    information->freeState(to);
    information->freeState(from);
}

TEST_CASE("a discarded plan is counted and each planner goes on to another") {
    for (const char* algorithm : {"rrt", "sst", "kpiece1", "est"}) {
        CAPTURE(algorithm);
        Problem problem = test::ceiling_problem();
        problem.planner.algorithm = algorithm;
        Fixture f(problem);
        planning::Random random(1);
        int asked = 0;
        planning::OmplHooks hooks;
        hooks.is_over = [&](const planning::OmplProgress& now) { return now.iteration >= 20000 || asked >= 3; };
        hooks.accept = [&](const Plan&, double, std::uint64_t) { return ++asked == 3; };
        const auto result = planning::plan_by_controls(f.steered, random, hooks);
        CHECK(asked == 3);
        CHECK(f.flights.statistics().rejected.at("direct_flight") == 2);
        CHECK(result.status == Status::solved);
    }
}

TEST_CASE("when every plan is discarded the nearest flight is approximate, never a solution") {
    Problem problem = test::ceiling_problem();
    problem.planner.algorithm = "rrt";
    Fixture f(problem);
    planning::Random random(1);
    planning::OmplHooks hooks;
    hooks.is_over = [](const planning::OmplProgress& now) { return now.iteration >= 3000; };
    hooks.accept = [](const Plan&, double, std::uint64_t) { return false; };
    const auto result = planning::plan_by_controls(f.steered, random, hooks);
    CHECK(f.flights.statistics().rejected.at("direct_flight") > 0);
    CHECK(result.status == Status::approximate);
    CHECK(result.plan);
    CHECK(result.iterations == 3000);
}

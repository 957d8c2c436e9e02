#include <catch2/catch.hpp>

#include "../support/flight_fixture.hpp"
#include "downwash/search/free_air_cost.hpp"
#include "downwash/search/line_flights.hpp"

using namespace downwash;

namespace {

Problem lines() {
    Problem problem = test::ceiling_problem();
    problem.planner.variant = Variant::mp_arm;
    return problem;
}

struct Fixture : test::FlightFixture {
    explicit Fixture(Problem given = lines()) : FlightFixture(std::move(given)) {}

    /// The flight from rest to rest between two places, with the hover if it is to be judged.
    [[nodiscard]] planning::FleetJob flown(const Configuration& from, const Configuration& to, bool hovers = false) {
        std::vector<FlightLeg> legs{{flights.fastest_segment(at_rest(from), at_rest(to))}};
        if (hovers) {
            legs.push_back(flights.hold_leg(at_rest(to)));
        }
        planning::FleetJob job =
            flights.job({planning::following(*model, at_rest(from), 0)}, 0, legs, hovers ? flights.judged_ticks() : 0);
        flights.fly(std::span(&job, 1));
        return job;
    }
};

}  // namespace

TEST_CASE("a line leads exactly along its reference, with the power of a hover") {
    Fixture f;
    const planning::FleetJob job = f.flown({-4, 2, 0}, {1, 3, 0.5});
    REQUIRE(job.is_accepted());
    const FlightLeg& leg = job.legs().front();
    CHECK(configuration_of(leg.end.plant.q) == Configuration{1, 3, 0.5});
    CHECK(leg.end.plant.q[2] == 0);
    CHECK(leg.end.plant.energy_j == Approx(planning::hover_power_w(*f.model) * leg.segment.duration_s()));
    // The estimate of a motion is that of its reference before it is rounded up to ticks.
    const planning::FreeAirCost cost(f.task);
    CHECK(f.flights.cost_after(0, planning::following(*f.model, at_rest({-4, 2, 0}), 0), leg) ==
          Approx(cost.of_motion({-4, 2, 0}, {1, 3, 0.5})).epsilon(0.01));
    CHECK(leg.flight.length_m == Approx(f.task.space.distance_m({-4, 2, 0}, {1, 3, 0.5})).epsilon(1e-6));
}

TEST_CASE("a line ends where it comes too near to an obstacle or leaves the bounds") {
    Problem problem = lines();
    problem.obstacles.push_back(test::box("post", {0.02, 8, 1}, {0, 0, 2}));
    Fixture f(problem);
    const planning::FleetJob blocked = f.flown({-4, 2, 0}, {4, 2, 0});
    REQUIRE_FALSE(blocked.is_accepted());
    CHECK(blocked.legs().front().flight.rejection == Rejection::collision);
    CHECK(blocked.legs().front().end.plant.q[0] < 0);
    CHECK(f.flown({-4, 3.5, -1.57}, {4, 3.5, -1.57}).is_accepted());
    const planning::FleetJob outside = f.flown({-4, 2, 0}, {-20, 2, 0});
    CHECK(outside.legs().front().flight.rejection == Rejection::bounds);
}

TEST_CASE("a hover on a line is judged by the goal") {
    Fixture f;
    planning::Random random(3);
    const std::optional<Configuration> goal = f.task.space.sample_goal(random);
    REQUIRE(goal);
    const Configuration start = f.problem.start.at;
    CHECK(f.flown(start, f.task.space.seen_from(start, *goal), true).is_accepted());
    const planning::FleetJob beside = f.flown(start, {0, 2, 0}, true);
    CHECK(beside.rejected_leg()->flight.rejection == Rejection::goal_missed);
}

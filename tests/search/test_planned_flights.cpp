#include <catch2/catch.hpp>

#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/search/planned_flights.hpp"

using namespace downwash;
using planning::FlightStatistics;
using test::quarter_turn;

namespace {

/// Flights in free air.
struct Fixture {
    explicit Fixture(Problem given) : problem(std::move(given)) {}

    [[nodiscard]] ReferenceSegment segment(const Configuration& from, const Configuration& to) const {
        return flights.fastest_segment(at_rest(from), at_rest(to));
    }

    Problem problem;
    std::shared_ptr<const FlightModel> model = make_flight_model(problem);
    planning::SearchTask task{problem, *model, nullptr};
    planning::PlannedFlights flights{task};
};

}  // namespace

TEST_CASE("flights of tree and refiner are counted together") {
    FlightStatistics tree;
    tree.edges = 1;
    tree.ticks = 20;
    tree.states_checked = 300;
    tree.rejected = {{"collision", 2}, {"bounds", 0}};
    tree.rejections = 2;
    FlightStatistics refiner;
    refiner.edges = 4;
    refiner.ticks = 50;
    refiner.states_checked = 600;
    refiner.rejected = {{"collision", 3}, {"tracking", 1}};
    refiner.rejections = 4;
    refiner.obstruction = Obstruction{"collision", {1, 2, 3}, 0.5};

    FlightStatistics sum = tree;
    sum += refiner;
    CHECK(sum.edges == 5);
    CHECK(sum.ticks == 70);
    CHECK(sum.states_checked == 900);
    CHECK(sum.rejected == std::map<std::string, std::uint64_t>{{"collision", 5}, {"bounds", 0}, {"tracking", 1}});
    CHECK(sum.rejections == 6);
    REQUIRE(sum.obstruction);
    CHECK(sum.obstruction->goal_distance_m == 0.5);

    // Of two obstructions the one nearer to the goal counts, whichever is added.
    for (const double other_m : {0.2, 0.8}) {
        FlightStatistics other;
        other.obstruction = Obstruction{"bounds", {}, other_m};
        FlightStatistics one_way = sum;
        one_way += other;
        other += sum;
        CHECK(one_way.obstruction->goal_distance_m == std::min(0.5, other_m));
        CHECK(other.obstruction->goal_distance_m == std::min(0.5, other_m));
    }
}

TEST_CASE("of two rejected ways to the goal the one that came nearer is told") {
    // A wall across the way. Level at the height of the goal the upright arm comes nearer than from below, hanging.
    const Configuration goal{3, 3.6, -quarter_turn};
    const Configuration near{-4, 3.6, -quarter_turn};
    const Configuration far{-4, 1, quarter_turn};
    for (const bool near_first : {true, false}) {
        Fixture f(test::walled_problem());
        CHECK_FALSE(f.flights.is_worth_flying(f.segment(near_first ? near : far, goal)));
        const Obstruction first = f.flights.statistics().obstruction.value();
        CHECK_FALSE(f.flights.is_worth_flying(f.segment(near_first ? far : near, goal)));
        const Obstruction& told = f.flights.statistics().obstruction.value();
        CHECK(told.cause == "collision");
        CHECK((told.at == first.at) == near_first);
        CHECK(told.at.z_m == Approx(3.6).margin(1e-9));
        CHECK(f.flights.statistics().rejections == 2);
        CHECK(f.flights.statistics().rejected.at("collision") == 2);
    }
}

TEST_CASE("a way that leads elsewhere obstructs nothing") {
    Fixture f(test::walled_problem());
    CHECK_FALSE(f.flights.is_worth_flying(f.segment({-4, 3, 0}, {2, 2, 0})));
    CHECK(f.flights.statistics().rejections == 1);
    CHECK_FALSE(f.flights.statistics().obstruction);
}

TEST_CASE("a flight that comes nearer than the margin is rejected") {
    // The body's lower side is 0.06 m below its centre, 0.64 m above the ground; the arm points up.
    const Configuration from{-4, 0.7, -quarter_turn};
    const Configuration to{-3.5, 0.7, -quarter_turn};
    const auto rejection_with = [&](double margin_m) {
        Problem problem = test::ceiling_problem();
        problem.planner.safety_margin_m = margin_m;
        problem.start.z_m = from.z_m;
        problem.start.arm_rad = from.arm_rad;
        Fixture f(std::move(problem));
        FlightJob job{f.task.start, {{f.segment(from, to)}}, 0};
        f.flights.fly({&job, 1});
        CHECK(f.flights.statistics().rejected.at("collision") == (job.rejection() == Rejection::collision ? 1 : 0));
        CHECK(f.flights.statistics().edges == 1);
        return job.rejection();
    };
    CHECK(rejection_with(0) == Rejection::none);
    CHECK(rejection_with(0.6) == Rejection::none);
    CHECK(rejection_with(0.7) == Rejection::collision);
}

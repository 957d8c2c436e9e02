#include <catch2/catch.hpp>

#include "../support/single_tick.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/search/flight_point.hpp"
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
        CHECK(told.at[plane::z] == Approx(3.6).margin(1e-9));
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
        problem.start.at[plane::z] = from[plane::z];
        problem.start.at[plane::arm] = from[plane::arm];
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

TEST_CASE("a flight that asks more of the rotors than they have counts up to the allowed saturation, and is clipped") {
    // A hover takes 12.1 N of each rotor, the climb up to 12.7 N.
    const auto flown_with = [](double max_saturation, double max_thrust_n) {
        Problem problem = test::ceiling_problem();
        problem.robot.rotors.max_thrust_n = max_thrust_n;
        problem.planner.max_saturation = max_saturation;
        Fixture f(std::move(problem));
        FlightJob job{f.task.start, {{f.segment({-4, 2, quarter_turn}, {-4, 3, quarter_turn})}}, 0};
        job.start = planning::resting_at(*f.model, {-4, 2, quarter_turn}).vehicle;
        f.flights.fly({&job, 1});
        CHECK(f.flights.statistics().rejected.at("saturation") == (job.rejection() == Rejection::saturation ? 1 : 0));
        return job;
    };
    CHECK(flown_with(1, 28).rejection() == Rejection::none);
    CHECK(flown_with(1, 12.5).rejection() == Rejection::saturation);
    CHECK(flown_with(1.05, 12.5).rejection() == Rejection::saturation);  // the more is asked, the later it is
    // What is flown is what the rotors have, not what was asked: the vehicle arrives late.
    const auto height_m = [&](double max_saturation, double max_thrust_n) {
        const FlightJob job = flown_with(max_saturation, max_thrust_n);
        REQUIRE(job.rejection() == Rejection::none);
        return job.legs.back().end.plant.q[1];
    };
    CHECK(height_m(1, 28) == Approx(3).margin(1e-3));
    CHECK(height_m(1.1, 12.5) < 2.98);
    CHECK(height_m(1.1, 12.5) > 2.9);
    // The allowance rejects less and changes no flight.
    CHECK(height_m(1.1, 12.5) == height_m(3, 12.5));
    CHECK(height_m(3, 28) == height_m(1, 28));
    // Other rules go on to hold: with 12.3 N the vehicle falls behind until it does not follow its reference.
    CHECK(flown_with(20, 12.3).rejection() == Rejection::tracking);
}

TEST_CASE("a flight in which the vehicle turns faster than it may counts as unstable") {
    const auto rejection_with = [](std::optional<double> max_pitch_rate_rad_s) {
        Problem problem = test::ceiling_problem();
        problem.planner.max_pitch_rate_rad_s = max_pitch_rate_rad_s;
        Fixture f(std::move(problem));
        FlightJob job{f.task.start, {{f.segment({-4, 2, quarter_turn}, {-2, 2, quarter_turn})}}, 0};
        f.flights.fly({&job, 1});
        CHECK(f.flights.statistics().rejected.at("unstable") == (job.rejection() == Rejection::unstable ? 1 : 0));
        return job.rejection();
    };
    Fixture f(test::ceiling_problem());
    FlightState state = f.task.start;
    const ReferenceSegment segment = f.segment({-4, 2, quarter_turn}, {-2, 2, quarter_turn});
    double fastest_rad_s = 0;
    for (std::int64_t tick = 0; tick < segment.ticks(); ++tick) {
        controllers::Actuation<double> given{};
        state = test::single_tick(f.model->tick(), state, segment.at_tick(tick), given);
        fastest_rad_s = std::max(fastest_rad_s, std::abs(state.plant.u[2]));
    }
    CHECK(rejection_with(std::nullopt) == Rejection::none);
    CHECK(rejection_with(1.02 * fastest_rad_s) == Rejection::none);
    CHECK(rejection_with(0.98 * fastest_rad_s) == Rejection::unstable);
}

TEST_CASE("an arm that does not move stays at its angle in flight") {
    Problem problem = test::ceiling_problem();
    problem.robot.arm.is_limited = true;
    problem.robot.arm.lower_limit_rad = problem.robot.arm.upper_limit_rad = 0;
    problem.start.at[plane::arm] = 0;
    Fixture f(std::move(problem));
    FlightJob job{f.task.start, {{f.segment({-4, 2, 0}, {-2, 3, 0})}}, 0};
    f.flights.fly({&job, 1});
    REQUIRE(job.rejection() == Rejection::none);
    // The joint holds it against the vehicle's accelerations.
    CHECK(std::abs(configuration_of(job.legs.back().end.plant.q)[plane::arm]) < 1e-3);

    CHECK(f.flights.is_worth_flying(f.segment({-4, 2, 0}, {-2, 3, 0})));
    CHECK_FALSE(f.flights.is_worth_flying(f.segment({-4, 2, 0}, {-4, 2, 0.3})));
}

namespace {

/// A world in which all surfaces are higher than believed, with the vehicle at the start.
planning::Counterexample raised(const Fixture& f, double z_m) {
    World world;
    world.scene_z_m = z_m;
    return {make_world(f.problem.robot, world), f.task.start};
}

planning::SearchWorlds raised_worlds(const Fixture& f, std::initializer_list<double> z_m) {
    planning::SearchWorlds worlds;
    for (const double z : z_m) {
        const planning::Counterexample one = raised(f, z);
        worlds.worlds.push_back(one.world);
        worlds.start.push_back(one.start);
    }
    return worlds;
}

/// A problem whose vehicle begins low over the ground, arm up: 0.64 m of clearance.
Problem low_problem() {
    Problem problem = test::ceiling_problem();
    problem.start.at[plane::z] = 0.7;
    problem.start.at[plane::arm] = -quarter_turn;
    problem.planner.safety_margin_m = 0.6;
    return problem;
}

const Configuration low_start{-4, 0.7, -quarter_turn};
const Configuration low_end{-3.5, 0.7, -quarter_turn};

}  // namespace

TEST_CASE("the margin is kept in the nominal world, and in other worlds a flight only must not touch anything") {
    const auto is_accepted_with = [](double raised_m) {
        const Fixture f(low_problem());
        const planning::SearchWorlds worlds = raised_worlds(f, {raised_m});
        const planning::SearchTask task(f.problem, *f.model, nullptr, {}, &worlds);
        planning::PlannedFlights flights(task);
        std::vector<planning::FleetJob> jobs{
            flights.job(flights.fleet_at_start(task.start), 0, {{f.segment(low_start, low_end)}})};
        flights.fly(jobs);
        CHECK(flights.statistics().rejections == (jobs[0].is_accepted() ? 0 : 1));
        return jobs[0].is_accepted();
    };
    CHECK(is_accepted_with(0));
    CHECK(is_accepted_with(0.3));
    CHECK_FALSE(is_accepted_with(0.7));
}

TEST_CASE("a flight that one world rejects is not flown in the rest, once that world is known for it") {
    const Fixture f(low_problem());
    const planning::SearchWorlds worlds =
        raised_worlds(f, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.7});  // two full batches, the last is bad
    const planning::SearchTask task(f.problem, *f.model, nullptr, {}, &worlds);
    planning::PlannedFlights flights(task);
    const auto edges_flown = [&] {
        const std::uint64_t before = flights.statistics().edges;
        std::vector<planning::FleetJob> jobs{
            flights.job(flights.fleet_at_start(task.start), 0, {{f.segment(low_start, low_end)}})};
        flights.fly(jobs);
        CHECK_FALSE(jobs[0].is_accepted());
        return flights.statistics().edges - before;
    };
    CHECK(edges_flown() == 17);
    CHECK(edges_flown() == 9);  // in the nominal world, and as many as fill the lanes
}

TEST_CASE("counterexamples constrain flights, do not count in their cost, and leave first if they reject nothing") {
    const Fixture f(low_problem());
    const planning::SearchWorlds worlds = raised_worlds(f, {0.1});
    const planning::SearchTask task(f.problem, *f.model, nullptr, {}, &worlds);
    planning::PlannedFlights flights(task);
    const auto flown = [&] {
        const planning::Fleet from = flights.fleet_at_start(task.start);
        std::vector<planning::FleetJob> jobs{flights.job(from, 0, {{f.segment(low_start, low_end)}})};
        flights.fly(jobs);
        return std::pair(jobs[0].is_accepted(), flights.cost_after(0, from, jobs[0], 0));
    };
    const auto [is_accepted, cost] = flown();
    CHECK(is_accepted);
    CHECK_FALSE(flights.has_counterexamples());

    World heavy;  // costs more
    heavy.mass_scale = 0.05;
    flights.join({{make_world(f.problem.robot, heavy), task.start}});
    CHECK(flights.has_counterexamples());
    CHECK(flights.fleet_at_start(task.start).size() == 3);
    CHECK(flown() == std::pair(true, cost));

    flights.join({raised(f, 0.7)});
    CHECK_FALSE(flown().first);
    constexpr std::size_t most = planning::PlannedFlights::most_counterexamples;
    flights.join(std::vector<planning::Counterexample>(2 * most, raised(f, 0.1)));
    CHECK(flights.fleet_at_start(task.start).size() == 2 + most);
    CHECK_FALSE(flown().first);  // the bad one is still there

    flights.forget();
    CHECK_FALSE(flights.has_counterexamples());
    CHECK(flown() == std::pair(true, cost));
}

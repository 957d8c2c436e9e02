// Thin obstacles and long ticks: what passes between two looks is found all the same.

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "downwash/simulation/execution.hpp"
#include "hover_scenes.hpp"

using namespace downwash;

namespace {

constexpr double speed_m_s = 1.5;
constexpr std::int64_t rising_ticks = 8;

/// Ten ticks a second, with gains that so few can do with.
Robot slow_robot(double rate_hz = 10) {
    Robot robot = test::test_robot();
    robot.controller.rate_hz = rate_hz;
    test::gains_of(robot).attitude_kp = 3;
    test::gains_of(robot).attitude_rate_kp = 6;
    test::gains_of(robot).arm_kp = 9;
    test::gains_of(robot).arm_kd = 6;
    return robot;
}

/// A rod across the plane, 1 cm thick, at a distance in front of the vehicle. The vehicle rises past it with its arm
/// level, 15 cm in a tick of a tenth of a second: 1.0, 1.15, ... 1.6, 1.75, ... m. At 1.675 m the rod is in the middle
/// between two ticks, at each of which it is 0.075 - 0.03 - 0.005 = 0.04 m from the arm of 6 cm thickness.
Problem past_a_rod(double x_m, double z_m = 1.675, double rate_hz = 10) {
    Problem problem = test::ceiling_problem();
    problem.robot = slow_robot(rate_hz);
    problem.bounds = {-6, 6, 0.5, 9};
    problem.obstacles = {{"rod", Cylinder{0.005, 1, {0, 1, 0}}, {x_m, 0, z_m}, {}}};
    return problem;
}

ReferencePoint rising_at(double z_m, double at_speed_m_s = speed_m_s) {
    return {{0, z_m, 0}, {0, at_speed_m_s, 0}, {}};
}

FlightState rising(const FlightModel& model) {
    return model.state_at({0, 1, 0, 0}, {0, speed_m_s, 0, 0});
}

ReferenceSegment rise(const FlightModel& model) {
    const double rate_hz = model.robot().controller.rate_hz;
    const auto ticks = static_cast<std::int64_t>(rate_hz / 10) * rising_ticks;
    return {rising_at(1), rising_at(1 + 0.1 * speed_m_s * rising_ticks), ticks, model.tick().tick_s};
}

SegmentFlight planned(const Problem& problem, double margin_m) {
    const auto model = make_flight_model(problem);
    FlightRules rules = test::rules_of(problem);
    rules.margin_m = margin_m;
    std::vector<FlightJob> jobs(3, FlightJob{rising(*model), {{rise(*model)}}});
    std::vector<FlightJob> expected = jobs;
    test::fly_one_by_one(*model, nullptr, rules, expected);
    FlightPool(*model, nullptr, rules, nullptr).fly(jobs);
    for (const FlightJob& job : jobs) {
        CHECK(test::is_same(job.legs.front(), expected[0].legs.front()));
    }
    return expected[0].legs.front().flight;
}

Execution flown(const Problem& problem) {
    const auto model = make_flight_model(problem);
    // After the rise a second for coming to rest.
    const std::vector<ReferenceKnot> knots{{0, rising_at(1)}, {8, rising_at(2.2)}, {18, rising_at(2.95, 0)}};
    return execute(*model, rising(*model), knots, problem.goal, false);
}

}  // namespace

TEST_CASE("a planned flight is rejected where the arm passes a rod between two ticks") {
    const auto hits_in_tick = [](const Problem& problem, double margin_m) {
        const SegmentFlight hit = planned(problem, margin_m);
        CHECK(hit.rejection == Rejection::collision);
        return hit.ticks;
    };
    CHECK(hits_in_tick(past_a_rod(0.9), 0.01) == 5);  // from 1.60 m to 1.75 m
    CHECK(planned(past_a_rod(0.9), 0).rejection == Rejection::collision);
    // The arm ends at 1.2 m, rounded by 0.03 m: 0.065 m are left to a rod of half a centimetre at 1.3 m.
    CHECK(planned(past_a_rod(1.3), 0.01).rejection == Rejection::none);
    CHECK(planned(past_a_rod(1.3), 0.06).rejection == Rejection::none);
    CHECK(planned(past_a_rod(1.3), 0.07).rejection == Rejection::collision);
    // With a margin of half the way between two ticks the ticks are enough: 0.075 m, and 0.04 m of clearance at both.
    CHECK(hits_in_tick(past_a_rod(0.9), 0.075) == 4);  // at 1.60 m already
    // At ten times the rate it meets the rod at the same height.
    CHECK(hits_in_tick(past_a_rod(0.9, 1.675, 100), 0.012) == 42);  // from 1.675 - 0.035 - 0.012 = 1.628 m on
}

TEST_CASE("a rod that the arm passes between two ticks ends a reported flight in a collision") {
    const Execution hit = flown(past_a_rod(0.9));
    CHECK(hit.outcome == Outcome::collision);
    CHECK(hit.rows.size() == 6);
    CHECK(hit.min_clearance_m <= 0);
    CHECK(hit.rows.back().q[1] == Approx(1.75).epsilon(1e-6));
    CHECK(hit.rows.back().clearance_m == Approx(0.04).epsilon(1e-6));
    const Execution past = flown(past_a_rod(1.3));
    CHECK(past.outcome != Outcome::collision);
    CHECK(past.rows.size() > 18);
    // At the ticks the rod is 0.1 m beyond the arm's end and 0.075 m above or below it.
    CHECK(past.min_clearance_m == Approx(std::hypot(0.1, 0.075) - 0.035).epsilon(1e-6));
}

TEST_CASE("edges fly side by side as one by one where ticks are long, rods thin and margins small") {
    Problem problem = test::cluttered_problem();
    problem.robot = slow_robot(20);
    test::Random random(9);
    for (int i = 0; i < 12; ++i) {
        const Vector3 at{random.uniform(-4, 4), random.uniform(-0.1, 0.1), random.uniform(1, 4.5)};
        problem.obstacles.push_back({"rod " + std::to_string(i), Cylinder{0.004, 1, {0, 1, 0}}, at, {}});
    }
    const auto model = make_flight_model(problem);
    int rejected = 0;
    int accepted = 0;
    for (const double margin_m : {0.0, 0.004, 0.02}) {
        FlightRules rules = test::rules_of(problem);
        rules.margin_m = margin_m;
        std::vector<FlightJob> jobs;
        while (jobs.size() < 80) {
            const Configuration from{random.uniform(-4, 4), random.uniform(1.5, 4), random.uniform(-3, 3)};
            const Configuration to{from[plane::x] + random.uniform(-2, 2), from[plane::z] + random.uniform(-1, 1),
                                   from[plane::arm] + random.uniform(-1, 1)};
            if (!model->collisions().is_nearer_than(level_at(from), margin_m)) {
                jobs.push_back({model->state_at(level_at(from)),
                                {{{at_rest(from), at_rest(to), random.integer(60, 120), model->tick().tick_s}}}});
            }
        }
        std::vector<FlightJob> expected = jobs;
        test::fly_one_by_one(*model, nullptr, rules, expected);
        FlightPool(*model, nullptr, rules, nullptr, 2).fly(jobs);
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            CAPTURE(margin_m, i);
            REQUIRE(test::is_same(jobs[i].legs.front(), expected[i].legs.front()));
            rejected += jobs[i].rejection() == Rejection::collision;
            accepted += jobs[i].rejection() == Rejection::none;
        }
    }
    CHECK(rejected > 20);
    CHECK(accepted > 20);
}

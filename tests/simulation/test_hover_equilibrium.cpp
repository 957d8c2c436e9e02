#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/problems/problem_model.hpp"
#include "downwash/simulation/hover_equilibrium.hpp"
#include "downwash/simulation/world_parameters.hpp"
#include "hover_scenes.hpp"

using namespace downwash;
using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

namespace {

/// A hover of so many seconds without noise and gusts; nothing where the vehicle does not stay.
std::optional<FlightState> hovered(const FlightModel& model, const AeroMap* map, const FlightState& start,
                                   const ReferencePoint& at, const FlownWorld& world, double seconds) {
    const FlownWorld quiet = without_noise(world);
    FlightState state = start;
    state.world = memory_at_start(quiet, start.plant);
    const double tick_s = model.tick().tick_s;
    const ReferenceSegment hover(at, at, std::llround(seconds / tick_s), tick_s);
    const bool stays = fly(model, map, rules_of_execution(), hover, state, {&quiet}).rejection == Rejection::none;
    return stays ? std::optional(state) : std::nullopt;
}

double distance(const FlightState& a, const FlightState& b) {
    double greatest = 0;
    for (int i = 0; i < 4; ++i) {
        greatest = std::max(greatest, std::abs(a.plant.q[i] - b.plant.q[i]));
    }
    return greatest;
}

ReferencePoint place_of(const FlightState& start) {
    return at_rest({start.plant.q[0], start.plant.q[1], start.plant.q[3]});
}

}  // namespace

TEST_CASE("an equilibrium in a world is where a long hover ends, with every kind of memory") {
    const int kind = GENERATE(0, 1, 2, 3);
    CAPTURE(kind);
    Problem problem = ceiling_problem();
    problem.start.at[plane::z] = 3.9;  // below the ceiling
    Robot& robot = problem.robot;
    robot.rotors.time_constant_s = 0.03;
    robot.controller.delay_s = 0.012;
    if (kind == 1) {
        controllers::Aids aids;
        aids.observer.emplace();
        aids.feed_forward = controllers::FeedForward{};
        give_aids(robot.controller.law, aids);
    } else if (kind == 2) {
        robot.controller.law = CascadedPid{};
    } else if (kind == 3) {
        gains_of(robot).position_ki = 0;
        robot.controller.delay_s = 0;
    }
    problem.uncertainty.emplace();
    const auto model = make_flight_model(problem);
    const auto map = GENERATE(true, false) ? model->make_map(problem.bounds) : nullptr;
    const FlightState start = start_state(*model, problem.start);
    const HoverEquilibria equilibria(*model, map.get(), start);
    int found = 0;
    for (std::uint64_t i = 1; i <= 40; ++i) {
        INFO("world " << i);
        const FlownWorld world = make_world(robot, draw_world(*problem.uncertainty, robot, 7, i));
        const std::optional<FlightState> equilibrium = equilibria.in(world);
        const std::optional<FlightState> end = hovered(*model, map.get(), start, place_of(start), world, 60);
        if (!equilibrium) {
            continue;
        }
        ++found;
        REQUIRE(end);
        CHECK(distance(*equilibrium, *end) < 1e-5);
        CHECK(equilibrium->plant.energy_j == 0);
        // Nothing moves there.
        const std::optional<FlightState> later =
            hovered(*model, map.get(), *equilibrium, place_of(start), world, model->tick().tick_s);
        REQUIRE(later);
        CHECK(distance(*equilibrium, *later) < 1e-6);
    }
    CHECK(found >= 36);
}

TEST_CASE("an equilibrium that the smallest disturbance leaves is not reported") {
    Problem problem = ceiling_problem();
    problem.robot.rotors.time_constant_s = 0.03;
    const auto model = make_flight_model(problem);
    const auto map = model->make_map(problem.bounds);
    const FlightState start = start_state(*model, problem.start);
    const HoverEquilibria equilibria(*model, map.get(), start);
    int stable = 0;
    int unstable = 0;
    for (double more_lag_s = 0; more_lag_s < 0.4; more_lag_s += 0.01) {
        CAPTURE(more_lag_s);
        World differs;
        differs.rotor_time_constant_s = more_lag_s;
        const FlownWorld world = make_world(problem.robot, differs);
        const std::optional<FlightState> equilibrium = equilibria.in(world);
        // Lag moves no equilibrium, and makes that of the nominal world unstable at some time.
        FlightState disturbed = *equilibria.in(model->nominal_world());
        disturbed.plant.q[2] += 1e-4;
        const std::optional<FlightState> end = hovered(*model, map.get(), disturbed, place_of(start), world, 120);
        const bool decays = end && distance(*end, *equilibria.in(model->nominal_world())) < 1e-5;
        CHECK(equilibrium.has_value() == decays);
        (decays ? stable : unstable) += 1;
    }
    CHECK(stable > 3);
    CHECK(unstable > 3);
}

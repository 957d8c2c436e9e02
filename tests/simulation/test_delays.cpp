#include <catch2/catch.hpp>
#include <vector>

#include "downwash/simulation/world_tick.hpp"
#include "world_scenes.hpp"

// Controllers that see the vehicle late.

using namespace downwash;
using namespace downwash::test;

TEST_CASE("A controller sees what was a delay ago, linear between two ticks") {
    World late;
    late.delay_s = 0.015;
    const FlownWorld world = make_world(test_robot(), late);
    simulation::WorldMemory<double> memory{};
    for (int age = 0; age < simulation::recent_ticks; ++age) {
        memory.past[age].q[0] = -(age + 1.0);
        memory.past[age].u[3] = 10 * (age + 1.0);
    }
    const double no_noise[simulation::noise_count] = {};
    const auto seen = simulation::seen_state(world.numbers, {}, memory, no_noise);
    CHECK(seen.q[0] == Approx(-1.5));
    CHECK(seen.u[3] == Approx(15));

    Hover hover(test_robot(), late, {0, 2, 0});
    hover.reference.position[0] = 0.5;
    std::vector<double> x_m{hover.state.plant.q[0]};
    hover.fly(20, [&](const FlightState& state) {
        for (std::size_t age = 0; age < simulation::recent_ticks && age < x_m.size(); ++age) {
            CHECK(state.world.past[age].q[0] == x_m[x_m.size() - 1 - age]);
        }
        x_m.push_back(state.plant.q[0]);
    });
    CHECK(x_m.back() > 1e-3);
}

TEST_CASE("a controller that sees many ticks late remembers so many, and no others do") {
    World late;
    late.delay_s = 0.125;
    Hover hover(test_robot(), late, {0, 2, 0});
    CHECK(hover.state.world.older.empty());  // it was always there
    hover.reference.position[0] = 0.5;
    const double no_noise[simulation::noise_count] = {};
    std::vector<double> x_m{hover.state.plant.q[0]};
    hover.fly(30, [&](const FlightState& state) {
        CHECK(state.world.older.size() == 13 - simulation::recent_ticks);
        x_m.push_back(state.plant.q[0]);
        const auto ago = [&](std::size_t ticks) { return ticks < x_m.size() ? x_m[x_m.size() - 1 - ticks] : x_m[0]; };
        const auto seen = simulation::seen_state(hover.world.numbers, state.plant, state.world, no_noise);
        CHECK(seen.q[0] == Approx(0.5 * (ago(12) + ago(13))).margin(1e-15));
        for (int age = 1; age <= 13; ++age) {
            CHECK(simulation::past_at(state.world, age).q[0] == ago(static_cast<std::size_t>(age)));
        }
    });
    CHECK(x_m.back() > 1e-3);

    late.delay_s = 0.03 * (1 + 1e-12);  // three ticks but for rounding
    Hover soon(test_robot(), late, {0, 2, 0});
    soon.fly(5);
    CHECK(soon.world.numbers.delay_ticks == Approx(3));
    CHECK(soon.state.world.older.empty());
    FlightState other = soon.state;
    CHECK(is_same(other, soon.state));
    other.world.older.assign(1, other.world.past[simulation::recent_ticks - 1]);
    CHECK(is_same(other, soon.state));
    other.world.older[0].q[0] += 1;
    CHECK_FALSE(is_same(other, soon.state));
}

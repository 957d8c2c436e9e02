#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "../support/washed_robot.hpp"
#include "downwash/dynamics/arm_wash.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "hover_scenes.hpp"

// A vehicle whose arm is in the slipstreams of its rotors.

using namespace downwash;
using namespace downwash::test;

namespace {

/// A vehicle at rest far from everything, after some ticks in a world.
FlightState hovered(const Robot& robot, const World& in, double arm_rad, int ticks) {
    const FlightModel model = in_free_air(robot);
    const FlownWorld world = make_world(robot, in);
    FlightState state = model.state_at(level_at(Configuration{0, 2, arm_rad}));
    state.world = memory_at_start(world, state.plant);
    const ReferenceSegment segment(at_rest({0, 2, arm_rad}), at_rest({0, 2, arm_rad}), ticks, model.tick().tick_s);
    simulation::FlightEffectOf calm{simulation::NoEffect{}};
    const simulation::FlightLoop loop(model.tick(), &world, calm);
    loop.fly(0, segment, state,
             [](const FlightState&, const ReferencePoint&, const controllers::Actuation<double>&, const FlightState&,
                const ReferencePoint&) { return Rejection::none; });
    return state;
}

double thrust_n(const FlightState& state) {
    double sum_n = 0;
    for (const double each : state.plant.thrust_n) {
        sum_n += each;
    }
    return sum_n;
}

Robot without_wash(Robot robot) {
    robot.arm.wash.reset();
    return robot;
}

}  // namespace

TEST_CASE("A wash of no speed is none, to the last bit, and one that is left out is none") {
    Robot robot = washed_robot();
    robot.arm.wash->scale = 0;
    const FlightState still = hovered(robot, {}, 0.4, 300);
    World other;
    other.arm_wash_scale = 0.5;  // nothing to scale
    for (const FlightState& state : {hovered(without_wash(robot), {}, 0.4, 300), hovered(robot, other, 0.4, 300)}) {
        CHECK(std::memcmp(&still.plant, &state.plant, sizeof state.plant) == 0);
        CHECK(std::memcmp(&still.memory, &state.memory, sizeof state.memory) == 0);
    }
    robot.arm.wash->scale = 1;
    CHECK(hovered(robot, {}, 0.4, 300).plant.q[3] != still.plant.q[3]);
}

TEST_CASE("A hover in the wash carries what the slipstreams push down, and more of it in a world with faster ones") {
    constexpr double arm_rad = 0.5;
    const Robot robot = washed_robot();
    const PlantModel plant = plant_of(robot);
    double push_n = 0;
    for (const double scale : {0.0, 0.3}) {
        World world;
        world.arm_wash_scale = scale;
        const FlightState hover = hovered(robot, world, arm_rad, 6000);
        CAPTURE(scale);
        CHECK(std::abs(hover.plant.u[1]) < 1e-3);
        double load[4] = {};
        dynamics::WashedVehicle<double> vehicle{
            dynamics::attitude(plant, hover.plant.q[2], hover.plant.q[3]), {}, {0, 0}, {}, 1 + scale};
        std::copy(hover.plant.thrust_n, hover.plant.thrust_n + 4, vehicle.acting_n);
        dynamics::add_arm_wash(plant, slipstreams_of(robot.arm, robot.rotors), vehicle, load);
        CHECK(load[1] < -0.5);
        CHECK(thrust_n(hover) * std::cos(hover.plant.q[2]) == Approx(plant.weight_n - load[1]).epsilon(1e-3));
        // It leans against the push along x.
        CHECK(thrust_n(hover) * std::sin(hover.plant.q[2]) == Approx(-load[0]).margin(0.03));
        CHECK(-load[1] > push_n);
        push_n = -load[1];
    }
    // The slipstreams of rotors that carry it are a little faster again.
    CHECK(push_n > 0.5);
}

TEST_CASE("The trim of a hover in the wash is the one that a long hover comes to") {
    Robot robot = washed_robot();
    gains_of(robot).arm_ki = 10;  // or the arm sags in the wash
    const FlightModel model = in_free_air(robot);
    for (const double arm_rad : {0.0, 0.5, 2.6}) {
        CAPTURE(arm_rad);
        const HoverAnalysis analysis = analyse_hover(model, 0, 2, arm_rad);
        REQUIRE(analysis.verdict == HoldVerdict::stable);
        const HoverAnalysis calm = analyse_hover(in_free_air(without_wash(robot)), 0, 2, arm_rad);
        const FlightState hover = hovered(robot, {}, arm_rad, 8000);
        double trim_n = 0, calm_n = 0;
        for (int i = 0; i < 4; ++i) {
            trim_n += analysis.trim.rotor_command_n[i];
            calm_n += calm.trim.rotor_command_n[i];
        }
        // Level or leaning against the push along x, of a few percent of the weight.
        CHECK(trim_n == Approx(thrust_n(hover)).epsilon(2e-3));
        CHECK(trim_n > calm_n + 0.5);
        CHECK(std::abs(analysis.trim.joint_torque_nm - calm.trim.joint_torque_nm) > 0.1);
    }
}

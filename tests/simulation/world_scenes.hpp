#pragma once

#include "../support/washed_robot.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "downwash/simulation/world.hpp"
#include "hover_scenes.hpp"

namespace downwash::test {

/// Everything different, a little.
inline World random_world(Random& random) {
    World world;
    world.ceiling_scale = random.uniform(-0.3, 0.3);
    world.ground_scale = random.uniform(-0.3, 0.3);
    world.scene_x_m = random.uniform(-0.04, 0.04);
    world.scene_y_m = random.uniform(-0.04, 0.04);
    world.scene_z_m = random.uniform(-0.04, 0.04);
    world.mass_scale = random.uniform(-0.05, 0.05);
    world.inertia_scale = random.uniform(-0.1, 0.1);
    world.arm_mass_scale = random.uniform(-0.1, 0.1);
    world.center_of_mass_x_m = random.uniform(-0.01, 0.01);
    world.center_of_mass_z_m = random.uniform(-0.01, 0.01);
    world.thrust_scale = random.uniform(-0.05, 0.05);
    for (double& scale : world.rotor_thrust_scale) {
        scale = random.uniform(-0.02, 0.02);
    }
    world.arm_wash_scale = random.uniform(-0.3, 0.3);
    world.rotor_time_constant_s = random.uniform(-0.005, 0.01);
    world.delay_s = random.uniform(0, 0.01);
    world.position_bias_x_m = random.uniform(-0.02, 0.02);
    world.position_bias_y_m = random.uniform(-0.02, 0.02);
    world.position_bias_z_m = random.uniform(-0.02, 0.02);
    world.pitch_bias_rad = random.uniform(-0.01, 0.01);
    world.wind_x_m_s = random.uniform(-1, 1);
    world.wind_z_m_s = random.uniform(-0.3, 0.3);
    world.position_noise_m = 0.005;
    world.velocity_noise_m_s = 0.02;
    world.gyro_noise_rad_s = 0.015;
    world.gust_m_s = 0.3;
    world.gust_length_x_m = 20;
    world.gust_length_z_m = 3;
    world.tape = static_cast<std::uint64_t>(random.integer(0, 1'000'000));
    return world;
}

/// A vehicle with all that a world can change: rotors that lag, drag, and sight that is late.
inline Robot real_robot() {
    Robot robot = test_robot();
    robot.rotors.time_constant_s = 0.02;
    robot.controller.delay_s = 0.01;
    robot.multirotor.drag = {1.5, 0.04};
    robot.arm.drag = {0, 0.05};
    return robot;
}

/// The same with an arm below its rotors.
inline Robot late_in_wash() {
    Robot robot = washed_robot();
    robot.rotors.time_constant_s = 0.02;
    robot.controller.delay_s = 0.01;
    return robot;
}

/// A vehicle that sees up to three ticks late in some worlds and later in the others.
inline Robot very_late() {
    Robot robot = test_robot();
    robot.controller.delay_s = 0.027;
    return robot;
}

inline Problem problem_with(const Robot& robot) {
    Problem problem = ceiling_problem();
    problem.robot = robot;
    return problem;
}

/// The flight of a reference at one place in free air.
struct Hover {
    std::shared_ptr<const FlightModel> model;
    FlownWorld world;
    FlightState state;
    ReferencePoint reference;

    Hover(const Robot& robot, const World& in, const Configuration& at)
        : model(std::make_shared<const FlightModel>(robot, PlaneOfMotion{},
                                                    std::make_shared<const Scene>(std::vector<Obstacle>{}), no_aero())),
          world(make_world(robot, in)),
          state(model->state_at(level_at(at))),
          reference(at_rest(at)) {
        state.world = memory_at_start(world, state.plant);
    }

    static AeroSettings no_aero() {
        AeroSettings aero;
        aero.enabled = false;
        return aero;
    }

    /// @param after callable (state) after every tick
    template <class After>
    void fly(int ticks, const After& after) {
        const ReferenceSegment segment(reference, reference, ticks, model->tick().tick_s);
        simulation::FlightEffectOf calm{simulation::NoEffect{}};
        const simulation::FlightLoop loop(model->tick(), &world, calm);
        loop.fly(0, segment, state,
                 [&](const FlightState&, const ReferencePoint&, const controllers::Actuation<double>&,
                     const FlightState& next, const ReferencePoint&) {
                     after(next);
                     return Rejection::none;
                 });
    }
    void fly(int ticks) {
        fly(ticks, [](const FlightState&) {});
    }
};

}  // namespace downwash::test

#include "downwash/simulation/world.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

#include "downwash/simulation/gusts.hpp"
#include "downwash/simulation/noise.hpp"

namespace downwash {
namespace {

/// The robot that really flies, seen from the multirotor's true centre of mass.
Robot real_robot(const Robot& nominal, const World& world) {
    Robot robot = nominal;
    robot.multirotor.mass_kg *= 1 + world.mass_scale;
    robot.multirotor.pitch_inertia_kg_m2 *= 1 + world.inertia_scale;
    robot.arm.mass_kg *= 1 + world.arm_mass_scale;
    robot.arm.inertia_kg_m2 *= (1 + world.inertia_scale) * (1 + world.arm_mass_scale);
    robot.arm.joint_x_m -= world.center_of_mass_x_m;
    robot.arm.joint_z_m -= world.center_of_mass_z_m;
    for (Vector3& hub_m : robot.rotors.positions_m) {
        hub_m[0] -= world.center_of_mass_x_m;
        hub_m[2] -= world.center_of_mass_z_m;
    }
    robot.rotors.time_constant_s += world.rotor_time_constant_s;
    return robot;
}

/// Whether something of the law along x carries a steady force: an integral or an observer. Laws that are not named
/// here count as without an integral.
bool carries_steady_force(const ControlLaw& law) {
    if (controllers::aids_of(law).observer) {
        return true;
    }
    if (const auto* inversion = std::get_if<ModelInversion>(&law)) {
        return inversion->position_ki > 0;
    }
    const auto* cascade = std::get_if<CascadedPid>(&law);
    return cascade != nullptr && cascade->horizontal_velocity_ki > 0;
}

/// How far air from the right pushes the vehicle to the left. The loop across the plane is taken to be as stiff as that
/// along x, and to carry a steady wind as that does; gusts it only resists.
double pushed_aside_m(const Robot& robot, const World& world) {
    const double wind_m_s = world.gust_y_m_s + (carries_steady_force(robot.controller.law) ? 0 : world.wind_y_m_s);
    if (wind_m_s == 0) {
        return 0;
    }
    double force_n = 0;
    for (const DragParameters& drag : {robot.multirotor.drag, robot.arm.drag}) {  // the arm is across the stream
        force_n += (drag.linear_n_s_m + drag.quadratic_n_s2_m2 * std::abs(wind_m_s)) * wind_m_s;
    }
    const double stiffness_1_s2 = std::visit([](const auto& law) { return law.position_stiffness_1_s2(0); },
                                             controllers::flown_law(robot.controller.law));
    return force_n / (robot.mass_kg() * stiffness_1_s2);
}

/// The filters of the gusts. A gust passes with the steady wind, or with 1 m/s where that is slower: a vehicle that
/// hovers in calm air meets it as one that flies through it.
void set_gusts(const World& world, double tick_s, simulation::WorldNumbers<double>& numbers) {
    if (!(world.gust_m_s > 0)) {
        return;
    }
    constexpr double least_speed_m_s = 1;
    const double speed_m_s =
        std::max(least_speed_m_s, std::sqrt(world.wind_x_m_s * world.wind_x_m_s + world.wind_z_m_s * world.wind_z_m_s));
    numbers.gust_m_s = world.gust_m_s;
    const simulation::GustFilter along = simulation::gust_filter(tick_s * speed_m_s / world.gust_length_x_m);
    numbers.gust_x_decay = along.decay;
    numbers.gust_x_noise = along.noise;
    const simulation::GustPairFilter upward = simulation::gust_pair_filter(tick_s * speed_m_s / world.gust_length_z_m);
    numbers.gust_z_decay = upward.decay;
    numbers.gust_z_coupling = upward.coupling;
    std::copy(std::begin(upward.noise), std::end(upward.noise), numbers.gust_z_noise);
}

}  // namespace

FlownWorld make_world(const Robot& robot, const World& world) {
    const Robot real = real_robot(robot, world);
    const double tick_s = 1 / robot.controller.rate_hz;
    FlownWorld flown{world, {}, false};
    simulation::WorldNumbers<double>& numbers = flown.numbers;
    numbers.plant = make_plant_model(real.multirotor, real.arm, real.rotors);
    numbers.center_of_mass_x_m = world.center_of_mass_x_m;
    numbers.center_of_mass_z_m = world.center_of_mass_z_m;
    for (int i = 0; i < max_rotors; ++i) {
        numbers.rotor_thrust_scale[i] = (1 + world.thrust_scale) * (1 + world.rotor_thrust_scale[i]);
    }
    numbers.arm_wash_scale = 1 + world.arm_wash_scale;
    numbers.ground_scale = world.ground_scale;
    numbers.ceiling_scale = world.ceiling_scale;
    numbers.scene_x_m = world.scene_x_m;
    numbers.scene_z_m = world.scene_z_m;
    numbers.delay_ticks = simulation::delay_ticks(robot.controller.delay_s + world.delay_s, robot.controller.rate_hz);
    numbers.position_bias_m[0] = world.position_bias_x_m;
    numbers.position_bias_m[1] = world.position_bias_z_m;
    numbers.pitch_bias_rad = world.pitch_bias_rad;
    numbers.position_noise_m = world.position_noise_m;
    numbers.velocity_noise_m_s = world.velocity_noise_m_s;
    numbers.gyro_noise_rad_s = world.gyro_noise_rad_s;
    numbers.wind_m_s[0] = world.wind_x_m_s;
    numbers.wind_m_s[1] = world.wind_z_m_s;
    set_gusts(world, tick_s, numbers);
    flown.has_noise =
        world.position_noise_m > 0 || world.velocity_noise_m_s > 0 || world.gyro_noise_rad_s > 0 || world.gust_m_s > 0;
    flown.lateral_m = pushed_aside_m(robot, world) + world.lateral_error_m - world.position_bias_y_m - world.scene_y_m;
    return flown;
}

FlownWorld without_noise(const FlownWorld& world) noexcept {
    FlownWorld quiet = world;
    quiet.has_noise = false;
    simulation::WorldNumbers<double>& numbers = quiet.numbers;
    numbers.position_noise_m = numbers.velocity_noise_m_s = numbers.gyro_noise_rad_s = numbers.gust_m_s = 0;
    numbers.gust_x_noise = 0;
    std::fill(std::begin(numbers.gust_z_noise), std::end(numbers.gust_z_noise), 0.0);
    return quiet;
}

simulation::FlightMemory memory_at_start(const FlownWorld& world, const dynamics::PlantState<double>& state) noexcept {
    simulation::FlightMemory memory{};
    for (simulation::PastMotion<double>& past : memory.past) {
        std::copy(state.q, state.q + 4, past.q);
        std::copy(state.u, state.u + 4, past.u);
    }
    if (world.has_noise) {
        double noise[simulation::noise_count];
        simulation::draw_noise(simulation::normal_levels(), world.world.tape, -1, noise, 1);
        memory.gust[0] = noise[0];
        simulation::start_gust_pair(noise[1], noise[2], memory.gust + 1);
    }
    return memory;
}

}  // namespace downwash

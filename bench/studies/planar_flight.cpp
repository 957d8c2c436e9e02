#include "downwash/studies/planar_flight.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "downwash/effects/effect_curve.hpp"
#include "downwash/effects/effect_table.hpp"
#include "downwash/simulation/direct_field.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

namespace downwash::studies {
namespace {

constexpr double degree_rad = std::numbers::pi / 180;
constexpr double max_factor = 2;
constexpr double rate_hz = 100;

RotorParameters rotors_of(const PlanarVehicle& vehicle) {
    const double a = vehicle.arm_m;
    const double s = a * std::numbers::sqrt2 / 2;
    RotorParameters rotors;
    rotors.radius_m = vehicle.radius_m;
    rotors.positions_m = vehicle.layout == RotorLayout::plus
                             ? std::vector<Vector3>{{a, 0, 0}, {0, a, 0}, {-a, 0, 0}, {0, -a, 0}}
                             : std::vector<Vector3>{{s, s, 0}, {-s, s, 0}, {-s, -s, 0}, {s, -s, 0}};
    rotors.max_thrust_n = vehicle.mass_kg * standard_gravity_m_s2 / 2;
    rotors.power_coefficient_w_n1p5 = 3;
    return rotors;
}

/// The manipulator without its arm: what is left of that is a millionth of a kilogram in the centre that no torque
/// turns.
Robot robot_of(const PlanarVehicle& vehicle, const PlanarControl& control) {
    constexpr double nothing = 1e-6;
    Robot robot;
    robot.name = "planar quadrotor";
    robot.multirotor.mass_kg = vehicle.mass_kg;
    robot.multirotor.pitch_inertia_kg_m2 = vehicle.pitch_inertia_kg_m2;
    robot.rotors = rotors_of(vehicle);
    robot.arm.length_m = robot.arm.radius_m = 1e-3;
    robot.arm.mass_kg = nothing;
    robot.arm.inertia_kg_m2 = nothing * nothing;
    robot.arm.max_torque_nm = 1;
    robot.controller.rate_hz = rate_hz;

    CascadedPid law;
    law.horizontal_position_kp = law.vertical_position_kp = control.position_kp;
    law.horizontal_velocity_kp = law.vertical_velocity_kp = control.velocity_kp;
    law.horizontal_velocity_ki = law.vertical_velocity_ki = 0;
    law.pitch_angle_kp = control.pitch_kp;
    law.pitch_rate_kp = control.rate_kp * vehicle.pitch_inertia_kg_m2;
    law.pitch_rate_ki = 0;
    law.joint_kp = law.joint_kd = law.joint_ki = 0;
    if (control.observer_gain_1_s) {
        law.aids.observer = controllers::DisturbanceObserver{*control.observer_gain_1_s};
    }
    if (control.map_offset_m) {
        law.aids.feed_forward = controllers::FeedForward{*control.map_offset_m, 0};
    }
    robot.controller.law = law;
    return robot;
}

FlightModel model_of(const PlanarExperiment& e) {
    std::vector<Obstacle> obstacles;
    if (e.has_plate) {
        const double width_m = e.plate_to_m - e.plate_from_m;
        obstacles.push_back({"plate", Box{{width_m, 20, 0.02}}, {e.plate_from_m + width_m / 2, 0, -0.01}, {}});
    }
    AeroSettings aero;
    aero.ground = e.ground;
    aero.ceiling = EffectModel::none;
    aero.tilt_loss = {};  // the thesis has none
    aero.max_factor = max_factor;
    return {robot_of(e.vehicle, e.control), {}, std::make_shared<const Scene>(std::move(obstacles)), aero};
}

}  // namespace

PlanarFlight::Range PlanarFlight::over_last(double seconds) const {
    const double from_s = time_s.back() - seconds;
    Range range{x_m.back(), x_m.back(), 0};
    for (std::size_t i = 0; i < time_s.size(); ++i) {
        if (time_s[i] >= from_s) {
            range.least_x_m = std::min(range.least_x_m, x_m[i]);
            range.greatest_x_m = std::max(range.greatest_x_m, x_m[i]);
            range.greatest_pitch_deg = std::max(range.greatest_pitch_deg, std::abs(pitch_deg[i]));
        }
    }
    return range;
}

PlanarFlight fly(const PlanarExperiment& e) {
    const FlightModel model = model_of(e);
    const double height_m = e.z_over_r * e.vehicle.radius_m;
    World with_noise;
    with_noise.gyro_noise_rad_s = e.gyro_noise_rad_s;
    with_noise.tape = 1;
    const FlownWorld world = make_world(model.robot(), with_noise);
    FlightState state = model.state_at({0, height_m, 0, 0});
    state.world = memory_at_start(world, state.plant);
    PlanarFlight flight;
    simulation::FlightEffectOf effect{simulation::DirectField(model)};
    const simulation::FlightLoop loop(model.tick(), &world, effect);
    const auto ticks = static_cast<std::int64_t>(std::lround(e.duration_s * rate_hz));
    for (std::int64_t tick = 0; tick <= ticks; ++tick) {
        const double* q = state.plant.q;
        flight.time_s.push_back(static_cast<double>(tick) / rate_hz);
        flight.x_m.push_back(q[0]);
        flight.z_m.push_back(q[1]);
        flight.pitch_deg.push_back(q[2] / degree_rad);
        // Written so that NaN is lost too.
        if (!(std::abs(q[2]) < 60 * degree_rad && std::abs(q[1] - height_m) < 5 && std::abs(q[0]) < 50)) {
            flight.is_lost = true;
            break;
        }
        // A step of the reference, whose commanded speed is clipped: the position loop never sees more than it
        // takes to ask for that speed.
        const double ahead_m = e.speed_m_s / e.control.position_kp;
        const double next_m = q[0] + std::clamp(e.target_m - q[0], -ahead_m, ahead_m);
        controllers::Actuation<double> given{};
        state = loop.tick(tick, state, at_rest({next_m, height_m, q[3]}), given);
    }
    return flight;
}

SurfaceEffect effect_on_each_rotor(const SurfaceEffect& model, const PlanarVehicle& vehicle) {
    constexpr double nearest = 0.05, farthest = 20, step = 1.02;
    const RotorNeighbours neighbours = neighbours_of(rotors_of(vehicle).positions_m, 0, vehicle.radius_m);
    std::vector<double> z_over_r;
    std::vector<double> factors;
    for (double zeta = nearest; zeta < farthest; zeta *= step) {
        z_over_r.push_back(zeta);
        factors.push_back(std::clamp(formula_factor(model, zeta, neighbours), 1.0, max_factor));
    }
    SurfaceEffect effect(EffectModel::table);
    effect.table = std::make_shared<const EffectTable>(std::move(z_over_r), std::vector<double>(), std::move(factors));
    return effect;
}

double torque_over_wide_plate(const PlanarExperiment& experiment, double pitch_rad) {
    PlanarExperiment wide = experiment;
    wide.has_plate = true;
    wide.plate_from_m = -100;
    wide.plate_to_m = 100;
    const FlightModel model = model_of(wide);
    const double height_m = wide.z_over_r * wide.vehicle.radius_m;
    return vehicle_effect(model, {0, height_m, pitch_rad, 0}).pitch_torque_nm;
}

}  // namespace downwash::studies

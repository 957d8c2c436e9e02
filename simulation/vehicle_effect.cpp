#include "downwash/simulation/vehicle_effect.hpp"

#include "downwash/simulation/flight_loop.hpp"

namespace downwash {

using dynamics::RotorWrench;

VehicleEffect vehicle_effect(const FlightModel& model, const PlanarPose& pose) {
    const PlantModel& plant = model.tick().plant;
    const simulation::DirectFactor factor{model};
    const double weight_n = plant.total_mass_kg * standard_gravity_m_s2;
    double command_n[max_rotors];
    dynamics::allocate(plant, weight_n, 0.0, command_n);
    const auto wrench_at = [&](double z_m, double pitch_rad) {
        const auto attitude = dynamics::attitude(plant, pitch_rad, pose.arm_rad);
        return dynamics::rotor_wrench(plant, attitude, pose.x_m, z_m, command_n, factor);
    };
    constexpr double step = 1e-3;  // [m] and [rad]
    const RotorWrench<double> here = wrench_at(pose.z_m, pose.pitch_rad);
    const RotorWrench<double> above = wrench_at(pose.z_m + step, pose.pitch_rad);
    const RotorWrench<double> below = wrench_at(pose.z_m - step, pose.pitch_rad);
    const RotorWrench<double> nose_down = wrench_at(pose.z_m, pose.pitch_rad + step);
    const RotorWrench<double> nose_up = wrench_at(pose.z_m, pose.pitch_rad - step);

    VehicleEffect effect;
    effect.force_factor = here.thrust_n / weight_n;
    effect.pitch_torque_nm = here.pitch_torque_nm;
    effect.pitch_torque_factor = here.pitch_torque_nm / (weight_n * model.robot().rotors.radius_m);
    effect.force_slope_n_m = (above.thrust_n - below.thrust_n) / (2 * step);
    effect.torque_slope_nm_rad = (nose_down.pitch_torque_nm - nose_up.pitch_torque_nm) / (2 * step);
    return effect;
}

bool is_flyable(const FlightModel& model, const PlanarPose& pose) {
    const double q[4] = {pose.x_m, pose.z_m, pose.pitch_rad, pose.arm_rad};
    const double u[4] = {};
    return simulation::all_rotors(model, model.state_at(q, u), [&](int rotor, double x_m, double z_m) {
        return model.effect(rotor).is_flyable(model.plane().to_world(x_m, model.rotor_lateral_m(rotor), z_m));
    });
}

}  // namespace downwash

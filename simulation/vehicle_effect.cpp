#include "downwash/simulation/vehicle_effect.hpp"

#include "downwash/dynamics/flight_step.hpp"
#include "downwash/simulation/direct_field.hpp"
#include "downwash/simulation/rotor_hubs.hpp"
#include "downwash/simulation/surroundings.hpp"

namespace downwash {

namespace {

double weight_n(const FlightModel& model) {
    return model.tick().plant.total_mass_kg * standard_gravity_m_s2;
}

}  // namespace

VehicleEffect vehicle_effect(const FlightModel& model, const PlanarPose& pose) {
    const PlantModel& plant = model.tick().plant;
    double command_n[max_rotors];
    dynamics::allocate(plant, weight_n(model), 0.0, command_n);  // no torque
    const auto attitude = dynamics::attitude(plant, pose.pitch_rad, pose.arm_rad);
    simulation::DirectField field(model);
    const simulation::NominalSurroundings<double, simulation::DirectField> around(field, model.tick().tilt_loss);
    const auto wrench = dynamics::rotor_wrench(plant, attitude, pose.x_m, pose.z_m, command_n, around);
    VehicleEffect effect;
    effect.force_factor = wrench.thrust_n / weight_n(model);
    effect.pitch_torque_nm = wrench.pitch_torque_nm;
    effect.pitch_torque_factor = wrench.pitch_torque_nm / (weight_n(model) * model.robot().rotors.radius_m);
    return effect;
}

bool is_flyable(const FlightModel& model, const PlanarPose& pose) {
    return simulation::all_rotors(model, pose, [&](int rotor, double x_m, double z_m) {
        return model.effect(rotor).is_flyable(model.plane().to_world(x_m, model.rotor_lateral_m(rotor), z_m));
    });
}

bool is_flyable(const FlightModel& model, const AeroMap& map, const PlanarPose& pose) {
    return simulation::all_rotors(model, pose, [&](int rotor, double x_m, double z_m) {
        return map.is_flyable(model.rotor_layer(rotor), x_m, z_m);
    });
}

}  // namespace downwash

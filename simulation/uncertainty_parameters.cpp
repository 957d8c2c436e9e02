#include "downwash/simulation/uncertainty_parameters.hpp"

namespace downwash {
namespace {

using U = RobotUncertainty;
using Rows = std::vector<Parameter<U>>;

void add_vehicle(Rows& rows) {
    SpreadRows<U> vehicle(rows, "vehicle", "the vehicle, beside what its controller knows");
    vehicle.add("mass_scale", "relative change of the multirotor's mass", 0.9, &U::mass_scale);
    vehicle.add("inertia_scale", "relative change of both inertias", 0.9, &U::inertia_scale);
    vehicle.add("arm_mass_scale", "relative change of the arm's mass", 0.9, &U::arm_mass_scale);
    SpreadRows<U> center(rows, "vehicle.com_offset_m", "where the multirotor's centre of mass is, in its frame");
    center.add("x", "forward [m]", 1, &U::center_of_mass_x_m);
    center.add("z", "upward [m]", 1, &U::center_of_mass_z_m);
    vehicle.add("thrust_scale", "relative change of the thrust of all rotors", 0.9, &U::thrust_scale);
    vehicle.add("rotor_thrust_scale", "the same of each rotor for itself", 0.9, &U::rotor_thrust_scale);
    vehicle.add_of_robot("rotor_time_constant_s", "lag of the rotors; sd around the robot's, range in s", 10,
                         &U::rotor_time_constant_s);
    vehicle.add_of_robot("delay_s", "age of what the controller sees; sd around the robot's, range in s", 0.3,
                         &U::delay_s);
}

void add_sensing(Rows& rows) {
    SpreadRows<U> sensing(rows, "sensing", "what the controller sees instead of the state");
    sensing.add("position_bias_m", "constant error, along x and along z", 10, &U::position_bias_m);
    sensing.add("pitch_bias_deg", "constant error", 30, &U::pitch_bias_rad);
    sensing.add_noise("gyro_noise_rad_s", "error of the pitch rate, anew in every control tick", 10,
                      &U::gyro_noise_rad_s);
    sensing.add_noise("velocity_noise_m_s", "the same of the velocity", 10, &U::velocity_noise_m_s);
    sensing.add_noise("position_noise_m", "the same of the position", 10, &U::position_noise_m);
}

Rows all_rows() {
    Rows rows;
    add_vehicle(rows);
    add_sensing(rows);
    return rows;
}

}  // namespace

const std::vector<Parameter<RobotUncertainty>>& robot_uncertainty_rows() {
    static const Rows rows = all_rows();
    return rows;
}

}  // namespace downwash

#include "downwash/judge/vehicle.hpp"

#include <cmath>
#include <cstddef>

namespace downwash::judge {

Planar from_body(Planar body, double pitch_rad) noexcept {
    const double c = std::cos(pitch_rad);
    const double s = std::sin(pitch_rad);
    return {c * body.x + s * body.z, c * body.z - s * body.x};
}

Planar arm_direction(double pitch_rad, double arm_rad) noexcept {
    return {std::cos(pitch_rad + arm_rad), -std::sin(pitch_rad + arm_rad)};
}

Vehicle vehicle_in(const World& world, const Robot& robot) {
    Vehicle v{};
    const Planar off{world.center_of_mass_x_m, world.center_of_mass_z_m};
    v.center_of_mass_m = off;
    v.body_mass_kg = robot.multirotor.mass_kg * (1 + world.mass_scale);
    v.body_inertia_kg_m2 = robot.multirotor.pitch_inertia_kg_m2 * (1 + world.inertia_scale);
    v.arm_mass_kg = robot.arm.mass_kg * (1 + world.arm_mass_scale);
    v.arm_inertia_kg_m2 = robot.arm.inertia_kg_m2 * (1 + world.inertia_scale) * (1 + world.arm_mass_scale);
    v.joint_m = Planar{robot.arm.joint_x_m, robot.arm.joint_z_m} - off;
    v.arm_center_of_mass_m = robot.arm.center_of_mass_m;
    v.arm_length_m = robot.arm.length_m;
    v.wash_scale = robot.arm.wash ? robot.arm.wash->scale * (1 + world.arm_wash_scale) : 0;
    v.rotor_radius_m = robot.rotors.radius_m;
    v.rotor_count = static_cast<int>(robot.rotors.positions_m.size());
    for (std::size_t i = 0; i < robot.rotors.positions_m.size(); ++i) {
        const Vector3& hub_m = robot.rotors.positions_m[i];
        v.hub_m[i] = Planar{hub_m[0], hub_m[2]} - off;
        v.hub_center_m = v.hub_center_m + (1.0 / v.rotor_count) * v.hub_m[i];
        v.hub_lateral_m[i] = hub_m[1];
        v.thrust_of[i] = (1 + world.thrust_scale) * (1 + world.rotor_thrust_scale[i]);
    }
    const double lag_s = robot.rotors.time_constant_s;
    v.rotor_time_constant_s = lag_s > 0 ? lag_s + world.rotor_time_constant_s : 0;
    v.power_coefficient_w_n1p5 = robot.rotors.power_coefficient_w_n1p5;
    v.body_drag = robot.multirotor.drag;
    v.arm_drag = robot.arm.drag;
    return v;
}

}  // namespace downwash::judge

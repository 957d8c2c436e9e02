#include "downwash/dynamics/plant_model.hpp"

#include <cassert>
#include <cstddef>

namespace downwash {
namespace {

struct LayoutSums {
    double count = 0, x = 0, xx = 0;
    [[nodiscard]] double determinant() const { return count * xx - x * x; }
};

LayoutSums sums(const RotorParameters& rotors) {
    LayoutSums s;
    for (const Vector3& position_m : rotors.positions_m) {
        s.count += 1;
        s.x += position_m[0];
        s.xx += position_m[0] * position_m[0];
    }
    return s;
}

}  // namespace

PlantModel make_plant_model(const MultirotorParameters& multirotor, const ArmParameters& arm,
                            const RotorParameters& rotors, bool has_fountain) {
    assert(rotors.positions_m.size() <= static_cast<std::size_t>(max_rotors));
    PlantModel model{};
    model.multirotor_mass_kg = multirotor.mass_kg;
    model.arm_mass_kg = arm.mass_kg;
    model.total_mass_kg = multirotor.mass_kg + arm.mass_kg;
    model.weight_n = model.total_mass_kg * standard_gravity_m_s2;
    model.inverse_mass_1_kg = 1 / model.total_mass_kg;
    model.reduced_mass_kg = multirotor.mass_kg * arm.mass_kg / model.total_mass_kg;
    model.arm_mass_ratio = arm.mass_kg / model.total_mass_kg;
    model.pitch_inertia_kg_m2 = multirotor.pitch_inertia_kg_m2;
    model.arm_inertia_kg_m2 = arm.inertia_kg_m2;
    model.joint_x_m = arm.joint_x_m;
    model.joint_z_m = arm.joint_z_m;
    model.arm_center_of_mass_m = arm.center_of_mass_m;
    model.arm_length_m = arm.length_m;
    model.max_joint_torque_nm = arm.max_torque_nm;

    // The pseudo-inverse of the rows (1, ..., 1) and (-x_1, ..., -x_N).
    const LayoutSums s = sums(rotors);
    const double determinant = s.determinant();
    model.rotor_count = static_cast<int>(rotors.positions_m.size());
    for (int i = 0; i < model.rotor_count; ++i) {
        const Vector3& position_m = rotors.positions_m[static_cast<std::size_t>(i)];
        model.rotor_x_m[i] = position_m[0];
        model.rotor_z_m[i] = position_m[2];
        model.force_share[i] = (s.xx - position_m[0] * s.x) / determinant;
        model.torque_share_1_m[i] = (s.x - position_m[0] * s.count) / determinant;
    }
    model.has_fountain = has_fountain;
    for (const Vector3& position_m : rotors.positions_m) {
        model.center_x_m += position_m[0] / s.count;
        model.center_z_m += position_m[2] / s.count;
    }
    model.min_thrust_n = rotors.min_thrust_n;
    model.max_thrust_n = rotors.max_thrust_n;
    model.has_rotor_lag = rotors.time_constant_s > 0;
    model.rotor_time_constant_s = rotors.time_constant_s;
    model.power_coefficient_w_n1p5 = rotors.power_coefficient_w_n1p5;
    model.has_drag = multirotor.drag.is_any() || arm.drag.is_any();
    model.body_drag_n_s_m = multirotor.drag.linear_n_s_m;
    model.body_drag_n_s2_m2 = multirotor.drag.quadratic_n_s2_m2;
    model.arm_drag_n_s_m = arm.drag.linear_n_s_m;
    model.arm_drag_n_s2_m2 = arm.drag.quadratic_n_s2_m2;
    return model;
}

}  // namespace downwash

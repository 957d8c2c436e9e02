#include "downwash/dynamics/space_model.hpp"

#include <cassert>
#include <cmath>

namespace downwash::detail {
namespace {

using dynamics::LaneSymmetric;
using dynamics::LaneVector;

LaneVector<double> vector_of(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

LaneVector<double> unit_vector_of(const Vector3& v) {
    const double length = std::sqrt(dot(v, v));
    assert(length > 0);
    return vector_of((1 / length) * v);
}

LaneSymmetric<double> symmetric_of(const Matrix3& m) {
    return {m[0][0], m[0][1], m[0][2], m[1][1], m[1][2], m[2][2]};
}

/// By cofactors.
LaneSymmetric<double> inverse_of(const LaneSymmetric<double>& m) {
    const double xx = m.yy * m.zz - m.yz * m.yz;
    const double xy = m.xz * m.yz - m.xy * m.zz;
    const double xz = m.xy * m.yz - m.xz * m.yy;
    const double scale = 1 / (m.xx * xx + m.xy * xy + m.xz * xz);
    return {scale * xx,
            scale * xy,
            scale * xz,
            scale * (m.xx * m.zz - m.xz * m.xz),
            scale * (m.xy * m.xz - m.xx * m.yz),
            scale * (m.xx * m.yy - m.xy * m.xy)};
}

}  // namespace

void set_multirotor(const SpacePlant& plant, SpaceStructure& structure, SpaceNumbers<double, 0>& out) {
    assert(plant.rotors.size() <= static_cast<std::size_t>(max_rotors));
    assert(plant.rotor_inertia_kg_m2 == 0 || plant.thrust_coefficient_n_s2 > 0);
    structure.rotor_count = static_cast<int>(plant.rotors.size());
    structure.has_rotor_lag = plant.time_constant_s > 0;
    structure.has_gyroscopic_term = plant.rotor_inertia_kg_m2 > 0;
    structure.has_drag = plant.drag.is_any();
    for (const SpaceLink& link : plant.links) {
        structure.has_drag = structure.has_drag || link.drag.is_any();
        structure.has_friction =
            structure.has_friction || link.viscous_friction_nm_s > 0 || link.coulomb_friction_nm > 0;
        structure.has_stops = structure.has_stops || link.stop.has_value();
    }
    out.body_drag_n_s_m = plant.drag.linear_n_s_m;
    out.body_drag_n_s2_m2 = plant.drag.quadratic_n_s2_m2;
    out.end_effector_m = vector_of(plant.end_effector_m);
    out.multirotor_mass_kg = plant.multirotor.mass_kg;
    out.inertia_kg_m2 = symmetric_of(plant.multirotor.inertia_kg_m2);
    out.inverse_inertia_1_kg_m2 = inverse_of(out.inertia_kg_m2);
    out.rotor_time_constant_s = plant.time_constant_s;
    out.power_coefficient_w_n1p5 = plant.power_coefficient_w_n1p5;
    const double spin_kg_m2_s_n0p5 =
        structure.has_gyroscopic_term ? plant.rotor_inertia_kg_m2 / std::sqrt(plant.thrust_coefficient_n_s2) : 0;
    int i = 0;
    for (const SpaceRotor& rotor : plant.rotors) {
        const double spin = rotor.spin < 0 ? -1 : 1;
        out.rotor[i++] = {vector_of(rotor.position_m), unit_vector_of(rotor.axis), -spin * rotor.drag_torque_m,
                          spin * spin_kg_m2_s_n0p5};
    }
    for (i = 0; i < structure.rotor_count; ++i) {
        out.center_m = out.center_m + 1.0 / structure.rotor_count * out.rotor[i].position_m;
        out.center_axis = out.center_axis + out.rotor[i].axis;
    }
    const double together = std::sqrt(dot(out.center_axis, out.center_axis));
    out.center_axis = together > 0 ? 1 / together * out.center_axis : LaneVector<double>{0, 0, 1};
}

SpaceLinkNumbers<double> link_numbers(const SpacePlant& plant, int link) {
    const auto number = static_cast<std::size_t>(link);
    const SpaceLink& from = plant.links[number];
    const bool is_last = number + 1 == plant.links.size();
    const Vector3& way_m = is_last ? plant.end_effector_m : plant.links[number + 1].joint_m;
    const double length_m = std::sqrt(dot(way_m, way_m));
    constexpr double far_rad = 1e6;
    const JointStop stop = from.stop.value_or(JointStop{-far_rad, far_rad, 0, 0});
    assert(stop.lower_rad < stop.upper_rad);
    return {from.body.mass_kg,
            vector_of(from.joint_m),
            unit_vector_of(from.axis),
            vector_of(from.center_of_mass_m),
            symmetric_of(from.body.inertia_kg_m2),
            length_m,
            length_m > 0 ? 1 / length_m : 0,
            from.drag.linear_n_s_m,
            from.drag.quadratic_n_s2_m2,
            from.viscous_friction_nm_s,
            from.coulomb_friction_nm,
            stop.lower_rad,
            stop.upper_rad,
            stop.stiffness_nm_rad,
            stop.dissipation_s_rad};
}

}  // namespace downwash::detail

#pragma once

#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/dynamics/plant_state.hpp"

// The two rigid bodies of the manipulator in closed form (docs/model.md 2; thesis C.1, A.6), one template over the lane
// type. Coordinates q = (x, z, pitch, arm) [m, m, rad, rad], speeds u = dq/dt; M du/dt + c = Q.

namespace downwash::dynamics {

/// Sines and cosines of one configuration and what follows from them, shared by all functions below.
template <class T>
struct Attitude {
    T sin_pitch, cos_pitch;
    T arm_x, arm_z;      ///< e: unit vector from the joint towards the end effector, world
    T joint_x, joint_z;  ///< r: centre of mass of the multirotor -> joint, world [m]
};

/// The attitude at a pitch and at an arm angle relative to the multirotor. @pre both together at most 1e5 rad
template <class T, class P>
Attitude<T> attitude(const BasicPlantModel<P>& model, T pitch_rad, T arm_rad) {
    Attitude<T> a;
    lane::sin_cos(pitch_rad, a.sin_pitch, a.cos_pitch);
    T sin_arm, cos_arm;
    lane::sin_cos(pitch_rad + arm_rad, sin_arm, cos_arm);
    a.arm_x = cos_arm;
    a.arm_z = -sin_arm;
    a.joint_x = a.cos_pitch * T(model.joint_x_m) + a.sin_pitch * T(model.joint_z_m);
    a.joint_z = a.cos_pitch * T(model.joint_z_m) - a.sin_pitch * T(model.joint_x_m);
    return a;
}

/// The entries of the symmetric mass matrix that are not zero or m, and the bias c (velocity products and gravity).
template <class T>
struct EquationsOfMotion {
    T pitch_x, pitch_z;  ///< J5 + Ea: how the arm's centre of mass moves with pitch [m]
    T arm_x, arm_z;      ///< Ea: how it moves with the arm angle [m]
    T m55, m57, m77;     ///< [kg m2]
    T bias[4];           ///< c [N, N, N m, N m]
};

/// The equations at an attitude and at speeds u [m/s, m/s, rad/s, rad/s].
template <class T, class P>
EquationsOfMotion<T> equations_of_motion(const BasicPlantModel<P>& model, const Attitude<T>& a, const T u[4]) {
    EquationsOfMotion<T> e;
    const T arm_mass(model.arm_mass_kg);
    const T reach(model.arm_center_of_mass_m);
    e.arm_x = reach * a.arm_z;
    e.arm_z = -(reach * a.arm_x);
    e.pitch_x = a.joint_z + e.arm_x;
    e.pitch_z = e.arm_z - a.joint_x;
    const T inertia_b(model.arm_inertia_kg_m2);
    e.m55 = T(model.pitch_inertia_kg_m2) + inertia_b + arm_mass * (e.pitch_x * e.pitch_x + e.pitch_z * e.pitch_z);
    e.m57 = inertia_b + arm_mass * (e.arm_x * e.pitch_x + e.arm_z * e.pitch_z);
    e.m77 = inertia_b + arm_mass * reach * reach;

    const T pitch_rate_squared = u[2] * u[2];
    const T arm_rate = u[2] + u[3];
    const T centripetal = reach * arm_rate * arm_rate;
    const T acceleration_x = -(a.joint_x * pitch_rate_squared + a.arm_x * centripetal);
    const T acceleration_z = -(a.joint_z * pitch_rate_squared + a.arm_z * centripetal);
    const T force_x = arm_mass * acceleration_x;
    const T force_z = arm_mass * (acceleration_z + T(standard_gravity_m_s2));
    e.bias[0] = force_x;
    e.bias[1] = arm_mass * acceleration_z + T(model.weight_n);
    e.bias[2] = e.pitch_x * force_x + e.pitch_z * force_z;
    e.bias[3] = e.arm_x * force_x + e.arm_z * force_z;
    return e;
}

/// Attitude and equations of motion at one instant.
template <class T>
struct Motion {
    Attitude<T> attitude;
    EquationsOfMotion<T> equations;
};

/// The motion at coordinates q [m, m, rad, rad] with speeds u [m/s, m/s, rad/s, rad/s].
template <class T, class P>
Motion<T> motion_at(const BasicPlantModel<P>& model, const T q[4], const T u[4]) {
    const Attitude<T> a = attitude(model, q[2], q[3]);
    return {a, equations_of_motion(model, a, u)};
}

/// Pitch and arm with the translation eliminated: s55 du5 + s57 du7 = g5, s57 du5 + s77 du7 = tau7 - c7 - coupling.
/// The determinant s55 s77 - s57^2 is positive for any positive masses and inertias.
template <class T>
struct RotationalSystem {
    T force_x, force_z;  ///< what is left of Q for the translation [N]
    T s55, s57, s77;     ///< [kg m2]
    T g5;                ///< [N m]
    T arm_coupling;      ///< torque on the arm from the translation [N m]
};

/// The system under the generalised forces Q of x, z and pitch [N, N, N m].
template <class T, class P>
RotationalSystem<T> rotational_system(const BasicPlantModel<P>& model, const EquationsOfMotion<T>& e,
                                      const T force[3]) {
    RotationalSystem<T> s;
    const T reduced_mass(model.reduced_mass_kg);
    const T ratio(model.arm_mass_ratio);
    const T inertia_b(model.arm_inertia_kg_m2);
    const T reach(model.arm_center_of_mass_m);
    s.force_x = force[0] - e.bias[0];
    s.force_z = force[1] - e.bias[1];
    s.s55 = T(model.pitch_inertia_kg_m2) + inertia_b + reduced_mass * (e.pitch_x * e.pitch_x + e.pitch_z * e.pitch_z);
    s.s57 = inertia_b + reduced_mass * (e.arm_x * e.pitch_x + e.arm_z * e.pitch_z);
    s.s77 = inertia_b + reduced_mass * reach * reach;
    s.g5 = force[2] - e.bias[2] - ratio * (e.pitch_x * s.force_x + e.pitch_z * s.force_z);
    s.arm_coupling = ratio * (e.arm_x * s.force_x + e.arm_z * s.force_z);
    return s;
}

/// du/dt under the generalised forces Q [N, N, N m, N m].
template <class T, class P>
void forward_dynamics(const BasicPlantModel<P>& model, const EquationsOfMotion<T>& e, const T force[4],
                      T acceleration[4]) {
    const RotationalSystem<T> s = rotational_system(model, e, force);
    const T g7 = force[3] - e.bias[3] - s.arm_coupling;
    const T inverse_determinant = T(1) / (s.s55 * s.s77 - s.s57 * s.s57);
    acceleration[2] = (s.s77 * s.g5 - s.s57 * g7) * inverse_determinant;
    acceleration[3] = (s.s55 * g7 - s.s57 * s.g5) * inverse_determinant;
    const T ratio(model.arm_mass_ratio);
    const T inverse_mass(model.inverse_mass_1_kg);
    acceleration[0] = s.force_x * inverse_mass - ratio * (e.pitch_x * acceleration[2] + e.arm_x * acceleration[3]);
    acceleration[1] = s.force_z * inverse_mass - ratio * (e.pitch_z * acceleration[2] + e.arm_z * acceleration[3]);
}

/// The generalised forces Q [N, N, N m, N m] that produce du/dt.
template <class T, class P>
void inverse_dynamics(const BasicPlantModel<P>& model, const EquationsOfMotion<T>& e, const T acceleration[4],
                      T force[4]) {
    const T mass(model.total_mass_kg);
    const T arm_mass(model.arm_mass_kg);
    const T* du = acceleration;
    force[0] = mass * du[0] + arm_mass * (e.pitch_x * du[2] + e.arm_x * du[3]) + e.bias[0];
    force[1] = mass * du[1] + arm_mass * (e.pitch_z * du[2] + e.arm_z * du[3]) + e.bias[1];
    force[2] = arm_mass * (e.pitch_x * du[0] + e.pitch_z * du[1]) + e.m55 * du[2] + e.m57 * du[3] + e.bias[2];
    force[3] = arm_mass * (e.arm_x * du[0] + e.arm_z * du[1]) + e.m57 * du[2] + e.m77 * du[3] + e.bias[3];
}

/// The joint torque [N m] that gives the arm the acceleration `arm_acceleration` [rad/s2] while the other generalised
/// forces are `force` [N, N, N m]: forward dynamics with du7 given.
template <class T, class P>
T joint_torque_for(const BasicPlantModel<P>& model, const EquationsOfMotion<T>& e, const T force[3],
                   T arm_acceleration) {
    const RotationalSystem<T> s = rotational_system(model, e, force);
    const T pitch_acceleration = (s.g5 - s.s57 * arm_acceleration) / s.s55;
    return s.s57 * pitch_acceleration + s.s77 * arm_acceleration + s.arm_coupling + e.bias[3];
}

/// Kinetic energy of both bodies [J].
template <class T, class P>
T kinetic_energy(const BasicPlantModel<P>& model, const EquationsOfMotion<T>& e, const T u[4]) {
    const T translation = T(model.total_mass_kg) * (u[0] * u[0] + u[1] * u[1]);
    const T coupling = T(model.arm_mass_kg) *
                       (u[0] * (e.pitch_x * u[2] + e.arm_x * u[3]) + u[1] * (e.pitch_z * u[2] + e.arm_z * u[3]));
    const T rotation = e.m55 * u[2] * u[2] + T(2) * e.m57 * u[2] * u[3] + e.m77 * u[3] * u[3];
    return T(0.5) * (translation + rotation) + coupling;
}

/// Potential energy of both bodies over z = 0 [J].
template <class T, class P>
T potential_energy(const BasicPlantModel<P>& model, const Attitude<T>& a, T z_m) {
    const T arm_height = z_m + a.joint_z + T(model.arm_center_of_mass_m) * a.arm_z;
    return T(standard_gravity_m_s2) * (T(model.multirotor_mass_kg) * z_m + T(model.arm_mass_kg) * arm_height);
}

/// Adds the drag of both bodies in moving air to generalised forces Q [N, N, N m, N m] (docs/model.md 2.1). Along the
/// arm the force is integrated with the two-point Gauss rule: exact where the stream crosses all of it from one side.
/// @param u speeds [m/s, m/s, rad/s, rad/s]   @param wind velocity of the air [m/s]
template <class T, class P>
void add_drag(const BasicPlantModel<P>& model, const Attitude<T>& a, const T u[4], const PlanePoint<T>& wind,
              T force[4]) {
    const T x_m_s = u[0] - wind.x;
    const T z_m_s = u[1] - wind.z;
    const T speed_m_s = lane::sqrt(x_m_s * x_m_s + z_m_s * z_m_s);
    const T resistance = T(model.body_drag_n_s_m) + T(model.body_drag_n_s2_m2) * speed_m_s;
    force[0] = force[0] - resistance * x_m_s;
    force[1] = force[1] - resistance * z_m_s;
    // Across the arm: n = (ez, -ex), the direction in which a point of it moves as the arm turns.
    const T arm_rate = u[2] + u[3];
    const T joint_m_s = (x_m_s + u[2] * a.joint_z) * a.arm_z - (z_m_s - u[2] * a.joint_x) * a.arm_x;
    const T lever_m = a.joint_z * a.arm_z + a.joint_x * a.arm_x;
    constexpr double point[] = {0.21132486540518713, 0.78867513459481287};  // 1/2 -+ 1/sqrt(12) of the length
    for (const double share : point) {
        const T from_joint_m = T(share) * T(model.arm_length_m);
        const T across_m_s = joint_m_s + arm_rate * from_joint_m;
        const T half_n =
            T(-0.5) * (T(model.arm_drag_n_s_m) + T(model.arm_drag_n_s2_m2) * lane::abs(across_m_s)) * across_m_s;
        force[0] = force[0] + half_n * a.arm_z;
        force[1] = force[1] - half_n * a.arm_x;
        force[2] = force[2] + half_n * (lever_m + from_joint_m);
        force[3] = force[3] + half_n * from_joint_m;
    }
}

/// The end effector in the plane [m].
template <class T, class P>
PlanePoint<T> end_effector_position(const BasicPlantModel<P>& model, const Attitude<T>& a, T x_m, T z_m) {
    const T length(model.arm_length_m);
    return {x_m + a.joint_x + length * a.arm_x, z_m + a.joint_z + length * a.arm_z};
}

/// A point of the multirotor, given in its body frame, in the plane [m].
template <class T>
PlanePoint<T> body_point(const Attitude<T>& a, T x_m, T z_m, T body_x_m, T body_z_m) {
    return {x_m + a.cos_pitch * body_x_m + a.sin_pitch * body_z_m,
            z_m - a.sin_pitch * body_x_m + a.cos_pitch * body_z_m};
}

/// The hub of rotor i in the plane [m]; its lateral offset does not change.
template <class T, class P>
PlanePoint<T> rotor_position(const BasicPlantModel<P>& model, const Attitude<T>& a, T x_m, T z_m, int rotor) {
    return body_point(a, x_m, z_m, T(model.rotor_x_m[rotor]), T(model.rotor_z_m[rotor]));
}

/// The centre between all hubs in the plane [m].
template <class T, class P>
PlanePoint<T> center_position(const BasicPlantModel<P>& model, const Attitude<T>& a, T x_m, T z_m) {
    return body_point(a, x_m, z_m, T(model.center_x_m), T(model.center_z_m));
}

}  // namespace downwash::dynamics

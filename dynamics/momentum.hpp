#pragma once

#include "downwash/dynamics/rigid_body.hpp"

// The generalised momentum p = M u of the manipulator, and what changes it besides forces; one template over the lane
// type. Coordinates and speeds as in rigid_body.hpp.

namespace downwash::dynamics {

/// p = M u [kg m/s, kg m/s, kg m2/s, kg m2/s] at speeds u [m/s, m/s, rad/s, rad/s].
template <class T, class P>
void momentum(const BasicPlantModel<P>& model, const EquationsOfMotion<T>& e, const T u[4], T p[4]) {
    const T mass(model.total_mass_kg);
    const T arm_mass(model.arm_mass_kg);
    p[0] = mass * u[0] + arm_mass * (e.pitch_x * u[2] + e.arm_x * u[3]);
    p[1] = mass * u[1] + arm_mass * (e.pitch_z * u[2] + e.arm_z * u[3]);
    p[2] = arm_mass * (e.pitch_x * u[0] + e.pitch_z * u[1]) + e.m55 * u[2] + e.m57 * u[3];
    p[3] = arm_mass * (e.arm_x * u[0] + e.arm_z * u[1]) + e.m57 * u[2] + e.m77 * u[3];
}

/// dp/dt without any force [N, N, N m, N m]: dM/dt u - c. By Lagrange's equations this is the change of kinetic less
/// potential energy with the coordinates, so that nothing has to be differentiated in time: M does not depend on x and
/// z, and of its entries only mB (J5 + Ea), mB Ea and |J5 + Ea|^2, Ea . J5 depend on the angles.
template <class T, class P>
void free_momentum_rate(const BasicPlantModel<P>& model, const Attitude<T>& a, const EquationsOfMotion<T>& e,
                        const T u[4], T rate[4]) {
    const T arm_mass(model.arm_mass_kg);
    const T gravity(standard_gravity_m_s2);
    const T reach(model.arm_center_of_mass_m);
    const T arm_rate = u[2] + u[3];
    // v . lB e and v . r: a quarter turn of the arm, and of the joint, turns Ea into -lB e and J5 into -r.
    const T along_arm = reach * (u[0] * a.arm_x + u[1] * a.arm_z);
    const T along_joint = u[0] * a.joint_x + u[1] * a.joint_z;
    // J5 = (rz, -rx), so that J5 . lB e changes by this as the arm turns about its joint.
    const T lever = reach * (a.joint_z * a.arm_x - a.joint_x * a.arm_z);
    rate[0] = T(0);
    rate[1] = -T(model.weight_n);
    rate[2] = -(arm_mass * (along_joint * u[2] + along_arm * arm_rate + gravity * e.pitch_z));
    rate[3] = -(arm_mass * (along_arm * arm_rate + lever * u[2] * arm_rate + gravity * e.arm_z));
}

}  // namespace downwash::dynamics

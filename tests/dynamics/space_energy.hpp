#pragma once

#include "downwash/dynamics/space_body.hpp"

// Energy and momentum of the plant in space.

namespace downwash::dynamics {

/// Momentum and energy at one instant.
template <class T>
struct SpaceInvariants {
    LaneVector<T> momentum_n_s;           ///< in world axes
    LaneVector<T> angular_momentum_nm_s;  ///< about the common centre of mass, in world axes; of spinning rotors too
    LaneVector<T> center_of_mass_m;       ///< of everything, in the world
    T kinetic_j;                          ///< of all bodies; rotors count as fixed to the multirotor
    T potential_j;                        ///< over z = 0
};

/// Energy and momentum at coordinates q and speeds u.
/// @param rotor_spin angular momentum of the rotors relative to the multirotor, in body axes [N m s]: rotor_spin_of()
template <class T, int n, class P>
SpaceInvariants<T> invariants_at(const BasicSpaceModel<P, n>& model, const T q[space_coordinates<n>],
                                 const T u[space_speeds<n>], const LaneVector<T>& rotor_spin) {
    const SpacePlaces<T, n> p = places_at(model, q);
    const SpaceEquations<T, n> e = equations_of_motion(model, p, u);
    const LaneVector<T> velocity = turned_back(p.attitude, LaneVector<T>{u[0], u[1], u[2]});
    const LaneVector<T> rate{u[3], u[4], u[5]};
    LaneVector<T> relative = cross(rate, e.first_moment_kg_m);  // momentum less that of the common velocity
    LaneVector<T> spin = e.inertia_kg_m2 * rate;
    T twice_energy(0);
    for (int i = 0; i < n; ++i) {
        relative = relative + u[6 + i] * e.joint_push_kg_m[i];
        spin = spin + u[6 + i] * e.joint_spin_kg_m2[i];
        T joint_spin = dot(e.joint_spin_kg_m2[i], rate);
        for (int k = 0; k < n; ++k) {
            joint_spin = joint_spin + (k < i ? e.joint_inertia_kg_m2[k][i] : e.joint_inertia_kg_m2[i][k]) * u[6 + k];
        }
        twice_energy = twice_energy + joint_spin * u[6 + i];
    }
    twice_energy = twice_energy + dot(spin, rate);
    const T mass(model.total_mass_kg);
    const LaneVector<T> center = T(model.inverse_mass_1_kg) * e.first_moment_kg_m;
    const LaneVector<T> center_in_world = p.attitude * center;
    SpaceInvariants<T> all;
    all.momentum_n_s = p.attitude * (mass * velocity + relative);
    // What the common velocity adds about the multirotor's centre of mass it takes away again about the common one.
    all.angular_momentum_nm_s = p.attitude * (spin - cross(center, relative) + rotor_spin);
    all.center_of_mass_m = LaneVector<T>{q[0], q[1], q[2]} + center_in_world;
    all.kinetic_j = T(0.5) * (mass * dot(velocity, velocity) + twice_energy) + dot(velocity, relative);
    all.potential_j = T(standard_gravity_m_s2) * mass * all.center_of_mass_m.z;
    return all;
}

}  // namespace downwash::dynamics

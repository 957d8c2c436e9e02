#pragma once

#include "downwash/dynamics/space_body.hpp"

// The generalised momentum of the plant in space, and what changes it besides forces; one template over the lane type.
// Three numbers are the linear momentum in world axes, three the angular momentum about the multirotor's centre of mass
// in body axes, n that of each joint's outer links about its axis.

namespace downwash::dynamics {

/// p = M u [kg m/s, kg m2/s, kg m2/s] at speeds u.
/// @param e equations_of_motion() there   @param[out] out 6 + n numbers
template <class T, int n, class P>
void momentum(const BasicSpaceModel<P, n>& model, const SpacePlaces<T, n>& p, const SpaceEquations<T, n>& e,
              const T u[space_speeds<n>], T out[space_speeds<n>]) {
    const LaneVector<T> velocity = turned_back(p.attitude, LaneVector<T>{u[0], u[1], u[2]});
    const LaneVector<T> rate{u[3], u[4], u[5]};
    LaneVector<T> push = cross(rate, e.first_moment_kg_m);
    LaneVector<T> spin = cross(e.first_moment_kg_m, velocity) + e.inertia_kg_m2 * rate;
    for (int i = 0; i < n; ++i) {
        push = push + u[6 + i] * e.joint_push_kg_m[i];
        spin = spin + u[6 + i] * e.joint_spin_kg_m2[i];
        T joint = dot(e.joint_push_kg_m[i], velocity) + dot(e.joint_spin_kg_m2[i], rate);
        for (int k = 0; k < n; ++k) {
            joint = joint + (k < i ? e.joint_inertia_kg_m2[k][i] : e.joint_inertia_kg_m2[i][k]) * u[6 + k];
        }
        out[6 + i] = joint;
    }
    push = p.attitude * push;
    out[0] = T(model.total_mass_kg) * u[0] + push.x;
    out[1] = T(model.total_mass_kg) * u[1] + push.y;
    out[2] = T(model.total_mass_kg) * u[2] + push.z;
    out[3] = spin.x;
    out[4] = spin.y;
    out[5] = spin.z;
}

/// dp/dt without any force but weight. About a point A that moves at v the angular momentum H of bodies with the linear
/// momentum P changes by the torque about A less v x P (Euler's second law). In axes that turn it changes by -w x H
/// besides.
/// @param[out] rate 6 + n numbers
template <class T, int n, class P>
void free_momentum_rate(const BasicSpaceModel<P, n>& model, const SpacePlaces<T, n>& p, const T u[space_speeds<n>],
                        T rate[space_speeds<n>]) {
    const LaneVector<T> velocity = turned_back(p.attitude, LaneVector<T>{u[0], u[1], u[2]});
    const LaneVector<T> body_rate{u[3], u[4], u[5]};
    const LaneVector<T> gravity =
        turned_back(p.attitude, LaneVector<T>{T(0), T(0), T(-standard_gravity_m_s2)});  // in body axes
    // Outward: how each link moves.
    LaneVector<T> joint_velocity[room_for<n>], link_rate[room_for<n>];
    LaneVector<T> link_push[room_for<n>], link_spin[room_for<n>];  // its momenta, the angular one about A
    LaneVector<T> from{T(0), T(0), T(0)};
    LaneVector<T> from_velocity = velocity;
    LaneVector<T> turn = body_rate;
    for (int i = 0; i < n; ++i) {
        joint_velocity[i] = from_velocity + cross(turn, p.joint_m[i] - from);
        turn = turn + u[6 + i] * p.axis[i];
        link_rate[i] = turn;
        link_push[i] = T(model.link[i].mass_kg) * (joint_velocity[i] + cross(turn, p.center_m[i] - p.joint_m[i]));
        link_spin[i] = cross(p.center_m[i], link_push[i]) + p.inertia_kg_m2[i] * turn;
        from = p.joint_m[i];
        from_velocity = joint_velocity[i];
    }
    // Inward: sums over each link and all behind it.
    LaneVector<T> push{T(0), T(0), T(0)};
    LaneVector<T> spin{T(0), T(0), T(0)};
    LaneVector<T> first{T(0), T(0), T(0)};  // first moment of mass about A
    if constexpr (n > 0) {
        T mass(0);
        for (int i = n - 1; i >= 0; --i) {
            push = push + link_push[i];
            spin = spin + link_spin[i];
            mass = mass + T(model.link[i].mass_kg);
            first = first + T(model.link[i].mass_kg) * p.center_m[i];
            const LaneVector<T> about_joint = spin - cross(p.joint_m[i], push);
            const LaneVector<T> weight_moment = cross(first - mass * p.joint_m[i], gravity);
            rate[6 + i] = dot(p.axis[i], weight_moment - cross(joint_velocity[i], push)) +
                          dot(cross(link_rate[i], p.axis[i]), about_joint);
        }
    }
    const LaneVector<T> all_spin = spread<T>(model.inertia_kg_m2) * body_rate + spin;
    const LaneVector<T> change = cross(first, gravity) - cross(velocity, push) - cross(body_rate, all_spin);
    rate[0] = T(0);
    rate[1] = T(0);
    rate[2] = T(-standard_gravity_m_s2) * T(model.total_mass_kg);
    rate[3] = change.x;
    rate[4] = change.y;
    rate[5] = change.z;
}

}  // namespace downwash::dynamics

#pragma once

#include "downwash/dynamics/space_model.hpp"

// Equations of motion of the multirotor and its arm in space (docs/model.md 2.2), one template over the lane type.
// Coordinates q: position of the multirotor's centre of mass [m], its attitude as a quaternion (w, x, y, z) that turns
// body axes into world axes, joint angles [rad]. Speeds u: velocity of that point in world axes [m/s], angular velocity
// in body axes [rad/s], joint rates [rad/s].
//
// All bodies are seen from the multirotor's centre of mass, in body axes: so no inertia has to be moved from frame to
// frame, and attitude enters with gravity alone. Gravity is an acceleration of the world upward.

namespace downwash::dynamics {

/// Coordinates and speeds of a plant with n joints.
template <int n>
inline constexpr int space_coordinates = 7 + n;
template <int n>
inline constexpr int space_speeds = 6 + n;

/// Where all bodies are. All but the attitude in body axes, places from the multirotor's centre of mass.
template <class T, int n>
struct SpacePlaces {
    LaneRotation<T> attitude;  ///< from body axes to world axes
    LaneVector<T> joint_m[room_for<n>];
    LaneVector<T> axis[room_for<n>];
    LaneVector<T> center_m[room_for<n>];          ///< centres of mass of the links
    LaneSymmetric<T> inertia_kg_m2[room_for<n>];  ///< of the links about them
};

/// The places at coordinates q.
template <class T, int n, class P>
SpacePlaces<T, n> places_at(const BasicSpaceModel<P, n>& model, const T q[space_coordinates<n>]) {
    SpacePlaces<T, n> p;
    p.attitude = rotation_of(q + 3);
    LaneRotation<T> link_axes;  // of the link before, in body axes
    for (int i = 0; i < n; ++i) {
        const SpaceLinkNumbers<P>& link = model.link[i];
        const LaneVector<T> axis = spread<T>(link.axis);
        const LaneRotation<T> turn = rotation_about(axis, q[7 + i]);
        if (i == 0) {
            p.joint_m[i] = spread<T>(link.joint_m);
            p.axis[i] = axis;
            link_axes = turn;
        } else {
            p.joint_m[i] = p.joint_m[i - 1] + link_axes * spread<T>(link.joint_m);
            p.axis[i] = link_axes * axis;
            link_axes = link_axes * turn;
        }
        p.center_m[i] = p.joint_m[i] + link_axes * spread<T>(link.center_of_mass_m);
        p.inertia_kg_m2[i] = turned(link_axes, spread<T>(link.inertia_kg_m2));
    }
    return p;
}

/// The mass matrix and the velocity products in body axes. With a the acceleration of the multirotor's centre of mass
/// less gravity, and y the other accelerations (angular, joints):
///   m a   + S y + bias_force  = force,
///   S^T a + H y + bias        = (torque about the multirotor's centre of mass, joint torques).
template <class T, int n>
struct SpaceEquations {
    LaneVector<T> first_moment_kg_m;  ///< of all mass; S y = rate x first moment + sum joint_push rate_i
    LaneVector<T> joint_push_kg_m[room_for<n>];
    T h[3 + n][3 + n];  ///< H; the upper triangle and the diagonal are set
    LaneVector<T> bias_force_n;
    T bias_nm[3 + n];
};

/// Composite bodies (Walker and Orin 1982, method 3; Featherstone, Rigid Body Dynamics Algorithms, 6.2) for H and S,
/// the recursive Newton-Euler algorithm without accelerations for the bias.
template <class T, int n, class P>
SpaceEquations<T, n> equations_of_motion(const BasicSpaceModel<P, n>& model, const SpacePlaces<T, n>& p,
                                         const T u[space_speeds<n>]) {
    SpaceEquations<T, n> e;
    const LaneVector<T> body_rate{u[3], u[4], u[5]};
    const LaneSymmetric<T> body_inertia = spread<T>(model.inertia_kg_m2);

    // Outward: what the links would need if nothing but velocity products accelerated them.
    LaneVector<T> link_force[room_for<n>];
    LaneVector<T> link_moment[room_for<n>];  // about the multirotor's centre of mass
    LaneVector<T> rate = body_rate;
    LaneVector<T> rate_change{T(0), T(0), T(0)};
    LaneVector<T> acceleration{T(0), T(0), T(0)};  // of `from`
    LaneVector<T> from{T(0), T(0), T(0)};
    for (int i = 0; i < n; ++i) {
        const LaneVector<T> along = p.joint_m[i] - from;
        from = p.joint_m[i];
        acceleration = acceleration + cross(rate, cross(rate, along));
        if (i > 0) {
            acceleration = acceleration + cross(rate_change, along);
        }
        const LaneVector<T> joint_rate = u[6 + i] * p.axis[i];
        rate_change = rate_change + cross(rate, joint_rate);
        rate = rate + joint_rate;
        const LaneVector<T> to_center = p.center_m[i] - p.joint_m[i];
        link_force[i] = T(model.link[i].mass_kg) *
                        (acceleration + cross(rate_change, to_center) + cross(rate, cross(rate, to_center)));
        link_moment[i] = cross(p.center_m[i], link_force[i]) + p.inertia_kg_m2[i] * rate_change +
                         cross(rate, p.inertia_kg_m2[i] * rate);
    }

    // Inward: sums over each link and all behind it.
    LaneVector<T> force{T(0), T(0), T(0)};
    LaneVector<T> moment = cross(body_rate, body_inertia * body_rate);
    LaneVector<T> first{T(0), T(0), T(0)};
    LaneSymmetric<T> second = body_inertia;
    if constexpr (n > 0) {
        T mass(0);
        LaneVector<T> arm_moment{T(0), T(0), T(0)};
        LaneSymmetric<T> arm_second{T(0), T(0), T(0), T(0), T(0), T(0)};
        for (int i = n - 1; i >= 0; --i) {
            const T link_mass(model.link[i].mass_kg);
            mass = mass + link_mass;
            first = first + link_mass * p.center_m[i];
            arm_second = arm_second + (p.inertia_kg_m2[i] + point_inertia(link_mass, p.center_m[i]));
            force = force + link_force[i];
            arm_moment = arm_moment + link_moment[i];
            e.bias_nm[3 + i] = dot(p.axis[i], arm_moment - cross(p.joint_m[i], force));
            // Momentum of these links when joint i turns at 1 rad/s: they move at `slide` where the multirotor is.
            const LaneVector<T> slide = cross(p.joint_m[i], p.axis[i]);
            const LaneVector<T> push = mass * slide + cross(p.axis[i], first);
            const LaneVector<T> spin = cross(first, slide) + arm_second * p.axis[i];
            e.joint_push_kg_m[i] = push;
            e.h[0][3 + i] = spin.x;
            e.h[1][3 + i] = spin.y;
            e.h[2][3 + i] = spin.z;
            for (int k = 0; k <= i; ++k) {
                e.h[3 + k][3 + i] = dot(p.axis[k], spin - cross(p.joint_m[k], push));
            }
        }
        moment = moment + arm_moment;
        second = second + arm_second;
    }
    e.first_moment_kg_m = first;
    e.bias_force_n = force;
    e.bias_nm[0] = moment.x;
    e.bias_nm[1] = moment.y;
    e.bias_nm[2] = moment.z;
    e.h[0][0] = second.xx;
    e.h[0][1] = second.xy;
    e.h[0][2] = second.xz;
    e.h[1][1] = second.yy;
    e.h[1][2] = second.yz;
    e.h[2][2] = second.zz;
    return e;
}

/// Solves a symmetric positive definite system by its factors L D L^T, in place. @param a upper triangle
template <class T, int size>
void solve_positive(T a[size][size], T x[size]) {
    T inverse_pivot[size];
    for (int i = 0; i < size; ++i) {
        inverse_pivot[i] = T(1) / a[i][i];
        for (int k = i + 1; k < size; ++k) {
            const T factor = a[i][k] * inverse_pivot[i];
            for (int j = k; j < size; ++j) {
                a[k][j] = a[k][j] - factor * a[i][j];
            }
            x[k] = x[k] - factor * x[i];
        }
    }
    for (int i = size - 1; i >= 0; --i) {
        T rest = x[i];
        for (int j = i + 1; j < size; ++j) {
            rest = rest - a[i][j] * x[j];
        }
        x[i] = rest * inverse_pivot[i];
    }
}

/// Force and torque on the multirotor in body axes, the torque about its centre of mass.
template <class T>
struct SpaceWrench {
    LaneVector<T> force_n, torque_nm;
};

/// du/dt under a wrench on the multirotor and joint torques. Eliminates the translation, whose mass is the same in
/// every direction, and solves for the other 3 + n.
template <class T, int n, class P>
void forward_dynamics(const BasicSpaceModel<P, n>& model, const SpacePlaces<T, n>& p, const SpaceEquations<T, n>& e,
                      const SpaceWrench<T>& wrench, const T joint_torque_nm[room_for<n>], T du[space_speeds<n>]) {
    const T inverse_mass(model.inverse_mass_1_kg);
    LaneVector<T> a;
    if constexpr (n == 0) {
        const LaneVector<T> spin = wrench.torque_nm - LaneVector<T>{e.bias_nm[0], e.bias_nm[1], e.bias_nm[2]};
        const LaneVector<T> rate_change = spread<T>(model.inverse_inertia_1_kg_m2) * spin;
        du[3] = rate_change.x;
        du[4] = rate_change.y;
        du[5] = rate_change.z;
        a = inverse_mass * wrench.force_n;
    } else {
        const LaneVector<T> force = wrench.force_n - e.bias_force_n;
        const LaneVector<T> center = inverse_mass * e.first_moment_kg_m;  // common centre of mass
        const LaneVector<T> lever = cross(center, force);
        T y[3 + n] = {wrench.torque_nm.x - e.bias_nm[0] - lever.x, wrench.torque_nm.y - e.bias_nm[1] - lever.y,
                      wrench.torque_nm.z - e.bias_nm[2] - lever.z};
        T h[3 + n][3 + n];
        const LaneSymmetric<T> moved = point_inertia(T(model.total_mass_kg), center);
        h[0][0] = e.h[0][0] - moved.xx;
        h[0][1] = e.h[0][1] - moved.xy;
        h[0][2] = e.h[0][2] - moved.xz;
        h[1][1] = e.h[1][1] - moved.yy;
        h[1][2] = e.h[1][2] - moved.yz;
        h[2][2] = e.h[2][2] - moved.zz;
        for (int i = 0; i < n; ++i) {
            const LaneVector<T> push = inverse_mass * e.joint_push_kg_m[i];
            const LaneVector<T> coupling = cross(e.first_moment_kg_m, push);
            h[0][3 + i] = e.h[0][3 + i] - coupling.x;
            h[1][3 + i] = e.h[1][3 + i] - coupling.y;
            h[2][3 + i] = e.h[2][3 + i] - coupling.z;
            for (int k = 0; k <= i; ++k) {
                h[3 + k][3 + i] = e.h[3 + k][3 + i] - dot(e.joint_push_kg_m[k], push);
            }
            y[3 + i] = joint_torque_nm[i] - e.bias_nm[3 + i] - dot(push, force);
        }
        solve_positive<T, 3 + n>(h, y);
        LaneVector<T> rest = force - cross(LaneVector<T>{y[0], y[1], y[2]}, e.first_moment_kg_m);
        for (int i = 0; i < n; ++i) {
            rest = rest - y[3 + i] * e.joint_push_kg_m[i];
        }
        a = inverse_mass * rest;
        for (int i = 0; i < 3 + n; ++i) {
            du[3 + i] = y[i];
        }
    }
    const LaneVector<T> in_world = p.attitude * a;
    du[0] = in_world.x;
    du[1] = in_world.y;
    du[2] = in_world.z - T(standard_gravity_m_s2);
}

/// dq/dt at speeds u; the quaternion's is half of q (0, body rate).
template <class T, int n>
void coordinate_rates(const T q[space_coordinates<n>], const T u[space_speeds<n>], T dq[space_coordinates<n>]) {
    for (int i = 0; i < 3; ++i) {
        dq[i] = u[i];
    }
    const T half_x = T(0.5) * u[3];
    const T half_y = T(0.5) * u[4];
    const T half_z = T(0.5) * u[5];
    dq[3] = -(q[4] * half_x + q[5] * half_y + q[6] * half_z);
    dq[4] = q[3] * half_x + q[5] * half_z - q[6] * half_y;
    dq[5] = q[3] * half_y + q[6] * half_x - q[4] * half_z;
    dq[6] = q[3] * half_z + q[4] * half_y - q[5] * half_x;
    for (int i = 0; i < n; ++i) {
        dq[7 + i] = u[6 + i];
    }
}

}  // namespace downwash::dynamics

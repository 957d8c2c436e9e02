#pragma once

#include "downwash/dynamics/space_model.hpp"

// Equations of motion of the multirotor and its arm in space (docs/model.md 2.2), one template over the lane type.
// Coordinates q: position of the multirotor's centre of mass [m], its attitude as a quaternion (w, x, y, z) that turns
// body axes into world axes, joint angles [rad]. Speeds u: velocity of that point in world axes [m/s], angular velocity
// in body axes [rad/s], joint rates [rad/s].
//
// All bodies are seen from the multirotor's centre of mass, in body axes: so no inertia has to be moved from frame to
// frame, and attitude enters with gravity alone. Gravity is an acceleration of the world upward. Functions are inlined
// always: what they hand on then stays in registers, which makes arms 1.5 times as fast.

namespace downwash::dynamics {

/// Number of coordinates of a plant with n joints.
template <int n>
inline constexpr int space_coordinates = 7 + n;
/// Number of speeds of a plant with n joints.
template <int n>
inline constexpr int space_speeds = 6 + n;

/// Where all bodies are. All but the attitude in body axes, places from the multirotor's centre of mass.
template <class T, int n>
struct SpacePlaces {
    LaneRotation<T> attitude;  ///< from body axes to world axes
    LaneVector<T> joint_m[room_for<n>];
    LaneVector<T> axis[room_for<n>];
    LaneVector<T> center_m[room_for<n>];          ///< centres of mass of the links
    LaneSymmetric<T> inertia_kg_m2[room_for<n>];  ///< inertia of each link about its centre of mass
    LaneVector<T> end_effector_m;
};

/// The places at coordinates q. @param attitude that of q: rotation_of(q + 3)
template <class T, int n, class P>
[[gnu::always_inline]] inline SpacePlaces<T, n> places_at(const BasicSpaceModel<P, n>& model,
                                                          const T q[space_coordinates<n>],
                                                          const LaneRotation<T>& attitude) {
    SpacePlaces<T, n> p;
    p.attitude = attitude;
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
    p.end_effector_m = spread<T>(model.end_effector_m);
    if constexpr (n > 0) {
        p.end_effector_m = p.joint_m[n - 1] + link_axes * p.end_effector_m;
    }
    return p;
}

/// The places at coordinates, whose rotation it computes.
template <class T, int n, class P>
SpacePlaces<T, n> places_at(const BasicSpaceModel<P, n>& model, const T q[space_coordinates<n>]) {
    return places_at(model, q, rotation_of(q + 3));
}

/// Where a point of a link is in the world [m], such as the end effector on the last one.
/// @param link 0 <= link < n   @param point_m from the link's joint, in its own axes
template <class T, int n, class P>
LaneVector<T> link_point(const BasicSpaceModel<P, n>& model, const T q[space_coordinates<n>], int link,
                         const LaneVector<T>& point_m) {
    LaneVector<T> at = point_m;
    for (int i = link; i >= 0; --i) {
        at = spread<T>(model.link[i].joint_m) + rotation_about(spread<T>(model.link[i].axis), q[7 + i]) * at;
    }
    return LaneVector<T>{q[0], q[1], q[2]} + rotation_of(q + 3) * at;
}

/// The mass matrix and the velocity products in body axes. With a the acceleration of the multirotor's centre of mass
/// less gravity, w' the angular acceleration and y_i those of the joints:
///   m a + w' x first_moment + sum joint_push_i y_i + bias_force = force,
///   first_moment x a + inertia w' + sum joint_spin_i y_i + bias_torque = torque about the multirotor's centre of mass,
///   joint_push_i . a + joint_spin_i . w' + sum joint_inertia_ik y_k + bias_joint_i = torque of joint i.
template <class T, int n>
struct SpaceEquations {
    LaneVector<T> first_moment_kg_m;  ///< first moment of all mass
    LaneSymmetric<T> inertia_kg_m2;   ///< inertia of all mass, about the multirotor's centre of mass
    LaneVector<T> joint_push_kg_m[room_for<n>];
    LaneVector<T> joint_spin_kg_m2[room_for<n>];
    T joint_inertia_kg_m2[room_for<n>][room_for<n>];  ///< the upper triangle and the diagonal are set
    LaneVector<T> bias_force_n, bias_torque_nm;
    T bias_joint_nm[room_for<n>];
};

/// Composite bodies (Walker and Orin 1982, method 3; Featherstone, Rigid Body Dynamics Algorithms, 6.2) for H and S,
/// the recursive Newton-Euler algorithm without accelerations for the bias.
template <class T, int n, class P>
[[gnu::always_inline]] inline SpaceEquations<T, n> equations_of_motion(const BasicSpaceModel<P, n>& model,
                                                                       const SpacePlaces<T, n>& p,
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
            e.bias_joint_nm[i] = dot(p.axis[i], arm_moment - cross(p.joint_m[i], force));
            // Momentum of these links when joint i turns at 1 rad/s: they move at `slide` where the multirotor is.
            const LaneVector<T> slide = cross(p.joint_m[i], p.axis[i]);
            const LaneVector<T> push = mass * slide + cross(p.axis[i], first);
            const LaneVector<T> spin = cross(first, slide) + arm_second * p.axis[i];
            e.joint_push_kg_m[i] = push;
            e.joint_spin_kg_m2[i] = spin;
            for (int k = 0; k <= i; ++k) {
                e.joint_inertia_kg_m2[k][i] = dot(p.axis[k], spin - cross(p.joint_m[k], push));
            }
        }
        moment = moment + arm_moment;
        second = second + arm_second;
    }
    e.first_moment_kg_m = first;
    e.inertia_kg_m2 = second;
    e.bias_force_n = force;
    e.bias_torque_nm = moment;
    return e;
}

/// Solves m x = b for a symmetric positive definite matrix, by cofactors.
template <class T>
[[gnu::always_inline]] inline LaneVector<T> solve_positive(const LaneSymmetric<T>& m, const LaneVector<T>& b) {
    const T xx = m.yy * m.zz - m.yz * m.yz;
    const T xy = m.xz * m.yz - m.xy * m.zz;
    const T xz = m.xy * m.yz - m.xz * m.yy;
    const LaneSymmetric<T> cofactors{
        xx, xy, xz, m.xx * m.zz - m.xz * m.xz, m.xy * m.xz - m.xx * m.yz, m.xx * m.yy - m.xy * m.xy};
    const T inverse_determinant = T(1) / (m.xx * xx + m.xy * xy + m.xz * xz);
    return inverse_determinant * (cofactors * b);
}

/// Force and torque on the multirotor in body axes, the torque about its centre of mass.
template <class T>
struct SpaceWrench {
    LaneVector<T> force_n, torque_nm;
};

/// All that acts on a plant: the wrench on all of it as if it were rigid, and the torque of each joint.
template <class T, int n>
struct SpaceLoad {
    SpaceWrench<T> wrench;
    T joint_torque_nm[room_for<n>];
};

/// Adds a force at a point: F dP/dq.
/// @param link that the point belongs to, -1 for the multirotor   @param at_m from the multirotor's centre of mass, in
/// body axes as is @param force_n
template <class T, int n>
void add_force_at(const SpacePlaces<T, n>& p, int link, const LaneVector<T>& at_m, const LaneVector<T>& force_n,
                  SpaceLoad<T, n>& load) {
    load.wrench.force_n = load.wrench.force_n + force_n;
    load.wrench.torque_nm = load.wrench.torque_nm + cross(at_m, force_n);
    for (int i = 0; i < n && i <= link; ++i) {
        load.joint_torque_nm[i] = load.joint_torque_nm[i] + dot(p.axis[i], cross(at_m - p.joint_m[i], force_n));
    }
}

/// Velocity of a point in body axes [m/s]. @param link,at_m as of add_force_at()   @param u speeds
template <class T, int n>
LaneVector<T> velocity_at(const SpacePlaces<T, n>& p, int link, const LaneVector<T>& at_m, const T u[space_speeds<n>]) {
    LaneVector<T> velocity =
        turned_back(p.attitude, LaneVector<T>{u[0], u[1], u[2]}) + cross(LaneVector<T>{u[3], u[4], u[5]}, at_m);
    for (int i = 0; i < n && i <= link; ++i) {
        velocity = velocity + u[6 + i] * cross(p.axis[i], at_m - p.joint_m[i]);
    }
    return velocity;
}

/// du/dt under a wrench on the multirotor and joint torques. Eliminates the translation, whose mass is the same in
/// every direction, then the joints from the last to the first, and solves for the angular acceleration.
template <class T, int n, class P>
[[gnu::always_inline]] inline void forward_dynamics(const BasicSpaceModel<P, n>& model, const SpacePlaces<T, n>& p,
                                                    const SpaceEquations<T, n>& e, const SpaceWrench<T>& wrench,
                                                    const T joint_torque_nm[room_for<n>], T du[space_speeds<n>]) {
    const T inverse_mass(model.inverse_mass_1_kg);
    LaneVector<T> turn = wrench.torque_nm - e.bias_torque_nm;  // a torque first, then the angular acceleration
    LaneVector<T> a;
    if constexpr (n == 0) {
        turn = spread<T>(model.inverse_inertia_1_kg_m2) * turn;
        a = inverse_mass * wrench.force_n;
    } else {
        const LaneVector<T> force = wrench.force_n - e.bias_force_n;
        const LaneVector<T> center = inverse_mass * e.first_moment_kg_m;  // common centre of mass
        turn = turn - cross(center, force);
        LaneSymmetric<T> inertia = e.inertia_kg_m2 - point_inertia(T(model.total_mass_kg), center);
        LaneVector<T> spin[n];
        T joint[n][n], y[n], inverse_pivot[n];
        for (int i = 0; i < n; ++i) {
            const LaneVector<T> push = inverse_mass * e.joint_push_kg_m[i];
            spin[i] = e.joint_spin_kg_m2[i] - cross(e.first_moment_kg_m, push);
            y[i] = joint_torque_nm[i] - e.bias_joint_nm[i] - dot(push, force);
            for (int k = 0; k <= i; ++k) {
                joint[k][i] = e.joint_inertia_kg_m2[k][i] - dot(e.joint_push_kg_m[k], push);
            }
        }
        for (int i = n - 1; i >= 0; --i) {
            inverse_pivot[i] = T(1) / joint[i][i];
            for (int k = 0; k < i; ++k) {
                const T factor = joint[k][i] * inverse_pivot[i];
                for (int j = 0; j <= k; ++j) {
                    joint[j][k] = joint[j][k] - factor * joint[j][i];
                }
                spin[k] = spin[k] - factor * spin[i];
                y[k] = y[k] - factor * y[i];
            }
            const LaneVector<T> share = inverse_pivot[i] * spin[i];
            inertia = inertia - outer_square(spin[i], share);
            turn = turn - y[i] * share;
        }
        turn = solve_positive(inertia, turn);
        LaneVector<T> rest = force - cross(turn, e.first_moment_kg_m);
        for (int i = 0; i < n; ++i) {
            y[i] = y[i] - dot(spin[i], turn);
            for (int k = 0; k < i; ++k) {
                y[i] = y[i] - joint[k][i] * y[k];
            }
            y[i] = y[i] * inverse_pivot[i];
            rest = rest - y[i] * e.joint_push_kg_m[i];
            du[6 + i] = y[i];
        }
        a = inverse_mass * rest;
    }
    const LaneVector<T> in_world = p.attitude * a;
    du[0] = in_world.x;
    du[1] = in_world.y;
    du[2] = in_world.z - T(standard_gravity_m_s2);
    du[3] = turn.x;
    du[4] = turn.y;
    du[5] = turn.z;
}

/// dq/dt at speeds u; the quaternion's is half of q (0, body rate).
template <class T, int n>
[[gnu::always_inline]] inline void coordinate_rates(const T q[space_coordinates<n>], const T u[space_speeds<n>],
                                                    T dq[space_coordinates<n>]) {
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

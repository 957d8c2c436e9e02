#pragma once

#include "downwash/dynamics/space_body.hpp"

// Drag of the multirotor and of the links in moving air, friction and stops of the joints (docs/model.md 2.8, 2.10),
// one template over the lane type. Places and forces are in body axes, as in space_body.hpp.

namespace downwash::dynamics {

/// A link in the stream of the air. A piece s metres from its joint moves through the air at across + s turning across
/// it.
template <class T>
struct LinkStream {
    LaneVector<T> joint_m;
    LaneVector<T> along;        ///< unit vector towards the next joint or the end effector; 0 for a link of no length
    LaneVector<T> across_m_s;   ///< what the joint moves through the air across the link
    LaneVector<T> turning_1_s;  ///< by how much more each metre along the link
};

/// The streams at all links.
template <class T, int n>
struct LinkStreams {
    LinkStream<T> of[room_for<n>];
};

/// Forces along a link.
template <class T>
struct LinkForce {
    LaneVector<T> force_n;
    LaneVector<T> first_nm;  ///< sum of distance from the joint times force: its moment about the joint is along x this
};

/// Forces along all links.
template <class T, int n>
struct LinkForces {
    LinkForce<T> of[room_for<n>];
};

/// The streams at all links. @param air_m_s velocity of the multirotor through the air   @param u speeds
template <class T, int n, class P>
[[gnu::always_inline]] inline LinkStreams<T, n> link_streams(const BasicSpaceModel<P, n>& model,
                                                             const SpacePlaces<T, n>& p, const LaneVector<T>& air_m_s,
                                                             const T u[space_speeds<n>]) {
    LinkStreams<T, n> streams;
    LaneVector<T> rate{u[3], u[4], u[5]};
    LaneVector<T> velocity = air_m_s;  // of `from`
    LaneVector<T> from{T(0), T(0), T(0)};
    for (int i = 0; i < n; ++i) {
        LinkStream<T>& stream = streams.of[i];
        velocity = velocity + cross(rate, p.joint_m[i] - from);
        from = p.joint_m[i];
        rate = rate + u[6 + i] * p.axis[i];
        const LaneVector<T> end_m = i + 1 < n ? p.joint_m[i + 1 < n ? i + 1 : i] : p.end_effector_m;
        stream.joint_m = from;
        stream.along = T(model.link[i].inverse_length_1_m) * (end_m - from);
        stream.across_m_s = velocity - dot(velocity, stream.along) * stream.along;
        stream.turning_1_s = cross(rate, stream.along);
    }
    return streams;
}

/// Adds forces along all links to a load.
template <class T, int n>
[[gnu::always_inline]] inline void add_link_forces(const SpacePlaces<T, n>& p, const LinkStreams<T, n>& streams,
                                                   const LinkForces<T, n>& forces, SpaceLoad<T, n>& load) {
    LaneVector<T> force{T(0), T(0), T(0)};
    LaneVector<T> moment{T(0), T(0), T(0)};  // about the multirotor's centre of mass
    for (int i = n - 1; i >= 0; --i) {
        force = force + forces.of[i].force_n;
        moment = moment + cross(p.joint_m[i], forces.of[i].force_n) + cross(streams.of[i].along, forces.of[i].first_nm);
        load.joint_torque_nm[i] = load.joint_torque_nm[i] + dot(p.axis[i], moment - cross(p.joint_m[i], force));
    }
    load.wrench.force_n = load.wrench.force_n + force;
    load.wrench.torque_nm = load.wrench.torque_nm + moment;
}

/// Drag of a body or of a whole link: (linear + quadratic |v|) v, against the speed through the air.
template <class T>
LaneVector<T> drag_at(const T& linear_n_s_m, const T& quadratic_n_s2_m2, const LaneVector<T>& v) {
    return (linear_n_s_m + quadratic_n_s2_m2 * lane::sqrt(dot(v, v))) * v;
}

/// Drag along all links, by the two-point Gauss rule: exact where the stream crosses all of a link in one direction.
/// @tparam pieces of a link, each with a rule of its own: so many times finer where the direction changes along it
template <int pieces = 1, class T, int n, class P>
[[gnu::always_inline]] inline LinkForces<T, n> link_drag(const BasicSpaceModel<P, n>& model,
                                                         const LinkStreams<T, n>& streams) {
    LinkForces<T, n> forces;
    constexpr double point[] = {0.21132486540518713, 0.78867513459481287};  // 1/2 -+ 1/sqrt(12) of the length
    for (int i = 0; i < n; ++i) {
        const SpaceLinkNumbers<P>& link = model.link[i];
        const LinkStream<T>& stream = streams.of[i];
        LinkForce<T>& all = forces.of[i];
        all = {{T(0), T(0), T(0)}, {T(0), T(0), T(0)}};
        for (int k = 0; k < 2 * pieces; ++k) {
            const int piece = k / 2;
            const T from_joint_m = T((piece + point[k % 2]) / pieces) * T(link.length_m);
            const LaneVector<T> half =
                T(-0.5 / pieces) * drag_at(T(link.drag_n_s_m), T(link.drag_n_s2_m2),
                                           stream.across_m_s + from_joint_m * stream.turning_1_s);
            all.force_n = all.force_n + half;
            all.first_nm = all.first_nm + from_joint_m * half;
        }
    }
    return forces;
}

/// Rate below which a joint creeps against Coulomb friction [rad/s]: there friction has 0.7 of its full torque.
inline constexpr double joint_slip_rad_s = 0.05;

/// Adds the friction of the joints to their torques. @param u speeds
template <class T, int n, class P>
[[gnu::always_inline]] inline void add_joint_friction(const BasicSpaceModel<P, n>& model, const T u[space_speeds<n>],
                                                      T joint_torque_nm[room_for<n>]) {
    for (int i = 0; i < n; ++i) {
        const T rate = u[6 + i];
        const T slip = lane::sqrt(rate * rate + T(joint_slip_rad_s * joint_slip_rad_s));
        const T per_rate = T(model.link[i].viscous_friction_nm_s) + T(model.link[i].coulomb_friction_nm) / slip;
        joint_torque_nm[i] = joint_torque_nm[i] - per_rate * rate;
    }
}

/// Adds the torques of the joints' stops. @param q,u coordinates and speeds
template <class T, int n, class P>
[[gnu::always_inline]] inline void add_joint_stops(const BasicSpaceModel<P, n>& model, const T q[space_coordinates<n>],
                                                   const T u[space_speeds<n>], T joint_torque_nm[room_for<n>]) {
    const T zero(0);
    for (int i = 0; i < n; ++i) {
        const SpaceLinkNumbers<P>& link = model.link[i];
        const T damping = T(link.stop_dissipation_s_rad) * u[6 + i];
        const T above = lane::max(q[7 + i] - T(link.stop_upper_rad), zero) * lane::max(T(1) + damping, zero);
        const T below = lane::max(T(link.stop_lower_rad) - q[7 + i], zero) * lane::max(T(1) - damping, zero);
        joint_torque_nm[i] = joint_torque_nm[i] + T(link.stop_stiffness_nm_rad) * (below - above);
    }
}

}  // namespace downwash::dynamics

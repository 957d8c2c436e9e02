#pragma once

#include <algorithm>

#include "downwash/dynamics/link_wash.hpp"
#include "downwash/dynamics/rotor_power.hpp"
#include "downwash/dynamics/runge_kutta.hpp"
#include "downwash/dynamics/space_loads.hpp"
#include "downwash/dynamics/space_surroundings.hpp"

// The plant in space over one control tick: bodies, rotors anywhere and tilted, and what surrounds them.

namespace downwash::dynamics {

/// The state of a plant in space with n joints; coordinates and speeds as in space_body.hpp.
template <class T, int n>
struct SpaceState {
    T q[space_coordinates<n>];  ///< the quaternion q[3..6] of length 1
    T u[space_speeds<n>];
    T thrust_n[max_rotors];  ///< free-air thrust of each rotor; follows the command with the rotors' lag, if any
    T energy_j;              ///< rotor and arm energy spent so far
};

/// The commands, constant over one tick.
template <class T, int n>
struct SpaceCommand {
    T thrust_n[max_rotors];  ///< free-air thrust of each rotor
    T joint_torque_nm[room_for<n>];
};

/// Angular momentum [N m s] of all rotors about their axes, in body axes: Jr Omega with Omega from T = C_T Omega^2.
template <class T, int n, class P>
LaneVector<T> rotor_spin_of(const BasicSpaceModel<P, n>& model, const T thrust_n[max_rotors]) {
    LaneVector<T> spin{T(0), T(0), T(0)};
    if (!model.has_gyroscopic_term) {
        return spin;
    }
    for (int i = 0; i < model.rotor_count; ++i) {
        // A lag shorter than the step lets a stage of the integrator undershoot a thrust that vanishes.
        const T root = lane::sqrt(lane::max(thrust_n[i], T(0)));
        spin = spin + (T(model.rotor[i].spin_kg_m2_s_n0p5) * root) * spread<T>(model.rotor[i].axis);
    }
    return spin;
}

/// Wrench of all rotors. Each one pushes along its axis with K times its free-air thrust. Its drag torque follows its
/// speed and has no K (thesis (4.13), yaw row). A fountain adds (K_body - 1) times the rotors' free-air thrust along
/// their mean axis, at the centre between them (docs/model.md 4.3). Walls add a level force through the centre of mass
/// and a moment (4.8).
/// A function of its own always: where a look-up in a map waits for the place of a hub, it is fastest so (measured: a
/// tick with a map by a half).
/// @param position_m of the multirotor's centre of mass, world   @param thrust_n of every rotor in free air with its
/// nominal thrust coefficient [N]: a measure of its speed
template <class T, int n, class P, SpaceSurroundings<T> Around>
[[gnu::noinline]] SpaceWrench<T> rotor_wrench(const BasicSpaceModel<P, n>& model, const LaneRotation<T>& attitude,
                                              const LaneVector<T>& position_m, const T thrust_n[max_rotors],
                                              const Around& around) {
    SpaceWrench<T> wrench{{T(0), T(0), T(0)}, {T(0), T(0), T(0)}};
    const auto& here = at_attitude<T>(around, attitude);
    for (int i = 0; i < model.rotor_count; ++i) {
        const LaneVector<T> place = spread<T>(model.rotor[i].position_m);
        const LaneVector<T> axis = spread<T>(model.rotor[i].axis);
        const T ratio = here.thrust_ratio(i, position_m + attitude * place, attitude * axis);
        const LaneVector<T> push = (ratio * (T(around.thrust_scale(i)) * thrust_n[i])) * axis;
        wrench.force_n = wrench.force_n + push;
        wrench.torque_nm =
            wrench.torque_nm + (cross(place, push) + (T(model.rotor[i].reaction_m) * thrust_n[i]) * axis);
    }
    if (model.has_fountain || model.has_walls) {
        const LaneVector<T> place = spread<T>(model.center_m);
        const LaneVector<T> center = position_m + attitude * place;
        T free_air_n(0);
        for (int i = 0; i < model.rotor_count; ++i) {
            free_air_n = free_air_n + T(around.thrust_scale(i)) * thrust_n[i];
        }
        if (model.has_fountain) {
            const LaneVector<T> axis = spread<T>(model.center_axis);
            const LaneVector<T> push = ((here.body_ratio(center, attitude * axis) - T(1)) * free_air_n) * axis;
            wrench.force_n = wrench.force_n + push;
            wrench.torque_nm = wrench.torque_nm + cross(place, push);
        }
        if (model.has_walls) {
            const LaneVector<T> acting = free_air_n * around.wall_nearness(center);
            const LaneVector<T> about{-acting.y, acting.x, T(0)};  // lowers the side towards the wall
            wrench.force_n = wrench.force_n + turned_back(attitude, T(-model.wall_force) * acting);
            wrench.torque_nm = wrench.torque_nm + turned_back(attitude, T(model.wall_moment_m) * about);
        }
    }
    return wrench;
}

/// Adds the drag of the multirotor and of its links in moving air, and what slipstreams change of it.
/// @param u speeds   @param thrust_n of every rotor in free air [N]
template <class T, int n, class P, SpaceSurroundings<T> Around>
[[gnu::always_inline]] inline void add_air_loads(const BasicSpaceModel<P, n>& model, const SpacePlaces<T, n>& p,
                                                 const T u[space_speeds<n>], const T thrust_n[max_rotors],
                                                 const Around& around, SpaceLoad<T, n>& load) {
    const LaneVector<T> through_air = LaneVector<T>{u[0], u[1], u[2]} - spread<T>(around.wind());
    const LaneVector<T> air_m_s = turned_back(p.attitude, through_air);
    load.wrench.force_n = load.wrench.force_n - drag_at(T(model.body_drag_n_s_m), T(model.body_drag_n_s2_m2), air_m_s);
    if constexpr (n > 0) {
        const LinkStreams<T, n> streams = link_streams(model, p, air_m_s, u);
        add_link_forces(p, streams, link_drag<Around::drag_pieces>(model, streams), load);
        if constexpr (Around::has_wash) {
            if (around.slipstreams().count > 0) {
                // A copy: what the step computes with stays where the compiler wants it.
                const LinkStreams<T, n> copy = streams;
                T acting_n[max_rotors];
                for (int i = 0; i < model.rotor_count; ++i) {
                    acting_n[i] = T(around.thrust_scale(i)) * thrust_n[i];
                }
                const T scale(around.wash_scale());
                add_link_forces(p, copy, link_wash(model, around.slipstreams(), copy, acting_n, scale), load);
            }
        }
    }
}

/// du/dt under the free-air thrusts of the rotors and joint torques.
/// @param rotor_spin rotor_spin_of() the thrusts
template <class T, int n, class P, SpaceSurroundings<T> Around>
void accelerations(const BasicSpaceModel<P, n>& model, const T q[space_coordinates<n>], const T u[space_speeds<n>],
                   const T thrust_n[max_rotors], const LaneVector<T>& rotor_spin, const T joint_torque_nm[room_for<n>],
                   const Around& around, T du[space_speeds<n>]) {
    // Surroundings first: a call out of here would send everything known by then to memory.
    const LaneRotation<T> attitude = rotation_of(q + 3);
    SpaceLoad<T, n> load;
    load.wrench = rotor_wrench(model, attitude, LaneVector<T>{q[0], q[1], q[2]}, thrust_n, around);
    if (model.has_gyroscopic_term) {
        load.wrench.torque_nm = load.wrench.torque_nm - cross(LaneVector<T>{u[3], u[4], u[5]}, rotor_spin);
    }
    for (int i = 0; i < n; ++i) {
        load.joint_torque_nm[i] = joint_torque_nm[i];
    }
    const SpacePlaces<T, n> p = places_at(model, q, attitude);
    if constexpr (Around::has_wind) {
        if (model.has_drag) {
            add_air_loads(model, p, u, thrust_n, around, load);
        }
    }
    if constexpr (n > 0) {
        if (model.has_friction) {
            add_joint_friction(model, u, load.joint_torque_nm);
        }
        if (model.has_stops) {
            add_joint_stops(model, q, u, load.joint_torque_nm);
        }
    }
    around.add_load(q, u, p, load);
    forward_dynamics(model, p, equations_of_motion(model, p, u), load.wrench, load.joint_torque_nm, du);
}

/// Brings the quaternion of coordinates q to length 1. A step of 10 ms changes its length by some 1e-9 at 5 rad/s
/// (docs/model.md 2.2), and nothing else depends on its length.
template <class T>
void normalise_attitude(T q[7]) {
    const T scale = T(1) / lane::sqrt(q[3] * q[3] + q[4] * q[4] + q[5] * q[5] + q[6] * q[6]);
    for (int i = 3; i < 7; ++i) {
        q[i] = scale * q[i];
    }
}

/// The state after `dt_s` with the command held: one classical Runge-Kutta step of fourth order, in which the four
/// numbers of the quaternion are numbers like others; it is brought back to length 1 at the end. The surroundings are
/// asked at every stage.
/// @param dt_s > 0
template <class T, int n, class P, SpaceSurroundings<T> Around>
SpaceState<T, n> space_step(const BasicSpaceModel<P, n>& model, const SpaceState<T, n>& state,
                            const SpaceCommand<T, n>& command, T dt_s, const Around& around) {
    constexpr int speeds_at = space_coordinates<n>, energy_at = speeds_at + space_speeds<n>, thrusts_at = energy_at + 1;
    const bool has_lag = model.has_rotor_lag;
    const int rotors = model.rotor_count;
    T y[thrusts_at + max_rotors];
    std::copy_n(state.q, space_coordinates<n>, y);
    std::copy_n(state.u, space_speeds<n>, y + speeds_at);
    y[energy_at] = state.energy_j;
    std::copy_n(state.thrust_n, max_rotors, y + thrusts_at);
    if (!has_lag) {
        std::copy_n(command.thrust_n, rotors, y + thrusts_at);
    }
    const LaneVector<T> held_spin = rotor_spin_of(model, y + thrusts_at);
    runge_kutta_step(y, thrusts_at + (has_lag ? rotors : 0), dt_s, [&](const T* at, T* rate) {
        const T *u = at + speeds_at, *thrust_n = at + thrusts_at;
        coordinate_rates<T, n>(at, u, rate);
        accelerations(model, at, u, thrust_n, has_lag ? rotor_spin_of(model, thrust_n) : held_spin,
                      command.joint_torque_nm, around, rate + speeds_at);
        T power_w(0);
        for (int i = 0; i < n; ++i) {
            power_w = power_w + lane::abs(command.joint_torque_nm[i] * u[6 + i]);
        }
        rate[energy_at] = has_lag ? power_w + rotor_power(model, thrust_n) : power_w;
        for (int i = 0; i < rotors && has_lag; ++i) {
            rate[thrusts_at + i] = (command.thrust_n[i] - thrust_n[i]) / T(model.rotor_time_constant_s);
        }
    });
    SpaceState<T, n> next;
    std::copy_n(y, space_coordinates<n>, next.q);
    normalise_attitude(next.q);
    std::copy_n(y + speeds_at, space_speeds<n>, next.u);
    next.energy_j = has_lag ? y[energy_at] : y[energy_at] + dt_s * rotor_power(model, command.thrust_n);
    std::copy_n(y + thrusts_at, max_rotors, next.thrust_n);
    return next;
}

}  // namespace downwash::dynamics

#pragma once

#include "downwash/dynamics/rigid_body.hpp"
#include "downwash/dynamics/rotors.hpp"

// The plant over one control tick: rigid bodies, rotors and the surface effect between command and force.

namespace downwash::dynamics {

/// Shares total thrust F3 [N] and pitch torque T2 [N m] among the rotors: the least-squares commands, not yet clipped.
template <class T, class P>
void allocate(const BasicPlantModel<P>& model, T total_thrust_n, T pitch_torque_nm, T thrust_n[max_rotors]) {
    for (int i = 0; i < model.rotor_count; ++i) {
        thrust_n[i] = T(model.force_share[i]) * total_thrust_n + T(model.torque_share_1_m[i]) * pitch_torque_nm;
    }
}

/// K of a rotor, or of the body. A factor that knows what tilt does takes the sine of the pitch too.
template <class T, class Factor>
T thrust_ratio(Factor& factor, int rotor, const PlanePoint<T>& hub, const Attitude<T>& a) {
    if constexpr (requires { factor(rotor, hub.x, hub.z, a.sin_pitch); }) {
        return factor(rotor, hub.x, hub.z, a.sin_pitch);
    } else {
        return factor(rotor, hub.x, hub.z);
    }
}

/// How near walls are, from -1 (the vehicle touches one behind it) to 1 (ahead).
template <class T, class P, class Factor>
T wall_nearness(const BasicPlantModel<P>& model, Factor& factor, const PlanePoint<T>& center) {
    if constexpr (requires { factor.wall_nearness(model.walls(), center.x, center.z); }) {
        return factor.wall_nearness(model.walls(), center.x, center.z);
    } else {
        return factor(model.walls(), center.x, center.z) - T(1);
    }
}

/// The wrench at a configuration. A fountain adds (K_body - 1) times the rotors' free-air thrust along b3, at the
/// centre between them (docs/model.md 4.3). Walls add a horizontal force through the centre of mass and a moment
/// (4.8).
/// @param thrust_n of every rotor in free air with its nominal thrust coefficient [N]: a measure of its speed
/// @param factor callable (rotor, x_m, z_m) -> K at the hub of that rotor in the plane, or the body's for body(), or
/// for walls() one more than how near they are; it may take the sine of the pitch behind the place, and know a wind and
/// thrust coefficients too
template <class T, class Factor, class P>
RotorWrench<T> rotor_wrench(const BasicPlantModel<P>& model, const Attitude<T>& a, T x_m, T z_m,
                            const T thrust_n[max_rotors], Factor&& factor) {
    RotorWrench<T> wrench{T(0), T(0)};
    T factors[max_rotors];
    for (int i = 0; i < model.rotor_count; ++i) {
        if (const int same = rotor_with_factor_of(factor, i); same != i) {
            factors[i] = factors[same];
        } else {
            const PlanePoint<T> hub = rotor_position(model, a, x_m, z_m, i);
            factors[i] = thrust_ratio(factor, i, hub, a);
        }
        const T acting_n = factors[i] * free_air_thrust(factor, i, thrust_n[i]);
        wrench.thrust_n = wrench.thrust_n + acting_n;
        wrench.pitch_torque_nm = wrench.pitch_torque_nm - T(model.rotor_x_m[i]) * acting_n;
    }
    if (model.has_fountain || model.has_walls) {
        const int body = model.body();
        const PlanePoint<T> center = rotor_position(model, a, x_m, z_m, body);
        T free_air_n(0);
        for (int i = 0; i < model.rotor_count; ++i) {
            free_air_n = free_air_n + free_air_thrust(factor, i, thrust_n[i]);
        }
        if (model.has_fountain) {
            const T push_n = (thrust_ratio(factor, body, center, a) - T(1)) * free_air_n;
            wrench.thrust_n = wrench.thrust_n + push_n;
            wrench.pitch_torque_nm = wrench.pitch_torque_nm - T(model.rotor_x_m[body]) * push_n;
        }
        if (model.has_walls) {
            const T acting_n = wall_nearness(model, factor, center) * free_air_n;
            wrench.wall_push_n = T(-model.wall_force) * acting_n;
            wrench.pitch_torque_nm = wrench.pitch_torque_nm + T(model.wall_moment_m) * acting_n;
        }
    }
    return wrench;
}

/// du/dt of the plant under the free-air thrusts of its rotors.
/// @param q,u coordinates [m, m, rad, rad] and their speeds   @param motion at q and u: motion_at(model, q, u)
/// @param thrust_n of every rotor in free air [N]   @param factor as for rotor_wrench(); there is drag only where it
/// says how fast the air is, by `wind()` [m/s], and other forces only where it adds them, by `add_load()`
/// @param[out] du accelerations [m/s2, m/s2, rad/s2, rad/s2]
template <class T, class Factor, class P>
void accelerations(const BasicPlantModel<P>& model, const T q[4], const T u[4], const Motion<T>& motion,
                   const T thrust_n[max_rotors], T joint_torque_nm, Factor&& factor, T du[4]) {
    const Attitude<T>& a = motion.attitude;
    const RotorWrench<T> wrench = rotor_wrench(model, a, q[0], q[1], thrust_n, factor);
    T force[4] = {wrench.thrust_n * a.sin_pitch, wrench.thrust_n * a.cos_pitch, wrench.pitch_torque_nm,
                  joint_torque_nm};
    if (model.has_walls) {
        force[0] = force[0] + wrench.wall_push_n;
    }
    if constexpr (requires { factor.wind(); }) {
        if (model.has_drag) {
            add_drag(model, a, u, factor.wind(), force);
        }
    }
    if constexpr (requires { factor.add_load(q, u, a, force); }) {
        factor.add_load(q, u, a, force);
    }
    forward_dynamics(model, motion.equations, force, du);
}

/// The state after `dt_s` with the command held: one classical Runge-Kutta step of fourth order. The surface effect
/// is evaluated at the rotor positions of every stage.
/// @param motion that of the state   @param dt_s > 0   @param factor as for rotor_wrench()
template <class T, class Factor, class P>
PlantState<T> flight_step(const BasicPlantModel<P>& model, const PlantState<T>& state, const Motion<T>& motion,
                          const PlantCommand<T>& command, T dt_s, Factor&& factor) {
    // A loop over the stages, not four copies of their code: it has to stay in the processor's instruction cache.
    constexpr double share_of_step[] = {0, 0.5, 0.5, 1};
    constexpr double weight[] = {1, 2, 2, 1};
    const bool has_lag = model.has_rotor_lag;
    const int rotors = model.rotor_count;
    T q[4], u[4], thrust_n[max_rotors];     // at the stage
    T du[4] = {}, thrust_rate[max_rotors];  // there
    T q_sum[4], u_sum[4], thrust_sum[max_rotors], power_sum(0);
    for (int i = 0; i < 4; ++i) {
        q[i] = state.q[i];
        u[i] = state.u[i];
        q_sum[i] = u_sum[i] = T(0);
    }
    for (int i = 0; i < rotors; ++i) {
        thrust_n[i] = has_lag ? state.thrust_n[i] : command.thrust_n[i];
        thrust_sum[i] = T(0);
    }
    Motion<T> here = motion;
    for (int stage = 0; stage < 4; ++stage) {
        if (stage > 0) {
            const T step_s = T(share_of_step[stage]) * dt_s;
            for (int i = 0; i < 4; ++i) {
                q[i] = state.q[i] + step_s * u[i];
                u[i] = state.u[i] + step_s * du[i];
            }
            if (has_lag) {
                for (int i = 0; i < rotors; ++i) {
                    thrust_n[i] = state.thrust_n[i] + step_s * thrust_rate[i];
                }
            }
            here = motion_at(model, q, u);
        }
        accelerations(model, q, u, here, thrust_n, command.joint_torque_nm, factor, du);
        const T w(weight[stage]);
        for (int i = 0; i < 4; ++i) {
            q_sum[i] = q_sum[i] + w * u[i];
            u_sum[i] = u_sum[i] + w * du[i];
        }
        power_sum = power_sum + w * lane::abs(command.joint_torque_nm * u[3]);
        if (has_lag) {
            power_sum = power_sum + w * rotor_power(model, thrust_n);
            for (int i = 0; i < rotors; ++i) {
                thrust_rate[i] = (command.thrust_n[i] - thrust_n[i]) / T(model.rotor_time_constant_s);
                thrust_sum[i] = thrust_sum[i] + w * thrust_rate[i];
            }
        }
    }
    const T sixth_s = dt_s * T(1.0 / 6.0);
    PlantState<T> next;
    for (int i = 0; i < 4; ++i) {
        next.q[i] = state.q[i] + sixth_s * q_sum[i];
        next.u[i] = state.u[i] + sixth_s * u_sum[i];
    }
    next.energy_j = state.energy_j + sixth_s * power_sum;
    if (!has_lag) {
        next.energy_j = next.energy_j + dt_s * rotor_power(model, command.thrust_n);
    }
    for (int i = 0; i < max_rotors; ++i) {
        next.thrust_n[i] = i >= rotors ? state.thrust_n[i]
                           : has_lag   ? state.thrust_n[i] + sixth_s * thrust_sum[i]
                                       : command.thrust_n[i];
    }
    return next;
}

/// The same if the motion of the state is not known yet.
template <class T, class Factor, class P>
PlantState<T> flight_step(const BasicPlantModel<P>& model, const PlantState<T>& state, const PlantCommand<T>& command,
                          T dt_s, Factor&& factor) {
    return flight_step(model, state, motion_at(model, state.q, state.u), command, dt_s, factor);
}

/// The tick as one Runge-Kutta step; for planning.
struct OneStep {
    /// The state after `dt_s`; see flight_step().
    template <class T, class P, class Factor>
    PlantState<T> operator()(const BasicPlantModel<P>& model, const PlantState<T>& state, const Motion<T>& motion,
                             const PlantCommand<T>& command, T dt_s, Factor&& factor) const {
        return flight_step(model, state, motion, command, dt_s, factor);
    }
};

/// The tick in as many steps as it needs; for flights that are reported. Where a rotor disc passes the edge of an
/// obstacle K is not smooth, and one step of 10 ms can be wrong by 2e-5 in a rate. A step is halved until both halves
/// agree with the whole.
struct RefinedStep {
    double tolerance = 1e-7;  ///< of every coordinate and rate, SI units
    int max_halvings = 8;

    /// The state after `dt_s`; see flight_step().
    template <class Factor>
    PlantState<double> operator()(const PlantModel& model, const PlantState<double>& state,
                                  const Motion<double>& motion, const PlantCommand<double>& command, double dt_s,
                                  Factor&& factor) const {
        return refined(model, state, command, dt_s, factor, flight_step(model, state, motion, command, dt_s, factor),
                       max_halvings);
    }

 private:
    template <class Factor>
    PlantState<double> refined(const PlantModel& model, const PlantState<double>& state,
                               const PlantCommand<double>& command, double dt_s, Factor&& factor,
                               const PlantState<double>& whole, int halvings) const {
        const double half_s = 0.5 * dt_s;
        const PlantState<double> middle = flight_step(model, state, command, half_s, factor);
        const PlantState<double> end = flight_step(model, middle, command, half_s, factor);
        if (halvings == 0 || agree(whole, end)) {
            return end;
        }
        const PlantState<double> reached = refined(model, state, command, half_s, factor, middle, halvings - 1);
        return refined(model, reached, command, half_s, factor, flight_step(model, reached, command, half_s, factor),
                       halvings - 1);
    }

    [[nodiscard]] bool agree(const PlantState<double>& a, const PlantState<double>& b) const {
        double worst = 0;
        for (int i = 0; i < 4; ++i) {
            worst = lane::max(worst, lane::max(lane::abs(a.q[i] - b.q[i]), lane::abs(a.u[i] - b.u[i])));
        }
        return worst <= tolerance;
    }
};

}  // namespace downwash::dynamics

#pragma once

#include "downwash/dynamics/arm_wash.hpp"
#include "downwash/dynamics/integration.hpp"
#include "downwash/dynamics/rigid_body.hpp"
#include "downwash/dynamics/rotor_power.hpp"

// The plant over one control tick: rigid bodies, rotors, and what surrounds them between command and force.

namespace downwash::dynamics {

/// Shares total thrust F3 [N] and pitch torque T2 [N m] among the rotors: the least-squares commands, not yet clipped.
template <class T, class P>
void allocate(const BasicPlantModel<P>& model, T total_thrust_n, T pitch_torque_nm, T thrust_n[max_rotors]) {
    for (int i = 0; i < model.rotor_count; ++i) {
        thrust_n[i] = T(model.force_share[i]) * total_thrust_n + T(model.torque_share_1_m[i]) * pitch_torque_nm;
    }
}

/// The wrench at a configuration. A fountain adds (K_body - 1) times the rotors' free-air thrust along b3, at the
/// centre between them (docs/model.md 4.3). Walls add a horizontal force through the centre of mass and a moment
/// (4.8).
/// @param thrust_n of every rotor in free air with its nominal thrust coefficient [N]: a measure of its speed
template <class T, class P, Surroundings<T> Around>
RotorWrench<T> rotor_wrench(const BasicPlantModel<P>& model, const Attitude<T>& a, T x_m, T z_m,
                            const T thrust_n[max_rotors], const Around& around) {
    RotorWrench<T> wrench{T(0), T(0)};
    T ratios[max_rotors];
    for (int i = 0; i < model.rotor_count; ++i) {
        if (const int same = around.same_as(i); same != i) {
            ratios[i] = ratios[same];
        } else {
            ratios[i] = around.thrust_ratio(i, rotor_position(model, a, x_m, z_m, i), a.sin_pitch);
        }
        const T acting_n = ratios[i] * (around.thrust_scale(i) * thrust_n[i]);
        wrench.thrust_n = wrench.thrust_n + acting_n;
        wrench.pitch_torque_nm = wrench.pitch_torque_nm - T(model.rotor_x_m[i]) * acting_n;
    }
    if (model.has_fountain || model.has_walls) {
        const PlanePoint<T> center = center_position(model, a, x_m, z_m);
        T free_air_n(0);
        for (int i = 0; i < model.rotor_count; ++i) {
            free_air_n = free_air_n + around.thrust_scale(i) * thrust_n[i];
        }
        if (model.has_fountain) {
            const T push_n = (around.body_ratio(center, a.sin_pitch) - T(1)) * free_air_n;
            wrench.thrust_n = wrench.thrust_n + push_n;
            wrench.pitch_torque_nm = wrench.pitch_torque_nm - T(model.center_x_m) * push_n;
        }
        if (model.has_walls) {
            const T acting_n = around.wall_nearness(center) * free_air_n;
            wrench.wall_push_n = T(-model.wall_force) * acting_n;
            wrench.pitch_torque_nm = wrench.pitch_torque_nm + T(model.wall_moment_m) * acting_n;
        }
    }
    return wrench;
}

/// du/dt of the plant under the free-air thrusts of its rotors.
/// @param q,u coordinates [m, m, rad, rad] and their speeds   @param motion at q and u: motion_at(model, q, u)
/// @param thrust_n of every rotor in free air [N]
/// @param[out] du accelerations [m/s2, m/s2, rad/s2, rad/s2]
template <class T, class P, Surroundings<T> Around>
void accelerations(const BasicPlantModel<P>& model, const T q[4], const T u[4], const Motion<T>& motion,
                   const T thrust_n[max_rotors], T joint_torque_nm, const Around& around, T du[4]) {
    const Attitude<T>& a = motion.attitude;
    const RotorWrench<T> wrench = rotor_wrench(model, a, q[0], q[1], thrust_n, around);
    T force[4] = {wrench.thrust_n * a.sin_pitch, wrench.thrust_n * a.cos_pitch, wrench.pitch_torque_nm,
                  joint_torque_nm};
    if (model.has_walls) {
        force[0] = force[0] + wrench.wall_push_n;
    }
    if constexpr (Around::has_wind) {
        if (model.has_drag) {
            add_drag(model, a, u, around.wind(), force);
            if constexpr (Around::has_wash) {
                if (around.slipstreams().count > 0) {
                    // A copy: what the step computes with stays where the compiler wants it.
                    WashedVehicle<T> vehicle{a, {u[0], u[1], u[2], u[3]}, around.wind(), {}, around.wash_scale()};
                    for (int i = 0; i < model.rotor_count; ++i) {
                        vehicle.acting_n[i] = around.thrust_scale(i) * thrust_n[i];
                    }
                    add_arm_wash(model, around.slipstreams(), vehicle, force);
                }
            }
        }
    }
    around.add_load(q, u, a, force);
    forward_dynamics(model, motion.equations, force, du);
}

/// Rotors that give the same thrust, as those on both sides of the plane do: what one of them does the others do.
struct AlikeRotors {
    int as[max_rotors];  ///< the earliest rotor that each is alike, perhaps that rotor itself
};

/// The rotors that are alike over a step: they give the same thrust at its beginning, in every lane, and have the same
/// command.
template <class T>
AlikeRotors alike_rotors(int rotor_count, const T thrust_n[max_rotors], const T command_n[max_rotors]) {
    const auto are_equal = [](const T& a, const T& b) { return lane::bits_of(!((a <= b) & (b <= a))) == 0; };
    AlikeRotors alike;
    for (int i = 0; i < rotor_count; ++i) {
        alike.as[i] = i;
        for (int j = 0; j < i; ++j) {
            if (alike.as[j] == j && are_equal(command_n[i], command_n[j]) && are_equal(thrust_n[i], thrust_n[j])) {
                alike.as[i] = j;
                break;
            }
        }
    }
    return alike;
}

/// The state after `dt_s` with the command held: one classical Runge-Kutta step of fourth order. The surroundings are
/// asked at every stage.
/// @param motion that of the state   @param dt_s > 0   @param[out] next not the state itself
template <class T, class P, Surroundings<T> Around>
void flight_step(const BasicPlantModel<P>& model, const PlantState<T>& state, const Motion<T>& motion,
                 const PlantCommand<T>& command, T dt_s, const Around& around, PlantState<T>& next) {
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
    AlikeRotors alike;
    if (has_lag) {
        alike = alike_rotors(rotors, state.thrust_n, command.thrust_n);
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
                    const int as = alike.as[i];
                    thrust_n[i] = as != i ? thrust_n[as] : state.thrust_n[i] + step_s * thrust_rate[i];
                }
            }
            here = motion_at(model, q, u);
        }
        accelerations(model, q, u, here, thrust_n, command.joint_torque_nm, around, du);
        const T w(weight[stage]);
        for (int i = 0; i < 4; ++i) {
            q_sum[i] = q_sum[i] + w * u[i];
            u_sum[i] = u_sum[i] + w * du[i];
        }
        power_sum = power_sum + w * lane::abs(command.joint_torque_nm * u[3]);
        if (has_lag) {
            power_sum = power_sum + w * rotor_power(model, thrust_n, alike.as);
            for (int i = 0; i < rotors; ++i) {
                if (alike.as[i] == i) {
                    thrust_rate[i] = (command.thrust_n[i] - thrust_n[i]) / T(model.rotor_time_constant_s);
                    thrust_sum[i] = thrust_sum[i] + w * thrust_rate[i];
                }
            }
        }
    }
    const T sixth_s = dt_s * T(1.0 / 6.0);
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
                           : has_lag   ? state.thrust_n[i] + sixth_s * thrust_sum[alike.as[i]]
                                       : command.thrust_n[i];
    }
}

/// The same, with the state after the step as a value.
template <class T, class P, Surroundings<T> Around>
PlantState<T> flight_step(const BasicPlantModel<P>& model, const PlantState<T>& state, const Motion<T>& motion,
                          const PlantCommand<T>& command, T dt_s, const Around& around) {
    PlantState<T> next;
    flight_step(model, state, motion, command, dt_s, around, next);
    return next;
}

/// One step if the motion of the state is not known yet.
template <class T, class P, Surroundings<T> Around>
PlantState<T> flight_step(const BasicPlantModel<P>& model, const PlantState<T>& state, const PlantCommand<T>& command,
                          T dt_s, const Around& around) {
    return flight_step(model, state, motion_at(model, state.q, state.u), command, dt_s, around);
}

template <class T, class P, Surroundings<T> Around>
PlantState<T> OneStep::operator()(const BasicPlantModel<P>& model, const PlantState<T>& state, const Motion<T>& motion,
                                  const PlantCommand<T>& command, T dt_s, const Around& around) const {
    return flight_step(model, state, motion, command, dt_s, around);
}

template <Surroundings<double> Around>
PlantState<double> DisturbedStep::operator()(const PlantModel& model, const PlantState<double>& state,
                                             const Motion<double>& motion, const PlantCommand<double>& command,
                                             double dt_s, const Around& around) const {
    PlantCommand<double> acting = command;
    acting.joint_torque_nm += added.joint_torque_nm;
    for (int i = 0; i < model.rotor_count; ++i) {
        acting.thrust_n[i] += added.thrust_n[i];
    }
    return flight_step(model, state, motion, acting, dt_s, around);
}

template <Surroundings<double> Around>
PlantState<double> RefinedStep::operator()(const PlantModel& model, const PlantState<double>& state,
                                           const Motion<double>& motion, const PlantCommand<double>& command,
                                           double dt_s, const Around& around) const {
    return refined(model, state, command, dt_s, around, flight_step(model, state, motion, command, dt_s, around),
                   max_halvings);
}

template <Surroundings<double> Around>
PlantState<double> RefinedStep::refined(const PlantModel& model, const PlantState<double>& state,
                                        const PlantCommand<double>& command, double dt_s, const Around& around,
                                        const PlantState<double>& whole, int halvings) const {
    const double half_s = 0.5 * dt_s;
    const PlantState<double> middle = flight_step(model, state, command, half_s, around);
    const PlantState<double> end = flight_step(model, middle, command, half_s, around);
    if (halvings == 0 || agree(whole, end)) {
        return end;
    }
    const PlantState<double> reached = refined(model, state, command, half_s, around, middle, halvings - 1);
    return refined(model, reached, command, half_s, around, flight_step(model, reached, command, half_s, around),
                   halvings - 1);
}

inline bool RefinedStep::agree(const PlantState<double>& a, const PlantState<double>& b) const {
    double worst = 0;
    for (int i = 0; i < 4; ++i) {
        worst = lane::max(worst, lane::max(lane::abs(a.q[i] - b.q[i]), lane::abs(a.u[i] - b.u[i])));
    }
    return worst <= tolerance;
}

}  // namespace downwash::dynamics

#pragma once

#include <limits>

#include "downwash/controllers/model_inversion.hpp"
#include "downwash/dynamics/flight_step.hpp"

// One tick of the closed loop: the one definition that planning, execution, studies and benchmarks share.

namespace downwash::simulation {

/// Everything about the vehicle that does not change in flight.
struct TickModel {
    PlantModel plant;
    ControllerGains gains;
    double tick_s;  ///< control period, 1 / rate_hz
};

/// Everything about the vehicle that changes in flight: bodies, rotor lag, energy, and every integrator.
template <class T>
struct State {
    dynamics::PlantState<T> plant;
    controllers::ControllerState<T> controller;
};

/// What happened in a tick.
template <class T>
struct TickRecord {
    dynamics::PlantCommand<T> command;  ///< held over the tick, after clipping
    T saturation;  ///< greatest demand over its limit: 1 at the limit, more when something had to be clipped
};

/// The worst of all rotors: a demanded thrust over the greatest; below the least thrust 1 and more, by how far it is
/// missed.
template <class T>
T thrust_saturation(const PlantModel& plant, const T demand_n[max_rotors]) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    T least_n(infinity);
    T most_n(-infinity);
    for (int i = 0; i < plant.rotor_count; ++i) {
        least_n = lane::min(least_n, demand_n[i]);
        most_n = lane::max(most_n, demand_n[i]);
    }
    const T below = T(plant.min_thrust_n) - least_n;
    const T missed = T(1) + below / T(plant.max_thrust_n - plant.min_thrust_n);
    return lane::max(most_n / T(plant.max_thrust_n), lane::select(below > T(0), missed, T(0)));
}

/// What the controller expects of the rotors in the middle of the tick: the commands, or where a lag will have brought
/// the thrust by then (one implicit step of half a tick). Surface effects are not known to it.
template <class T>
dynamics::RotorWrench<T> expected_wrench(const TickModel& model, const State<T>& state,
                                         const dynamics::PlantCommand<T>& command) {
    const PlantModel& plant = model.plant;
    const double half_tick_s = 0.5 * model.tick_s;
    const T reached(half_tick_s / (half_tick_s + plant.rotor_time_constant_s));  // 1 without lag
    dynamics::RotorWrench<T> wrench{T(0), T(0)};
    for (int i = 0; i < plant.rotor_count; ++i) {
        const T from = plant.rotor_time_constant_s > 0 ? state.plant.thrust_n[i] : command.thrust_n[i];
        const T thrust_n = from + reached * (command.thrust_n[i] - from);
        wrench.thrust_n = wrench.thrust_n + thrust_n;
        wrench.pitch_torque_nm = wrench.pitch_torque_nm - T(plant.rotor_x_m[i]) * thrust_n;
    }
    return wrench;
}

/// The commands that the controller holds from this state on, and its memory at the end of the tick.
/// @param motion that of the state
template <class T>
controllers::ControllerState<T> control(const TickModel& model, const State<T>& state,
                                        const dynamics::Motion<T>& motion, const controllers::Setpoint<T>& reference,
                                        TickRecord<T>& record) {
    const PlantModel& plant = model.plant;
    const auto step = controllers::model_inversion_control(plant, model.gains, state.plant.q, state.plant.u, motion,
                                                           state.controller, reference, T(model.tick_s));
    T demand_n[max_rotors];
    dynamics::allocate(plant, step.demand.thrust_n, step.demand.pitch_torque_nm, demand_n);
    record.saturation = thrust_saturation(plant, demand_n);
    for (int i = 0; i < plant.rotor_count; ++i) {
        record.command.thrust_n[i] = lane::clamp(demand_n[i], T(plant.min_thrust_n), T(plant.max_thrust_n));
    }
    const dynamics::RotorWrench<T> wrench = expected_wrench(model, state, record.command);
    const T torque_nm =
        controllers::joint_torque(plant, motion, step.demand.arm_acceleration, wrench.thrust_n, wrench.pitch_torque_nm);
    const T most_torque(plant.max_joint_torque_nm);
    record.saturation = lane::max(record.saturation, lane::abs(torque_nm) / most_torque);
    record.command.joint_torque_nm = lane::clamp(torque_nm, -most_torque, most_torque);
    const auto is_clipped = record.saturation > T(1);
    controllers::ControllerState<T> next = step.integrated;
    for (int i = 0; i < 2; ++i) {
        next.position_integral[i] =
            lane::select(is_clipped, step.frozen.position_integral[i], step.integrated.position_integral[i]);
    }
    next.pitch_rate_integral =
        lane::select(is_clipped, step.frozen.pitch_rate_integral, step.integrated.pitch_rate_integral);
    next.arm_integral = lane::select(is_clipped, step.frozen.arm_integral, step.integrated.arm_integral);
    return next;
}

// With the narrow registers of every processor a tick with all that it calls in one place takes a sixth less; kernels
// of wide ones flatten their whole loop instead. What sanitizers add would keep the compiler busy for minutes.
#if defined(__AVX2__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DOWNWASH_IN_ONE_PIECE
#else
#define DOWNWASH_IN_ONE_PIECE [[gnu::flatten]]
#endif

/// One control tick, a pure function: the controller reads the state, its commands are held while the plant moves.
/// @param motion that of the state
/// @param factor callable (rotor, x_m, z_m) -> K, the surface effect at a rotor hub in the plane
/// @param integrate callable (plant, state, motion, command, dt, factor) -> state: dynamics::OneStep or
/// dynamics::RefinedStep
template <class T, class Factor, class Integrate = dynamics::OneStep>
DOWNWASH_IN_ONE_PIECE State<T> tick(const TickModel& model, const State<T>& state, const dynamics::Motion<T>& motion,
                                    const controllers::Setpoint<T>& reference, const Factor& factor,
                                    TickRecord<T>& record, const Integrate& integrate = {}) {
    State<T> next;
    next.controller = control(model, state, motion, reference, record);
    next.plant = integrate(model.plant, state.plant, motion, record.command, T(model.tick_s), factor);
    return next;
}

#undef DOWNWASH_IN_ONE_PIECE

/// The same where the motion of the state is not known yet.
template <class T, class Factor, class Integrate = dynamics::OneStep>
State<T> tick(const TickModel& model, const State<T>& state, const controllers::Setpoint<T>& reference,
              const Factor& factor, TickRecord<T>& record, const Integrate& integrate = {}) {
    const auto motion = dynamics::motion_at(model.plant, state.plant.q, state.plant.u);
    return tick(model, state, motion, reference, factor, record, integrate);
}

}  // namespace downwash::simulation

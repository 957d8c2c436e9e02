#pragma once

#include <limits>

#include "downwash/base/lane_math.hpp"
#include "downwash/controllers/actuation.hpp"
#include "downwash/dynamics/flight_step.hpp"

// From what a control law demands to what rotors and joint are commanded. One template over the lane type.

namespace downwash::controllers {

/// The joint torque for the demanded arm acceleration under the thrust and pitch torque that the rotors give. Where
/// they give what was demanded this is row 4 with the accelerations of the inversion (docs/model.md 5.2). Where they
/// lag or are clipped it is not: a joint that pushes against a pitch acceleration that has yet to come would tip the
/// vehicle the wrong way, and hover with a hanging arm would diverge from a lag of 10 ms on.
template <class T>
T joint_torque(const PlantModel& nominal, const dynamics::Motion<T>& motion, T arm_acceleration, T thrust_n,
               T pitch_torque_nm) {
    const T force[3] = {thrust_n * motion.attitude.sin_pitch, thrust_n * motion.attitude.cos_pitch, pitch_torque_nm};
    return dynamics::joint_torque_for(nominal, motion.equations, force, arm_acceleration);
}

/// The saturation of the worst rotor: the demanded thrust over the greatest one. Below the least thrust it is more than
/// 1, by the share of the range that is missing.
template <class T>
T thrust_saturation(const PlantModel& plant, const T demand_n[max_rotors]) {
    T min_n(std::numeric_limits<double>::infinity());
    T max_n(-std::numeric_limits<double>::infinity());
    for (int i = 0; i < plant.rotor_count; ++i) {
        min_n = lane::min(min_n, demand_n[i]);
        max_n = lane::max(max_n, demand_n[i]);
    }
    const T below = T(plant.min_thrust_n) - min_n;
    T missed(0);
    if (lane::bits_of(below > T(0)) != 0) {  // a division that hardly any tick needs
        missed = lane::select(below > T(0), T(1) + below / T(plant.max_thrust_n - plant.min_thrust_n), T(0));
    }
    return lane::max(max_n / T(plant.max_thrust_n), missed);
}

/// The free-air thrust [N] that a controller expects of rotor i in the middle of the tick: the command, or where a lag
/// will have brought the thrust by then (one implicit step of half a tick).
template <class T>
T expected_thrust(const PlantModel& nominal, const dynamics::PlantState<T>& seen, const T command_n[max_rotors],
                  double tick_s, int i) {
    const double half_tick_s = 0.5 * tick_s;
    const T reached(half_tick_s / (half_tick_s + nominal.rotor_time_constant_s));  // 1 without lag
    const T from = nominal.has_rotor_lag ? seen.thrust_n[i] : command_n[i];
    return from + reached * (command_n[i] - from);
}

/// What a controller expects of all rotors then. It does not know surface effects.
template <class T>
dynamics::RotorWrench<T> expected_wrench(const PlantModel& nominal, const dynamics::PlantState<T>& seen,
                                         const T command_n[max_rotors], double tick_s) {
    dynamics::RotorWrench<T> wrench{T(0), T(0)};
    for (int i = 0; i < nominal.rotor_count; ++i) {
        const T thrust_n = expected_thrust(nominal, seen, command_n, tick_s, i);
        wrench.thrust_n = wrench.thrust_n + thrust_n;
        wrench.pitch_torque_nm = wrench.pitch_torque_nm - T(nominal.rotor_x_m[i]) * thrust_n;
    }
    return wrench;
}

/// Clips what the rotors are asked for to their limits.
/// @param demand_n free-air thrusts [N], which get the lead   @param rotor_lead how much more a rotor is asked for than
/// it lacks, so that its lag shrinks by 1 / (1 + lead); see docs/model.md 5.2
/// @param[out] given the rotors' commands and their saturation
template <class T>
void limit_rotors(const PlantModel& nominal, const dynamics::PlantState<T>& seen, T demand_n[max_rotors],
                  Actuation<T>& given, double rotor_lead) {
    given.saturation = thrust_saturation(nominal, demand_n);
    for (int i = 0; i < nominal.rotor_count; ++i) {
        if (nominal.has_rotor_lag && rotor_lead > 0) {
            demand_n[i] = demand_n[i] + T(rotor_lead) * (demand_n[i] - seen.thrust_n[i]);
        }
        given.command.thrust_n[i] = lane::clamp(demand_n[i], T(nominal.min_thrust_n), T(nominal.max_thrust_n));
    }
}

/// What a law knows of its vehicle besides the model: nothing. Forces and torques on the coordinates are zero, and
/// rotors act as in free air. aided_law.hpp has one that knows something.
struct Unaided {
    /// The equations that a law inverts.
    template <class T>
    [[nodiscard]] const dynamics::Motion<T>& explained(const dynamics::Motion<T>& motion) const {
        return motion;
    }
    /// What else pushes coordinate i [N, N, N m, N m].
    template <class T>
    [[nodiscard]] T force(int /*i*/) const {
        return T(0);
    }
    /// The commands of the rotors for a thrust [N] and a pitch torque [N m], allocated and clipped to their limits.
    /// @param seen state as the controller knows it   @param rotor_lead see limit_rotors()
    /// @param[out] given the rotors' commands and their saturation   @return what the rotors will give
    template <class T>
    dynamics::RotorWrench<T> command_rotors(const PlantModel& nominal, const dynamics::PlantState<T>& seen, T thrust_n,
                                            T pitch_torque_nm, double tick_s, double rotor_lead,
                                            Actuation<T>& given) const {
        T demand_n[max_rotors];
        dynamics::allocate(nominal, thrust_n, pitch_torque_nm, demand_n);
        limit_rotors(nominal, seen, demand_n, given, rotor_lead);
        return expected_wrench(nominal, seen, given.command.thrust_n, tick_s);
    }
};

/// The command of the joint, clipped to its limit. @pre the rotors have been commanded
/// @param[in,out] given gets the joint's command, and its saturation if that is the greater one
template <class T>
void command_joint(const PlantModel& nominal, T torque_nm, Actuation<T>& given) {
    const T max_torque_nm(nominal.max_joint_torque_nm);
    given.saturation = lane::max(given.saturation, lane::abs(torque_nm) / max_torque_nm);
    given.command.joint_torque_nm = lane::clamp(torque_nm, -max_torque_nm, max_torque_nm);
}

/// The commands for a demand.
/// @param seen state as the controller knows it   @param motion nominal motion of that state
/// @param rotor_lead see limit_rotors()   @param aid Unaided, or what knows more
template <class T, class Aid = Unaided>
void actuate(const PlantModel& nominal, const dynamics::PlantState<T>& seen, const dynamics::Motion<T>& motion,
             const Demand<T>& demand, double tick_s, Actuation<T>& given, double rotor_lead = 0, Aid&& aid = {}) {
    const dynamics::RotorWrench<T> wrench =
        aid.command_rotors(nominal, seen, demand.thrust_n, demand.pitch_torque_nm, tick_s, rotor_lead, given);
    command_joint(nominal,
                  joint_torque(nominal, motion, demand.arm_acceleration, wrench.thrust_n, wrench.pitch_torque_nm),
                  given);
}

}  // namespace downwash::controllers

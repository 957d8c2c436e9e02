#pragma once

#include <optional>

#include "downwash/controllers/actuate.hpp"
#include "downwash/controllers/aided_law.hpp"
#include "downwash/controllers/disturbance_observer.hpp"
#include "downwash/controllers/feed_forward.hpp"

// The law of Aided.

namespace downwash::controllers {

/// What an aided law knows in one tick. It has the members of Unaided.
template <class T, dynamics::ThrustRatios<T> Map>
class Aid {
 public:
    /// @param motion nominal motion of the state that the law sees   @param observed memory of the observer
    /// @param map what the feed-forward reads
    Aid(const Aids& aids, const PlantModel& nominal, const dynamics::PlantState<T>& seen,
        const dynamics::Motion<T>& motion, const T observed[4], double tick_s, const Map& map)
        : aids_(aids), motion_(motion), map_(map) {
        if (aids.observer) {
            observation_.emplace(*aids.observer, tick_s, nominal, seen, motion, observed);
            explained_ = observation_->explained(motion);
        }
    }

    [[nodiscard]] const dynamics::Motion<T>& explained(const dynamics::Motion<T>& motion) const {
        return observation_ ? explained_ : motion;
    }
    template <class>
    [[nodiscard]] T force(int i) const {
        return observation_ ? observation_->force()[i] : T(0);
    }
    dynamics::RotorWrench<T> command_rotors(const PlantModel& nominal, const dynamics::PlantState<T>& seen, T thrust_n,
                                            T pitch_torque_nm, double tick_s, double rotor_lead, Actuation<T>& given) {
        if (!aids_.feed_forward) {
            return wrench_ =
                       Unaided().command_rotors(nominal, seen, thrust_n, pitch_torque_nm, tick_s, rotor_lead, given);
        }
        const ReadRatios<T> ratios = read_ratios(*aids_.feed_forward, nominal, seen, motion_.attitude, map_);
        T demand_n[max_rotors];
        allocate_against(nominal, ratios, thrust_n, pitch_torque_nm, demand_n);
        limit_rotors(nominal, seen, demand_n, given, rotor_lead);
        T expected_n[max_rotors];
        for (int i = 0; i < nominal.rotor_count; ++i) {
            expected_n[i] = expected_thrust(nominal, seen, given.command.thrust_n, tick_s, i);
        }
        return wrench_ = wrench_against(nominal, ratios, expected_n);
    }

    /// What the observer, if there is one, has to remember once the commands are given.
    void keep(const Actuation<T>& given, T observed[4]) const {
        for (int i = 0; i < 4; ++i) {
            observed[i] = T(0);
        }
        if (observation_) {
            observation_->keep(wrench_, given.command.joint_torque_nm, observed);
        }
    }

 private:
    const Aids& aids_;
    const dynamics::Motion<T>& motion_;
    const Map& map_;
    std::optional<Observation<T>> observation_;
    dynamics::Motion<T> explained_;
    dynamics::RotorWrench<T> wrench_{T(0), T(0)};  ///< wrench that the law expects to act in mid-tick
};

template <CanBeAided Law>
template <class T>
auto Aided<Law>::rested(const PlantModel& nominal, const dynamics::PlantState<T>& state, double tick_s) const
    -> Memory<T> {
    Memory<T> memory{law.rested(nominal, state), {T(0), T(0), T(0), T(0)}};
    if (law.aids.observer) {
        start_observing(*law.aids.observer, tick_s, nominal, state, memory.observed);
    }
    return memory;
}

template <CanBeAided Law>
template <class T>
void Aided<Law>::hold_estimate(const Memory<T>& before, const T change[4], double tick_s, Memory<T>& now) const {
    if (law.aids.observer) {
        controllers::hold_estimate(*law.aids.observer, tick_s, change, before.observed, now.observed);
    }
}

template <CanBeAided Law>
template <class T, class Map>
auto Aided<Law>::control(const PlantModel& nominal, const dynamics::PlantState<T>& seen,
                         const dynamics::Motion<T>& motion, const Memory<T>& memory,
                         const BasicReferencePoint<T>& reference, double tick_s, Actuation<T>& given,
                         const Map& map) const -> Memory<T> {
    Aid<T, Map> aid(law.aids, nominal, seen, motion, memory.observed, tick_s, map);
    Memory<T> next;
    next.loops = law.control(nominal, seen, motion, memory.loops, reference, tick_s, given, aid);
    aid.keep(given, next.observed);
    return next;
}

template <CanBeAided Law>
Rest<Aided<Law>::template Memory> Aided<Law>::rest(const PlantModel& nominal,
                                                   const dynamics::EquationsOfMotion<double>& equations,
                                                   RestingCommand command) const {
    const double given[4] = {0, command.wrench.thrust_n, command.wrench.pitch_torque_nm, command.joint_torque_nm};
    Rest<Memory> rest;
    for (int i = 0; i < 4; ++i) {
        if (law.aids.observer) {
            command.known_force[i] = equations.bias[i] - given[i];
        }
        rest.memory.observed[i] = command.known_force[i];
        rest.feeds_back.observed[i] = law.aids.observer.has_value();
    }
    const auto loops = law.rest(nominal, equations, command);
    rest.limit = loops.limit;
    rest.memory.loops = loops.memory;
    rest.feeds_back.loops = loops.feeds_back;
    for (int i = 0; i < 3; ++i) {
        rest.error[i] = loops.error[i];
    }
    rest.pitch_reference_rad = loops.pitch_reference_rad;
    rest.height_gain_1_s2 = loops.height_gain_1_s2;
    rest.pitch_gain_1_s2 = loops.pitch_gain_1_s2;
    return rest;
}

}  // namespace downwash::controllers

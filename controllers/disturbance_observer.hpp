#pragma once

#include "downwash/base/lane_math.hpp"
#include "downwash/controllers/aids.hpp"
#include "downwash/dynamics/flight_step.hpp"
#include "downwash/dynamics/momentum.hpp"

// An observer of what the model does not know, in momentum form (docs/model.md 5.6; thesis (3.9)). One template over
// the lane type.

namespace downwash::controllers {

/// The share of its error that an estimate loses in a tick, 1 - e^-x with x = L h. e^x is summed up to x^4 / 24: the
/// time constant is 1 / L to 1 % while x < 1.38, and the share stays below 1 whatever the gain.
[[nodiscard, gnu::always_inline]] inline double observed_share(double gain_1_s, double tick_s) {
    const double x = gain_1_s * tick_s;
    return 1 - 1 / (1 + x * (1 + x * (1.0 / 2 + x * (1.0 / 6 + x * (1.0 / 24)))));
}

/// The observer in one tick. With p = M u, b = dM/dt u - c, the nominal forces Q and the estimate D, the model expects
/// dp/dt = Q + b + D. D grows by the share of what p misses a tick later over the tick. The only memory is D - share p
/// / h, less what the model expects: as long as D is right nothing has to be added up.
template <class T>
class Observation {
 public:
    /// @param motion nominal motion of the state that the law sees   @param kept memory of the tick before
    Observation(const DisturbanceObserver& observer, double tick_s, const PlantModel& nominal,
                const dynamics::PlantState<T>& seen, const dynamics::Motion<T>& motion, const T kept[4])
        : nominal_(nominal), seen_(seen), tick_s_(tick_s), share_(observed_share(observer.gain_1_s, tick_s)) {
        dynamics::momentum(nominal, motion.equations, seen.u, momentum_);
        for (int i = 0; i < 4; ++i) {
            force_[i] = kept[i] + T(share_ / tick_s) * momentum_[i];
        }
    }

    /// D: forces and torques on the coordinates beside the nominal ones [N, N, N m, N m].
    [[nodiscard]] const T* force() const { return force_; }

    /// The motion with D among its equations: M du/dt + c - D = Q.
    [[nodiscard]] dynamics::Motion<T> explained(const dynamics::Motion<T>& motion) const {
        dynamics::Motion<T> with = motion;
        for (int i = 0; i < 4; ++i) {
            with.equations.bias[i] = with.equations.bias[i] - force_[i];
        }
        return with;
    }

    /// The memory for the next tick. Commands count as they were given, within their limits: what was clipped winds
    /// nothing up. Angles are those of half a tick later at the present speeds.
    /// @param wrench that the controller expects in mid-tick
    void keep(const dynamics::RotorWrench<T>& wrench, T joint_torque_nm, T kept[4]) const {
        T q[4];
        for (int i = 0; i < 4; ++i) {
            q[i] = seen_.q[i] + T(0.5 * tick_s_) * seen_.u[i];
        }
        const dynamics::Motion<T> middle = dynamics::motion_at(nominal_, q, seen_.u);
        T rate[4];
        dynamics::free_momentum_rate(nominal_, middle.attitude, middle.equations, seen_.u, rate);
        const T given[4] = {wrench.thrust_n * middle.attitude.sin_pitch, wrench.thrust_n * middle.attitude.cos_pitch,
                            wrench.pitch_torque_nm, joint_torque_nm};
        for (int i = 0; i < 4; ++i) {
            kept[i] = force_[i] - T(share_ / tick_s_) * momentum_[i] - T(share_) * (given[i] + rate[i] + force_[i]);
        }
    }

 private:
    const PlantModel& nominal_;
    const dynamics::PlantState<T>& seen_;
    double tick_s_;
    double share_;
    T momentum_[4];
    T force_[4];
};

/// The memory of an observer that has nothing to report of a vehicle in a state.
template <class T>
void start_observing(const DisturbanceObserver& observer, double tick_s, const PlantModel& nominal,
                     const dynamics::PlantState<T>& state, T kept[4]) {
    T p[4];
    dynamics::momentum(nominal, dynamics::motion_at(nominal, state.q, state.u).equations, state.u, p);
    for (int i = 0; i < 4; ++i) {
        kept[i] = -(T(observed_share(observer.gain_1_s, tick_s) / tick_s) * p[i]);
    }
}

/// The memory with which the estimate stands still over a tick. It is made from what the tick before remembered, not
/// from what the law saw: noise does not add up.
/// @param change of the nominal momentum over the tick   @param before memory at its start
template <class T>
void hold_estimate(const DisturbanceObserver& observer, double tick_s, const T change[4], const T before[4],
                   T kept[4]) {
    for (int i = 0; i < 4; ++i) {
        kept[i] = before[i] - T(observed_share(observer.gain_1_s, tick_s) / tick_s) * change[i];
    }
}

}  // namespace downwash::controllers

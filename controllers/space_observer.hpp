#pragma once

#include "downwash/controllers/disturbance_observer.hpp"
#include "downwash/dynamics/space_momentum.hpp"
#include "downwash/dynamics/space_step.hpp"

// The disturbance observer in space, in momentum form (docs/model.md 5.9): that of disturbance_observer.hpp with the
// generalised momentum of space_momentum.hpp. It estimates three forces in world axes [N], three torques in body axes
// [N m] and a torque for each joint [N m]. One template over the lane type and the number of joints.

namespace downwash::controllers {

/// Coordinates with the rates u that would be reached after a time at constant rates. The quaternion is not of
/// length 1.
/// @param time_s so short that |body rate| time < 1
template <class T, int n>
void advanced(const T q[dynamics::space_coordinates<n>], const T u[dynamics::space_speeds<n>], double time_s,
              T at[dynamics::space_coordinates<n>]) {
    for (int i = 0; i < 3; ++i) {
        at[i] = q[i] + T(time_s) * u[i];
    }
    // q times (cos x, sin(x) / x half-angles), both to x^5, where x is half the angle.
    const T half(0.5 * time_s);
    const T x = half * u[3];
    const T y = half * u[4];
    const T z = half * u[5];
    const T square = x * x + y * y + z * z;
    const T w = T(1) - square * (T(1.0 / 2) - square * T(1.0 / 24));
    const T s = T(1) - square * (T(1.0 / 6) - square * T(1.0 / 120));
    at[3] = w * q[3] - s * (q[4] * x + q[5] * y + q[6] * z);
    at[4] = w * q[4] + s * (q[3] * x + q[5] * z - q[6] * y);
    at[5] = w * q[5] + s * (q[3] * y + q[6] * x - q[4] * z);
    at[6] = w * q[6] + s * (q[3] * z + q[4] * y - q[5] * x);
    for (int i = 0; i < n; ++i) {
        at[7 + i] = q[7 + i] + T(time_s) * u[6 + i];
    }
}

/// The observer in one tick; see Observation.
template <class T, int n>
class SpaceObservation {
 public:
    static constexpr int numbers = dynamics::space_speeds<n>;

    /// @param places,e of the state that the law sees   @param kept memory of the tick before
    SpaceObservation(double gain_1_s, double tick_s, const SpaceModel<n>& nominal,
                     const dynamics::SpaceState<T, n>& seen, const dynamics::SpacePlaces<T, n>& places,
                     const dynamics::SpaceEquations<T, n>& e, const T kept[numbers])
        : nominal_(nominal), seen_(seen), tick_s_(tick_s), share_(observed_share(gain_1_s, tick_s)) {
        dynamics::momentum(nominal, places, e, seen.u, momentum_);
        for (int i = 0; i < numbers; ++i) {
            force_[i] = kept[i] + T(share_ / tick_s) * momentum_[i];
        }
    }

    /// D: forces and torques beside the nominal ones.
    [[nodiscard]] const T* force() const { return force_; }

    /// Puts D among the equations: they then ask for what is missing.
    void explain(const dynamics::LaneRotation<T>& attitude, dynamics::SpaceEquations<T, n>& e) const {
        e.bias_force_n =
            e.bias_force_n - turned_back(attitude, dynamics::LaneVector<T>{force_[0], force_[1], force_[2]});
        e.bias_torque_nm = e.bias_torque_nm - dynamics::LaneVector<T>{force_[3], force_[4], force_[5]};
        for (int i = 0; i < n; ++i) {
            e.bias_joint_nm[i] = e.bias_joint_nm[i] - force_[6 + i];
        }
    }

    /// The memory for the next tick.
    /// @param wrench that the controller expects in mid-tick, the gyroscopic torque of rotors included   @param
    /// joint_torque_nm as commanded
    void keep(const dynamics::SpaceWrench<T>& wrench, const T joint_torque_nm[room_for<n>], T kept[numbers]) const {
        T q[dynamics::space_coordinates<n>];
        advanced<T, n>(seen_.q, seen_.u, 0.5 * tick_s_, q);
        const dynamics::SpacePlaces<T, n> middle = dynamics::places_at(nominal_, q);
        T rate[numbers];
        dynamics::free_momentum_rate(nominal_, middle, seen_.u, rate);
        const dynamics::LaneVector<T> force = middle.attitude * wrench.force_n;
        const T given[6] = {force.x, force.y, force.z, wrench.torque_nm.x, wrench.torque_nm.y, wrench.torque_nm.z};
        for (int i = 0; i < numbers; ++i) {
            const T acting = i < 6 ? given[i] : joint_torque_nm[i - 6];
            kept[i] = force_[i] - T(share_ / tick_s_) * momentum_[i] - T(share_) * (acting + rate[i] + force_[i]);
        }
    }

 private:
    const SpaceModel<n>& nominal_;
    const dynamics::SpaceState<T, n>& seen_;
    double tick_s_;
    double share_;
    T momentum_[numbers];
    T force_[numbers];
};

/// The memory of an observer that has nothing to report of a vehicle in a state.
template <class T, int n>
void start_observing(double gain_1_s, double tick_s, const SpaceModel<n>& nominal,
                     const dynamics::SpaceState<T, n>& state, T kept[dynamics::space_speeds<n>]) {
    const dynamics::SpacePlaces<T, n> places = dynamics::places_at(nominal, state.q);
    T p[dynamics::space_speeds<n>];
    dynamics::momentum(nominal, places, dynamics::equations_of_motion(nominal, places, state.u), state.u, p);
    for (int i = 0; i < dynamics::space_speeds<n>; ++i) {
        kept[i] = -(T(observed_share(gain_1_s, tick_s) / tick_s) * p[i]);
    }
}

/// Lets the observer estimate at the next tick what it estimated at this one, whatever pushes in between; up to noise
/// in what the law saw. @param change of the nominal momentum over the tick   @param before memory at its start
template <int n, class T>
void hold_estimate(double gain_1_s, double tick_s, const T change[dynamics::space_speeds<n>],
                   const T before[dynamics::space_speeds<n>], T kept[dynamics::space_speeds<n>]) {
    for (int i = 0; i < dynamics::space_speeds<n>; ++i) {
        kept[i] = before[i] - T(observed_share(gain_1_s, tick_s) / tick_s) * change[i];
    }
}

}  // namespace downwash::controllers

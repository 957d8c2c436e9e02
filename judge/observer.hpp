#pragma once

#include <array>

#include "downwash/judge/equations_of_motion.hpp"

// The disturbance observer of docs/model.md 5.6, from the momenta of the two bodies. Private: not installed.

namespace downwash::judge {

/// Numbers for x, z, pitch and arm.
using Four = std::array<double, 4>;

/// What an observer keeps between ticks.
struct ObserverMemory {
    Four estimate{};           ///< forces and torques that the model does not explain
    Four expected_momentum{};  ///< momentum at the next tick, if the estimate is right
};

/// The momenta of both bodies, as they belong to the coordinates x, z, pitch and arm.
[[nodiscard]] DOWNWASH_EXPORT Four momentum_of(const Vehicle& vehicle, const Motion& motion);

/// How these change where nothing acts but weight.
[[nodiscard]] DOWNWASH_EXPORT Four free_momentum_rate(const Vehicle& vehicle, const Motion& motion);

/// An observer that expects the nominal vehicle.
class Observer {
 public:
    /// @param gain_1_s see DisturbanceObserver; 0: there is none, and estimates are zero
    Observer(const Vehicle& nominal, double gain_1_s, double tick_s);

    /// The memory at the start of a flight, with nothing estimated.
    [[nodiscard]] ObserverMemory at_start(const Motion& motion) const;
    /// The memory in the middle of a flight. @param kept for each coordinate: the estimate less share / tick times the
    /// momentum
    [[nodiscard]] ObserverMemory of_kept(const Four& kept) const;
    /// Compares the momentum with what was expected.
    void look(const Motion& seen, ObserverMemory& memory) const;
    /// Says what to expect a tick later.
    /// @param thrust_n,pitch_torque_nm expected to act in mid-tick
    void expect(const Motion& seen, double thrust_n, double pitch_torque_nm, double joint_torque_nm,
                ObserverMemory& memory) const;
    /// The memory with which the next look finds what the last one found, whatever pushed in between.
    /// @param memory before the last look   @param from,to motion at both ends of the tick
    [[nodiscard]] ObserverMemory held(ObserverMemory memory, const Motion& from, const Motion& to) const;

 private:
    Vehicle nominal_vehicle_;
    double tick_s_;
    double share_;
};

}  // namespace downwash::judge

#pragma once

#include "downwash/judge/space_bodies.hpp"

// The disturbance observer in space (docs/model.md 5.9), from the momenta of the bodies. Private: not installed.

namespace downwash::judge {

/// What an observer keeps between ticks: three forces in world axes, three torques in body axes, a torque for each
/// joint.
struct SpaceObserverMemory {
    Eigen::VectorXd estimate;           ///< what the model does not explain
    Eigen::VectorXd expected_momentum;  ///< at the next tick, if the estimate is right
};

/// The momenta of all bodies: linear in world axes, angular about the multirotor's centre of mass in body axes, and of
/// the links beyond each joint about its axis.
[[nodiscard]] DOWNWASH_EXPORT Eigen::VectorXd momentum_of(const SpaceVehicle& vehicle, const BodyMotions& bodies);
/// How these change where nothing acts but weight.
[[nodiscard]] DOWNWASH_EXPORT Eigen::VectorXd free_momentum_rate(const SpaceVehicle& vehicle,
                                                                 const BodyMotions& bodies);

/// An observer that expects the nominal vehicle.
class SpaceObserver {
 public:
    /// @param nominal outlives this   @param gain_1_s > 0
    DOWNWASH_EXPORT SpaceObserver(const SpaceVehicle& nominal, double gain_1_s, double tick_s);

    /// The memory at the start of a flight, with nothing estimated.
    [[nodiscard]] DOWNWASH_EXPORT SpaceObserverMemory at_start(const SpaceCoordinates& seen) const;
    /// Compares the momentum with what was expected.
    DOWNWASH_EXPORT void look(const SpaceCoordinates& seen, SpaceObserverMemory& memory) const;
    /// Says what to expect a tick later. @param force_n,torque_nm,joints_nm expected in mid-tick, body axes
    DOWNWASH_EXPORT void expect(const SpaceCoordinates& seen, const Eigen::Vector3d& force_n,
                                const Eigen::Vector3d& torque_nm, const Eigen::VectorXd& joints_nm,
                                SpaceObserverMemory& memory) const;
    /// The memory with which the estimate stands still over a tick. @param memory before it
    [[nodiscard]] SpaceObserverMemory held(SpaceObserverMemory memory, const SpaceCoordinates& from,
                                           const SpaceCoordinates& to) const;

 private:
    const SpaceVehicle& nominal_;
    double tick_s_, share_;
};

}  // namespace downwash::judge

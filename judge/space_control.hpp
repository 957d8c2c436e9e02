#pragma once

#include <optional>

#include "downwash/judge/space_observer.hpp"
#include "downwash/judge/space_plant.hpp"
#include "downwash/judge/space_rotors.hpp"

// The control laws in space (docs/model.md 5.9 to 5.11). Private: not installed.

namespace downwash::judge {

/// What a law remembers between ticks.
struct SpaceControlMemory {
    Eigen::Vector3d position_integral, velocity_integral, rate_integral;
    Eigen::VectorXd joint_integral;
    Eigen::Vector3d direction, direction_rate;  ///< of the wanted thrust, world axes
    Eigen::Vector3d rate_reference;             ///< body axes
    Eigen::Vector3d velocity_before, rate_before;
    SpaceObserverMemory observer;
};

/// The law of a robot, which expects the nominal vehicle and reads surfaces in their nominal places. Safe to share
/// between threads.
class SpaceControl {
 public:
    /// @pre space_robot_errors(robot) is empty
    DOWNWASH_EXPORT explicit SpaceControl(const SpaceRobot& robot);
    SpaceControl(const SpaceControl&) = delete;
    SpaceControl& operator=(const SpaceControl&) = delete;

    [[nodiscard]] double tick_s() const noexcept { return tick_s_; }
    [[nodiscard]] const SpaceVehicle& nominal() const noexcept { return nominal_; }

    /// Thrusts that carry the weight without a torque.
    [[nodiscard]] DOWNWASH_EXPORT std::vector<double> resting_thrust_n() const;
    /// The memory of a law that has come to rest.
    [[nodiscard]] DOWNWASH_EXPORT SpaceControlMemory at_start(const SpaceCoordinates& seen) const;
    /// The memory in the middle of a flight. @param numbers as SpaceCarry::controller_memory has them
    [[nodiscard]] SpaceControlMemory memory_of(const std::vector<double>& numbers) const;

    /// One tick. @param thrust_n that the rotors' lag has reached   @param surfaces in their nominal places
    /// @param push read by a law that inverts its model
    [[nodiscard]] DOWNWASH_EXPORT SpaceCommands command(const SpaceCoordinates& seen,
                                                        const std::vector<double>& thrust_n,
                                                        const SpacePoint& reference, const SpaceSurroundings& surfaces,
                                                        SpaceControlMemory& memory,
                                                        const std::optional<BodyPush>& push = {}) const;

    /// Lets integrals stand still over a tick, and the observer estimate at the next one what it did at this one.
    /// @param before memory at the beginning of the tick   @param from,to true motions at its ends
    DOWNWASH_EXPORT void stand_still(const SpaceControlMemory& before, const SpaceCoordinates& from,
                                     const SpaceCoordinates& to, SpaceControlMemory& memory) const;

 private:
    struct Tick;
    [[nodiscard]] SpaceCommands command_by(const SpaceInversion& law, const Tick& tick,
                                           SpaceControlMemory& memory) const;
    [[nodiscard]] SpaceCommands command_by(const Px4Cascade& law, const Tick& tick, SpaceControlMemory& memory) const;
    [[nodiscard]] std::vector<double> ratios(const SpaceInversion& law, const Tick& tick) const;
    /// Clips joint torques. @param[in,out] saturation
    [[nodiscard]] Eigen::VectorXd within_limits(const Eigen::VectorXd& joints_nm, double& saturation) const;

    SpaceVehicle nominal_;
    SpaceLaw law_;
    double tick_s_;
    RotorShares shares_;
    std::optional<SpaceObserver> observer_;
};

}  // namespace downwash::judge

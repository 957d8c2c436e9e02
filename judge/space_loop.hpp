#pragma once

#include "downwash/judge/space_control.hpp"
#include "downwash/judge/space_sensors.hpp"

// The vehicle in space in closed loop. Private: not installed.

namespace downwash::judge {

/// A vehicle in closed loop, tick by tick.
class SpaceLoop {
 public:
    /// @param nominal surfaces as the controller's map has them   @param start motion of the point of the robot file
    /// @pre all but the start outlive this
    DOWNWASH_EXPORT SpaceLoop(const SpaceControl& control, const SpaceSurroundings& nominal, const SpacePlant& plant,
                              const SpaceWorld& world, const SpaceRobot& robot, const SpaceCoordinates& start);
    /// What a vehicle in flight carries; empty lists change nothing.
    void carry(const std::vector<double>& rotor_thrust_n, const std::vector<double>& controller_memory);

    [[nodiscard]] const SpacePlantState& state() const noexcept { return state_; }
    /// Another plant from here on: one that touches something, or none. @pre it outlives the loop
    void fly_with(const SpacePlant& plant) noexcept { plant_ = &plant; }
    [[nodiscard]] const SpacePlant& plant() const noexcept { return *plant_; }
    /// The motion of the point that the robot file calls the centre of mass; joints count on over whole turns.
    [[nodiscard]] const SpaceCoordinates& coordinates() const noexcept { return now_; }
    /// What the controller saw in the last tick.
    [[nodiscard]] const SpaceCoordinates& seen() const noexcept { return seen_; }
    /// What the controller gave in the last tick.
    [[nodiscard]] const SpaceCommands& commands() const noexcept { return commands_; }

    /// Goes on by a tick. @param tick from the start of the flight
    /// @param is_at_surface integrals and the observer stand still, contact or not   @param push that the law expects
    DOWNWASH_EXPORT void next(std::int64_t tick, const SpacePoint& reference, bool is_at_surface = false,
                              const std::optional<BodyPush>& push = {});
    /// The bodies so long after the beginning of the last tick.
    [[nodiscard]] DOWNWASH_EXPORT BodyMotions bodies_within(double since_s) const;
    /// From now on, in a world: the vehicle was always in this state, and has spent no energy.
    DOWNWASH_EXPORT void forget(const SpaceWorld& world);

 private:
    const SpaceControl& control_;
    const SpaceSurroundings& nominal_surfaces_;
    const SpacePlant* plant_;
    SpaceWorld world_;
    const SpaceRobot& robot_;
    SpacePlantState state_, before_;
    SpaceCoordinates now_, seen_;
    SpaceControlMemory memory_;
    SpaceSensors sensors_;
    SpaceGusts gusts_;
    SpaceCommands commands_;
    Eigen::Vector3d wind_;
};

}  // namespace downwash::judge

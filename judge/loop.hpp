#pragma once

#include "downwash/judge/control_law.hpp"
#include "downwash/judge/sensors.hpp"
#include "downwash/problems/problem.hpp"

// The vehicle in closed loop. Private: not installed.

namespace downwash::judge {

/// A vehicle in closed loop, tick by tick.
class Loop {
 public:
    /// @param nominal surfaces as the controller's map has them
    Loop(const ControlLaw& law, const Surroundings& nominal, const Plant& plant, const World& world, const Robot& robot,
         const PlantState& state, const ControlMemory& memory);

    [[nodiscard]] const PlantState& state() const noexcept { return state_; }
    [[nodiscard]] const ControlMemory& memory() const noexcept { return memory_; }
    /// The motion of the point of the robot file.
    [[nodiscard]] Motion motion() const;

    /// What the controller sees in a tick that begins now. @param tick from the start of the flight
    [[nodiscard]] Motion seen(std::int64_t tick) const;

    /// Another plant from here on: one that touches something. @pre it outlives the loop
    void fly_with(const Plant& plant) noexcept { plant_ = &plant; }
    [[nodiscard]] const Plant& plant() const noexcept { return *plant_; }

    /// Goes on by a tick. @param tick from the start of the flight
    /// @param is_at_surface integrals and the observer stand still, contact or not
    void next(std::int64_t tick, const ReferencePoint& reference, bool is_at_surface = false);

    /// The motion of the file's point so long after the beginning of the last tick.
    [[nodiscard]] Motion motion_within(double since_s) const;

 private:
    const ControlLaw& law_;
    const Surroundings& nominal_surroundings_;
    const Plant* plant_;
    const World& world_;
    Sensors sensors_;
    Gusts gusts_;
    PlantState state_, before_;
    ControlMemory memory_;
    Command command_;
    Planar wind_;
};

/// How the point of the robot file moves at the start of a problem.
[[nodiscard]] Motion motion_of(const Start& start);

/// The vehicle at the start of a problem, its rotors carrying the weight.
[[nodiscard]] PlantState start_of(const Start& start, const ControlLaw& law, const Vehicle& vehicle);

}  // namespace downwash::judge

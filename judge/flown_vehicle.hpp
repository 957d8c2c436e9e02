#pragma once

#include <cstdint>

#include "downwash/judge/control_law.hpp"
#include "downwash/judge/judged_flight.hpp"
#include "downwash/judge/loop.hpp"
#include "downwash/judge/obstacles.hpp"
#include "downwash/judge/umpire.hpp"

// A vehicle in a world, with all that acts on it and the umpire beside it. Private: not installed.

namespace downwash::judge {

/// What all flights of a problem share. Safe to share between threads.
struct Setting {
    Problem problem;
    SurfaceEffects effects;
    Obstacles obstacles;
    ControlLaw law;

    /// @pre problem_errors(problem) is empty
    explicit Setting(const Problem& of);
};

/// A vehicle from the start of a problem on. In a world a vehicle at rest has hovered there, in calm air and with quiet
/// sensors.
class FlownVehicle {
 public:
    /// @pre the setting outlives it
    FlownVehicle(const Setting& setting, const FlightConditions& conditions);
    FlownVehicle(const FlownVehicle&) = delete;
    FlownVehicle& operator=(const FlownVehicle&) = delete;

    /// Whether the vehicle could hover at its start.
    [[nodiscard]] bool has_begun() const noexcept { return begin_.is_stable; }

    [[nodiscard]] Loop& loop() noexcept { return loop_; }
    [[nodiscard]] const Loop& loop() const noexcept { return loop_; }
    [[nodiscard]] Umpire& umpire() noexcept { return umpire_; }
    /// What the umpire has written down.
    [[nodiscard]] JudgedFlight& flight() noexcept { return flight_; }
    [[nodiscard]] const JudgedFlight& flight() const noexcept { return flight_; }
    [[nodiscard]] const World& world() const noexcept { return world_; }
    /// The plant of this vehicle, touching something. @pre the surface and this outlive it
    [[nodiscard]] Plant touching(const TouchSurface& surface) const { return {vehicle_, surroundings_, &surface}; }

 private:
    /// How the flight begins.
    struct Begin {
        PlantState state;
        ControlMemory memory;
        bool is_stable = true;
    };
    [[nodiscard]] Begin begin(const Setting& setting, bool hovers) const;

    World world_;
    World nominal_;
    const SurfaceEffects* effects_;
    Vehicle vehicle_;
    Surroundings surroundings_, nominal_surroundings_;
    Plant plant_;
    Begin begin_;
    JudgedFlight flight_;
    Loop loop_;
    Umpire umpire_;
};

}  // namespace downwash::judge

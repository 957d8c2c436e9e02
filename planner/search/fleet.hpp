#pragma once

#include <cstddef>
#include <vector>

#include "downwash/simulation/flight_batch.hpp"

namespace downwash::planning {

/// The vehicle in every world that a search flies in, the nominal one first.
using Fleet = std::vector<FlightState>;

/// A job of a whole fleet: each vehicle flies the legs in its world.
struct FleetJob {
    std::vector<FlightJob> jobs;  ///< one in each world

    /// As flown in the nominal world.
    [[nodiscard]] const std::vector<FlightLeg>& legs() const noexcept { return jobs.front().legs; }
    /// The rejected leg in the first world in which the flight ended early; nullptr when it did in none.
    [[nodiscard]] const FlightLeg* rejected_leg() const noexcept;
    [[nodiscard]] bool is_accepted() const noexcept { return rejected_leg() == nullptr; }
    /// At the end of a leg. @pre the flight was accepted that far
    [[nodiscard]] Fleet fleet_after(std::size_t leg) const;
    /// At the end. @pre is_accepted()
    [[nodiscard]] Fleet end() const { return fleet_after(legs().size() - 1); }
};

/// A world in which a plan failed that had passed all those of the search, and the vehicle at the search's start in it.
struct Counterexample {
    FlownWorld world;
    FlightState start;
};

/// The worlds of a search beside the nominal one, and the fleet at its start. Empty for a search in one world.
struct SearchWorlds {
    std::vector<FlownWorld> worlds;
    Fleet start;  ///< start in each of these worlds
};

}  // namespace downwash::planning

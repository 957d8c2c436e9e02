#pragma once

#include <cstddef>
#include <vector>

#include "downwash/search/family.hpp"
#include "downwash/simulation/flight_batch.hpp"

namespace downwash::planning {

/// The states of the one vehicle in the worlds of a search. The nominal world, where it belongs to them, is the first.
template <class Family>
using FleetOf = std::vector<typename Family::FlightState>;
using Fleet = FleetOf<Plane>;

/// The same legs to be flown in every world.
template <class Family>
struct FleetJobOf {
    using FlightJob = typename Family::FlightJob;
    using FlightLeg = typename Family::FlightLeg;
    using Fleet = FleetOf<Family>;

    std::vector<FlightJob> jobs;   ///< one in each world
    bool is_hover_judged = false;  ///< the last leg is a hover that a GoalRegion judges, not the rules of the flight

    /// The legs as flown in the nominal world.
    [[nodiscard]] const std::vector<FlightLeg>& legs() const noexcept { return jobs.front().legs; }
    /// The rejected leg in the first world in which the flight ended early; nullptr when it did in none.
    [[nodiscard]] const FlightLeg* rejected_leg() const noexcept;
    [[nodiscard]] bool is_accepted() const noexcept { return rejected_leg() == nullptr; }
    /// The states at the end of a leg. @pre the flight was accepted that far
    [[nodiscard]] Fleet fleet_after(std::size_t leg) const;
    /// The states at the end of the last leg. @pre is_accepted()
    [[nodiscard]] Fleet end() const { return fleet_after(legs().size() - 1); }
};
using FleetJob = FleetJobOf<Plane>;

/// A world in which a plan failed although it passed in all worlds of the search, and the vehicle's state at the
/// search's start there.
template <class Family>
struct CounterexampleOf {
    using FlightState = typename Family::FlightState;
    using FlownWorld = typename Family::FlownWorld;

    FlownWorld world;
    FlightState start;
};
using Counterexample = CounterexampleOf<Plane>;

/// The worlds of a search without the nominal one, and the states at its start. Empty for a search in one world.
template <class Family>
struct SearchWorldsOf {
    using FlownWorld = typename Family::FlownWorld;
    using Fleet = FleetOf<Family>;

    std::vector<FlownWorld> worlds;
    Fleet start;  ///< state at the start in each of these worlds
};
using SearchWorlds = SearchWorldsOf<Plane>;

}  // namespace downwash::planning

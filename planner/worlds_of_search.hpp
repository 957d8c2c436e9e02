#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/planner/certificate.hpp"
#include "downwash/search/fleet.hpp"

// What ProblemWorlds and SpaceProblemWorlds make in the same way of worlds and the vehicles in them.

namespace downwash::planning {

/// A vehicle for each of some worlds; nothing where it does not get that far.
template <class Family>
using VehiclesOf = std::vector<std::optional<typename Family::FlightState>>;

/// The worlds of a search with the vehicles at its start. @throws InputError when one of them is not there
template <class Family>
SearchWorldsOf<Family> worlds_of_search(std::vector<typename Family::FlownWorld> worlds,
                                        const VehiclesOf<Family>& vehicles) {
    SearchWorldsOf<Family> search{std::move(worlds), {}};
    for (const auto& vehicle : vehicles) {
        if (!vehicle) {
            throw_input_error(
                "is so wide that the vehicle cannot hover at its start in one of the worlds of the search: "
                "expected less, or a controller that bears it",
                "uncertainty");
        }
        search.start.push_back(*vehicle);
    }
    return search;
}

/// Indices of some worlds in which a plan failed on its way to a goal, from 0.
[[nodiscard]] inline std::vector<std::uint64_t> failed_on_way_to(std::size_t goal, const Certificate& certificate) {
    constexpr std::size_t most = 4;
    std::vector<std::uint64_t> worlds;
    for (const WorldSample& sample : certificate.worst) {
        if (sample.outcome != Outcome::ok && sample.goal == goal && worlds.size() < most) {
            worlds.push_back(sample.world);
        }
    }
    return worlds;
}

/// Those worlds in which there is a vehicle, each with it.
template <class Family>
std::vector<CounterexampleOf<Family>> counterexamples_of(const std::vector<typename Family::FlownWorld>& worlds,
                                                         const VehiclesOf<Family>& vehicles) {
    std::vector<CounterexampleOf<Family>> counterexamples;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        if (vehicles[i]) {
            counterexamples.push_back({worlds[i], *vehicles[i]});
        }
    }
    return counterexamples;
}

}  // namespace downwash::planning

#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "downwash/controllers/plan.hpp"
#include "downwash/search/search_task.hpp"

namespace downwash::planning {

/// A moment of a simulated flight: all that the future depends on, and of the past only sums. A plain value; flying on
/// from it is a pure function.
template <class Family>
struct FlightPointOf {
    using Configuration = typename Family::Configuration;
    using ReferencePoint = typename Family::ReferencePoint;
    using FlightState = typename Family::FlightState;
    using Fleet = FleetOf<Family>;

    FlightState vehicle;       ///< bodies, rotor lag, energy and the controller's memory
    Fleet others;              ///< the vehicle in the other worlds of the search
    ReferencePoint reference;  ///< reference that the vehicle follows
    Configuration rest;        ///< where the reference would come to rest; stands for the place of this moment
    double cost = 0;           ///< cost of the flight from the start, in the objective's unit
    std::int64_t ticks = 0;    ///< since the start
    bool is_valid = true;      ///< false: the edge to here was rejected, and nothing flies on from it
};
using FlightPoint = FlightPointOf<Plane>;

/// The start of a search; `rest` is where it begins.
template <class Family>
[[nodiscard]] FlightPointOf<Family> start_point(const SearchTaskOf<Family>& task) {
    FlightPointOf<Family> point;
    point.vehicle = task.start;
    point.reference = reference_at(task.problem.start);
    point.rest = place_of(task.problem.start);
    return point;
}

/// The vehicle level and at rest at a configuration.
[[nodiscard]] FlightPoint resting_at(const FlightModel& model, const Configuration& configuration);
/// The same in space, for distances: the controller has not come to rest there.
[[nodiscard]] FlightPointOf<Space> resting_at(const SpaceProblemModel& model, const SpaceConfiguration& configuration);

/// Whether vehicle, in all worlds, and reference are the same to the last bit.
template <class Family>
[[nodiscard]] bool is_same_moment(const FlightPointOf<Family>& a, const FlightPointOf<Family>& b) {
    const auto are_same = [](const auto& one, const auto& other) { return is_same(one, other); };
    return is_same(a.vehicle, b.vehicle) && std::ranges::equal(a.others, b.others, are_same) &&
           a.reference == b.reference;
}

/// A plan as it was simulated: the moments at its knots, then the one after the hover at the goal.
/// @param blank a plan without knots   @return the plan through all moments but the last
template <class Family>
[[nodiscard]] typename Family::Plan plan_through(const std::vector<FlightPointOf<Family>>& moments,
                                                 typename Family::Plan blank) {
    for (std::size_t i = 0; i + 1 < moments.size(); ++i) {
        blank.reference.push_back({moments[i].ticks, moments[i].reference});
    }
    return blank;
}

}  // namespace downwash::planning

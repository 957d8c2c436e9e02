#pragma once

#include <cstdint>
#include <vector>

#include "downwash/controllers/plan.hpp"
#include "downwash/search/search_task.hpp"

namespace downwash::planning {

/// A moment of a simulated flight: all that the future depends on, and of the past only sums. A plain value; flying on
/// from it is a pure function.
struct FlightPoint {
    FlightState vehicle;       ///< bodies, rotor lag, energy and the controller's memory
    Fleet others;              ///< the vehicle in the other worlds of the search
    ReferencePoint reference;  ///< reference that the vehicle follows
    Configuration rest;        ///< where the reference would come to rest; stands for the place of this moment
    double cost = 0;           ///< cost of the flight from the start, in the objective's unit
    std::int64_t ticks = 0;    ///< since the start
    bool is_valid = true;      ///< false: the edge to here was rejected, and nothing flies on from it
};

/// The start of a search; `rest` is where it begins.
[[nodiscard]] FlightPoint start_point(const SearchTask& task);

/// The vehicle level and at rest at a configuration.
[[nodiscard]] FlightPoint resting_at(const FlightModel& model, const Configuration& configuration);

/// Whether vehicle, in all worlds, and reference are the same to the last bit.
[[nodiscard]] bool is_same_moment(const FlightPoint& a, const FlightPoint& b);

/// A plan as it was simulated: the moments at its knots, then the one after the hover at the goal.
/// @return the plan through all moments but the last
[[nodiscard]] Plan plan_through(const std::vector<FlightPoint>& moments, double tick_s);

}  // namespace downwash::planning

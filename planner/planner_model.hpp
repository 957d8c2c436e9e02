#pragma once

#include <memory>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::planning {

/// The planner's own model of a problem, in which all its searches fly.
struct PlannerModel {
    std::shared_ptr<const FlightModel> flight;
    std::shared_ptr<const AeroMap> map;  ///< nullptr: surfaces do not act
};

}  // namespace downwash::planning

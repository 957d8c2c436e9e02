#pragma once

#include <memory>
#include <utility>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/search/family.hpp"

namespace downwash::planning {

/// The planner's own model of a problem, in which all its searches fly, and the world in which plans have to do well.
template <class Family>
struct PlannerModelOf {
    using FlightModel = typename Family::FlightModel;
    using Effects = typename Family::Effects;

    /// @param map of surface effects as they are; nullptr for none, or where nothing is flown through it
    PlannerModelOf(Variant variant, std::shared_ptr<const FlightModel> flight_model, std::shared_ptr<const Effects> map)
        : flight(std::move(flight_model)),
          own_map(variant == Variant::mp_arm_ada ? map : nullptr),
          true_map(std::move(map)) {}

    std::shared_ptr<const FlightModel> flight;
    std::shared_ptr<const Effects> own_map;   ///< nullptr: surfaces do not act in the planner's own model
    std::shared_ptr<const Effects> true_map;  ///< through which certificates and stops are flown
};
using PlannerModel = PlannerModelOf<Plane>;

}  // namespace downwash::planning

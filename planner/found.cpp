#include "downwash/planner/found.hpp"

namespace downwash {

double cost_of(const Execution& execution, const CostFunction& objective) {
    return objective({static_cast<const FlightSums&>(execution), execution.energy_j, execution.duration_s,
                      execution.clearance_integral});
}

double cost_of(const SpaceFlight& flight, const CostFunction& objective) {
    return objective(
        {static_cast<const FlightSums&>(flight), flight.energy_j, flight.duration_s, flight.clearance_integral});
}

}  // namespace downwash

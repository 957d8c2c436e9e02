#include "downwash/planner/found.hpp"

namespace downwash {

double cost_of(const Execution& execution, const CostFunction& objective) {
    return objective({execution, execution.energy_j, execution.duration_s, execution.clearance_integral});
}

double cost_of(const SpaceFlight& flight, const CostFunction& objective) {
    return objective({flight, flight.energy_j, flight.duration_s, flight.clearance_integral});
}

double cost_of(const Found& found, const CostFunction& objective) {
    return found.execution ? cost_of(*found.execution, objective) : found.cost;
}

}  // namespace downwash

#include "downwash/planner/found.hpp"

namespace downwash {

double cost_of(const Execution& execution, const CostFunction& objective) {
    const FlightSums& sums = execution;
    return objective({sums, execution.energy_j, execution.duration_s, execution.clearance_integral});
}

double cost_of(const Found& found, const CostFunction& objective) {
    return found.execution ? cost_of(*found.execution, objective) : found.cost;
}

}  // namespace downwash

#include "downwash/planner/found.hpp"

namespace downwash {

double cost_of(const Execution& execution, const CostFunction& objective) {
    const FlightSums& sums = execution;
    return objective({sums, execution.energy_j, execution.duration_s, execution.clearance_integral});
}

}  // namespace downwash

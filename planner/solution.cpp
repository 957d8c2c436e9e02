#include "downwash/planner/solution.hpp"

namespace downwash {

double cost_of(const Execution& execution, const CostFunction& objective) {
    return objective({execution, execution.energy_j, execution.duration_s, execution.clearance_integral});
}

}  // namespace downwash

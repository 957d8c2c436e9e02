#include "downwash/planner/direct_flight.hpp"

#include <utility>

#include "downwash/planner/stopwatch.hpp"

namespace downwash::planning {

DirectFlight fly_directly(const FlightModel& model, const FlightState& start, const Plan& plan,
                          const std::vector<Goal>& goals, std::optional<double> energy_budget_j,
                          const StopCondition& is_over) {
    const Stopwatch clock;
    Execution execution = execute(model, start, plan.reference, goals, true, {}, is_over, energy_budget_j);
    return {std::move(execution), clock.seconds()};
}

bool is_good(const Execution& flight, double safety_margin_m) {
    return flight.outcome == Outcome::ok && flight.min_clearance_m >= safety_margin_m;
}

}  // namespace downwash::planning

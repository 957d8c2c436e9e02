#include "downwash/search/search_objective.hpp"

namespace downwash::planning {

ProblemObjective::ProblemObjective(const SearchTask& task)
    : objective_(task.problem.planner.objective), tick_s_(task.model.tick().tick_s), free_air_cost_(task) {}

double ProblemObjective::of_leg(const FlightState& from, const FlightLeg& leg) const {
    const double time_s = static_cast<double>(leg.flight.ticks) * tick_s_;
    const FlightSums& sums = leg.flight;
    return objective_({sums, leg.end.plant.energy_j - from.plant.energy_j, time_s, leg.flight.clearance_integral});
}

}  // namespace downwash::planning

#include "downwash/search/search_objective.hpp"

namespace downwash::planning {

template <class Family>
ProblemObjectiveOf<Family>::ProblemObjectiveOf(const SearchTask& task)
    : objective_(task.problem.planner.objective), tick_s_(task.tick_s), free_air_cost_(task) {}

template <class Family>
double ProblemObjectiveOf<Family>::of_leg(const FlightState& from, const FlightLeg& leg) const {
    const double time_s = static_cast<double>(leg.flight.ticks) * tick_s_;
    const double energy_j = leg.end.plant.energy_j - from.plant.energy_j;
    return objective_({static_cast<const FlightSums&>(leg.flight), energy_j, time_s, leg.flight.clearance_integral});
}

template class ProblemObjectiveOf<Plane>;
template class ProblemObjectiveOf<Space>;

}  // namespace downwash::planning

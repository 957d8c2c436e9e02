#include "downwash/search/search_objective.hpp"

#include <type_traits>

namespace downwash::planning {

template <class Family>
ProblemObjectiveOf<Family>::ProblemObjectiveOf(const SearchTask& task)
    : objective_(task.problem.planner.objective), tick_s_(task.tick_s), free_air_cost_(task) {}

template <class Family>
double ProblemObjectiveOf<Family>::of_leg(const FlightState& from, const FlightLeg& leg) const {
    const double time_s = static_cast<double>(leg.flight.ticks) * tick_s_;
    const double energy_j = leg.end.plant.energy_j - from.plant.energy_j;
    if constexpr (std::is_base_of_v<FlightSums, typename Family::SegmentFlight>) {
        const FlightSums& sums = leg.flight;
        return objective_({sums, energy_j, time_s, leg.flight.clearance_integral});
    } else {
        return objective_({{}, energy_j, time_s, 0});  // flights in space sum up no more
    }
}

template class ProblemObjectiveOf<Plane>;
template class ProblemObjectiveOf<Space>;

}  // namespace downwash::planning

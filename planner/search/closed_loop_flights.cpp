#include "downwash/search/closed_loop_flights.hpp"

#include <utility>

namespace downwash::planning {

ClosedLoopFlights::ClosedLoopFlights(const SearchTask& task, FlightRules rules, int threads)
    : task_(task), pool_(task.model, task.map, std::move(rules), &task.problem.goal, threads) {}

std::uint64_t ClosedLoopFlights::fly(std::span<FlightJob> jobs) {
    pool_.fly(jobs);
    std::uint64_t ticks = 0;
    for (const FlightJob& job : jobs) {
        for (const FlightLeg& leg : job.legs) {
            ticks += static_cast<std::uint64_t>(leg.flight.ticks);
        }
    }
    return ticks;
}

void ClosedLoopFlights::fly(std::span<FlightChain* const> chains) {
    pool_.fly(chains);
}

SegmentFlight ClosedLoopFlights::fly_again(const ReferenceSegment& segment, FlightState& vehicle,
                                           const FlightWorld& in) const {
    FlightRules to_the_end = pool_.rules();
    to_the_end.is_over = {};
    return downwash::fly(task_.model, task_.map, to_the_end, segment, vehicle, in);
}

}  // namespace downwash::planning

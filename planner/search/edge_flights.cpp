#include "downwash/search/edge_flights.hpp"

#include <utility>

#include "downwash/search/line_flights.hpp"
#include "downwash/simulation/flight_batch.hpp"

namespace downwash::planning {
namespace {

/// Closed-loop flights, in free air or through the aero map.
class ClosedLoopFlights final : public EdgeFlights {
 public:
    ClosedLoopFlights(const SearchTask& task, FlightRules rules, int threads)
        : task_(task), pool_(task.model, task.map, std::move(rules), &task.problem.goal, threads) {}

    std::uint64_t fly(std::span<FlightJob> jobs) override {
        pool_.fly(jobs);
        std::uint64_t ticks = 0;
        for (const FlightJob& job : jobs) {
            for (const FlightLeg& leg : job.legs) {
                ticks += static_cast<std::uint64_t>(leg.flight.ticks);
            }
        }
        return ticks;
    }
    [[nodiscard]] SegmentFlight fly_again(const ReferenceSegment& segment, FlightState& vehicle,
                                          const FlightWorld& in) const override {
        FlightRules to_the_end = pool_.rules();
        to_the_end.is_over = {};
        return downwash::fly(task_.model, task_.map, to_the_end, segment, vehicle, in);
    }
    void use_threads(int threads) override { pool_.use_threads(threads); }
    [[nodiscard]] const FlightRules& rules() const noexcept override { return pool_.rules(); }

 private:
    const SearchTask& task_;
    FlightPool pool_;
};

}  // namespace

std::unique_ptr<EdgeFlights> edge_flights(const SearchTask& task, FlightRules rules, int threads) {
    if (task.flies()) {
        return std::make_unique<ClosedLoopFlights>(task, std::move(rules), threads);
    }
    return std::make_unique<LineFlights>(task, std::move(rules));
}

}  // namespace downwash::planning

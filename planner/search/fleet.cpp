#include "downwash/search/fleet.hpp"

namespace downwash::planning {

const FlightLeg* FleetJob::rejected_leg() const noexcept {
    for (const FlightJob& job : jobs) {
        if (const FlightLeg* leg = job.rejected_leg()) {
            return leg;
        }
    }
    return nullptr;
}

Fleet FleetJob::fleet_after(std::size_t leg) const {
    Fleet fleet;
    fleet.reserve(jobs.size());
    for (const FlightJob& job : jobs) {
        fleet.push_back(job.legs[leg].end);
    }
    return fleet;
}

}  // namespace downwash::planning

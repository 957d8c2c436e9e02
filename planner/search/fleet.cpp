#include "downwash/search/fleet.hpp"

namespace downwash::planning {

template <class Family>
auto FleetJobOf<Family>::rejected_leg() const noexcept -> const FlightLeg* {
    for (const FlightJob& job : jobs) {
        if (const FlightLeg* leg = job.rejected_leg()) {
            return leg;
        }
    }
    return nullptr;
}

template <class Family>
auto FleetJobOf<Family>::fleet_after(std::size_t leg) const -> Fleet {
    Fleet fleet;
    fleet.reserve(jobs.size());
    for (const FlightJob& job : jobs) {
        fleet.push_back(job.legs[leg].end);
    }
    return fleet;
}

template struct FleetJobOf<Plane>;
template struct FleetJobOf<Space>;

}  // namespace downwash::planning

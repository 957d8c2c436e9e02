#include "downwash/simulation/flight_job.hpp"

#include <algorithm>

namespace downwash {

const FlightLeg* FlightJob::rejected_leg() const noexcept {
    const auto refused = std::find_if(legs.begin(), legs.end(),
                                      [](const FlightLeg& leg) { return leg.flight.rejection != Rejection::none; });
    return refused != legs.end() ? &*refused : nullptr;
}

}  // namespace downwash

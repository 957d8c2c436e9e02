#include "downwash/search/flight_point.hpp"

namespace downwash::planning {

FlightPoint resting_at(const FlightModel& model, const Configuration& c) {
    FlightPoint point;
    point.vehicle = model.state_at(level_at(c));
    point.reference = at_rest(c);
    point.rest = c;
    return point;
}

}  // namespace downwash::planning

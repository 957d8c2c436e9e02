#include "downwash/search/flight_point.hpp"

#include <algorithm>

#include "downwash/simulation/space_configuration.hpp"

namespace downwash::planning {

FlightPoint resting_at(const FlightModel& model, const Configuration& c) {
    FlightPoint point;
    point.vehicle = model.state_at(level_at(c));
    point.reference = at_rest(c);
    point.rest = c;
    return point;
}

FlightPointOf<Space> resting_at(const SpaceProblemModel& /*model*/, const SpaceConfiguration& c) {
    FlightPointOf<Space> point;
    const SpacePose pose = level_at(c);
    double* q = point.vehicle.plant.q;
    std::ranges::copy(pose.position_m, q);
    std::ranges::copy(pose.attitude, q + 3);
    std::ranges::copy(pose.joints_rad, q + 7);
    point.reference = at_rest(c);
    point.rest = c;
    return point;
}

}  // namespace downwash::planning

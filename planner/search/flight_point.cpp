#include "downwash/search/flight_point.hpp"

#include <algorithm>

namespace downwash::planning {

FlightPoint start_point(const SearchTask& task) {
    FlightPoint point;
    point.vehicle = task.start;
    point.reference = reference_at(task.problem.start);
    point.rest = task.problem.start.at;
    return point;
}

FlightPoint resting_at(const FlightModel& model, const Configuration& c) {
    FlightPoint point;
    point.vehicle = model.state_at(level_at(c));
    point.reference = at_rest(c);
    point.rest = c;
    return point;
}

bool is_same_moment(const FlightPoint& a, const FlightPoint& b) {
    const auto are_same = [](const FlightState& one, const FlightState& other) { return is_same(one, other); };
    return is_same(a.vehicle, b.vehicle) && std::ranges::equal(a.others, b.others, are_same) &&
           a.reference == b.reference;
}

Plan plan_through(const std::vector<FlightPoint>& moments, double tick_s) {
    Plan plan;
    plan.tick_s = tick_s;
    for (std::size_t i = 0; i + 1 < moments.size(); ++i) {
        plan.reference.push_back({moments[i].ticks, moments[i].reference});
    }
    return plan;
}

}  // namespace downwash::planning

#include "downwash/planner/course.hpp"

#include <stdexcept>
#include <utility>

#include "downwash/planner/world_flights.hpp"
#include "downwash/search/free_air_cost.hpp"
#include "downwash/search/line_flights.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/flight.hpp"

namespace downwash::planning {

Course Course::from_start(const Problem& problem, const FlightModel& model) {
    Course course;
    course.vehicle = start_state(model, problem.start);
    return course;
}

Course advanced(Course course, const Goal& goal, const Plan& part, double cost, const PlannerModel& model,
                Variant variant) {
    const std::size_t flown = course.plan.reference.empty() ? 1 : course.plan.reference.size();
    const std::int64_t begun = course.ticks();
    course.plan = with_hover(course.plan.followed_by(part), goal, *model.flight);
    course.goals.push_back(goal);
    course.cost += cost;
    if (!plans_flights(variant)) {
        const double part_s = static_cast<double>(course.ticks() - begun) * course.plan.tick_s;
        course.vehicle = following(*model.flight, course.plan.reference.back().point,
                                   course.vehicle.plant.energy_j + hover_power_w(*model.flight) * part_s);
        return course;
    }
    for (std::size_t knot = flown; knot < course.plan.reference.size(); ++knot) {
        const SegmentFlight flight =
            fly(*model.flight, model.own_map.get(), rules_of_execution(), course.plan.segment_to(knot), course.vehicle);
        if (flight.rejection != Rejection::none) {
            throw std::logic_error("a part of a plan does not fly as it was planned");
        }
    }
    return course;
}

}  // namespace downwash::planning

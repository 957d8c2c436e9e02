#include "downwash/planner/course.hpp"

#include <utility>

#include "downwash/planner/family_parts.hpp"
#include "downwash/planner/world_flights.hpp"
#include "downwash/search/free_air_cost.hpp"
#include "downwash/search/line_flights.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/flight.hpp"

namespace downwash::planning {

template <class Family>
auto CourseOf<Family>::from_start(const Problem& problem, const FlightModel& model) -> CourseOf {
    CourseOf course;
    course.vehicle = start_state(model, problem.start);
    return course;
}

template <class Family>
CourseOf<Family> advanced(CourseOf<Family> course, const typename Family::Goal& goal, const typename Family::Plan& part,
                          double cost, const PlannerModelOf<Family>& model, Variant variant) {
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
    course.vehicle = flown_on(model, course.plan, flown - 1, goal, course.vehicle);
    return course;
}

template struct CourseOf<Plane>;
template struct CourseOf<Space>;
template Course advanced(Course, const Goal&, const Plan&, double, const PlannerModel&, Variant);
template CourseOf<Space> advanced(CourseOf<Space>, const SpaceGoal&, const SpacePlan&, double,
                                  const PlannerModelOf<Space>&, Variant);

}  // namespace downwash::planning

#include "downwash/search/planned_flights.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "downwash/search/free_air_cost.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::planning {
namespace {

FlightRules planning_rules(const Problem& problem, std::function<bool()> is_over) {
    FlightRules rules;
    rules.margin_m = problem.planner.safety_margin_m;
    rules.bounds = problem.bounds;
    rules.is_over = std::move(is_over);
    rules.measures_clearance = problem.planner.objective.weight(Objective::clearance) > 0;
    return rules;
}

}  // namespace

std::string cause_of(Rejection rejection) {
    switch (rejection) {
        case Rejection::collision:
            return "collision";
        case Rejection::flyable_area:
            return "flyable_area";
        case Rejection::saturation:
            return "saturation";
        case Rejection::tracking:
            return "tracking";
        case Rejection::unstable:
            return "unstable";
        case Rejection::bounds:
            return "bounds";
        case Rejection::goal_missed:
            return "goal_missed";
        case Rejection::none:
        case Rejection::interrupted:
            break;
    }
    throw std::logic_error("a flight that was not rejected has no cause of rejection");
}

std::map<std::string, std::uint64_t> no_rejections() {
    return {{"collision", 0}, {"flyable_area", 0}, {"saturation", 0},    {"tracking", 0}, {"unstable", 0},
            {"bounds", 0},    {"goal_missed", 0},  {"direct_flight", 0}, {"too_long", 0}};
}

FlightStatistics& FlightStatistics::operator+=(const FlightStatistics& other) {
    edges += other.edges;
    ticks += other.ticks;
    states_checked += other.states_checked;
    rejections += other.rejections;
    for (const auto& [cause, count] : other.rejected) {
        rejected[cause] += count;
    }
    if (other.obstruction && (!obstruction || other.obstruction->goal_distance_m < obstruction->goal_distance_m)) {
        obstruction = other.obstruction;
    }
    return *this;
}

PlannedFlights::PlannedFlights(const SearchTask& task, std::function<bool()> is_over, int threads)
    : task_(task),
      limits_(task.problem.motion),
      tick_s_(task.model.tick().tick_s),
      crew_(task.model, task.map, planning_rules(task.problem, std::move(is_over)), &task.problem.goal, threads,
            best_instructions(), task.worlds != nullptr ? &task.worlds->ceiling : nullptr) {
    forget_statistics();
}

void PlannedFlights::forget_statistics() {
    statistics_ = {};
    statistics_.rejected = no_rejections();
}

void PlannedFlights::count_rejection(const std::string& cause) {
    ++statistics_.rejected[cause];
    ++statistics_.rejections;
}

void PlannedFlights::count_rejection(Rejection rejection) {
    if (rejection != Rejection::interrupted) {
        count_rejection(cause_of(rejection));
    }
}

bool PlannedFlights::leads_to_goal(const ReferenceSegment& segment) const {
    return task_.space.is_near_goal(configuration_of(segment.to()));
}

void PlannedFlights::reject(const ReferenceSegment& segment, Rejection rejection, const Configuration& at) {
    count_rejection(rejection);
    if (rejection == Rejection::interrupted || !leads_to_goal(segment)) {
        return;
    }
    const double distance_m = task_.space.goal_distance_m(at);
    std::optional<Obstruction>& nearest = statistics_.obstruction;
    if (!nearest || distance_m < nearest->goal_distance_m) {
        nearest = {cause_of(rejection), at, distance_m};
    }
}

bool PlannedFlights::is_worth_flying(const ReferenceSegment& segment) {
    constexpr double spacing_m = 0.1;
    const ReferencePoint& a = segment.from();
    const ReferencePoint& b = segment.to();
    const double arm_m = task_.problem.robot.arm.length_m;
    const auto weighted = [arm_m](const double* v) { return std::abs(v[0]) + std::abs(v[1]) + arm_m * std::abs(v[2]); };
    const double step[3] = {b.position[0] - a.position[0], b.position[1] - a.position[1],
                            b.position[2] - a.position[2]};
    // Ends that move may lead beyond the line between them.
    const double motion_m = weighted(step) + (weighted(a.velocity) + weighted(b.velocity)) * segment.duration_s();
    const auto samples = static_cast<std::int64_t>(std::ceil(motion_m / spacing_m)) + 1;
    const auto at = [&](std::int64_t i) { return configuration_of(segment.at_tick(segment.ticks() * i / samples)); };
    Rejection rejection = Rejection::none;
    for (std::int64_t i = samples; i >= 1 && rejection == Rejection::none;
         --i) {  // the new end first: likelier to collide
        ++statistics_.states_checked;
        rejection = task_.space.rejection_at(at(i));
    }
    if (rejection == Rejection::none) {
        return true;
    }
    if (!leads_to_goal(segment)) {
        count_rejection(rejection);
        return false;
    }
    // Of a way to the goal the place matters where a flight would have been stopped.
    std::int64_t first = 1;
    while (task_.space.rejection_at(at(first)) == Rejection::none) {
        ++first;
    }
    reject(segment, task_.space.rejection_at(at(first)), at(first));
    return false;
}

void PlannedFlights::fly(std::span<FlightJob> jobs) {
    crew_.fly(jobs);
    for (const FlightJob& job : jobs) {
        count(job);
        if (const FlightLeg* leg = job.rejected_leg()) {
            reject(leg->segment, leg->flight.rejection, configuration_of(leg->end.plant.q));
        }
    }
}

void PlannedFlights::count(const FlightJob& job) {
    for (const FlightLeg& leg : job.legs) {
        statistics_.edges += leg.flight.ticks > 0 ? 1 : 0;
        statistics_.ticks += static_cast<std::uint64_t>(leg.flight.ticks);
        statistics_.states_checked += static_cast<std::uint64_t>(leg.flight.ticks);
    }
}

FleetJob PlannedFlights::job(const Fleet& from, std::int64_t ticks_from_start, std::vector<FlightLeg> legs,
                             std::int64_t judged_ticks) const {
    FleetJob fleet;
    fleet.jobs.reserve(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
        const FlownWorld* world = i == 0 ? nullptr : &task_.worlds->worlds[i - 1];
        fleet.jobs.push_back({from[i], legs, judged_ticks, world, task_.first_tick + ticks_from_start});
    }
    return fleet;
}

void PlannedFlights::fly(std::span<FleetJob> jobs) {
    std::vector<FlightJob> flown;
    const auto fly_all = [&](const auto& is_wanted) {
        std::vector<FlightJob*> owners;
        for (FleetJob& fleet : jobs) {
            for (std::size_t i = 0; i < fleet.jobs.size(); ++i) {
                if (is_wanted(fleet, i)) {
                    owners.push_back(&fleet.jobs[i]);
                }
            }
        }
        flown.clear();
        for (FlightJob* owner : owners) {
            flown.push_back(std::move(*owner));
        }
        crew_.fly(flown);
        for (std::size_t i = 0; i < flown.size(); ++i) {
            count(flown[i]);
            *owners[i] = std::move(flown[i]);
        }
    };
    fly_all([](const FleetJob&, std::size_t world) { return world == 0; });
    if (task_.worlds != nullptr) {
        fly_all([](const FleetJob& fleet, std::size_t world) {
            return world > 0 && fleet.jobs.front().rejection() == Rejection::none;
        });
    }
    for (const FleetJob& fleet : jobs) {
        if (const FlightLeg* leg = fleet.rejected_leg()) {
            reject(leg->segment, leg->flight.rejection, configuration_of(leg->end.plant.q));
        }
    }
}

bool ends_with_hover(std::span<const FlightPoint> moments, const PlannedFlights& flights) {
    const FlightPoint& end = moments.back();
    const FlightPoint& arrival = moments[moments.size() - 2];
    const FlightLeg hover = flights.hold_leg(arrival.reference);
    return is_at_rest(end.reference) && end.reference == arrival.reference &&
           end.ticks - arrival.ticks == hover.segment.ticks() &&
           meets_goal(flights.task().problem.goal, flights.task().model.tick().plant, end.vehicle);
}

void PlannedFlights::verify(std::span<const FlightPoint> moments) const {
    FlightRules to_the_end = rules();
    to_the_end.is_over = {};
    FlightPoint point = moments.front();
    for (std::size_t i = 1; i < moments.size(); ++i) {
        const FlightPoint& next = moments[i];
        const ReferenceSegment segment(point.reference, next.reference, next.ticks - point.ticks, tick_s_);
        const SegmentFlight flight = downwash::fly(task_.model, task_.map, to_the_end, segment, point.vehicle);
        point.reference = segment.to();
        point.ticks = next.ticks;
        if (flight.rejection != Rejection::none || !is_same_moment(point, next)) {
            throw std::logic_error("flying a plan again did not reproduce the planner's flight bit for bit");
        }
    }
}

FlightLeg PlannedFlights::hold_leg(const ReferencePoint& at) const {
    return {{at, at, hold_ticks(task_.problem.goal, task_.model, at), tick_s_}};
}

std::int64_t PlannedFlights::judged_ticks() const {
    return std::llround(goal_settling_s / tick_s_);
}

double PlannedFlights::cost_after(double cost_before, const FlightState& from, const FlightLeg& leg) const {
    const double time_s = static_cast<double>(leg.flight.ticks) * tick_s_;
    const FlightSums& sums = leg.flight;
    return cost_before + task_.problem.planner.objective({sums, leg.end.plant.energy_j - from.plant.energy_j, time_s,
                                                          leg.flight.clearance_integral});
}

double PlannedFlights::cost_after(double cost_before, const Fleet& from, const FleetJob& job, std::size_t leg) const {
    double sum = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        sum += cost_after(0, from[i], job.jobs[i].legs[leg]);
    }
    return cost_before + sum / static_cast<double>(from.size());
}

ReferenceSegment PlannedFlights::fastest_segment(const ReferencePoint& from, const ReferencePoint& to) const {
    return {from, to, shortest_ticks(from, to, limits_, tick_s_), tick_s_};
}

}  // namespace downwash::planning

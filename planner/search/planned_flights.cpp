#include "downwash/search/planned_flights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "downwash/controllers/space_duration.hpp"
#include "downwash/scene/space_pose.hpp"
#include "downwash/search/closed_loop_flights.hpp"
#include "downwash/search/line_flights.hpp"
#include "downwash/search/obstacle_labels.hpp"
#include "downwash/search/space_flights.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::planning {
namespace {}  // namespace

FlightRules planning_rules(const Problem& problem, bool in_nominal_world, std::function<bool()> is_over) {
    FlightRules rules;
    rules.margin_m = problem.planner.safety_margin_m;
    rules.bounds = problem.bounds;
    rules.max_saturation = problem.planner.max_saturation;
    rules.max_pitch_rate_rad_s = problem.planner.max_pitch_rate_rad_s.value_or(rules.max_pitch_rate_rad_s);
    if (!in_nominal_world) {
        rules = rules_of_execution();
    }
    rules.is_over = std::move(is_over);
    rules.measures_clearance = problem.planner.objective.weight(Objective::clearance) > 0;
    return rules;
}

namespace {

/// The same in space, where the rules of execution are those of every flight.
std::optional<SpacePlanningRules> space_planning_rules(const SpaceProblem& problem, bool in_nominal_world) {
    if (!in_nominal_world) {
        return std::nullopt;
    }
    SpacePlanningRules rules;
    rules.low_m = problem.bounds.low_m;
    rules.high_m = problem.bounds.high_m;
    rules.keeps_joint_limits = false;  // references do; an arm that hovers at a limit swings about it
    // A vehicle that starts beyond this tilt first falls. It is near no reference until it has recovered.
    const bool starts_lost =
        problem.start.attitude && rotation_of(*problem.start.attitude)[2][2] < std::cos(unstable_pitch_rad);
    rules.max_tracking_error_m = starts_lost ? unstable_error_m : FlightRules{}.max_tracking_error_m;
    rules.max_saturation = problem.planner.max_saturation;
    rules.max_tilt_rate_rad_s = problem.planner.max_pitch_rate_rad_s.value_or(rules.max_tilt_rate_rad_s);
    return rules;
}

/// Edges as the level of the task's problem has them.
std::unique_ptr<EdgeFlights> edge_flights(const SearchTask& task, bool in_nominal_world, std::function<bool()> is_over,
                                          int threads) {
    FlightRules rules = planning_rules(task.problem, in_nominal_world, std::move(is_over));
    if (task.flies()) {
        return std::make_unique<ClosedLoopFlights>(task, std::move(rules), threads);
    }
    return std::make_unique<LineFlights>(task, std::move(rules));
}
std::unique_ptr<EdgeFlightsOf<Space>> edge_flights(const SearchTaskOf<Space>& task, bool in_nominal_world,
                                                   std::function<bool()> is_over, int threads) {
    if (task.flies()) {
        return std::make_unique<SpaceFlights>(task, space_planning_rules(task.problem, in_nominal_world),
                                              std::move(is_over), threads);
    }
    FlightRules rules;
    rules.margin_m = task.problem.planner.safety_margin_m;
    rules.is_over = std::move(is_over);
    rules.measures_clearance = task.problem.planner.objective.weight(Objective::clearance) > 0;
    return std::make_unique<LineFlightsOf<Space>>(task, std::move(rules));
}

/// Where the obstacles of a world see a vehicle.
PlanarPose pose_among_obstacles(const FlightState& vehicle, const FlownWorld* world) {
    return among_obstacles(pose_of(vehicle), world);
}
SpacePose pose_among_obstacles(const AnySpaceState& vehicle, const SpaceWorld* world) {
    return among_obstacles(motion_of(vehicle), world != nullptr ? *world : SpaceWorld{});
}
Configuration place_of(const FlightState& vehicle) {
    return configuration_of(vehicle.plant.q);
}
SpaceConfiguration place_of(const AnySpaceState& vehicle) {
    return configuration_of(motion_of(vehicle));
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
        case Rejection::arm_limits:
            return "arm_limits";
        case Rejection::goal_missed:
            return "goal_missed";
        case Rejection::over_budget:
            return "over_budget";
        case Rejection::none:
        case Rejection::interrupted:
            break;
    }
    throw std::logic_error("a flight that was not rejected has no cause of rejection");
}

std::map<std::string, std::uint64_t> no_rejections() {
    return {{"collision", 0}, {"flyable_area", 0}, {"saturation", 0},  {"tracking", 0},      {"unstable", 0},
            {"bounds", 0},    {"arm_limits", 0},   {"goal_missed", 0}, {"direct_flight", 0}, {"too_long", 0}};
}

template <class Family>
FlightStatisticsOf<Family>& FlightStatisticsOf<Family>::operator+=(const FlightStatisticsOf& other) {
    edges += other.edges;
    ticks += other.ticks;
    states_checked += other.states_checked;
    rejections += other.rejections;
    for (const auto& [cause, count] : other.rejected) {
        rejected[cause] += count;
    }
    for (const auto& [obstacle, count] : other.stopped_by) {
        stopped_by[obstacle] += count;
    }
    if (other.obstruction && (!obstruction || other.obstruction->goal_distance_m < obstruction->goal_distance_m)) {
        obstruction = other.obstruction;
    }
    return *this;
}

template <class Family>
PlannedFlightsOf<Family>::PlannedFlightsOf(const SearchTask& task, std::function<bool()> is_over, int threads)
    : task_(task),
      is_over_(is_over),
      goal_(task),
      objective_(task),
      limits_(motion_limits_of(task.problem)),
      tick_s_(task.tick_s),
      nominal_(edge_flights(task, true, is_over, threads)) {
    if (task.worlds != nullptr) {
        other_worlds_ = edge_flights(task, false, is_over, threads);
    }
    forget();
}

template <class Family>
void PlannedFlightsOf<Family>::use_threads(int threads) {
    nominal_->use_threads(threads);
    if (other_worlds_ != nullptr) {
        other_worlds_->use_threads(threads);
    }
}

template <class Family>
void PlannedFlightsOf<Family>::forget() {
    joined_.clear();
    rejected_in_.assign(worlds_of_task(), 0);
    statistics_ = {};
    statistics_.rejected = no_rejections();
}

template <class Family>
void PlannedFlightsOf<Family>::count_rejection(const std::string& cause, FlightStatistics& counts) {
    ++counts.rejected[cause];
    ++counts.rejections;
}

template <class Family>
void PlannedFlightsOf<Family>::count_rejection(Rejection rejection, FlightStatistics& counts) {
    if (rejection != Rejection::interrupted) {
        count_rejection(cause_of(rejection), counts);
    }
}

template <class Family>
bool PlannedFlightsOf<Family>::leads_to_goal(const ReferenceSegment& segment) const {
    return goal().contains(configuration_of(segment.to()));
}

template <class Family>
void PlannedFlightsOf<Family>::reject(const ReferenceSegment& segment, Rejection rejection, const Configuration& at,
                                      const Pose& pose, FlightStatistics& counts) const {
    count_rejection(rejection, counts);
    if (rejection == Rejection::collision) {
        count_collision(task_.model, pose, task_.problem.planner.safety_margin_m, counts.stopped_by);
    }
    if (rejection == Rejection::interrupted || !leads_to_goal(segment)) {
        return;
    }
    const double distance_m = goal().distance_m(at);
    std::optional<Obstruction>& nearest = counts.obstruction;
    if (!nearest || distance_m < nearest->goal_distance_m) {
        nearest = {cause_of(rejection), at, distance_m};
        if (rejection == Rejection::collision || rejection == Rejection::flyable_area) {
            nearest->obstacles = obstacles_near(task_.model, pose);
        }
    }
}

template <class Family>
bool PlannedFlightsOf<Family>::is_worth_flying(const ReferenceSegment& segment, FlightStatistics& counts) const {
    constexpr double spacing_m = 0.1;
    const std::int64_t samples = samples_along(segment, task_.space, spacing_m);
    const auto at = [&](std::int64_t i) { return segment.at_tick(segment.ticks() * i / samples); };
    const bool tilts = task_.flies() && limits_.max_thrust_ratio;
    const auto pose_at = [&](const ReferencePoint& point) { return task_.space.pose_along(point, tilts); };
    const auto rejection_at = [&](const ReferencePoint& point) {
        return task_.space.rejection_at(configuration_of(point), pose_at(point));
    };
    Rejection rejection = Rejection::none;
    std::int64_t stopped_at = samples;
    for (std::int64_t i = samples; i >= 1 && rejection == Rejection::none;
         --i) {  // the new end first: likelier to collide
        ++counts.states_checked;
        rejection = rejection_at(at(i));
        stopped_at = i;
    }
    if (rejection == Rejection::none) {
        return true;
    }
    if (!leads_to_goal(segment)) {
        reject(segment, rejection, configuration_of(at(stopped_at)), pose_at(at(stopped_at)), counts);
        return false;
    }
    // Of a way to the goal the place matters where a flight would have been stopped.
    std::int64_t first = 1;
    while (rejection_at(at(first)) == Rejection::none) {
        ++first;
    }
    reject(segment, rejection_at(at(first)), configuration_of(at(first)), pose_at(at(first)), counts);
    return false;
}

template <class Family>
void PlannedFlightsOf<Family>::fly(std::span<FlightJob> jobs) {
    statistics_.states_checked += nominal_->fly(jobs);
    for (const FlightJob& job : jobs) {
        count(job, statistics_);
        if (const FlightLeg* leg = job.rejected_leg()) {
            reject(*leg, job.world, statistics_);
        }
    }
}

template <class Family>
void PlannedFlightsOf<Family>::count(const FlightJob& job, FlightStatistics& counts) {
    for (const FlightLeg& leg : job.legs) {
        counts.edges += leg.flight.ticks > 0 ? 1 : 0;
        counts.ticks += static_cast<std::uint64_t>(leg.flight.ticks);
    }
}

template <class Family>
void PlannedFlightsOf<Family>::count_nominal(const FleetJob& fleet, FlightStatistics& counts) const {
    const std::uint64_t ticks_before = counts.ticks;
    count(fleet.jobs.front(), counts);
    counts.states_checked += counts.ticks - ticks_before;
    reject(fleet, counts);
}

template <class Family>
std::size_t PlannedFlightsOf<Family>::worlds_of_task() const noexcept {
    return 1 + (task_.worlds != nullptr ? task_.worlds->worlds.size() : 0);
}

template <class Family>
auto PlannedFlightsOf<Family>::world(std::size_t number) const -> const FlownWorld* {
    if (number == 0) {
        return nullptr;
    }
    const std::size_t own = worlds_of_task();
    return number < own ? &task_.worlds->worlds[number - 1] : &joined_[number - own].world;
}

template <class Family>
void PlannedFlightsOf<Family>::join(const std::vector<Counterexample>& counterexamples) {
    joined_.insert(joined_.end(), counterexamples.begin(), counterexamples.end());
    rejected_in_.insert(rejected_in_.end(), counterexamples.size(), 1);
    while (joined_.size() > most_counterexamples) {
        const auto first = rejected_in_.begin() + static_cast<std::ptrdiff_t>(worlds_of_task());
        const auto least = std::min_element(first, rejected_in_.end());
        joined_.erase(joined_.begin() + (least - first));
        rejected_in_.erase(least);
    }
}

template <class Family>
auto PlannedFlightsOf<Family>::fleet_at_start(const FlightState& nominal) const -> Fleet {
    Fleet fleet = task_.fleet_from(nominal);
    for (const Counterexample& counterexample : joined_) {
        fleet.push_back(counterexample.start);
    }
    return fleet;
}

template <class Family>
auto PlannedFlightsOf<Family>::job(const Fleet& from, std::int64_t ticks_from_start, std::vector<FlightLeg> legs,
                                   std::int64_t judged_ticks) const -> FleetJob {
    FleetJob fleet;
    fleet.jobs.reserve(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
        FlightJob& job = fleet.jobs.emplace_back();
        job.start = from[i];
        job.legs = legs;
        job.judged_ticks = goal().is_of_problem() ? judged_ticks : 0;
        job.world = world(i);
        job.first_tick = task_.first_tick + ticks_from_start;
    }
    fleet.is_hover_judged = judged_ticks > 0 && !goal().is_of_problem();
    return fleet;
}

/// Flies those jobs in some worlds that nothing speaks against so far.
template <class Family>
void PlannedFlightsOf<Family>::fly_in(std::span<const std::size_t> worlds, std::span<FleetJob> jobs) {
    if (worlds.empty()) {
        return;
    }
    std::vector<FlightJob*> owners;
    std::vector<std::size_t> world_of;
    std::vector<bool> is_judged_here;
    for (FleetJob& fleet : jobs) {
        if (!fleet.is_accepted()) {
            continue;
        }
        for (const std::size_t i : worlds) {
            owners.push_back(&fleet.jobs[i]);
            world_of.push_back(i);
            is_judged_here.push_back(fleet.is_hover_judged);
        }
    }
    std::vector<FlightJob> flown;
    flown.reserve(owners.size());
    for (FlightJob* owner : owners) {
        flown.push_back(std::move(*owner));
    }
    statistics_.states_checked += (worlds.front() == 0 ? *nominal_ : *other_worlds_).fly(flown);
    for (std::size_t i = 0; i < flown.size(); ++i) {
        if (is_judged_here[i] && flown[i].rejection() == Rejection::none && !goal().is_met(flown[i].end())) {
            flown[i].legs.back().flight.rejection = Rejection::goal_missed;
        }
        count(flown[i], statistics_);
        rejected_in_[world_of[i]] += flown[i].rejected_leg() != nullptr ? 1 : 0;
        *owners[i] = std::move(flown[i]);
    }
}

template <class Family>
void PlannedFlightsOf<Family>::fly(std::span<FleetJob> jobs) {
    fly_nominal(jobs);
    fly_in_other_worlds(jobs);
}

template <class Family>
void PlannedFlightsOf<Family>::fly_nominal(std::span<FleetJob> jobs) {
    fly_in(std::array<std::size_t, 1>{0}, jobs);
    for (const FleetJob& fleet : jobs) {
        reject(fleet, statistics_);
    }
}

template <class Family>
void PlannedFlightsOf<Family>::fly_in_other_worlds(std::span<FleetJob> jobs) {
    constexpr std::size_t lanes = 8;
    std::vector<FleetJob*> accepted;
    for (FleetJob& fleet : jobs) {
        if (fleet.is_accepted()) {
            accepted.push_back(&fleet);
        }
    }
    if (accepted.empty() || accepted.front()->jobs.size() == 1) {
        return;
    }
    std::vector<std::size_t> order(accepted.front()->jobs.size() - 1);
    std::iota(order.begin(), order.end(), std::size_t{1});
    std::stable_sort(order.begin(), order.end(),
                     [this](std::size_t a, std::size_t b) { return rejected_in_[a] > rejected_in_[b]; });
    const std::size_t first = std::clamp<std::size_t>(lanes / accepted.size(), 1, order.size());
    fly_in(std::span(order).first(first), jobs);
    fly_in(std::span(order).subspan(first), jobs);
    for (const FleetJob* fleet : accepted) {
        reject(*fleet, statistics_);
    }
}

/// Counts the rejection of a fleet, if it was rejected.
template <class Family>
void PlannedFlightsOf<Family>::reject(const FleetJob& fleet, FlightStatistics& counts) const {
    const auto rejected = std::find_if(fleet.jobs.begin(), fleet.jobs.end(),
                                       [](const FlightJob& job) { return job.rejected_leg() != nullptr; });
    if (rejected != fleet.jobs.end()) {
        reject(*rejected->rejected_leg(), rejected->world, counts);
    }
}

template <class Family>
void PlannedFlightsOf<Family>::reject(const FlightLeg& leg, const FlownWorld* world, FlightStatistics& counts) const {
    reject(leg.segment, leg.flight.rejection, place_of(leg.end), pose_among_obstacles(leg.end, world), counts);
}

bool ends_with_hover(std::span<const FlightPoint> moments, const PlannedFlights& flights) {
    const FlightPoint& end = moments.back();
    const FlightPoint& arrival = moments[moments.size() - 2];
    const FlightLeg hover = flights.hold_leg(arrival.reference);
    return is_at_rest(end.reference) && end.reference == arrival.reference &&
           end.ticks - arrival.ticks == hover.segment.ticks() && flights.goal().is_met(end.vehicle);
}

template <class Family>
void PlannedFlightsOf<Family>::fly_again(FleetJob& fleet) const {
    for (std::size_t i = 0; i < fleet.jobs.size(); ++i) {
        FlightJob& job = fleet.jobs[i];
        FlightState vehicle = job.start;
        std::int64_t tick = job.first_tick;
        for (FlightLeg& leg : job.legs) {
            leg.flight = (i == 0 ? *nominal_ : *other_worlds_).fly_again(leg.segment, vehicle, {job.world, tick});
            leg.end = vehicle;
            tick += leg.segment.ticks();
            if (leg.flight.rejection != Rejection::none) {
                break;
            }
        }
    }
}

template <class Family>
void PlannedFlightsOf<Family>::verify(std::span<const FlightPoint> moments) const {
    FlightPoint point = moments.front();
    for (std::size_t i = 1; i < moments.size(); ++i) {
        const FlightPoint& next = moments[i];
        const ReferenceSegment segment(point.reference, next.reference, next.ticks - point.ticks, tick_s_);
        const SegmentFlight flight = nominal_->fly_again(segment, point.vehicle);
        point.reference = segment.to();
        point.ticks = next.ticks;
        point.others = next.others;  // not flown again
        if (flight.rejection != Rejection::none || !is_same_moment(point, next)) {
            throw std::logic_error("flying a plan again did not reproduce the planner's flight bit for bit");
        }
    }
}

template <class Family>
auto PlannedFlightsOf<Family>::hold_leg(const ReferencePoint& at) const -> FlightLeg {
    return {{at, at, task_.space.hold_ticks(at), tick_s_}};
}

template <class Family>
std::int64_t PlannedFlightsOf<Family>::judged_ticks() const {
    return std::llround(goal_settling_s / tick_s_);
}

template <class Family>
double PlannedFlightsOf<Family>::cost_after(double cost_before, const Fleet& from, const FleetJob& job,
                                            std::size_t leg) const {
    double sum = 0;
    const std::size_t worlds = worlds_of_task();
    for (std::size_t i = 0; i < worlds; ++i) {
        sum += cost_after(0, from[i], job.jobs[i].legs[leg]);
    }
    return cost_before + sum / static_cast<double>(worlds);
}

template <class Family>
auto PlannedFlightsOf<Family>::fastest_segment(const ReferencePoint& from, const ReferencePoint& to) const
    -> ReferenceSegment {
    return {from, to, shortest_ticks(from, to, limits_, tick_s_), tick_s_};
}

template struct FlightStatisticsOf<Plane>;
template struct FlightStatisticsOf<Space>;
template class PlannedFlightsOf<Plane>;
template class PlannedFlightsOf<Space>;

}  // namespace downwash::planning

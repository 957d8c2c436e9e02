#include "downwash/planner/braking.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/planner/world_flights.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/search/search_space.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::planning {
namespace {

/// One way to brake. Distances are those of a constant deceleration, times a factor.
struct Maneuver {
    double harder;   ///< limits of acceleration and jerk, over those of the problem
    double farther;  ///< distance
    double aside_m;  ///< upwards
};

/// The gentle ones first, then those that get out of the way of something.
constexpr Maneuver maneuvers[] = {{1, 1.3, 0},   {2, 1.2, 0}, {1, 1.3, -0.3}, {1, 1.3, 0.3},  {2, 1.2, -0.3},
                                  {2, 1.2, 0.3}, {3, 1.1, 0}, {2, 2.5, 0},    {2, 1.2, -0.8}, {2, 1.2, 0.8}};

MotionLimits harder_limits(MotionLimits limits, double times) {
    limits.max_speed_m_s *= 2;  // a vehicle is as fast as it is
    limits.max_arm_rate_rad_s *= 2;
    limits.max_acceleration_m_s2 *= times;
    limits.max_arm_acceleration_rad_s2 *= times;
    limits.max_jerk_m_s3 *= times;
    return limits;
}

/// Where a reference comes to rest.
Configuration rest_of(const ReferencePoint& from, std::span<const Axis> axes, const MotionLimits& limits,
                      const Maneuver& maneuver) {
    const double speed_m_s = std::hypot(from.velocity[plane::x], from.velocity[plane::z]);
    const MotionLimits straight = limits_along(limits, from.velocity);
    Configuration rest;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const double rate = axes[i].group == AxisGroup::translation ? speed_m_s : std::abs(from.velocity[i]);
        const double time_s = maneuver.farther * rate / max_acceleration(straight, axes[i].group);
        rest[i] = from.position[i] + 0.5 * time_s * from.velocity[i];
    }
    rest[plane::z] += maneuver.aside_m;
    return rest;
}

bool is_inside(const Bounds& bounds, const Configuration& at) {
    return at[plane::x] >= bounds.x_low_m && at[plane::x] <= bounds.x_high_m && at[plane::z] >= bounds.z_low_m &&
           at[plane::z] <= bounds.z_high_m;
}

/// A hover there: it may be a little beside it, but has to come to rest.
Goal hover_at(const Configuration& rest) {
    Goal goal;
    goal.kind = ConfigurationGoal{rest[plane::x], rest[plane::z], rest[plane::arm], 0.3, 0.35};
    goal.hold_s = stop_hold_s;
    return goal;
}

}  // namespace

Braking::Braking(const Problem& problem, std::shared_ptr<const FlightModel> model, MapAround map_around,
                 std::vector<FlownWorld> worlds, int threads)
    : problem_(problem),
      model_(std::move(model)),
      map_around_(std::move(map_around)),
      worlds_(std::move(worlds)),
      threads_(threads) {
    worlds_.insert(worlds_.begin(), model_->nominal_world());
}

void Braking::fly_around(const Bounds& places) {
    std::shared_ptr<const AeroMap> map = map_around_(places);
    if (!pool_ || map != map_) {
        map_ = std::move(map);
        FlightRules rules = rules_of_execution();
        rules.finds_min_clearance = true;
        pool_ = std::make_unique<FlightPool>(*model_, map_.get(), rules, nullptr, threads_);
    }
}

/// Those between the vehicle and the rests, and around them.
Bounds Braking::places_on(std::span<const Try> tries, const Start& from) const {
    Bounds places{from.at[plane::x], from.at[plane::x], from.at[plane::z], from.at[plane::z]};
    for (const Try& each : tries) {
        const Configuration rest = each.plan.last();
        places = {std::min(places.x_low_m, rest[plane::x]), std::max(places.x_high_m, rest[plane::x]),
                  std::min(places.z_low_m, rest[plane::z]), std::max(places.z_high_m, rest[plane::z])};
    }
    constexpr double swing_m = 0.3;
    const Bounds& bounds = problem_.bounds;  // rests are within them, wherever the vehicle is
    return {std::clamp(places.x_low_m, bounds.x_low_m, bounds.x_high_m) - swing_m,
            std::clamp(places.x_high_m, bounds.x_low_m, bounds.x_high_m) + swing_m,
            std::clamp(places.z_low_m, bounds.z_low_m, bounds.z_high_m) - swing_m,
            std::clamp(places.z_high_m, bounds.z_low_m, bounds.z_high_m) + swing_m};
}

std::vector<Braking::Try> Braking::all_tries(const ReferencePoint& from) const {
    const double tick_s = model_->tick().tick_s;
    std::vector<Try> tries;
    for (const Maneuver& maneuver : maneuvers) {
        const MotionLimits limits = harder_limits(problem_.motion, maneuver.harder);
        const Configuration rest = rest_of(from, problem_.axes(), limits, maneuver);
        if (is_inside(problem_.bounds, rest)) {
            Plan plan{{{0, from}}, tick_s};
            plan.reference.push_back({shortest_ticks(from, at_rest(rest), limits, tick_s), at_rest(rest)});
            tries.push_back({std::move(plan), hover_at(rest)});
        }
    }
    return tries;
}

/// Ways to places without the margin, unless all are.
void Braking::leave_out_near_rests(std::vector<Try>& tries, double margin_m) const {
    const auto is_near = [&](const Try& each) {
        return model_->collisions().clearance_m(level_at(each.plan.last())) < margin_m;
    };
    if (!std::ranges::all_of(tries, is_near)) {
        std::erase_if(tries, is_near);
    }
}

/// Mostly the first way is safe, else one of the next two, for which a small map is enough. Where none of them is, the
/// others are flown in the nominal world, and those that are safe there in the worlds, until one is safe in all.
std::optional<Braking::Stop> Braking::best_stop(const Start& from, const std::vector<FlightState>& fleet) {
    std::vector<FlightState> vehicles = fleet;
    if (vehicles.empty()) {
        const FlightState here = start_state(*model_, from);
        for (const FlownWorld& world : worlds_) {
            vehicles.push_back(here);
            vehicles.back().world = memory_at_start(world, here.plant);
        }
    }
    std::vector<Try> tries = all_tries(reference_at(from));
    if (tries.empty()) {
        return std::nullopt;
    }
    leave_out_near_rests(tries, kept_margin_m(vehicles.front()));
    const auto is_safe = [](const Try& each) { return each.failures == 0; };
    const std::span all(tries);
    std::size_t flown = 0;
    const auto has_safe = [&] { return std::ranges::any_of(all.first(flown), is_safe); };
    const auto fly_next = [&](std::size_t count, std::size_t first_world) {
        count = std::min(count, all.size() - flown);
        fly(all.subspan(flown, count), vehicles, first_world, worlds_.size());
        flown += count;
    };
    fly_around(places_on(all.first(std::min<std::size_t>(3, all.size())), from));
    fly_next(1, 0);
    if (!has_safe()) {
        fly_next(2, 0);
    }
    if (!has_safe() && flown < all.size()) {
        const std::span others = all.subspan(flown);
        fly_around(places_on(others, from));
        fly(others, vehicles, 0, 1);
        std::stable_partition(others.begin(), others.end(), is_safe);
        while (!has_safe() && flown < all.size()) {
            fly_next(2, 1);
        }
    }
    const auto best = std::min_element(tries.begin(), tries.begin() + static_cast<std::ptrdiff_t>(flown),
                                       [](const Try& a, const Try& b) { return a.failures < b.failures; });
    return Stop{std::move(best->plan), best->failures};
}

/// That of the problem, if the vehicle has it.
double Braking::kept_margin_m(const FlightState& vehicle) const {
    const double here_m = model_->collisions().clearance_m(pose_of(vehicle));
    return std::min(problem_.planner.safety_margin_m, here_m - min_clearance_error_m(here_m));
}

void Braking::fly(std::span<Try> tries, const std::vector<FlightState>& fleet, std::size_t first_world,
                  std::size_t last_world) {
    const double margin_m = kept_margin_m(fleet.front());
    const std::int64_t settling = std::llround(goal_settling_s / model_->tick().tick_s);
    std::vector<FlightJob> jobs;
    for (const Try& each : tries) {
        std::vector<FlightLeg> legs;
        for (const ReferenceSegment& segment : with_hover(each.plan, each.hover, *model_).segments()) {
            legs.push_back({segment});
        }
        for (std::size_t i = first_world; i < last_world; ++i) {
            jobs.push_back({fleet[i], legs, settling, &worlds_[i], 0, &each.hover});
        }
    }
    pool_->fly(jobs);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const FlightJob& job = jobs[i];
        const bool is_nominal = job.world == worlds_.data();
        const Rejection rejection = job.rejection();
        // In another world the vehicle may still be settling.
        const bool fails = is_nominal ? rejection != Rejection::none || min_clearance_m(job) < margin_m
                                      : rejection != Rejection::none && rejection != Rejection::goal_missed;
        tries[i / (last_world - first_world)].failures += fails ? 1 : 0;
    }
}

StopFinder::StopFinder(const Problem& problem, std::shared_ptr<const FlightModel> model,
                       std::shared_ptr<const AeroMap> map, std::vector<FlownWorld> worlds, int threads)
    : problem_(problem),
      model_(model),
      worlds_(std::move(worlds)),
      braking_(
          problem, model, [map](const Bounds&) { return map; }, worlds_, threads),
      flights_(problem, model, map, threads) {}

SafeStops StopFinder::along(const Plan& plan, const StopCondition& is_over) {
    constexpr double step_s = 0.5;
    const auto step = std::max<std::int64_t>(1, std::llround(step_s / plan.tick_s));
    std::vector<std::int64_t> ticks;
    for (const ReferenceKnot& knot : plan.reference) {
        for (std::int64_t tick = ticks.empty() ? knot.tick : ticks.back() + step; tick < knot.tick; tick += step) {
            ticks.push_back(tick);
        }
        ticks.push_back(knot.tick);
    }
    Plan moments{{}, plan.tick_s};
    for (const std::int64_t tick : ticks) {
        moments.reference.push_back({tick, plan.at(tick)});
    }
    const FlightState nominal = start_state(*model_, problem_.start);
    std::vector<FlightJob> fleet{{nominal, {}, 0, &model_->nominal_world()}};
    const std::vector<std::optional<FlightState>> starts = flights_.starts_in(worlds_);
    for (std::size_t i = 0; i < worlds_.size(); ++i) {
        fleet.push_back({starts[i].value_or(nominal), {}, 0, &worlds_[i]});
    }
    SafeStops stops;
    std::int64_t without = 0;
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        throw_if_over(is_over);
        const std::int64_t tick = ticks[i];
        if (i > 0) {
            flights_.advance(fleet, moments, i - 1, i, std::nullopt);
        }
        std::vector<FlightState> vehicles;
        vehicles.reserve(fleet.size());
        for (const FlightJob& job : fleet) {
            vehicles.push_back(job.legs.empty() ? job.start : job.end());
        }
        SafeStops::Moment& moment = stops.moments.emplace_back();
        moment.tick = tick;
        const auto stop = braking_.best_stop(start_of(*model_, vehicles.front(), moments.reference[i].point), vehicles);
        if (stop && stop->failures == 0) {
            moment.rest = stop->plan.last();
            moment.duration_s = stop->plan.duration_s();
        } else if (i + 1 < ticks.size()) {
            without += ticks[i + 1] - tick;
        }
    }
    if (ticks.back() > 0) {
        stops.share_without = static_cast<double>(without) / static_cast<double>(ticks.back());
    }
    return stops;
}

}  // namespace downwash::planning

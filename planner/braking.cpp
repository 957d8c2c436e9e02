#include "downwash/planner/braking.hpp"

#include <algorithm>
#include <array>
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

Bounds hull_of(const Bounds& a, const Bounds& b) {
    return {std::min(a.x_low_m, b.x_low_m), std::max(a.x_high_m, b.x_high_m), std::min(a.z_low_m, b.z_low_m),
            std::max(a.z_high_m, b.z_high_m)};
}

/// The vehicle after so many legs of a job, or where the flight ended before.
const FlightState& state_at_leg(const FlightJob& job, std::size_t legs) {
    if (const FlightLeg* const rejected = job.rejected_leg()) {
        legs = std::min(legs, static_cast<std::size_t>(rejected - job.legs.data()) + 1);
    }
    return legs == 0 ? job.start : job.legs[legs - 1].end;
}

bool are_same(const std::vector<FlightState>& a, const std::vector<FlightState>& b) {
    return std::ranges::equal(a, b,
                              [](const FlightState& one, const FlightState& other) { return is_same(one, other); });
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
        rules.finds_min_clearance = ClearanceError{};
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

Braking::Tries Braking::all_tries(Moment moment) const {
    const ReferencePoint from = reference_at(moment.from);
    if (moment.fleet.empty()) {
        const FlightState here = start_state(*model_, moment.from);
        for (const FlownWorld& world : worlds_) {
            moment.fleet.push_back(here);
            moment.fleet.back().world = memory_at_start(world, here.plant);
        }
    }
    const double margin_m = kept_margin_m(moment.fleet.front());
    Tries tries{std::move(moment), margin_m, {}};
    const double tick_s = model_->tick().tick_s;
    for (const Maneuver& maneuver : maneuvers) {
        const MotionLimits limits = harder_limits(problem_.motion, maneuver.harder);
        const Configuration rest = rest_of(from, problem_.axes(), limits, maneuver);
        if (is_inside(problem_.bounds, rest)) {
            Plan plan{{{0, from}}, tick_s};
            plan.reference.push_back({shortest_ticks(from, at_rest(rest), limits, tick_s), at_rest(rest)});
            tries.all.push_back({std::move(plan), hover_at(rest)});
        }
    }
    leave_out_near_rests(tries);
    return tries;
}

/// Ways to places without the margin, unless all are.
void Braking::leave_out_near_rests(Tries& tries) const {
    const auto is_near = [&](const Try& each) {
        return model_->collisions().clearance_m(level_at(each.plan.last())) < tries.margin_m;
    };
    if (!std::ranges::all_of(tries.all, is_near)) {
        std::erase_if(tries.all, is_near);
    }
}

bool Braking::Tries::has_safe() const {
    return std::ranges::any_of(std::span(all).first(flown), [](const Try& each) { return each.failures == 0; });
}

Braking::Batch Braking::next(Tries& tries, std::size_t count, std::size_t first_world) const {
    const std::size_t first = tries.flown;
    tries.flown += std::min(count, tries.all.size() - first);
    return {&tries, std::span(tries.all).subspan(first, tries.flown - first), first_world, worlds_.size()};
}

std::optional<Braking::Stop> Braking::best_stop(const Start& from, const std::vector<FlightState>& fleet) {
    return std::move(best_stops({{from, fleet}}).front());
}

/// Mostly the first way is safe, else one of the next two, for which a small map is enough.
std::vector<std::optional<Braking::Stop>> Braking::best_stops(std::vector<Moment> moments,
                                                              const StopCondition& is_over) {
    std::vector<Tries> tries;
    tries.reserve(moments.size());
    for (Moment& moment : moments) {
        tries.push_back(all_tries(std::move(moment)));
    }
    for (const std::size_t count : {1U, 2U}) {
        throw_if_over(is_over);
        std::vector<Batch> batches;
        std::optional<Bounds> places;
        for (Tries& each : tries) {
            if (each.is_open()) {
                const std::size_t first_tries = std::min<std::size_t>(3, each.all.size());
                const Bounds own = places_on(std::span(each.all).first(first_tries), each.moment.from);
                places = places ? hull_of(*places, own) : own;
                batches.push_back(next(each, count, 0));
            }
        }
        if (places) {
            fly_around(*places);
            fly(batches);
        }
    }
    std::vector<std::optional<Stop>> stops;
    for (Tries& each : tries) {
        throw_if_over(is_over);
        if (each.is_open()) {
            try_the_others(each);
        }
        const auto end = each.all.begin() + static_cast<std::ptrdiff_t>(each.flown);
        const auto best =
            std::min_element(each.all.begin(), end, [](const Try& a, const Try& b) { return a.failures < b.failures; });
        stops.push_back(each.all.empty() ? std::nullopt : std::optional(Stop{std::move(best->plan), best->failures}));
    }
    return stops;
}

/// They are flown in the nominal world, and those that are safe there in the worlds, until one is safe in all.
void Braking::try_the_others(Tries& tries) {
    const std::span others = std::span(tries.all).subspan(tries.flown);
    fly_around(places_on(others, tries.moment.from));
    fly(std::array{Batch{&tries, others, 0, 1}});
    std::stable_partition(others.begin(), others.end(), [](const Try& each) { return each.failures == 0; });
    while (tries.is_open()) {
        fly(std::array{next(tries, 2, 1)});
    }
}

/// That of the problem, if the vehicle has it.
double Braking::kept_margin_m(const FlightState& vehicle) const {
    const double here_m = model_->collisions().clearance_m(pose_of(vehicle));
    return std::min(problem_.planner.safety_margin_m, here_m - ClearanceError{}.at_m(here_m));
}

void Braking::fly(std::span<const Batch> batches) {
    const std::int64_t settling = std::llround(goal_settling_s / model_->tick().tick_s);
    std::vector<FlightJob> jobs;
    std::vector<Try*> try_of;
    std::vector<double> margin_of_m;
    for (const Batch& batch : batches) {
        for (Try& each : batch.tries) {
            std::vector<FlightLeg> legs;
            for (const ReferenceSegment& segment : with_hover(each.plan, each.hover, *model_).segments()) {
                legs.push_back({segment});
            }
            for (std::size_t i = batch.first_world; i < batch.last_world; ++i) {
                jobs.push_back({batch.of->moment.fleet[i], legs, settling, &worlds_[i], 0, &each.hover});
                try_of.push_back(&each);
                margin_of_m.push_back(batch.of->margin_m);
            }
        }
    }
    pool_->fly(jobs);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const FlightJob& job = jobs[i];
        const bool is_nominal = job.world == worlds_.data();
        const Rejection rejection = job.rejection();
        // In another world the vehicle may still be settling.
        const bool fails = is_nominal ? rejection != Rejection::none || min_clearance_m(job) < margin_of_m[i]
                                      : rejection != Rejection::none && rejection != Rejection::goal_missed;
        try_of[i]->failures += fails ? 1 : 0;
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
    const Plan moments = plan.divided(std::max<std::int64_t>(1, std::llround(step_s / plan.tick_s)));
    const std::vector<ReferenceKnot>& knots = moments.reference;
    const FlightState nominal = start_state(*model_, problem_.start);
    std::vector<FlightJob> fleet{{nominal, {}, 0, &model_->nominal_world()}};
    const std::vector<std::optional<FlightState>> starts = flights_.starts_in(worlds_);
    for (std::size_t i = 0; i < worlds_.size(); ++i) {
        fleet.push_back({starts[i].value_or(nominal), {}, 0, &worlds_[i]});
    }
    flights_.advance(fleet, moments, 0, knots.size() - 1, std::nullopt);
    throw_if_over(is_over);

    std::vector<Known> all(knots.size());
    std::vector<std::size_t> unknown;
    std::vector<Braking::Moment> asked;
    for (std::size_t i = 0; i < knots.size(); ++i) {
        Known& known = all[i];
        for (const FlightJob& job : fleet) {
            known.moment.fleet.push_back(state_at_leg(job, i));
        }
        known.moment.from = start_of(*model_, known.moment.fleet.front(), knots[i].point);
        known.stop.tick = knots[i].tick;
        const auto before = std::ranges::find_if(known_, [&](const Known& each) {
            return each.stop.tick == knots[i].tick && each.moment.from.reference == known.moment.from.reference &&
                   are_same(each.moment.fleet, known.moment.fleet);
        });
        if (before != known_.end()) {
            known.stop = before->stop;
        } else {
            unknown.push_back(i);
            asked.push_back(known.moment);
        }
    }
    const std::vector<std::optional<Braking::Stop>> found = braking_.best_stops(std::move(asked), is_over);
    for (std::size_t i = 0; i < unknown.size(); ++i) {
        if (found[i] && found[i]->failures == 0) {
            SafeStops::Moment& moment = all[unknown[i]].stop;
            moment.rest = found[i]->plan.last();
            moment.duration_s = found[i]->plan.duration_s();
        }
    }
    known_ = std::move(all);

    SafeStops stops;
    std::int64_t without = 0;
    for (std::size_t i = 0; i < known_.size(); ++i) {
        stops.moments.push_back(known_[i].stop);
        if (!known_[i].stop.rest && i + 1 < known_.size()) {
            without += knots[i + 1].tick - knots[i].tick;
        }
    }
    if (knots.back().tick > 0) {
        stops.share_without = static_cast<double>(without) / static_cast<double>(knots.back().tick);
    }
    return stops;
}

}  // namespace downwash::planning

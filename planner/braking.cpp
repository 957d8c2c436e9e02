#include "downwash/planner/braking.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/planner/planner.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/search/search_space.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::planning {
namespace {

/// A way to brake. Distances are those of a constant deceleration, times a factor.
struct Way {
    double harder;   ///< limits of acceleration and jerk, over those of the problem
    double farther;  ///< distance
    double aside_m;  ///< upwards
};

/// The gentle ones first, then those that get out of the way of something.
constexpr Way ways[] = {{1, 1.3, 0},   {2, 1.2, 0}, {1, 1.3, -0.3}, {1, 1.3, 0.3},  {2, 1.2, -0.3},
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
Configuration rest_of(const ReferencePoint& from, const MotionLimits& limits, const Way& way) {
    const double speed_m_s = std::hypot(from.velocity[0], from.velocity[1]);
    const MotionLimits straight = limits_along(limits, from.velocity[0], from.velocity[1]);
    const double time_s = way.farther * speed_m_s / straight.max_acceleration_m_s2;
    const double arm_time_s = way.farther * std::abs(from.velocity[2]) / limits.max_arm_acceleration_rad_s2;
    return {from.position[0] + 0.5 * time_s * from.velocity[0],
            from.position[1] + 0.5 * time_s * from.velocity[1] + way.aside_m,
            from.position[2] + 0.5 * arm_time_s * from.velocity[2]};
}

bool is_inside(const Bounds& bounds, const Configuration& at) {
    return at.x_m >= bounds.x_low_m && at.x_m <= bounds.x_high_m && at.z_m >= bounds.z_low_m &&
           at.z_m <= bounds.z_high_m;
}

/// A hover there: it may be a little beside it, but has to come to rest.
Goal hover_at(const Configuration& rest) {
    Goal goal;
    goal.configuration = ConfigurationGoal{rest.x_m, rest.z_m, rest.arm_rad, 0.3, 0.35};
    goal.hold_s = stop_hold_s;
    return goal;
}

}  // namespace

Braking::Braking(const Problem& problem, std::shared_ptr<const FlightModel> model, std::shared_ptr<const AeroMap> map,
                 std::vector<FlownWorld> worlds, int threads)
    : problem_(problem), model_(std::move(model)), map_(std::move(map)), worlds_(std::move(worlds)), threads_(threads) {
    worlds_.insert(worlds_.begin(), model_->nominal_world());
}

Bounds Braking::reach(const Problem& problem, const Start& from) {
    const ReferencePoint reference = reference_at(from);
    Bounds reach{from.x_m, from.x_m, from.z_m, from.z_m};
    for (const Way& way : ways) {
        const Configuration rest = rest_of(reference, harder_limits(problem.motion, way.harder), way);
        reach = {std::min(reach.x_low_m, rest.x_m), std::max(reach.x_high_m, rest.x_m),
                 std::min(reach.z_low_m, rest.z_m), std::max(reach.z_high_m, rest.z_m)};
    }
    constexpr double swing_m = 0.5;
    const Bounds& bounds = problem.bounds;  // stops are within them, however fast the vehicle is
    return {std::clamp(reach.x_low_m, bounds.x_low_m, bounds.x_high_m) - swing_m,
            std::clamp(reach.x_high_m, bounds.x_low_m, bounds.x_high_m) + swing_m,
            std::clamp(reach.z_low_m, bounds.z_low_m, bounds.z_high_m) - swing_m,
            std::clamp(reach.z_high_m, bounds.z_low_m, bounds.z_high_m) + swing_m};
}

std::optional<Braking::Stop> Braking::best_stop(const Start& from, const std::vector<FlightState>& fleet) const {
    const ReferencePoint reference = reference_at(from);
    const double tick_s = model_->tick().tick_s;
    Problem stop = problem_;
    stop.stops.clear();
    stop.start = from;
    std::optional<Stop> best;
    std::vector<FlightState> vehicles = fleet;
    if (vehicles.empty()) {
        const FlightState here = start_state(*model_, from);
        for (const FlownWorld& world : worlds_) {
            vehicles.push_back(here);
            vehicles.back().world = memory_at_start(world, here.plant);
        }
    }
    for (const Way& way : ways) {
        const MotionLimits limits = harder_limits(problem_.motion, way.harder);
        const Configuration rest = rest_of(reference, limits, way);
        if (!is_inside(problem_.bounds, rest)) {
            continue;
        }
        Plan plan{{{0, reference}}, tick_s};
        plan.reference.push_back({shortest_ticks(reference, at_rest(rest), limits, tick_s), at_rest(rest)});
        stop.goal = hover_at(rest);
        const std::size_t failing = failures(stop, plan, vehicles);
        if (!best || failing < best->failures) {
            best = {std::move(plan), failing};
        }
        if (failing == 0) {
            break;
        }
    }
    return best;
}

std::size_t Braking::failures(const Problem& stop, const Plan& plan, const std::vector<FlightState>& fleet) const {
    const double here_m = model_->collisions().clearance_m(pose_of(fleet.front()));
    const double margin_m = std::min(stop.planner.safety_margin_m, here_m - min_clearance_error_m(here_m));
    const Plan held = with_hover(plan, stop.goal, *model_);
    std::vector<FlightJob> jobs;
    for (std::size_t i = 0; i < worlds_.size(); ++i) {
        jobs.push_back({fleet[i], {}, 0, &worlds_[i]});
    }
    WorldFlights flights(stop, model_, map_, threads_);
    flights.advance(jobs, held, 0, held.reference.size() - 1, 0);
    // Where the vehicle is not quite as believed it may still be settling.
    const auto failing = static_cast<std::size_t>(std::count_if(jobs.begin() + 1, jobs.end(), [](const FlightJob& job) {
        return job.rejection() != Rejection::none && job.rejection() != Rejection::goal_missed;
    }));
    const bool is_good = jobs.front().rejection() == Rejection::none && min_clearance_m(jobs.front()) >= margin_m;
    return failing + (is_good ? 0 : 1);
}

SafeStops stops_along(const Problem& problem, const std::shared_ptr<const FlightModel>& model,
                      const std::shared_ptr<const AeroMap>& map, const std::vector<FlownWorld>& worlds,
                      const Plan& plan, int threads, const StopCondition& is_over) {
    constexpr double step_s = 0.5;
    const Braking braking(problem, model, map, worlds, threads);
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
        moments.reference.push_back({tick, reference_of(plan, tick)});
    }
    WorldFlights flights(problem, model, map, threads);
    std::vector<FlownWorld> all = worlds;
    all.insert(all.begin(), model->nominal_world());
    const FlightState believed = start_state(*model, problem.start);
    std::vector<FlightJob> fleet{{believed, {}, 0, all.data()}};
    const std::vector<std::optional<FlightState>> starts = flights.starts_in(worlds);
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        fleet.push_back({starts[i].value_or(believed), {}, 0, &all[i + 1]});
    }
    SafeStops stops;
    std::int64_t without = 0;
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        throw_if_over(is_over);
        const std::int64_t tick = ticks[i];
        if (i > 0) {
            flights.advance(fleet, moments, i - 1, i, std::nullopt);
        }
        std::vector<FlightState> vehicles;
        vehicles.reserve(fleet.size());
        for (const FlightJob& job : fleet) {
            vehicles.push_back(job.legs.empty() ? job.start : job.end());
        }
        SafeStops::Moment& moment = stops.moments.emplace_back();
        moment.tick = tick;
        const auto stop = braking.best_stop(start_of(*model, vehicles.front(), moments.reference[i].point), vehicles);
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

#include "downwash/planner/braking.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/planner/flight_search.hpp"
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
constexpr Way ways[] = {{1, 1.3, 0}, {2, 1.2, 0}, {1, 1.3, -0.3}, {1, 1.3, 0.3}, {2, 1.2, -0.3}, {2, 1.2, 0.3},
                        {3, 1.1, 0}, {2, 2.5, 0}, {2, 1.2, -0.8}, {2, 1.2, 0.8}};

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
    const double time_s = way.farther * speed_m_s / limits.max_acceleration_m_s2;
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
    : problem_(problem),
      model_(std::move(model)),
      map_(std::move(map)),
      worlds_(std::move(worlds)),
      threads_(threads) {}

Bounds Braking::reach(const Problem& problem, const Start& from) {
    const ReferencePoint reference = reference_at(from);
    Bounds reach{from.x_m, from.x_m, from.z_m, from.z_m};
    for (const Way& way : ways) {
        const Configuration rest = rest_of(reference, harder_limits(problem.motion, way.harder), way);
        reach = {std::min(reach.x_low_m, rest.x_m), std::max(reach.x_high_m, rest.x_m),
                 std::min(reach.z_low_m, rest.z_m), std::max(reach.z_high_m, rest.z_m)};
    }
    constexpr double swing_m = 0.5;
    return {reach.x_low_m - swing_m, reach.x_high_m + swing_m, reach.z_low_m - swing_m, reach.z_high_m + swing_m};
}

std::optional<Plan> Braking::safe_stop(const Start& from) const {
    const ReferencePoint reference = reference_at(from);
    const double tick_s = model_->tick().tick_s;
    Problem stop = problem_;
    stop.stops.clear();
    stop.start = from;
    for (const Way& way : ways) {
        const MotionLimits limits = harder_limits(problem_.motion, way.harder);
        const Configuration rest = rest_of(reference, limits, way);
        if (!is_inside(problem_.bounds, rest)) {
            continue;
        }
        Plan plan{{{0, reference}}, tick_s};
        plan.reference.push_back({shortest_ticks(reference, at_rest(rest), limits, tick_s), at_rest(rest)});
        stop.goal = hover_at(rest);
        if (is_safe(stop, plan)) {
            return plan;
        }
    }
    return std::nullopt;
}

bool Braking::is_safe(const Problem& stop, const Plan& plan) const {
    const FlightState start = start_state(*model_, stop.start);
    const Execution flight = execute(*model_, start, plan.reference, stop.goal, stop.aero.enabled);
    const double margin_m =
        std::min(stop.planner.safety_margin_m, model_->collisions().clearance_m(pose_of(start)) - 1e-3);
    if (!is_good(flight, margin_m)) {
        return false;
    }
    if (worlds_.empty()) {
        return true;
    }
    WorldFlights flights(stop, model_, map_, threads_);
    const std::vector<WorldFlight> flown = flights.fly(plan, 1, worlds_);
    return std::all_of(flown.begin(), flown.end(),
                       [](const WorldFlight& each) { return each.rejection == Rejection::none; });
}

}  // namespace downwash::planning

#include "downwash/judge/space_disagreements.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "downwash/controllers/space_axes.hpp"
#include "downwash/judge/space_reference.hpp"

namespace downwash::judge {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Greatest difference of coordinates that should be the same; files hold all digits.
constexpr double rounding = 1e-9;

bool is_same(double a, double b) {
    return std::abs(a - b) <= rounding * std::max({1.0, std::abs(a), std::abs(b)});
}

class List {
 public:
    void compare(const std::string& what, const SpacePoint& file, const SpacePoint& judge, int joints) {
        const std::span<const Axis> axes = axes_in_space(joints);
        for (std::size_t i = 0; i < axes.size(); ++i) {
            if (!is_same(file.position[i], judge.position[i])) {
                found.push_back({what + '.' + std::string(axes[i].position), file.position[i], judge.position[i]});
            }
        }
    }
    /// @param limit that the file should not exceed
    void limit(const std::string& what, double file, double limit) {
        if (!(file <= limit * (1 + limit_tolerance))) {
            found.push_back({what, file, limit});
        }
    }
    void compare(const char* what, double file, double judge, double tolerance) {
        if (!(std::abs(file - judge) <= tolerance)) {
            found.push_back({what, file, judge});
        }
    }

    std::vector<Disagreement> found;
};

double norm(const double* v) {
    return std::hypot(v[0], v[1], v[2]);
}

/// The greatest figures at the ticks of a piece of the reference.
struct Peaks {
    double speed = 0, acceleration = 0, jerk = 0, thrust_ratio = 0, tilt_rate = 0;
    double axis_rate[space_axes<max_joints>] = {}, axis_acceleration[space_axes<max_joints>] = {};

    /// @param before one tick ago
    void see(const SpacePoint& before, const SpacePoint& p, double tick_s) {
        const double change[] = {p.acceleration[0] - before.acceleration[0], p.acceleration[1] - before.acceleration[1],
                                 p.acceleration[2] - before.acceleration[2]};
        jerk = std::max(jerk, norm(change) / tick_s);
        speed = std::max(speed, norm(p.velocity));
        acceleration = std::max(acceleration, norm(p.acceleration));
        const Vector3 force = force_of(p);
        thrust_ratio = std::max(thrust_ratio, norm(force.data()) / standard_gravity_m_s2);
        tilt_rate = std::max(tilt_rate, angle_between(force_of(before), force) / tick_s);
        for (int axis = space::yaw; axis < space_axes<max_joints>; ++axis) {
            axis_rate[axis] = std::max(axis_rate[axis], std::abs(p.velocity[axis]));
            axis_acceleration[axis] = std::max(axis_acceleration[axis], std::abs(p.acceleration[axis]));
        }
    }

 private:
    static Vector3 force_of(const SpacePoint& p) {
        return {p.acceleration[0], p.acceleration[1], p.acceleration[2] + standard_gravity_m_s2};
    }
    static double angle_between(const Vector3& a, const Vector3& b) {
        const Vector3 across = cross(a, b);
        return std::atan2(norm(across.data()), dot(a, b));
    }
};

void check_limits(const SpacePlan& plan, const SpaceMotionLimits& limits, List& list) {
    const std::vector<SpaceKnot>& knots = plan.reference;
    const std::span<const Axis> axes = axes_in_space(plan.joints);
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
        Peaks peaks;
        SpacePoint before = knots[i].point;
        peaks.see(before, before, plan.tick_s);
        for (std::int64_t tick = knots[i].tick + 1; tick <= knots[i + 1].tick; ++tick) {
            const SpacePoint here = tick < knots[i + 1].tick ? reference_at(plan, tick) : knots[i + 1].point;
            peaks.see(std::exchange(before, here), here, plan.tick_s);
        }
        const std::string piece = "plan.reference[" + std::to_string(i) + "] to [" + std::to_string(i + 1) + "]: ";
        list.limit(piece + "speed_m_s", peaks.speed, limits.max_speed_m_s);
        list.limit(piece + "acceleration_m_s2", peaks.acceleration, limits.max_acceleration_m_s2);
        list.limit(piece + "jerk_m_s3", peaks.jerk, limits.max_jerk_m_s3);
        if (limits.max_thrust_ratio) {
            list.limit(piece + "thrust_ratio", peaks.thrust_ratio, *limits.max_thrust_ratio);
        }
        if (limits.max_tilt_rate_rad_s) {
            list.limit(piece + "tilt_rate_rad_s", peaks.tilt_rate, *limits.max_tilt_rate_rad_s);
        }
        for (std::size_t axis = space::yaw; axis < axes.size(); ++axis) {
            const std::size_t joint = axis - space::first_joint;
            const bool is_yaw = axis == space::yaw;
            list.limit(piece + std::string(axes[axis].velocity), peaks.axis_rate[axis],
                       is_yaw ? limits.max_yaw_rate_rad_s : limits.max_joint_rate_rad_s[joint]);
            list.limit(piece + std::string(axes[axis].acceleration), peaks.axis_acceleration[axis],
                       is_yaw ? limits.max_yaw_acceleration_rad_s2 : limits.max_joint_acceleration_rad_s2[joint]);
        }
    }
}

/// An impact and a release magnify what was different before.
constexpr double touch_swing = 3;

bool flight_touches(const SpaceJudgedFlight& flight) {
    return std::ranges::any_of(flight.goals, [](const SpaceJudgedGoal& goal) { return goal.touch.has_value(); });
}

/// Where a plan has to begin; any yaw where the problem gives an attitude.
SpacePoint begin_of(const SpaceStart& start, const SpacePoint& first) {
    SpacePoint begin;
    if (const auto& reference = start.reference) {
        std::copy(reference->position.begin(), reference->position.end(), begin.position);
        return begin;
    }
    std::copy(start.position_m.begin(), start.position_m.end(), begin.position);
    begin.position[space::yaw] = start.attitude ? first.position[space::yaw] : start.yaw_rad;
    std::copy(start.joints_rad.begin(), start.joints_rad.end(), begin.position + space::first_joint);
    return begin;
}

}  // namespace

double worst_goal_error_m(const SpaceJudgedFlight& flight) noexcept {
    double worst_m = 0;
    for (const SpaceJudgedGoal& goal : flight.goals) {
        worst_m = std::max(worst_m, goal.error_m);
    }
    return worst_m;
}

std::vector<Disagreement> disagreements_in_plan(const SpaceClaims& claims, const SpaceProblem& problem) {
    List list;
    const std::vector<SpaceKnot>& knots = claims.plan.reference;
    if (claims.has_waypoints && claims.waypoints.size() != knots.size()) {
        list.found.push_back({"plan.waypoints: their number", static_cast<double>(claims.waypoints.size()),
                              static_cast<double>(knots.size())});
    }
    for (std::size_t i = 0; i < std::min(claims.waypoints.size(), knots.size()); ++i) {
        list.compare("plan.waypoints[" + std::to_string(i) + "]", claims.waypoints[i], knots[i].point,
                     claims.plan.joints);
    }
    const SpacePoint& first = knots.front().point;
    list.compare("plan.reference[0]", first, begin_of(problem.start, first), claims.plan.joints);
    check_limits(claims.plan, problem.motion, list);
    double speed = 0;
    for (const double rate : knots.back().point.velocity) {
        speed = std::max(speed, std::abs(rate));
    }
    if (speed > rounding) {
        list.found.push_back({"plan.reference, its end: speed", speed, 0.0});
    }
    return std::move(list.found);
}

std::vector<Disagreement> disagreements_about_flight(const SpaceClaims& claims, const SpaceJudgedFlight& flight) {
    const FlightClaims& said = *claims.flight;
    List list;
    if (said.outcome != name_of(flight.outcome)) {
        list.found.push_back({"execution.outcome", said.outcome, std::string(name_of(flight.outcome))});
    }
    // How deep a contact is means nothing; without obstacles both are infinite.
    const double file_m = std::max(0.0, said.min_clearance_m.value_or(infinity));
    if (file_m != flight.min_clearance_m) {
        list.compare("execution.min_clearance_m", file_m, flight.min_clearance_m, clearance_tolerance_m);
    }
    list.compare("execution.energy_j", said.energy_j, flight.energy_j, cost_tolerance * flight.energy_j);
    // When a touch begins and how far behind the surface its reference ends is a matter of a few ticks.
    const double ticks = flight_touches(flight) ? 10 : 1;
    list.compare("execution.duration_s", said.duration_s, flight.duration_s,
                 ticks * claims.plan.tick_s * (1 + rounding));
    const CostFunction& objective = claims.objective;
    if (claims.has_cost && objective.weight(Objective::length) == 0 && objective.weight(Objective::clearance) == 0) {
        const double cost = objective.weight(Objective::energy) * flight.energy_j +
                            objective.weight(Objective::time) * flight.duration_s;
        list.compare("execution.cost", said.cost, cost, cost_tolerance * cost);
    }
    list.compare("execution.goal_error_m", said.goal_error_m, worst_goal_error_m(flight),
                 (flight_touches(flight) ? touch_swing : 1) * goal_error_tolerance_m);
    return std::move(list.found);
}

}  // namespace downwash::judge

#include "downwash/judge/disagreements.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "downwash/base/infinity.hpp"
#include "downwash/judge/goals.hpp"
#include "downwash/judge/reference.hpp"

namespace downwash::judge {
namespace {

/// Greatest difference of coordinates that should be the same; files hold all digits.
constexpr double rounding = 1e-9;

bool is_same(double a, double b) {
    return std::abs(a - b) <= rounding * std::max({1.0, std::abs(a), std::abs(b)});
}

class List {
 public:
    void compare(const std::string& what, const Configuration& file, const Configuration& judge) {
        for (std::size_t i = 0; i < planar_axes.size(); ++i) {
            if (!is_same(file[i], judge[i])) {
                found.push_back({what + '.' + std::string(planar_axes[i].position), file[i], judge[i]});
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

/// The greatest speeds, accelerations and jerks at the ticks of a piece of the reference, and of a point mass that
/// follows it the greatest force over its weight and turn of that force.
struct Peaks {
    double speed = 0, acceleration = 0, jerk = 0, arm_rate = 0, arm_acceleration = 0, thrust_ratio = 0, pitch_rate = 0;

    /// @param before one tick ago
    void see(const ReferencePoint& before, const ReferencePoint& p, double tick_s) {
        jerk = std::max(
            jerk, std::hypot(p.acceleration[0] - before.acceleration[0], p.acceleration[1] - before.acceleration[1]) /
                      tick_s);
        speed = std::max(speed, std::hypot(p.velocity[0], p.velocity[1]));
        acceleration = std::max(acceleration, std::hypot(p.acceleration[0], p.acceleration[1]));
        arm_rate = std::max(arm_rate, std::abs(p.velocity[2]));
        arm_acceleration = std::max(arm_acceleration, std::abs(p.acceleration[2]));
        thrust_ratio = std::max(thrust_ratio, std::hypot(p.acceleration[0], p.acceleration[1] + standard_gravity_m_s2) /
                                                  standard_gravity_m_s2);
        pitch_rate = std::max(pitch_rate, std::abs(pitch_of(p) - pitch_of(before)) / tick_s);
    }

 private:
    static double pitch_of(const ReferencePoint& p) {
        return std::atan2(p.acceleration[0], p.acceleration[1] + standard_gravity_m_s2);
    }
};

void check_limits(const Plan& plan, const MotionLimits& limits, List& list) {
    Reference reference(plan);
    const std::vector<ReferenceKnot>& knots = plan.reference;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
        Peaks peaks;
        ReferencePoint before = knots[i].point;
        peaks.see(before, before, plan.tick_s);
        for (std::int64_t tick = knots[i].tick + 1; tick <= knots[i + 1].tick; ++tick) {
            const ReferencePoint here = tick < knots[i + 1].tick ? reference.at(tick) : knots[i + 1].point;
            peaks.see(std::exchange(before, here), here, plan.tick_s);
        }
        const std::string piece = "plan.reference[" + std::to_string(i) + "] to [" + std::to_string(i + 1) + "]: ";
        list.limit(piece + "speed_m_s", peaks.speed, limits.max_speed_m_s);
        list.limit(piece + "acceleration_m_s2", peaks.acceleration, limits.max_acceleration_m_s2);
        list.limit(piece + "jerk_m_s3", peaks.jerk, limits.max_jerk_m_s3);
        list.limit(piece + "arm_rate_rad_s", peaks.arm_rate, limits.max_arm_rate_rad_s);
        list.limit(piece + "arm_acceleration_rad_s2", peaks.arm_acceleration, limits.max_arm_acceleration_rad_s2);
        if (limits.max_thrust_ratio) {
            list.limit(piece + "thrust_ratio", peaks.thrust_ratio, *limits.max_thrust_ratio);
        }
        if (limits.max_pitch_rate_rad_s) {
            list.limit(piece + "pitch_rate_rad_s", peaks.pitch_rate, *limits.max_pitch_rate_rad_s);
        }
    }
}

/// The plan visits all goals, and rests in the last one.
void check_goals(const Plan& plan, const Problem& problem, List& list) {
    const std::vector<Goal> goals = goals_of(problem);
    const ReferencePoint& last = plan.reference.back().point;
    const PlanarPose end{last.position[0], last.position[1], 0, last.position[2]};
    const double share = goal_distance(goals.back(), problem.robot.arm, end).used_share;
    if (!(share <= 1)) {
        list.found.push_back({"plan.reference, its end: share of the goal's tolerance", share, 1.0});
    }
    const double speed = std::max({std::abs(last.velocity[0]), std::abs(last.velocity[1]), std::abs(last.velocity[2])});
    if (speed > rounding) {
        list.found.push_back({"plan.reference, its end: speed", speed, 0.0});
    }
    const std::size_t visits = hover_ends(plan, goals, problem.robot.arm).size();
    if (visits < goals.size()) {  // the last of them may be anywhere
        list.found.push_back(
            {"plan.reference: hovers at goals", static_cast<double>(visits - 1), static_cast<double>(goals.size())});
    }
}

}  // namespace

std::vector<Disagreement> disagreements_in_plan(const Claims& claims, const Problem& problem) {
    List list;
    const std::vector<ReferenceKnot>& knots = claims.plan.reference;
    if (claims.waypoints.size() != knots.size()) {
        list.found.push_back({"plan.waypoints: their number", static_cast<double>(claims.waypoints.size()),
                              static_cast<double>(knots.size())});
    }
    for (std::size_t i = 0; i < std::min(claims.waypoints.size(), knots.size()); ++i) {
        list.compare("plan.waypoints[" + std::to_string(i) + "]", claims.waypoints[i],
                     configuration_of(knots[i].point));
    }
    const Start& start = problem.start;
    list.compare("plan.reference[0]", claims.plan.first(),
                 start.reference ? configuration_of(*start.reference) : start.at);
    check_limits(claims.plan, problem.motion, list);
    check_goals(claims.plan, problem, list);
    return std::move(list.found);
}

std::vector<Disagreement> disagreements_about_flight(const FlightClaims& claims, const CostFunction& objective,
                                                     const JudgedFlight& flight, double tick_s) {
    List list;
    if (claims.outcome != name_of(flight.outcome)) {
        list.found.push_back({"execution.outcome", claims.outcome, std::string(name_of(flight.outcome))});
    }
    // How deep a contact is means nothing; without obstacles both are infinite.
    const double file_m = std::max(0.0, claims.min_clearance_m.value_or(infinity));
    if (file_m != flight.min_clearance_m) {
        list.compare("execution.min_clearance_m", file_m, flight.min_clearance_m, clearance_tolerance_m);
    }
    const double cost = flight.cost(objective);
    list.compare("execution.energy_j", claims.energy_j, flight.energy_j, cost_tolerance * flight.energy_j);
    // When a touch begins and how far behind the surface its reference ends is a matter of a few ticks.
    const bool touches =
        std::ranges::any_of(flight.goals, [](const JudgedGoal& goal) { return goal.touch_force_n.has_value(); });
    const double ticks = touches ? 10 : 1;
    list.compare("execution.duration_s", claims.duration_s, flight.duration_s, ticks * tick_s * (1 + rounding));
    list.compare("execution.cost", claims.cost, cost, cost_tolerance * cost);
    const double swing = touches ? 3 : 1;  // an impact and a release magnify what was different before
    list.compare("execution.goal_error_m", claims.goal_error_m, flight.goal_error_m, swing * goal_error_tolerance_m);
    return std::move(list.found);
}

}  // namespace downwash::judge

#include "downwash/judge/umpire.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "downwash/judge/goals.hpp"
#include "downwash/judge/position_loop.hpp"

namespace downwash::judge {
namespace {

// docs/model.md 7.1 and 7.4, section 9 for the hover at the start.
constexpr double unstable_pitch_rad = 80 * std::numbers::pi / 180;
constexpr double unstable_error_m = 3;
constexpr double settling_s = 1;
constexpr double slow_m_s = 0.05;
constexpr double max_number = 1e20;
/// Between two poses a tick apart contact is looked for down to stretches in which nothing moves farther [m].
constexpr double unseen_motion_m = 1e-4;

PlanarPose pose_of(const Motion& motion) {
    return {motion.position_m.x, motion.position_m.z, motion.pitch_rad, motion.arm_rad};
}

double error_m(const Motion& motion, const ReferencePoint& reference) {
    return std::hypot(motion.position_m.x - reference.position[0], motion.position_m.z - reference.position[1]);
}

/// How far from the multirotor's centre of mass a body reaches [m].
double reach_of(const BodyShape& body) {
    struct Radius {
        double operator()(const Box& b) const { return 0.5 * std::sqrt(dot(b.size_m, b.size_m)); }
        double operator()(const Cylinder& c) const { return std::hypot(c.radius_m, 0.5 * c.length_m); }
        double operator()(const Sphere& s) const { return s.radius_m; }
    };
    return std::sqrt(dot(body.center_body_m, body.center_body_m)) + std::visit(Radius{}, body.shape);
}

double norm(Planar v) {
    return std::hypot(v.x, v.z);
}

/// Whether no number is NaN or beyond what can be computed with.
bool is_usable(const Motion& m) {
    const double all[] = {m.position_m.x,   m.position_m.z,   m.pitch_rad,        m.arm_rad,
                          m.velocity_m_s.x, m.velocity_m_s.z, m.pitch_rate_rad_s, m.arm_rate_rad_s};
    return std::all_of(std::begin(all), std::end(all), [](double x) { return std::abs(x) <= max_number; });
}

}  // namespace

bool is_stable(const Motion& m, const ReferencePoint& reference) {
    return is_usable(m) && std::abs(m.pitch_rad) <= unstable_pitch_rad && error_m(m, reference) <= unstable_error_m;
}

Umpire::Umpire(const Problem& problem, const SurfaceEffects* effects, const Obstacles& obstacles, const World& world,
               JudgedFlight& flight)
    : problem_(problem),
      effects_(effects),
      obstacles_(obstacles),
      world_(world),
      lateral_m_(lateral_m(world, problem.robot)),
      tick_s_(1 / problem.robot.controller.rate_hz),
      flight_(flight) {
    for (const BodyShape& body : problem.robot.body) {
        body_reach_m_ = std::max(body_reach_m_, reach_of(body));
    }
}

bool Umpire::sees(const Loop& loop, const ReferencePoint& reference) {
    const Motion motion = loop.motion();
    if (!is_usable(motion) || !(loop.state().energy_j <= max_number)) {  // no row: nothing follows from it
        flight_.outcome = Outcome::unstable;
        return false;
    }
    const double clearance_m = obstacles_.clearance_m(among_obstacles(motion));
    const bool is_contact = clearance_m <= 0;
    add_row(motion, reference, clearance_m, loop.state().energy_j);
    if (!is_stable(motion, reference)) {
        flight_.outcome = Outcome::unstable;
    } else if (is_contact || touches_within_tick(loop, motion, clearance_m)) {
        sees_collision(among_obstacles(motion));
    } else if (!is_flyable(motion)) {
        flight_.outcome = Outcome::left_flyable_area;
    }
    last_ = motion;
    return flight_.outcome == Outcome::ok;
}

bool Umpire::sees_touch(const Loop& loop, const ReferencePoint& reference, const TouchSurface& surface) {
    constexpr double max_depth_m = 0.002;
    constexpr double air_m = 5e-4;
    const Motion motion = loop.motion();
    if (!is_usable(motion) || !(loop.state().energy_j <= max_number)) {
        flight_.outcome = Outcome::unstable;
        return false;
    }
    const double depth_m = surface.depth_m(loop.plant().vehicle(), loop.state().motion);
    const double back_m = std::max(0.0, depth_m + air_m);
    PlanarPose beside = among_obstacles(motion);
    beside.x_m += back_m * surface.touch().normal.x;
    beside.z_m += back_m * surface.touch().normal.z;
    const double before_m = flight_.min_clearance_m;
    add_row(motion, reference, obstacles_.clearance_m(among_obstacles(motion)), loop.state().energy_j);
    flight_.min_clearance_m = before_m;  // the touch does not count
    if (!is_stable(motion, reference)) {
        flight_.outcome = Outcome::unstable;
    } else if (depth_m > max_depth_m || obstacles_.clearance_m(beside) <= 0) {
        sees_collision(beside);
    } else if (!is_flyable(motion)) {
        flight_.outcome = Outcome::left_flyable_area;
    }
    is_apart_ = depth_m < 0;
    last_ = motion;
    return flight_.outcome == Outcome::ok;
}

double Umpire::sees_hold(const Touch& touch, const std::optional<TouchCourse::Hold>& hold) {
    if (flight_.outcome == Outcome::ok && !(hold && hold->worst_second_n <= touch.force_tolerance_n && is_apart_)) {
        flight_.outcome = Outcome::goal_missed;
    }
    return hold ? hold->mean_n : 0;
}

void Umpire::sees_goals(const std::vector<Goal>& goals, const std::vector<Stay>& stays) {
    const auto settling = static_cast<std::size_t>(std::llround(settling_s / tick_s_));
    for (std::size_t i = 0; i < goals.size(); ++i) {
        const Stay& stay = stays[i];
        JudgedGoal goal{stay.row.has_value() && stay.is_touch_met, 0, stay.touch_force_n};
        const auto look = [&](std::size_t last, std::size_t ticks) {
            for (std::size_t t = last - std::min(last, ticks); t <= last; ++t) {
                const JudgedRow& row = flight_.rows[t];
                const GoalDistance off = goal_distance(goals[i], problem_.robot.arm, row.pose);
                goal.error_m = std::max(goal.error_m, off.distance_m);
                goal.is_met = goal.is_met && off.used_share <= 1 && std::hypot(row.vx_m_s, row.vz_m_s) < slow_m_s;
            }
        };
        if (stay.row) {
            look(*stay.row, settling);
        } else if (!flight_.rows.empty()) {
            look(flight_.rows.size() - 1, 0);
        }
        if (stay.row_after) {
            look(*stay.row_after, settling);
        }
        flight_.goal_error_m = std::max(flight_.goal_error_m, goal.error_m);
        if (!goal.is_met && flight_.outcome == Outcome::ok) {
            flight_.outcome = Outcome::goal_missed;
        }
        flight_.goals.push_back(goal);
    }
    if (flight_.outcome == Outcome::ok && problem_.energy_budget_j && flight_.energy_j > *problem_.energy_budget_j) {
        flight_.outcome = Outcome::over_budget;
    }
}

PlanarPose Umpire::among_obstacles(const Motion& motion) const {
    PlanarPose pose = pose_of(motion);
    pose.x_m -= world_.scene_x_m;
    pose.z_m -= world_.scene_z_m;
    pose.lateral_m = lateral_m_;
    return pose;
}

void Umpire::sees_collision(PlanarPose pose) {
    flight_.outcome = Outcome::collision;
    flight_.min_clearance_m = 0;
    pose.lateral_m = 0;
    flight_.is_lateral_collision = lateral_m_ != 0 && obstacles_.clearance_m(pose) > 0;
}

void Umpire::add_row(const Motion& motion, const ReferencePoint& reference, double clearance_m, double energy_j) {
    JudgedRow row;
    row.t_s = static_cast<double>(flight_.rows.size()) * tick_s_;
    row.pose = pose_of(motion);
    row.vx_m_s = motion.velocity_m_s.x;
    row.vz_m_s = motion.velocity_m_s.z;
    row.reference_x_m = reference.position[0];
    row.reference_z_m = reference.position[1];
    row.reference_arm_rad = reference.position[2];
    row.clearance_m = clearance_m;
    row.energy_j = energy_j;
    if (!flight_.rows.empty()) {
        const PlanarPose& from = flight_.rows.back().pose;
        const double turn_m = 0.5 * problem_.robot.arm.length_m * (row.pose.arm_rad - from.arm_rad);
        flight_.length_m += std::hypot(row.pose.x_m - from.x_m, row.pose.z_m - from.z_m, turn_m);
        flight_.clearance_integral += tick_s_ / (std::max(clearance_m, 0.0) + 0.1);
    }
    flight_.rows.push_back(row);
    flight_.min_clearance_m = std::min(flight_.min_clearance_m, clearance_m);
    flight_.max_tracking_error_m = std::max(flight_.max_tracking_error_m, error_m(motion, reference));
    flight_.energy_j = energy_j;
    flight_.duration_s = row.t_s;
}

bool Umpire::touches_within_tick(const Loop& loop, const Motion& motion, double clearance_m) const {
    return flight_.rows.size() > 1 &&
           touches_between(loop, {0, last_, flight_.rows[flight_.rows.size() - 2].clearance_m},
                           {tick_s_, motion, clearance_m});
}

bool Umpire::touches_between(const Loop& loop, const Instant& from, const Instant& to) const {
    const double motion_m = max_speed(from.motion, to.motion) * (to.since_s - from.since_s);
    if (from.clearance_m + to.clearance_m > motion_m || motion_m < unseen_motion_m) {
        return false;
    }
    Instant middle{0.5 * (from.since_s + to.since_s), {}, 0};
    middle.motion = loop.motion_within(middle.since_s);
    middle.clearance_m = obstacles_.clearance_m(among_obstacles(middle.motion));
    return middle.clearance_m <= 0 || touches_between(loop, from, middle) || touches_between(loop, middle, to);
}

double Umpire::max_speed(const Motion& a, const Motion& b) const {
    const ArmParameters& arm = problem_.robot.arm;
    const auto speed = [&](Planar velocity, double pitch_rate, double arm_rate) {
        const double joint_m = std::hypot(arm.joint_x_m, arm.joint_z_m);
        return norm(velocity) +
               std::max(body_reach_m_ * std::abs(pitch_rate),
                        joint_m * std::abs(pitch_rate) + arm.length_m * std::abs(pitch_rate + arm_rate));
    };
    return std::max(speed(a.velocity_m_s, a.pitch_rate_rad_s, a.arm_rate_rad_s),
                    speed(b.velocity_m_s, b.pitch_rate_rad_s, b.arm_rate_rad_s)) +
           speed(b.velocity_m_s - a.velocity_m_s, b.pitch_rate_rad_s - a.pitch_rate_rad_s,
                 b.arm_rate_rad_s - a.arm_rate_rad_s);
}

bool Umpire::is_flyable(const Motion& motion) const {
    if (effects_ == nullptr) {
        return true;
    }
    const RotorParameters& rotors = problem_.robot.rotors;
    const double distance_m = problem_.aero.min_distance_radii * rotors.radius_m;
    const PlanarPose pose = among_obstacles(motion);
    for (std::size_t i = 0; i < rotors.positions_m.size(); ++i) {
        const Vector3& hub_m = rotors.positions_m[i];
        const Planar hub = Planar{pose.x_m, pose.z_m} + from_body({hub_m[0], hub_m[2]}, pose.pitch_rad);
        if (!obstacles_.disc_keeps(distance_m, hub.x, hub_m[1], hub.z)) {
            return false;
        }
        // A given map says itself where it is defined.
        if (problem_.aero.map &&
            !effects_->all->effect(static_cast<int>(i)).is_flyable(problem_.plane.to_world(hub.x, hub_m[1], hub.z))) {
            return false;
        }
    }
    return true;
}

}  // namespace downwash::judge

#include "downwash/simulation/space_flying.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/flight_rules.hpp"
#include "downwash/simulation/goal.hpp"
#include "downwash/simulation/space_looks.hpp"
#include "downwash/simulation/space_rules.hpp"

namespace downwash::simulation {
namespace {

/// Few: among thousands of obstacles a tick takes milliseconds.
constexpr std::int64_t ticks_between_questions = 8;

double tracking_error_m(const SpaceMotion& motion, const SpacePoint& reference) {
    return space_tracking_error_m(motion.position_m.data(), reference.position);
}

bool is_in_range(SpaceFlightRow row) {
    row.clearance_m = std::isinf(row.clearance_m) ? 0 : row.clearance_m;
    return are_within(row, max_result);
}

/// Whether every joint is within its limits: what a checker says of solids of the robot itself is for those.
bool is_within_joint_limits(const SpaceRobot& robot, const SpacePose& pose) {
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        const SpaceLinkLimits& link = robot.links[i];
        const double angle_rad = pose.joints_rad[i];
        if (link.is_limited && (angle_rad < link.lower_limit_rad || angle_rad > link.upper_limit_rad)) {
            return false;
        }
    }
    return true;
}

}  // namespace

bool SpaceStability::is_lost(const SpaceLoop& loop, const SpaceMotion& motion, const SpacePoint& reference) {
    const bool is_upright = cosine_of_tilt(motion.attitude.data()) > lane::sin_cos(unstable_pitch_rad).cosine;
    const bool falls_over = was_upright_ && !is_upright;
    was_upright_ = was_upright_ || is_upright;
    // A number that is not finite is beyond every limit.
    return falls_over || !loop.is_within(max_state) || !(tracking_error_m(motion, reference) <= unstable_error_m);
}

SpaceFlying::SpaceFlying(const SpaceRobot& robot, const SpaceFlightSettings& settings, SpaceLoop& loop,
                         const SpacePoint& reference, SpaceFlight& flight)
    : robot_(robot),
      settings_(settings),
      loop_(loop),
      reference_(reference),
      flight_(flight),
      tick_s_(1 / robot.controller.rate_hz) {
    flight_.joints = robot.joints();
    flight_.rotor_count = static_cast<int>(robot.plant.rotors.size());
    flight_.has_rotor_lag = robot.plant.time_constant_s > 0;
    flight_.min_clearance_m = infinity;
}

void SpaceFlying::settle(const SpaceMotion& start) {
    SpacePoint here;
    std::copy(start.position_m.begin(), start.position_m.end(), here.position);
    const auto& q = start.attitude;
    here.position[space::yaw] = lane::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
    std::copy(start.joints_rad.begin(), start.joints_rad.end(), here.position + space::first_joint);
    SpaceStability stability;
    const std::int64_t ticks = std::llround(settling_before_start_s * robot_.controller.rate_hz);
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
        SpaceFlightRow row;
        loop_.quiet_tick(here, row);
        if (stability.is_lost(loop_, loop_.motion(), here)) {
            rejection_ = Rejection::unstable;
            return;
        }
    }
    loop_.forget();
}

void SpaceFlying::begin() {
    if (rejection_ == Rejection::none) {
        rejection_ = judged(loop_.motion());
    }
}

Rejection SpaceFlying::judged(const SpaceMotion& before) {
    const SpaceMotion motion = loop_.motion();
    flight_.max_tracking_error_m = std::max(flight_.max_tracking_error_m, tracking_error_m(motion, reference_));
    if (stability_.is_lost(loop_, motion, reference_)) {
        return Rejection::unstable;
    }
    flight_.length_m += length_of(motion.position_m - before.position_m);
    if (settings_.checker != nullptr && touches_anything(motion)) {
        flight_.min_clearance_m = std::min(flight_.min_clearance_m, 0.0);
        return Rejection::collision;
    }
    return loop_.is_flyable() ? Rejection::none : Rejection::flyable_area;
}

bool SpaceFlying::touches_anything(const SpaceMotion& motion) {
    const SpaceChecker& checker = *settings_.checker;
    SpacePose pose = among_obstacles(motion, settings_.world);
    if (settings_.measures_clearance) {
        clearance_m_ = checker.clearance_m(pose);
        if (touch_ == nullptr) {
            flight_.min_clearance_m = std::min(flight_.min_clearance_m, clearance_m_);
        }
    }
    if (touch_ != nullptr) {
        pose = touch_->off_surface(pose);
    }
    const bool touches =
        may_touch(pose) &&
        ((settings_.measures_clearance ? checker.clearance_m(pose) <= 0 : checker.is_nearer_than(pose, 0)) ||
         (before_ && checker.comes_nearer_between(*before_, pose, 0)));
    before_ = pose;
    return touches;
}

/// Whether a pose is so far from the last one at which collisions were looked for that there may be one. Where
/// clearances are measured there is no need to know. A vehicle that stays at a surface is looked at several times
/// before its free motion is found again: to find it takes longer than to look.
bool SpaceFlying::may_touch(const SpacePose& pose) {
    constexpr double at_surface_m = 0.005;
    constexpr int looks_at_surface = 16;
    if (settings_.measures_clearance) {
        return true;
    }
    if (looks_left_ > 0) {
        --looks_left_;
        return true;
    }
    const SpaceChecker& checker = *settings_.checker;
    const SpaceChange<double> change = change_between(looked_at_, pose);
    if (motion_m(checker.reach(), change) < free_.to_obstacles_m &&
        joint_motion_m(checker.reach(), change) < free_.to_itself_m && is_within_joint_limits(robot_, pose)) {
        return false;
    }
    looked_at_ = pose;
    free_ = checker.free_motion(pose, 0, max_free_motion_m);
    free_.to_obstacles_m -= free_motion_error_m(checker.kind());
    free_.to_itself_m -= free_motion_error_m(checker.kind());
    looks_left_ = free_.to_obstacles_m < at_surface_m ? looks_at_surface : 0;
    return true;
}

Rejection SpaceFlying::add(SpaceFlightRow row) {
    row.t_s = static_cast<double>(flight_.rows.size()) * tick_s_;
    row.clearance_m = clearance_m_;
    const bool is_usable = is_in_range(row);
    if (!is_usable) {
        std::fill(std::begin(row.rotor_command_n), std::end(row.rotor_command_n), 0.0);
        std::fill(std::begin(row.joint_torque_nm), std::end(row.joint_torque_nm), 0.0);
        row.saturation = max_result;
        row.power_w = 0;
    }
    flight_.max_saturation = std::max(flight_.max_saturation, row.saturation);
    flight_.rows.push_back(row);
    return is_usable ? Rejection::none : Rejection::unstable;
}

template <class Move>
void SpaceFlying::fly_tick(const Move& move) {
    if (ticks() % ticks_between_questions == 0) {
        throw_if_over(settings_.is_over);
    }
    SpaceFlightRow row;
    row.reference = reference_;
    row.contact_force_n = contact_force_n_;
    loop_.describe(row);
    const SpaceMotion before = row.motion;
    reference_ = move(settings_.first_tick + ticks(), row);
    rejection_ = add(row);
    if (rejection_ == Rejection::none && settings_.after_tick) {
        rejection_ = settings_.after_tick(flight_.rows.back());
    }
    if (rejection_ == Rejection::none) {
        rejection_ = judged(before);
        flight_.clearance_integral += tick_s_ * clearance_density(clearance_m_);
    }
}

void SpaceFlying::tick(const SpacePoint& next) {
    fly_tick([&](std::int64_t number, SpaceFlightRow& row) {
        loop_.tick(number, reference_, row);
        return next;
    });
}

SpaceTouchRecord SpaceFlying::touch(const SpaceTouch& touch) {
    SpaceTouchFlight course(robot_, touch, settings_.world, reference_, settings_.leads_touches);
    touch_ = &course;
    reference_ = course.reference();
    while (!course.is_over() && rejection_ == Rejection::none) {
        fly_tick([&](std::int64_t number, SpaceFlightRow& row) {
            dynamics::SpaceContactRecord seen;
            const double before_j = loop_.energy_j();
            const auto push = course.push();
            loop_.touching_tick(number, reference_, course.contact(), push ? &*push : nullptr, course.is_at_surface(),
                                row, seen);
            const double end_s = static_cast<double>(ticks() + 1) * tick_s_;
            course.saw(seen, loop_.motion(), end_s, loop_.energy_j() - before_j);
            contact_force_n_ = seen.normal_impulse_n_s / tick_s_;
            return course.reference();
        });
        if (rejection_ == Rejection::none && course.is_too_deep()) {
            rejection_ = Rejection::collision;
        }
    }
    touch_ = nullptr;
    contact_force_n_ = 0;
    const SpaceTouchRecord record = course.record(rejection_ == Rejection::none);
    if (rejection_ == Rejection::none && !record.is_met) {
        rejection_ = Rejection::goal_missed;
    }
    return record;
}

void SpaceFlying::end() {
    if (flight_.rows.empty() || loop_.is_within(max_state)) {
        SpaceFlightRow row;
        row.reference = reference_;
        row.contact_force_n = contact_force_n_;
        loop_.look(reference_, row);
        loop_.describe(row);
        static_cast<void>(add(row));
    }
    flight_.rejection = rejection_;
    flight_.outcome = outcome_of(rejection_);
    flight_.end = loop_.state();
    flight_.energy_j = flight_.rows.back().energy_j;
    flight_.duration_s = flight_.rows.back().t_s;
}

}  // namespace downwash::simulation

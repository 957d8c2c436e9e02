#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "downwash/base/portable_math.hpp"
#include "downwash/identification/logged_flight.hpp"
#include "downwash/judge/space_judge.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "random.hpp"

// Flights of vehicles with known differences, as their own logs tell them; for measurements and tests.

namespace downwash::test {

/// A reference of rests 1.5 s apart, within a metre and a half, in which yaw and joints turn.
inline SpacePlan identification_reference(const SpaceRobot& robot, double length_s, Random& random) {
    SpacePlan plan;
    plan.tick_s = 1 / robot.controller.rate_hz;
    plan.joints = robot.joints();
    constexpr double between_s = 1.5;
    const auto between = static_cast<std::int64_t>(std::llround(between_s / plan.tick_s));
    const auto knots = static_cast<std::int64_t>(length_s / between_s);
    for (std::int64_t k = 0; k <= knots; ++k) {
        SpaceKnot knot{k * between, {}};
        double* at = knot.point.position;
        at[space::x] = random.uniform(-0.7, 0.7);
        at[space::y] = random.uniform(-0.7, 0.7);
        at[space::z] = 3 + random.uniform(-0.7, 0.7);
        at[space::yaw] = random.uniform(-0.7, 0.7);
        for (int i = 0; i < robot.joints(); ++i) {
            const SpaceLinkLimits& limits = robot.links[static_cast<std::size_t>(i)];
            const double low = limits.is_limited ? limits.lower_limit_rad : -1,
                         high = limits.is_limited ? limits.upper_limit_rad : 1;
            at[space::first_joint + i] = 0.5 * (low + high) + random.uniform(-0.2, 0.2) * (high - low);
        }
        plan.reference.push_back(knot);
    }
    return plan;
}

inline SpaceMotion motion_of(const judge::SpaceJudgedMotion& motion) {
    return {motion.position_m,   motion.attitude,         motion.joints_rad,
            motion.velocity_m_s, motion.body_rates_rad_s, motion.joint_rates_rad_s};
}

/// What the vehicle recorded of a flight.
inline LoggedFlight log_of(const judge::SpaceJudgedFlight& flight, const std::string& name) {
    LoggedFlight log;
    log.name = name;
    log.has_reference = true;
    for (std::size_t i = 0; i < flight.records.size(); ++i) {
        const judge::SpaceJudgedRecord& record = flight.records[i];
        LoggedTick tick;
        tick.t_s = flight.rows[i].t_s;
        tick.seen = motion_of(record.seen);
        tick.reference = flight.rows[i].reference;
        std::copy(record.rotor_command_n.begin(), record.rotor_command_n.end(), tick.rotor_command_n.begin());
        std::copy(record.joint_torque_nm.begin(), record.joint_torque_nm.end(), tick.joint_torque_nm.begin());
        log.ticks.push_back(tick);
    }
    return log;
}

/// What a log has beside what the judge's controller saw: its attitude and joints are exact, those of no real log are.
/// Standard deviations of each angle and rate.
struct LogNoise {
    double attitude_rad = 0, joint_rad = 0, joint_rate_rad_s = 0;
};

/// Adds white noise to a log.
inline void add_noise(const LogNoise& noise, int joints, Random& random, LoggedFlight& log) {
    const auto normal = [&](double sd) { return sd > 0 ? sd * normal_quantile(random.uniform(1e-12, 1)) : 0; };
    for (LoggedTick& tick : log.ticks) {
        const double x = 0.5 * normal(noise.attitude_rad), y = 0.5 * normal(noise.attitude_rad),
                     z = 0.5 * normal(noise.attitude_rad);
        const std::array<double, 4> q = tick.seen.attitude;
        std::array<double, 4>& turned = tick.seen.attitude;
        turned = {q[0] - q[1] * x - q[2] * y - q[3] * z, q[1] + q[0] * x + q[2] * z - q[3] * y,
                  q[2] + q[0] * y - q[1] * z + q[3] * x, q[3] + q[0] * z + q[1] * y - q[2] * x};
        const double length = std::hypot(std::hypot(turned[0], turned[1]), std::hypot(turned[2], turned[3]));
        for (double& number : turned) {
            number /= length;
        }
        for (std::size_t i = 0; i < static_cast<std::size_t>(joints); ++i) {
            tick.seen.joints_rad[i] += normal(noise.joint_rad);
            tick.seen.joint_rates_rad_s[i] += normal(noise.joint_rate_rad_s);
        }
    }
}

/// Flies a reference in a world, far from everything.
/// @param robot as it truly is, but for the world   @return without records if the vehicle could not hover at the start
inline judge::SpaceJudgedFlight fly_for_log(const SpaceRobot& robot, const SpaceWorld& world, const SpacePlan& plan) {
    AeroSettings calm;
    calm.enabled = false;
    const judge::SpaceJudge judge(robot, {}, calm);
    judge::SpaceFlightConditions conditions;
    const double* start = plan.reference.front().point.position;
    conditions.start.position_m = {start[space::x], start[space::y], start[space::z]};
    const double half_rad = 0.5 * start[space::yaw];
    conditions.start.attitude = {std::cos(half_rad), 0, 0, std::sin(half_rad)};
    std::copy_n(start + space::first_joint, max_joints, conditions.start.joints_rad.begin());
    conditions.world = world;
    conditions.records = true;
    return judge.fly(plan, conditions);
}

}  // namespace downwash::test

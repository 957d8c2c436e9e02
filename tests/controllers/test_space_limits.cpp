#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "../support/random.hpp"
#include "downwash/controllers/space_duration.hpp"
#include "downwash/controllers/space_limits.hpp"
#include "space_motion.hpp"

using namespace downwash;
using test::Random;

namespace {

constexpr double tick_s = 0.01;
constexpr double g_m_s2 = 9.80665;
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// Limits that nothing here breaks.
SpaceMotionLimits wide_limits() {
    SpaceMotionLimits limits;
    limits.max_speed_m_s = limits.max_acceleration_m_s2 = limits.max_jerk_m_s3 = 1e6;
    limits.max_yaw_rate_rad_s = limits.max_yaw_acceleration_rad_s2 = 1e6;
    limits.max_joint_rate_rad_s = limits.max_joint_acceleration_rad_s2 = SpaceMotionLimits::every(1e6);
    return limits;
}

/// A flight of one second from hover with a constant jerk: its acceleration is jerk times time.
SpaceSegment with_jerk(double x, double y, double z) {
    const double jerk[3] = {x, y, z};
    SpacePoint to;
    for (int axis = 0; axis < 3; ++axis) {
        to.position[axis] = jerk[axis] / 6;
        to.velocity[axis] = jerk[axis] / 2;
        to.acceleration[axis] = jerk[axis];
    }
    return {{}, to, 100, tick_s};
}

}  // namespace

TEST_CASE("Limits that are proven hold at dense samples, and a segment that does not keep them breaks one there") {
    Random random(1);
    const SpaceMotionLimits agile = test::agile_space_limits();
    const SpaceMotionLimits gentle;
    int kept = 0;
    int binding[7] = {};
    double most = 0;
    double least_of_broken = 10;
    for (int i = 0; i < 10000; ++i) {
        const SpaceMotionLimits& limits = i % 2 == 0 ? agile : gentle;
        const double size = i % 2 == 0 ? 1 : 0.3;
        const double moving = i % 4 < 2 ? 0 : random.uniform(0, size);
        SpacePoint from = test::random_space_point(random, 3, 2, moving, moving);
        SpacePoint to = test::random_space_point(random, 3, 2, moving, 0.5 * moving);
        if (i % 3 == 0) {  // the translation binds
            for (int axis = space::yaw; axis < test::all_axes; ++axis) {
                to.position[axis] = from.position[axis];
                from.velocity[axis] = to.velocity[axis] = from.acceleration[axis] = to.acceleration[axis] = 0;
            }
        }
        // Around the shortest duration, where limits are kept or broken by little.
        const auto ticks = static_cast<double>(shortest_ticks(from, to, limits, tick_s));
        const SpaceSegment segment(from, to,
                                   std::max<std::int64_t>(1, std::llround(ticks * random.uniform(0.98, 1.02))), tick_s);
        const test::SpaceUse use = test::use_by_samples(segment, limits, 400);
        if (keeps_limits(segment, limits)) {
            most = std::max(most, use.greatest(limits));
            ++kept;
        } else {
            least_of_broken = std::min(least_of_broken, use.greatest(limits));
        }
        const double ratios[7] = {use.speed,     use.acceleration, use.jerk,  use.thrust,
                                  use.tilt_rate, use.yaw,          use.joints};
        ++binding[std::max_element(ratios, ratios + 7) - ratios];
        CHECK(use_of_limits(segment, limits) <= use.greatest(limits) * (1 + 1e-4));
    }
    CHECK(most <= 1 + 1e-9);
    CHECK(least_of_broken > 1 - 2e-4);  // what 400 samples miss of a peak
    CHECK(kept > 3000);
    CHECK(kept < 7000);
    for (const int times : binding) {
        CHECK(times > 20);
    }
}

TEST_CASE("Each limit of a point counts, those of x, y and z together") {
    SpaceMotionLimits limits;
    limits.max_speed_m_s = 3;
    limits.max_acceleration_m_s2 = 3;
    limits.max_thrust_ratio = 1.25;
    SpacePoint point;
    const double velocity[4] = {1, -2, 2, -0.78};
    const double acceleration[4] = {-2, 1, 2, 1.04};
    std::copy_n(velocity, 4, point.velocity);
    std::copy_n(acceleration, 4, point.acceleration);
    point.velocity[space::first_joint + 1] = 0.78;
    point.acceleration[space::first_joint + 2] = -1.57;
    CHECK(keeps_limits(point, limits));
    for (double* value : {&point.velocity[0], &point.velocity[1], &point.velocity[2], &point.velocity[3],
                          &point.velocity[5], &point.acceleration[0], &point.acceleration[1], &point.acceleration[2],
                          &point.acceleration[3], &point.acceleration[6]}) {
        const double before = std::exchange(*value, 1.02 * *value);
        CHECK_FALSE(keeps_limits(point, limits));
        *value = no_number;
        CHECK_FALSE(keeps_limits(point, limits));
        *value = before;
    }
    limits.max_acceleration_m_s2 = 12;
    point.acceleration[space::z] = 0.22 * g_m_s2;
    point.acceleration[space::y] = 0;
    CHECK(keeps_limits(point, limits));
    point.acceleration[space::z] = 0.25 * g_m_s2;  // and 2 m/s2 along x
    CHECK_FALSE(keeps_limits(point, limits));
}

TEST_CASE("The force of a flight tilts as fast as its jerk across it says, in whichever direction") {
    // Hover plus a constant jerk: at the start the force turns at jerk / g, later slower.
    SpaceMotionLimits limits = wide_limits();
    for (const double angle : {0.0, 0.7, 2.0, -2.5}) {
        for (const double rate : {0.1, 1.0, 3.0}) {
            const double jerk = rate * g_m_s2;
            const SpaceSegment segment = with_jerk(jerk * std::cos(angle), jerk * std::sin(angle), 0);
            limits.max_tilt_rate_rad_s = rate * (1 + 1e-7);
            CHECK(keeps_limits(segment, limits));
            CHECK(use_of_limits(segment, limits) == Approx(1));
            limits.max_tilt_rate_rad_s = rate * (1 - 1e-7);
            CHECK_FALSE(keeps_limits(segment, limits));
        }
    }
    // Straight up nothing tilts.
    limits.max_tilt_rate_rad_s = 1e-6;
    CHECK(keeps_limits(with_jerk(0, 0, 50), limits));
}

TEST_CASE("Where a fall leaves no force, or one that points down, the limits of thrust and tilt rate are broken") {
    SpaceMotionLimits limits = wide_limits();
    const SpaceSegment fall = with_jerk(0, 0, -2 * g_m_s2);  // through weightlessness after half a second
    CHECK(keeps_limits(fall, limits));
    limits.max_tilt_rate_rad_s = 1000;  // the force turns over in no time, which its derivative does not show
    CHECK_FALSE(keeps_limits(fall, limits));
    limits.max_tilt_rate_rad_s.reset();
    limits.max_thrust_ratio = 100;
    CHECK_FALSE(keeps_limits(fall, limits));
    CHECK(use_of_limits(fall, limits) == std::numeric_limits<double>::infinity());
    CHECK(keeps_limits(with_jerk(0, 0, -0.999 * g_m_s2), limits));
    CHECK_FALSE(keeps_limits(with_jerk(0, 0, -g_m_s2), limits));
    // Downwards at the ends alone.
    SpacePoint down;
    down.acceleration[space::z] = -1.5 * g_m_s2;
    CHECK_FALSE(keeps_limits(down, limits));
    CHECK_FALSE(keeps_limits(SpaceSegment(down, down, 1, tick_s), limits));
    // Past weightlessness sideways the force turns fast, but does turn.
    limits = wide_limits();
    limits.max_tilt_rate_rad_s = 60;
    CHECK(keeps_limits(with_jerk(0.1 * g_m_s2, 0, -2 * g_m_s2), limits));
    limits.max_tilt_rate_rad_s = 20;
    CHECK_FALSE(keeps_limits(with_jerk(0.1 * g_m_s2, 0, -2 * g_m_s2), limits));
}

TEST_CASE("Nothing moves within any limits, for any time") {
    SpaceMotionLimits limits = test::agile_space_limits();
    SpacePoint here;
    here.position[space::x] = 1e5;
    here.position[space::yaw] = -40;
    for (const std::int64_t ticks : {std::int64_t{1}, std::int64_t{100}, std::int64_t{1} << 40}) {
        CHECK(keeps_limits(SpaceSegment(here, here, ticks, tick_s), limits));
    }
    // A slow drift for an hour, and one that has to come back from far away.
    SpacePoint there = here;
    there.position[space::y] = 3000;
    here.velocity[space::y] = there.velocity[space::y] = 3000 / 3600.0;
    CHECK(keeps_limits(SpaceSegment(here, there, 360000, tick_s), limits));
    here.acceleration[space::y] = 1;
    CHECK_FALSE(keeps_limits(SpaceSegment(here, there, 360000, tick_s), limits));
}

TEST_CASE("What is no number keeps no limit") {
    const SpaceMotionLimits limits;
    for (int axis = 0; axis < test::all_axes; ++axis) {
        for (const double value : {no_number, std::numeric_limits<double>::infinity()}) {
            SpacePoint point;
            point.position[axis] = value;
            CHECK_FALSE(keeps_limits(SpaceSegment(point, {}, 100, tick_s), limits));
            point = {};
            point.velocity[axis] = value;
            CHECK_FALSE(keeps_limits(point, limits));
            CHECK_FALSE(keeps_limits(SpaceSegment({}, point, 100, tick_s), limits));
        }
    }
}

TEST_CASE("Straight up a thrust ratio leaves less acceleration than sideways, in every vertical plane") {
    SpaceMotionLimits agile = wide_limits();
    CHECK(limits_along(agile, {1, 2, 3}).max_acceleration_m_s2 == agile.max_acceleration_m_s2);
    agile.max_thrust_ratio = 1.3;
    CHECK(limits_along(agile, {0, 0, 2}).max_acceleration_m_s2 == Approx(0.3 * g_m_s2));
    CHECK(limits_along(agile, {0, 0, -1}).max_acceleration_m_s2 == Approx(0.3 * g_m_s2));
    CHECK(limits_along(agile, {-3, 4, 0}).max_acceleration_m_s2 == Approx(std::sqrt(0.69) * g_m_s2));
    CHECK(limits_along(agile, {}).max_acceleration_m_s2 == agile.max_acceleration_m_s2);
    agile.max_thrust_ratio = 3;  // a fast fall needs some force, too
    CHECK(limits_along(agile, {0, 0, 1}).max_acceleration_m_s2 < g_m_s2);
    CHECK(max_rate(agile, space::y) == agile.max_speed_m_s);
    CHECK(max_acceleration(agile, space::yaw) == agile.max_yaw_acceleration_rad_s2);
}

TEST_CASE("Limits in every direction keep those of thrust and tilt rate whichever way a reference in space leads") {
    const SpaceMotionLimits agile = test::agile_space_limits();
    const SpaceMotionLimits all = limits_in_every_direction(agile);
    Random random(5);
    SpaceMotionLimits only_force = wide_limits();
    only_force.max_thrust_ratio = agile.max_thrust_ratio;
    only_force.max_tilt_rate_rad_s = agile.max_tilt_rate_rad_s;
    for (int i = 0; i < 300; ++i) {
        const double moving = i % 2 == 0 ? 0 : 0.8;
        const SpacePoint from = test::random_space_point(random, 0, 2, moving, moving);
        const SpacePoint to = test::random_space_point(random, 0, 2, moving, moving);
        SpaceMotionLimits translation = all;
        translation.max_thrust_ratio.reset();
        translation.max_tilt_rate_rad_s.reset();
        const SpaceSegment segment(from, to, shortest_ticks(from, to, translation, tick_s), tick_s);
        if (keeps_limits(segment, translation)) {
            CHECK(keeps_limits(segment, only_force));
        }
    }
}

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "../support/random.hpp"
#include "downwash/controllers/configuration.hpp"
#include "downwash/controllers/reference_segment.hpp"
#include "downwash/controllers/space_duration.hpp"
#include "space_motion.hpp"

using namespace downwash;
using test::Random;

namespace {

constexpr double tick_s = 0.01;

struct Way {
    double along[test::all_axes];
};

Way way_between(const SpacePoint& from, const SpacePoint& to) {
    Way way;
    for (int axis = 0; axis < test::all_axes; ++axis) {
        way.along[axis] = to.position[axis] - from.position[axis];
    }
    return way;
}

SpacePoint point_at(double x_m, double y_m, double z_m) {
    SpacePoint point;
    point.position[space::x] = x_m;
    point.position[space::y] = y_m;
    point.position[space::z] = z_m;
    return point;
}

}  // namespace

TEST_CASE("In space, too, the duration at rest is that of the limit that binds") {
    const SpaceMotionLimits limits;
    const auto duration_s = [&](int axis, double distance) {
        Way way{};
        way.along[axis] = distance;
        return rest_to_rest_duration_s(way.along, limits);
    };
    const double root = std::sqrt(10 / std::sqrt(3.0));
    CHECK(duration_s(space::y, -8) == Approx(15));                            // speed
    CHECK(duration_s(space::z, 0.5) == Approx(root));                         // acceleration
    CHECK(duration_s(space::x, 0.015) == Approx(std::cbrt(60 * 0.015 / 4)));  // jerk
    CHECK(duration_s(space::yaw, -limits.max_yaw_rate_rad_s * 8) == Approx(15));
    CHECK(duration_s(space::yaw, 0.01) == Approx(root * std::sqrt(0.01 / limits.max_yaw_acceleration_rad_s2)));
    for (int joint = 0; joint < max_joints; ++joint) {
        CHECK(duration_s(space::first_joint + joint, limits.max_joint_rate_rad_s[0] * 8) == Approx(15));
    }
    CHECK(duration_s(space::x, 0) == 0);
    CHECK(rest_to_rest_duration_s({3, 4, 12}, limits) == Approx(13.0 * 15 / 8));  // Euclidean
    CHECK(rest_to_rest_duration_s({3, 4, 12, 0.1, 0.1}, limits) == Approx(13.0 * 15 / 8));
}

TEST_CASE("The duration at rest is a metric") {
    Random random(1);
    const SpaceMotionLimits limits = test::agile_space_limits();
    for (int i = 0; i < 3000; ++i) {
        const double size = std::abs(random.magnitude(-3, 1));
        const SpacePoint a = test::random_space_point(random, 3, size, 0, 0);
        const SpacePoint b = test::random_space_point(random, 3, size, 0, 0);
        const SpacePoint c = test::random_space_point(random, 3, size, 0, 0);
        const double direct_s = rest_to_rest_duration_s(way_between(a, c).along, limits);
        const double over_b_s = rest_to_rest_duration_s(way_between(a, b).along, limits) +
                                rest_to_rest_duration_s(way_between(b, c).along, limits);
        CHECK(direct_s <= over_b_s * (1 + 1e-12));
        CHECK(direct_s == rest_to_rest_duration_s(way_between(c, a).along, limits));
    }
}

TEST_CASE("The shortest motion from rest to rest is the closed form, rounded up, and one tick less breaks a limit") {
    Random random(2);
    SpaceMotionLimits agile = test::agile_space_limits();
    agile.max_tilt_rate_rad_s.reset();
    for (int i = 0; i < 2000; ++i) {
        const SpaceMotionLimits& limits = i % 2 == 0 ? agile : SpaceMotionLimits{};
        const double size = std::abs(random.magnitude(-3, 1));
        const SpacePoint from = test::random_space_point(random, 2, size, 0, 0);
        SpacePoint to = test::random_space_point(random, 2, size, 0, 0);
        if (i % 3 == 0) {
            std::copy_n(from.position + space::yaw, test::all_axes - space::yaw, to.position + space::yaw);
        }
        const Way way = way_between(from, to);
        const double duration_s = rest_to_rest_duration_s(way.along, limits_along(limits, way.along));
        const std::int64_t ticks = shortest_ticks(from, to, limits, tick_s);
        CHECK(static_cast<double>(ticks) * tick_s >= duration_s - 1e-11);
        CHECK(static_cast<double>(ticks - 1) * tick_s < duration_s);
        CHECK(keeps_limits(SpaceSegment(from, to, ticks, tick_s), limits));
        CHECK((ticks == 1 || !keeps_limits(SpaceSegment(from, to, ticks - 1, tick_s), limits)));
        CHECK(ticks == shortest_ticks(to, from, limits, tick_s));
    }
}

TEST_CASE("A whole number of ticks that is just enough is enough") {
    SpaceMotionLimits limits;
    for (int ticks = 200; ticks < 1200; ticks += 7) {
        const double distance_m = ticks * tick_s * limits.max_speed_m_s / (15.0 / 8.0);
        limits.max_acceleration_m_s2 = 100;
        limits.max_jerk_m_s3 = 1000;
        CHECK(shortest_ticks({}, point_at(0.48 * distance_m, 0.6 * distance_m, 0.64 * distance_m), limits, tick_s) ==
              ticks);
    }
}

TEST_CASE("From and to moving ends the limits are kept, and no shorter motion keeps them") {
    Random random(3);
    const SpaceMotionLimits agile = test::agile_space_limits();
    const SpaceMotionLimits gentle;
    int found = 0;
    int none = 0;
    for (int i = 0; i < 600; ++i) {
        const SpaceMotionLimits& limits = i % 2 == 0 ? agile : gentle;
        const double speed = i % 2 == 0 ? 2.2 : 0.55;
        const double acceleration = i % 3 == 0 ? 0 : (i % 2 == 0 ? 5 : 0.28);
        const SpacePoint from = test::random_space_point(random, 1, 2, speed, acceleration);
        const SpacePoint to = test::random_space_point(random, 1, 2, i % 4 == 0 ? 0 : speed, acceleration);
        if (!keeps_limits(from, limits) || !keeps_limits(to, limits)) {
            continue;
        }
        constexpr double long_tick_s = 0.02;
        const std::int64_t ticks = shortest_ticks(from, to, limits, long_tick_s);
        const auto keeps_in = [&](std::int64_t count) {
            return keeps_limits(SpaceSegment(from, to, count, long_tick_s), limits);
        };
        if (keeps_in(ticks)) {
            ++found;
            bool is_shorter_enough = false;
            for (std::int64_t count = 1; count < ticks; ++count) {
                is_shorter_enough = is_shorter_enough || keeps_in(count);
            }
            CHECK_FALSE(is_shorter_enough);
        } else {
            ++none;
            bool is_any_enough = false;
            for (std::int64_t count = 1; count < 3000; ++count) {
                is_any_enough = is_any_enough || keeps_in(count);
            }
            CHECK_FALSE(is_any_enough);
        }
    }
    CHECK(found > 300);
    CHECK(none > 3);
}

TEST_CASE("A vehicle at its greatest speed that flies straight on is not slowed down") {
    SpaceMotionLimits limits;
    SpacePoint from = point_at(0, 0, 1);
    from.velocity[space::y] = limits.max_speed_m_s;
    SpacePoint to = from;
    to.position[space::y] = 0.1;
    CHECK(shortest_ticks(from, to, limits, tick_s) == 10);
    CHECK(keeps_limits(SpaceSegment(from, to, 10, tick_s), limits));
}

TEST_CASE("A start that no duration can mend in space is not flown at a crawl") {
    SpaceMotionLimits limits;
    SpacePoint from;
    from.velocity[space::x] = limits.max_speed_m_s;
    from.acceleration[space::x] = limits.max_acceleration_m_s2;
    const SpacePoint to = point_at(2, 2, 1);
    const std::int64_t ticks = shortest_ticks(from, to, limits, tick_s);
    CHECK(static_cast<double>(ticks) * tick_s < 8);
    const auto use_in = [&](std::int64_t count) {
        return use_of_limits(SpaceSegment(from, to, count, tick_s), limits);
    };
    CHECK(use_in(ticks) < 1.5);
    for (const std::int64_t other : {ticks / 2, ticks * 3 / 4, ticks * 5 / 4, ticks * 2, ticks * 4}) {
        CHECK(use_in(ticks) <= use_in(other));
    }
}

TEST_CASE("In the plane of motion, motions in space take as long as planar ones") {
    Random random(4);
    const MotionLimits planar_limits[2] = {{1, 0.5, 0.785, 1.57, 4, {}, {}}, {3.9, 9, 10, 100, 200, 1.3, 5}};
    for (int i = 0; i < 1000; ++i) {
        const MotionLimits& planar = planar_limits[i % 2];
        SpaceMotionLimits limits;
        limits.max_speed_m_s = planar.max_speed_m_s;
        limits.max_acceleration_m_s2 = planar.max_acceleration_m_s2;
        limits.max_jerk_m_s3 = planar.max_jerk_m_s3;
        limits.max_thrust_ratio = planar.max_thrust_ratio;
        limits.max_tilt_rate_rad_s = planar.max_pitch_rate_rad_s;
        limits.max_joint_rate_rad_s = SpaceMotionLimits::every(planar.max_arm_rate_rad_s);
        limits.max_joint_acceleration_rad_s2 = SpaceMotionLimits::every(planar.max_arm_acceleration_rad_s2);
        ReferencePoint ends[2];
        SpacePoint ends_in_space[2];
        for (int end = 0; end < 2; ++end) {
            for (int axis = 0; axis < 3; ++axis) {
                const int in_space = axis == 0 ? space::x : axis == 1 ? space::z : space::first_joint;
                ends[end].position[axis] = ends_in_space[end].position[in_space] = random.uniform(-3, 3);
                const double speed = i % 4 < 2 ? 0 : random.uniform(-0.5, 0.5);
                ends[end].velocity[axis] = ends_in_space[end].velocity[in_space] = speed;
            }
        }
        const auto ticks = static_cast<double>(shortest_ticks(ends[0], ends[1], planar, tick_s));
        const auto in_space = static_cast<double>(shortest_ticks(ends_in_space[0], ends_in_space[1], limits, tick_s));
        if (is_at_rest(ends[0]) && is_at_rest(ends[1]) && !planar.max_pitch_rate_rad_s) {
            CHECK(in_space == ticks);
        } else {
            // Planar limits are checked at samples, and its search begins with half of the duration at rest.
            CHECK(in_space <= 1.01 * ticks + 1);
            if (is_at_rest(ends[0]) && is_at_rest(ends[1])) {
                CHECK(in_space >= ticks);
            }
        }
    }
}

TEST_CASE("Durations of impossible and of endless motions are numbers all the same") {
    const SpaceMotionLimits limits = test::agile_space_limits();
    constexpr double infinite = std::numeric_limits<double>::infinity();
    CHECK(shortest_ticks({}, {}, limits, tick_s) == 1);
    CHECK(shortest_ticks({}, {}, SpaceMotionLimits{}, tick_s) == 1);
    CHECK(shortest_ticks({}, point_at(1e9, 0, 0), limits, tick_s) ==
          std::llround(std::ceil(15.0 / 8 * 1e9 / limits.max_speed_m_s / tick_s)));
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), infinite, -infinite, 1e300}) {
        for (const bool is_velocity : {false, true}) {
            SpacePoint strange;
            (is_velocity ? strange.velocity : strange.position)[space::y] = value;
            const std::int64_t ticks = shortest_ticks({}, strange, limits, tick_s);
            CHECK(ticks >= 1);
            CHECK_FALSE(keeps_limits(SpaceSegment({}, strange, ticks, tick_s), limits));
        }
    }
    // Straight down, as fast as a vehicle falls that still has to be held upright.
    SpaceMotionLimits fall = limits;
    fall.max_acceleration_m_s2 = 100;
    fall.max_jerk_m_s3 = 1000;
    fall.max_speed_m_s = 100;
    fall.max_thrust_ratio = 10;
    const std::int64_t ticks = shortest_ticks({}, point_at(0, 0, -5), fall, tick_s);
    CHECK(keeps_limits(SpaceSegment({}, point_at(0, 0, -5), ticks, tick_s), fall));
    CHECK(static_cast<double>(ticks) * tick_s ==
          Approx(std::sqrt(10 / std::sqrt(3.0) * 5 / (0.99 * 9.80665))).margin(tick_s));
}

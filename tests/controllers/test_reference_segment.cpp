#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "../support/random.hpp"
#include "downwash/controllers/configuration.hpp"
#include "downwash/controllers/reference_segment.hpp"

using namespace downwash;
using test::Random;

namespace {

constexpr double tick_s = 0.01;
constexpr MotionLimits limits{1.0, 0.5, 0.785, 1.57, 4, {}, {}};

ReferencePoint rest_at(double x_m, double z_m, double arm_rad) {
    return at_rest({x_m, z_m, arm_rad});
}

ReferencePoint random_rest(Random& random) {
    const double x_m = random.uniform(-3, 3);
    const double z_m = random.uniform(-3, 3);
    return rest_at(x_m, z_m, random.uniform(-3, 3));
}

ReferencePoint random_point(Random& random) {
    ReferencePoint point;
    for (int axis = 0; axis < 3; ++axis) {
        point.position[axis] = random.uniform(-3, 3);
        point.velocity[axis] = random.uniform(-1, 1);
        point.acceleration[axis] = random.uniform(-1, 1);
    }
    return point;
}

double length(const double axis[3]) {
    return std::hypot(axis[0], axis[1]);
}

/// The third derivative by time, at many places.
double largest_jerk(const ReferenceSegment& segment) {
    double largest = 0;
    for (int i = 0; i <= 1000; ++i) {
        const double s = i / 1000.0;
        double jerk[3] = {};
        for (int axis = 0; axis < 2; ++axis) {
            const double* c = segment.coefficients()[axis];
            jerk[axis] = (6 * c[3] + 24 * c[4] * s + 60 * c[5] * s * s) / std::pow(segment.duration_s(), 3);
        }
        largest = std::max(largest, length(jerk));
    }
    return largest;
}

/// The greatest of speeds, accelerations and jerks over their limits; of speeds and accelerations at every tick between
/// the ends.
double use_of_limits(const ReferenceSegment& segment) {
    double worst = largest_jerk(segment) / limits.max_jerk_m_s3;
    for (std::int64_t tick = 1; tick < segment.ticks(); ++tick) {
        const ReferencePoint p = segment.at_tick(tick);
        worst = std::max({worst, length(p.velocity) / limits.max_speed_m_s,
                          length(p.acceleration) / limits.max_acceleration_m_s2,
                          std::abs(p.velocity[2]) / limits.max_arm_rate_rad_s,
                          std::abs(p.acceleration[2]) / limits.max_arm_acceleration_rad_s2});
    }
    return worst;
}

/// A start that a flight along some earlier reference could have left, well within the limits.
ReferencePoint moving_start(Random& random) {
    ReferencePoint point = rest_at(0, 0, random.uniform(-3, 3));
    const double direction = random.uniform(-3.2, 3.2);
    const double speed = random.uniform(0.05, 0.8);
    point.velocity[0] = speed * std::cos(direction);
    point.velocity[1] = speed * std::sin(direction);
    point.velocity[2] = random.uniform(-0.6, 0.6);
    return point;
}

}  // namespace

TEST_CASE("A segment begins and ends in exactly its two points") {
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const ReferencePoint from = random_point(random);
        const ReferencePoint to = random_point(random);
        const std::int64_t ticks = random.integer(1, 500);
        const ReferenceSegment segment(from, to, ticks, tick_s);
        CHECK(segment.at_tick(0) == from);
        CHECK(segment.at_tick(ticks) == to);
        CHECK(segment.duration_s() == Approx(static_cast<double>(ticks) * tick_s));
    }
}

TEST_CASE("The polynomial itself meets position, velocity and acceleration at both ends") {
    // One tick of a very fine grid from each end, carried over by a Taylor step.
    Random random(2);
    constexpr std::int64_t ticks = 1'000'000;
    constexpr double fine_s = 2e-6;
    double worst = 0;
    for (int i = 0; i < 200; ++i) {
        const ReferencePoint ends[2] = {random_point(random), random_point(random)};
        const ReferenceSegment segment(ends[0], ends[1], ticks, fine_s);
        const ReferencePoint beside[2] = {segment.at_tick(1), segment.at_tick(ticks - 1)};
        for (int end = 0; end < 2; ++end) {
            const double h = end == 0 ? fine_s : -fine_s;
            for (int axis = 0; axis < 3; ++axis) {
                const ReferencePoint& at = ends[end];
                worst = std::max(
                    {worst, std::abs(beside[end].position[axis] - (at.position[axis] + h * at.velocity[axis])) / 1e-9,
                     std::abs(beside[end].velocity[axis] - (at.velocity[axis] + h * at.acceleration[axis])) / 1e-7,
                     std::abs(beside[end].acceleration[axis] - at.acceleration[axis]) / 1e-3});
            }
        }
    }
    CHECK(worst < 1);
}

TEST_CASE("Velocity and acceleration are the derivatives of the position") {
    Random random(3);
    double worst = 0;
    for (int i = 0; i < 100; ++i) {
        const ReferenceSegment segment(random_point(random), random_point(random), 2000, 1e-3);
        for (std::int64_t tick = 1; tick < 2000; tick += 37) {
            const ReferencePoint before = segment.at_tick(tick - 1);
            const ReferencePoint here = segment.at_tick(tick);
            const ReferencePoint after = segment.at_tick(tick + 1);
            for (int axis = 0; axis < 3; ++axis) {
                const double velocity = (after.position[axis] - before.position[axis]) / 2e-3;
                const double acceleration = (after.velocity[axis] - before.velocity[axis]) / 2e-3;
                worst = std::max({worst, std::abs(velocity - here.velocity[axis]),
                                  std::abs(acceleration - here.acceleration[axis])});
            }
        }
    }
    CHECK(worst < 1e-4);  // the difference quotients' own error, second order in 1 ms
}

TEST_CASE("Between points at rest the reference is a straight line that all axes pass together") {
    Random random(4);
    for (int i = 0; i < 50; ++i) {
        const ReferencePoint from = random_rest(random);
        const ReferencePoint to = random_rest(random);
        const std::int64_t ticks = shortest_ticks(from, to, limits, tick_s);
        const ReferenceSegment segment(from, to, ticks, tick_s);
        for (std::int64_t tick = 0; tick <= ticks; tick += 7) {
            const double t = static_cast<double>(tick) / static_cast<double>(ticks);
            const double s = t * t * t * (10 + t * (-15 + 6 * t));
            const ReferencePoint p = segment.at_tick(tick);
            for (int axis = 0; axis < 3; ++axis) {
                const double expected = from.position[axis] + s * (to.position[axis] - from.position[axis]);
                CHECK(std::abs(p.position[axis] - expected) < 1e-12);
            }
        }
    }
}

TEST_CASE("The shortest segment between points at rest touches a limit and breaks none") {
    Random random(5);
    for (int i = 0; i < 500; ++i) {
        const double size = std::abs(random.magnitude(-2, 1));
        const ReferencePoint from = rest_at(0, 1, 0.3);
        const ReferencePoint to =
            rest_at(size * random.uniform(-1, 1), 1 + size * random.uniform(-1, 1), 0.3 + size * random.uniform(-1, 1));
        const std::int64_t ticks = shortest_ticks(from, to, limits, tick_s);
        REQUIRE(ticks >= 2);
        CHECK(use_of_limits(ReferenceSegment(from, to, ticks, tick_s)) <= 1 + 1e-9);
        // By the peaks of the quintic between its ticks one tick less is too fast.
        const double distance = std::hypot(to.position[0] - from.position[0], to.position[1] - from.position[1]);
        const double arm = std::abs(to.position[2] - from.position[2]);
        const double duration_s = rest_to_rest_duration_s(distance, arm, limits);
        CHECK(static_cast<double>(ticks) * tick_s >= duration_s - 1e-9);
        CHECK(static_cast<double>(ticks - 1) * tick_s < duration_s);
    }
}

TEST_CASE("The duration at rest is that of the limit that binds") {
    CHECK(rest_to_rest_duration_s(8, 0, limits) == Approx(15));                                // speed
    CHECK(rest_to_rest_duration_s(0.5, 0, limits) == Approx(std::sqrt(10 / std::sqrt(3.0))));  // acceleration
    CHECK(rest_to_rest_duration_s(0.015, 0, limits) == Approx(std::cbrt(60 * 0.015 / 4)));     // jerk
    CHECK(rest_to_rest_duration_s(0, 0.785 * 8, limits) == Approx(15));
    CHECK(rest_to_rest_duration_s(0, 0.157, limits) == Approx(std::sqrt(1 / std::sqrt(3.0))));
    CHECK(rest_to_rest_duration_s(0, 0, limits) == 0);
}

TEST_CASE("The limit of translation is Euclidean, not per axis, and going nowhere takes one tick") {
    CHECK(shortest_ticks(rest_at(0, 0, 0), rest_at(5, 0, 0), limits, tick_s) ==
          shortest_ticks(rest_at(0, 0, 0), rest_at(3, 4, 0), limits, tick_s));
    CHECK(shortest_ticks(rest_at(1, 2, 3), rest_at(1, 2, 3), limits, tick_s) == 1);
}

TEST_CASE("A point keeps the limits up to them, its speed and acceleration in the plane taken together") {
    ReferencePoint point = rest_at(1, 2, 3);
    CHECK(keeps_limits(point, limits));
    point.velocity[0] = 0.6;
    point.velocity[1] = -0.8;
    point.acceleration[2] = -1.57;
    CHECK(keeps_limits(point, limits));
    for (double* value : {&point.velocity[0], &point.velocity[1], &point.acceleration[2]}) {
        const double before = std::exchange(*value, 1.01 * *value);
        CHECK_FALSE(keeps_limits(point, limits));
        *value = before;
    }
}

TEST_CASE("From a moving start the limits are kept all the way, and one tick less would break a limit") {
    Random random(6);
    double worst = 0;
    int slack = 0;
    for (int i = 0; i < 4000; ++i) {
        const ReferencePoint from = moving_start(random);
        const ReferencePoint to = random_rest(random);
        const std::int64_t ticks = shortest_ticks(from, to, limits, tick_s);
        worst = std::max(worst, use_of_limits(ReferenceSegment(from, to, ticks, tick_s)));
        slack += ticks > 1 && use_of_limits(ReferenceSegment(from, to, ticks - 1, tick_s)) < 1 ? 1 : 0;
    }
    CHECK(worst < 1.01);
    CHECK(slack == 0);
}

TEST_CASE("A short correction of a moving start is not stretched to the sampling of its limits") {
    ReferencePoint from = rest_at(0, 0, 0);
    from.velocity[0] = 0.01;
    const std::int64_t ticks = shortest_ticks(from, rest_at(0.001, 0, 0), limits, tick_s);
    CHECK(ticks < 20);
    CHECK(use_of_limits(ReferenceSegment(from, rest_at(0.001, 0, 0), ticks, tick_s)) <= 1 + 1e-9);
}

TEST_CASE("A start at a limit, to the last bit beyond it, can still be left") {
    ReferencePoint from = rest_at(0, 0, 0);
    from.velocity[0] = std::nextafter(limits.max_speed_m_s, 2);
    const std::int64_t ticks = shortest_ticks(from, rest_at(3, 0, 0), limits, tick_s);
    CHECK(use_of_limits(ReferenceSegment(from, rest_at(3, 0, 0), ticks, tick_s)) < 1.003);
    CHECK(static_cast<double>(ticks) * tick_s < 8);
}

TEST_CASE("A start that no duration can mend is not flown at a crawl") {
    // Already at the speed limit and still accelerating.
    ReferencePoint from = rest_at(0, 0, 0);
    from.velocity[0] = limits.max_speed_m_s;
    from.acceleration[0] = limits.max_acceleration_m_s2;
    const std::int64_t ticks = shortest_ticks(from, rest_at(3, 0, 0), limits, tick_s);
    const double use = use_of_limits(ReferenceSegment(from, rest_at(3, 0, 0), ticks, tick_s));
    CHECK(static_cast<double>(ticks) * tick_s < 8);
    for (const std::int64_t other : {ticks / 2, ticks * 3 / 4, ticks * 5 / 4, ticks * 2, ticks * 4}) {
        CHECK(use <= use_of_limits(ReferenceSegment(from, rest_at(3, 0, 0), other, tick_s)));
    }
}

namespace {

/// Those of a planar rotor that can give 1.3 times its weight.
MotionLimits agile_limits() {
    MotionLimits agile{3.9, 14, 10, 100, 500, {}, {}};
    agile.max_thrust_ratio = 1.3;
    agile.max_pitch_rate_rad_s = 5;
    return agile;
}

constexpr double g_m_s2 = 9.80665;

/// The greatest force of a point mass over its weight, and the greatest turn of that force in a tick over the limit.
std::pair<double, double> use_of_agile_limits(const ReferenceSegment& segment, const MotionLimits& agile) {
    double ratio = 0;
    double turn = 0;
    double before_rad = 0;
    for (std::int64_t tick = 0; tick <= segment.ticks(); ++tick) {
        const ReferencePoint point = segment.at_tick(tick);
        const double up = point.acceleration[1] + g_m_s2;
        ratio = std::max(ratio, std::hypot(point.acceleration[0], up) / g_m_s2);
        const double pitch_rad = std::atan2(point.acceleration[0], up);
        CHECK(pitch_along(point) == Approx(pitch_rad).margin(1e-9));
        if (tick > 0) {
            turn = std::max(turn, std::abs(pitch_rad - before_rad) / tick_s / *agile.max_pitch_rate_rad_s);
        }
        before_rad = pitch_rad;
    }
    return {ratio / *agile.max_thrust_ratio, turn};
}

}  // namespace

TEST_CASE("agile segments keep thrust and pitch rate at every tick, and hardly less time breaks a limit") {
    Random random(11);
    const MotionLimits agile = agile_limits();
    int moving = 0;
    for (int i = 0; i < 200; ++i) {
        const ReferencePoint from = random_rest(random);
        ReferencePoint to = random_rest(random);
        to.position[2] = from.position[2];
        if (i % 2 == 1) {
            to.velocity[0] = random.uniform(-2, 2);
            to.acceleration[1] = random.uniform(-4, 2);
        }
        const std::int64_t ticks = shortest_ticks(from, to, agile, tick_s);
        const ReferenceSegment segment(from, to, ticks, tick_s);
        if (!keeps_limits(segment, agile)) {
            REQUIRE(i % 2 == 1);  // out of reach at that speed
            continue;
        }
        moving += i % 2;
        const auto [ratio, turn] = use_of_agile_limits(segment, agile);
        CHECK(ratio <= 1.003);
        CHECK(turn <= 1.01);
        // The limits are checked at samples.
        CHECK_FALSE(keeps_limits(ReferenceSegment(from, to, ticks - 1 - ticks / 100, tick_s), agile));
    }
    CHECK(moving > 50);
}

TEST_CASE("straight up a thrust ratio of 1.3 leaves 0.3 g, sideways the tilt of 39.7 degrees") {
    MotionLimits agile{100, 100, 10, 100, 10000, {}, {}};
    agile.max_thrust_ratio = 1.3;
    CHECK(limits_along(agile, {0, 2}).max_acceleration_m_s2 == Approx(0.3 * g_m_s2));
    CHECK(limits_along(agile, {0, -1}).max_acceleration_m_s2 == Approx(0.3 * g_m_s2));
    CHECK(limits_along(agile, {-3, 0}).max_acceleration_m_s2 == Approx(std::sqrt(0.69) * g_m_s2));
    CHECK(limits_along(limits, {1, 2}).max_acceleration_m_s2 == limits.max_acceleration_m_s2);
    // Without a limit of the pitch rate the fastest motion from rest to rest is known: peak 10 / sqrt(3) d / t^2.
    const double duration_s = std::sqrt(10 / std::sqrt(3.0) / (0.3 * g_m_s2));
    CHECK(shortest_ticks(rest_at(0, 0, 0), rest_at(0, 1, 0), agile, tick_s) ==
          std::llround(std::ceil(duration_s / tick_s)));
    // A fast fall needs some force, too.
    agile.max_thrust_ratio = 3;
    CHECK(limits_along(agile, {0, 1}).max_acceleration_m_s2 < g_m_s2);
}

TEST_CASE("limits in every direction keep those of thrust and pitch rate whichever way a reference leads") {
    const MotionLimits agile = agile_limits();
    const MotionLimits all = limits_in_every_direction(agile);
    for (int i = 0; i < 36; ++i) {
        const double angle = i * 0.1745;
        const double x = all.max_acceleration_m_s2 * std::cos(angle);
        const double up = g_m_s2 + all.max_acceleration_m_s2 * std::sin(angle);
        CHECK(std::hypot(x, up) <= 1.3 * g_m_s2 * (1 + 1e-9));
        CHECK(all.max_jerk_m_s3 / std::hypot(x, up) <= *agile.max_pitch_rate_rad_s * (1 + 1e-9));
    }
    CHECK(limits_in_every_direction(limits).max_acceleration_m_s2 == limits.max_acceleration_m_s2);
    CHECK(limits_in_every_direction(limits).max_jerk_m_s3 == limits.max_jerk_m_s3);
}

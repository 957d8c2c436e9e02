#include "downwash/exports/setpoints.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "downwash/base/key_error.hpp"

using namespace downwash;

namespace {

constexpr double tick_s = 0.01;

/// From rest through a moving point to rest.
Plan curved_plan() {
    Plan plan;
    plan.tick_s = tick_s;
    plan.reference = {{0, {}}, {300, {{2, 1, 0.5}, {0.8, 0.1, -0.2}, {0.1, 0, 0.3}}}, {700, at_rest({4, 0.5, -1})}};
    return plan;
}

}  // namespace

TEST_CASE("set-points at the controller's rate are the reference that is flown") {
    const Plan plan = curved_plan();
    const auto points = setpoints(plan, PlaneOfMotion(), 9, 1 / tick_s);
    REQUIRE(points.size() == 901);
    for (std::size_t knot = 0; knot < 2; ++knot) {
        const ReferenceKnot& from = plan.reference[knot];
        const ReferenceKnot& to = plan.reference[knot + 1];
        const ReferenceSegment segment(from.point, to.point, to.tick - from.tick, tick_s);
        for (std::int64_t tick = 0; tick < segment.ticks(); ++tick) {
            const ReferencePoint expected = segment.at_tick(tick);
            const Setpoint& point = points[static_cast<std::size_t>(from.tick + tick)];
            REQUIRE(point.t_s == Approx(tick_s * static_cast<double>(from.tick + tick)));
            REQUIRE(point.position_m[0] == Approx(expected.position[0]).margin(1e-9));
            REQUIRE(point.position_m[2] == Approx(expected.position[1]).margin(1e-9));
            REQUIRE(point.joints[0].angle_rad == Approx(expected.position[2]).margin(1e-9));
            REQUIRE(point.velocity_m_s[0] == Approx(expected.velocity[0]).margin(1e-9));
            REQUIRE(point.acceleration_m_s2[2] == Approx(expected.acceleration[1]).margin(1e-9));
        }
    }
    CHECK(points.back().position_m == Vector3{4, 0, 0.5});
    CHECK(points.back().velocity_m_s == Vector3{0, 0, 0});
}

TEST_CASE("set-points at any rate are derivatives of each other and end where the flight does") {
    const double rate_hz = GENERATE(3.3, 50., 999.);
    const auto points = setpoints(curved_plan(), PlaneOfMotion(), 8.123, rate_hz);
    CHECK(points.front().t_s == 0);
    CHECK(points.back().t_s == 8.123);
    CHECK(points.size() == static_cast<std::size_t>(std::ceil(8.123 * rate_hz)) + 1);
    if (rate_hz > 900) {
        for (std::size_t i = 1; i + 1 < points.size() - 1; ++i) {
            const double slope = (points[i + 1].position_m[0] - points[i - 1].position_m[0]) * rate_hz / 2;
            REQUIRE(points[i].velocity_m_s[0] == Approx(slope).margin(2e-3));
            const double arm_slope =
                (points[i + 1].joints[0].rate_rad_s - points[i - 1].joints[0].rate_rad_s) * rate_hz / 2;
            REQUIRE(points[i].joints[0].acceleration_rad_s2 == Approx(arm_slope).margin(2e-2));
        }
    }
}

TEST_CASE("set-points stand in the world, whatever the plane's heading") {
    const PlaneOfMotion plane({10, 20, 30}, 0.7);
    const auto level = setpoints(curved_plan(), PlaneOfMotion(), 0, 20);
    const auto turned = setpoints(curved_plan(), plane, 0, 20);
    REQUIRE(level.size() == turned.size());
    for (std::size_t i = 0; i < level.size(); ++i) {
        const Vector3 expected = plane.to_world(level[i].position_m[0], 0, level[i].position_m[2]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            REQUIRE(turned[i].position_m[axis] == Approx(expected[axis]));
        }
        REQUIRE(turned[i].velocity_m_s[1] == Approx(level[i].velocity_m_s[0] * std::sin(0.7)).margin(1e-12));
        REQUIRE(turned[i].yaw_rad == 0.7);
    }
}

TEST_CASE("rates that make no sense are errors") {
    for (const double rate_hz : {0., -1., 1e5, std::numeric_limits<double>::quiet_NaN()}) {
        CHECK_THROWS_AS(setpoints(curved_plan(), PlaneOfMotion(), 0, rate_hz), InputError);
    }
    CHECK_THROWS_AS(setpoints(curved_plan(), PlaneOfMotion(), 3600, 1000), InputError);
}

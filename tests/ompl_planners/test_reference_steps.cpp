#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "downwash/ompl_planners/reference_steps.hpp"

using namespace downwash;
using planning::ReferenceSteps;

namespace {

constexpr MotionLimits limits{1.0, 0.5, 0.75, 1.5, 4, {}, {}};
constexpr double still[3] = {0, 0, 0};

}  // namespace

TEST_CASE("a step is the whole number of ticks nearest to half a second") {
    CHECK(ReferenceSteps(planar_axes, limits, 0.01).ticks() == 50);
    CHECK(ReferenceSteps(planar_axes, limits, 0.01).duration_s() == Approx(0.5));
    CHECK(ReferenceSteps(planar_axes, limits, 0.3).ticks() == 2);
    CHECK(ReferenceSteps(planar_axes, limits, 2.0).ticks() == 1);
}

TEST_CASE("from rest a step gains two thirds of what the greatest acceleration would") {
    MotionLimits any_jerk = limits;
    any_jerk.max_jerk_m_s3 = 100;
    const ReferenceSteps steps(planar_axes, any_jerk, 0.01);
    const double wanted[3] = {10, 0, -10};
    const ReferencePoint next = steps.after(ReferencePoint{}, wanted);
    CHECK(next.velocity[0] == Approx(1.0 / 6));
    CHECK(next.velocity[1] == 0);
    CHECK(next.velocity[2] == Approx(-0.5));
    CHECK(next.position[0] == Approx(1.0 / 24));
    CHECK(next.position[2] == Approx(-0.125));
    CHECK(next.acceleration[0] == 0);
    const ReferenceSegment segment(ReferencePoint{}, next, steps.ticks(), 0.01);
    CHECK(segment.at_tick(25).acceleration[0] == Approx(0.5));
    CHECK(segment.at_tick(25).acceleration[2] == Approx(-1.5));
}

TEST_CASE("from rest a step gains a sixth of what the greatest jerk would in its time squared") {
    MotionLimits smooth = limits;
    smooth.max_jerk_m_s3 = 1.2;
    const ReferenceSteps steps(planar_axes, smooth, 0.01);
    const double wanted[3] = {10, 0, 0};
    const ReferencePoint next = steps.after(ReferencePoint{}, wanted);
    CHECK(next.velocity[0] == Approx(1.2 * 0.5 * 0.5 / 6));
    CHECK(ReferenceSegment(ReferencePoint{}, next, steps.ticks(), 0.01).peak_jerk_m_s3() == Approx(1.2));
}

TEST_CASE("whatever is asked for, every tick keeps the limits") {
    const ReferenceSteps steps(planar_axes, limits, 0.01);
    test::Random random(7);
    ReferencePoint point;
    double fastest = 0;
    for (int i = 0; i < 500; ++i) {
        const double wanted[3] = {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-2, 2)};
        const ReferencePoint next = steps.after(point, wanted);
        const ReferenceSegment segment(point, next, steps.ticks(), 0.01);
        for (int tick = 0; tick <= 50; ++tick) {
            const ReferencePoint p = segment.at_tick(tick);
            fastest = std::max(fastest, std::hypot(p.velocity[0], p.velocity[1]));
            CHECK(std::hypot(p.acceleration[0], p.acceleration[1]) <= 0.5 + 1e-9);
            CHECK(std::abs(p.velocity[2]) <= 0.75 + 1e-9);
            CHECK(std::abs(p.acceleration[2]) <= 1.5 + 1e-9);
        }
        point = next;
    }
    CHECK(fastest <= 1 + 1e-9);
    CHECK(fastest > 0.5);
}

TEST_CASE("the place of rest is where braking step by step ends") {
    const ReferenceSteps steps(planar_axes, limits, 0.01);
    test::Random random(8);
    for (int i = 0; i < 100; ++i) {
        ReferencePoint point;
        for (int axis = 0; axis < 3; ++axis) {
            point.position[axis] = random.uniform(-5, 5);
            point.velocity[axis] = random.uniform(-0.7, 0.7);
        }
        const Configuration rest = steps.rest_of(point);
        const double ticks = steps.braking_ticks(point);
        int braked = 0;
        for (; point.velocity[0] != 0 || point.velocity[1] != 0 || point.velocity[2] != 0; ++braked) {
            point = steps.after(point, still);
        }
        CHECK(rest[plane::x] == Approx(point.position[0]).margin(1e-12));
        CHECK(rest[plane::z] == Approx(point.position[1]).margin(1e-12));
        CHECK(rest[plane::arm] == Approx(point.position[2]).margin(1e-12));
        CHECK(ticks == 50 * braked);
    }
    CHECK(steps.braking_ticks(ReferencePoint{}) == 0);
}

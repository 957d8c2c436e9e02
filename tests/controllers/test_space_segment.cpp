#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "downwash/controllers/reference_segment.hpp"
#include "downwash/controllers/space_segment.hpp"
#include "space_motion.hpp"

using namespace downwash;
using test::Random;

namespace {

constexpr double tick_s = 0.01;

/// The axes in space of those in the plane: x, z and the first joint.
constexpr int axis_in_space[3] = {space::x, space::z, space::first_joint};

ReferencePoint in_plane(const SpacePoint& point) {
    ReferencePoint planar;
    for (int axis = 0; axis < 3; ++axis) {
        planar.position[axis] = point.position[axis_in_space[axis]];
        planar.velocity[axis] = point.velocity[axis_in_space[axis]];
        planar.acceleration[axis] = point.acceleration[axis_in_space[axis]];
    }
    return planar;
}

}  // namespace

TEST_CASE("A segment in space begins and ends in exactly its two points") {
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const SpacePoint from = test::random_space_point(random, 6, 3, 1, 1);
        const SpacePoint to = test::random_space_point(random, 6, 3, 1, 1);
        const int ticks = random.integer(1, 500);
        const SpaceSegment segment(from, to, ticks, tick_s);
        CHECK(segment.at_tick(0) == from);
        CHECK(segment.at_tick(ticks) == to);
        CHECK(segment.ticks() == ticks);
        CHECK(segment.duration_s() == Approx(ticks * tick_s));
    }
}

TEST_CASE("The polynomials of a segment in space meet both ends and are the derivatives of each other") {
    Random random(2);
    double worst_end = 0;
    double worst_slope = 0;
    for (int i = 0; i < 200; ++i) {
        const SpacePoint from = test::random_space_point(random, 6, 3, 1, 1);
        const SpacePoint to = test::random_space_point(random, 6, 3, 1, 1);
        const SpaceSegment segment(from, to, 200, tick_s);
        const SpacePoint begin = segment.at(0);
        const SpacePoint end = segment.at(1);
        const double s = random.uniform(0.01, 0.99);
        constexpr double h = 1e-4;
        const SpacePoint before = segment.at(s - h);
        const SpacePoint here = segment.at(s);
        const SpacePoint after = segment.at(s + h);
        const double span_s = 2 * h * segment.duration_s();
        for (int axis = 0; axis < test::all_axes; ++axis) {
            worst_end = std::max({worst_end, std::abs(begin.position[axis] - from.position[axis]),
                                  std::abs(begin.velocity[axis] - from.velocity[axis]),
                                  std::abs(begin.acceleration[axis] - from.acceleration[axis]),
                                  std::abs(end.position[axis] - to.position[axis]),
                                  std::abs(end.velocity[axis] - to.velocity[axis]),
                                  std::abs(end.acceleration[axis] - to.acceleration[axis])});
            worst_slope = std::max(
                {worst_slope, std::abs((after.position[axis] - before.position[axis]) / span_s - here.velocity[axis]),
                 std::abs((after.velocity[axis] - before.velocity[axis]) / span_s - here.acceleration[axis])});
        }
    }
    CHECK(worst_end < 1e-12);
    CHECK(worst_slope < 1e-6);
}

TEST_CASE("In the plane of motion a segment in space is the planar one to the last bit") {
    Random random(3);
    for (int i = 0; i < 500; ++i) {
        const SpacePoint from = test::random_space_point(random, 1, 3, 1, 1);
        const SpacePoint to = test::random_space_point(random, 1, 3, 1, 1);
        const int ticks = random.integer(1, 500);
        const SpaceSegment segment(from, to, ticks, tick_s);
        const ReferenceSegment planar(in_plane(from), in_plane(to), ticks, tick_s);
        CHECK(segment.inverse_duration_1_s() == planar.inverse_duration_1_s());
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(std::equal(planar.coefficients()[axis], planar.coefficients()[axis] + 6,
                             segment.coefficients()[axis_in_space[axis]]));
        }
        for (int tick = 0; tick <= ticks; tick += 13) {
            CHECK(in_plane(segment.at_tick(tick)) == planar.at_tick(tick));
        }
    }
}

TEST_CASE("Between points at rest all axes in space pass a straight line together") {
    Random random(4);
    const SpacePoint from = test::random_space_point(random, 3, 3, 0, 0);
    const SpacePoint to = test::random_space_point(random, 3, 3, 0, 0);
    const SpaceSegment segment(from, to, 300, tick_s);
    for (int tick = 0; tick <= 300; tick += 7) {
        const double t = tick / 300.0;
        const double s = t * t * t * (10 + t * (-15 + 6 * t));
        const SpacePoint point = segment.at_tick(tick);
        for (int axis = 0; axis < test::all_axes; ++axis) {
            const double expected = from.position[axis] + s * (to.position[axis] - from.position[axis]);
            CHECK(std::abs(point.position[axis] - expected) < 1e-12);
        }
    }
}

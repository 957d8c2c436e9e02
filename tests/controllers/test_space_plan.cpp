#include <catch2/catch.hpp>
#include <cstdint>

#include "downwash/controllers/space_reference.hpp"
#include "downwash/controllers/space_segment.hpp"
#include "space_motion.hpp"

using namespace downwash;

namespace {

constexpr double tick_s = 0.01;

/// From rest through a moving point to rest, with two joints.
SpacePlan curved_plan() {
    test::Random random(1);
    return {{{0, test::random_space_point(random, 2, 2, 0, 0)},
             {300, test::random_space_point(random, 2, 2, 0.5, 0.2)},
             {700, test::random_space_point(random, 2, 2, 0, 0)}},
            tick_s,
            2};
}

void check_near(const SpacePoint& a, const SpacePoint& b) {
    for (int axis = 0; axis < test::all_axes; ++axis) {
        CHECK(a.position[axis] == Approx(b.position[axis]).margin(1e-12));
        CHECK(a.velocity[axis] == Approx(b.velocity[axis]).margin(1e-11));
        CHECK(a.acceleration[axis] == Approx(b.acceleration[axis]).margin(1e-9));
    }
}

}  // namespace

TEST_CASE("A plan in space at a tick is its segment there, its knots exactly, and beyond its ends what these are") {
    const SpacePlan plan = curved_plan();
    CHECK(plan.duration_s() == Approx(7));
    CHECK(SpacePlan{}.duration_s() == 0);
    const SpaceSegment second(plan.reference[1].point, plan.reference[2].point, 400, tick_s);
    for (const SpaceKnot& knot : plan.reference) {
        CHECK(plan.at(knot.tick) == knot.point);
    }
    CHECK(plan.at(431) == second.at_tick(131));
    CHECK(plan.at(-5) == plan.reference.front().point);
    CHECK(plan.at(9999) == plan.reference.back().point);
    for (const std::int64_t tick : {0, 17, 300, 431, 699}) {
        check_near(plan.at_time(static_cast<double>(tick) * tick_s), plan.at(tick));
    }
    SpacePlan moving_at_its_end = plan.beginning(500);
    CHECK_FALSE(is_at_rest(moving_at_its_end.reference.back().point));
    CHECK(moving_at_its_end.at_time(5) == rest_at(plan.at(500)));
}

TEST_CASE("The segments of a plan in space join its knots") {
    const SpacePlan plan = curved_plan();
    const auto segments = plan.segments();
    REQUIRE(segments.size() == 2);
    CHECK(segments[0].ticks() == 300);
    CHECK(segments[1].ticks() == 400);
    CHECK(segments[0].to() == segments[1].from());
    CHECK(segments[1].to() == plan.reference.back().point);
    CHECK(SpacePlan{{{0, {}}}, tick_s, 0}.segments().empty());
}

TEST_CASE("A beginning and the rest of a plan in space are the plan again") {
    const SpacePlan plan = curved_plan();
    const SpacePlan again = plan.beginning(300).followed_by(plan.rest_after(300));
    REQUIRE(again.reference.size() == 3);
    CHECK(again.joints == 2);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(again.reference[i].tick == plan.reference[i].tick);
        CHECK(again.reference[i].point == plan.reference[i].point);
    }
    const SpacePlan rest = plan.rest_after(450);
    CHECK(rest.reference.front().point == plan.at(450));
    CHECK(rest.reference.back().tick == 250);
    CHECK(plan.rest_after(800).reference.size() == 1);
    const SpacePlan joined = plan.beginning(450).followed_by(rest);
    for (const std::int64_t tick : {100, 449, 450, 451, 600, 700}) {
        check_near(joined.at(tick), plan.at(tick));
    }
}

TEST_CASE("A plan in space that is held, or asked for more than it has, stays at its last point") {
    const SpacePlan plan = curved_plan();
    for (const SpacePlan& longer : {plan.held_for(200), plan.beginning(900)}) {
        CHECK(longer.reference.size() == 4);
        CHECK(longer.reference.back().tick == 900);
        CHECK(longer.at(800) == plan.reference.back().point);
        CHECK(longer.joints == 2);
    }
    CHECK(SpacePlan{}.followed_by(plan).reference.size() == 3);
}

TEST_CASE("A divided plan in space is the same reference with knots near to each other") {
    const SpacePlan plan = curved_plan();
    const SpacePlan parts = plan.divided(50);
    REQUIRE(parts.reference.size() == 700 / 50 + 1);
    for (std::size_t i = 1; i < parts.reference.size(); ++i) {
        CHECK(parts.reference[i].tick - parts.reference[i - 1].tick == 50);
    }
    for (std::int64_t tick = 0; tick <= 700; tick += 17) {
        check_near(parts.at(tick), plan.at(tick));
    }
    CHECK(plan.divided(290).reference.size() == 5);  // the knots of the plan stay
    CHECK(plan.divided(290).reference[2].point == plan.reference[1].point);
    CHECK(plan.divided(1000).reference.size() == 3);
}

TEST_CASE("A point rests where its rates and accelerations are zero") {
    SpacePoint point;
    point.position[space::yaw] = 3;
    CHECK(is_at_rest(point));
    point.velocity[space::first_joint + 5] = 1e-300;
    CHECK_FALSE(is_at_rest(point));
    CHECK(rest_at(point).position[space::yaw] == 3);
    CHECK(is_at_rest(rest_at(point)));
}

#include <catch2/catch.hpp>
#include <cstdint>

#include "downwash/controllers/plan.hpp"

using namespace downwash;

namespace {

constexpr double tick_s = 0.01;

/// From rest through a moving point to rest.
Plan curved_plan() {
    return {
        {{0, at_rest({0, 0, 0})}, {300, {{2, 1, 0.5}, {0.8, 0.1, -0.2}, {0.1, 0, 0.3}}}, {700, at_rest({4, 0.5, -1})}},
        tick_s};
}

}  // namespace

TEST_CASE(
    "A plan at a tick is its segment there, its knots exactly, and beyond its ends what it begins and ends with") {
    const Plan plan = curved_plan();
    const ReferenceSegment second(plan.reference[1].point, plan.reference[2].point, 400, tick_s);
    for (const ReferenceKnot& knot : plan.reference) {
        CHECK(plan.at(knot.tick) == knot.point);
    }
    CHECK(plan.at(431) == second.at_tick(131));
    CHECK(plan.at(-5) == plan.reference.front().point);
    CHECK(plan.at(9999) == plan.reference.back().point);
    for (const std::int64_t tick : {0, 17, 300, 431, 699}) {
        const ReferencePoint at_tick = plan.at(tick);
        const ReferencePoint at_time = plan.at_time(static_cast<double>(tick) * tick_s);
        for (std::size_t axis = 0; axis < plan.axes.size(); ++axis) {
            CHECK(at_time.position[axis] == Approx(at_tick.position[axis]).margin(1e-12));
            CHECK(at_time.velocity[axis] == Approx(at_tick.velocity[axis]).margin(1e-12));
        }
    }
    CHECK(plan.at_time(99) == plan.reference.back().point);
}

TEST_CASE("The segments of a plan join its knots") {
    const Plan plan = curved_plan();
    const auto segments = plan.segments();
    REQUIRE(segments.size() == 2);
    CHECK(segments[0].ticks() == 300);
    CHECK(segments[1].ticks() == 400);
    CHECK(segments[0].to() == segments[1].from());
    CHECK(segments[1].to() == plan.reference.back().point);
    CHECK(Plan{{{0, at_rest({1, 2, 3})}}, tick_s}.segments().empty());
}

TEST_CASE("A beginning and the rest of a plan are the plan again") {
    const Plan plan = curved_plan();
    const Plan again = plan.beginning(300).followed_by(plan.rest_after(300));
    REQUIRE(again.reference.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(again.reference[i].tick == plan.reference[i].tick);
        CHECK(again.reference[i].point == plan.reference[i].point);
    }
    const Plan rest = plan.rest_after(450);
    CHECK(rest.reference.front().tick == 0);
    CHECK(rest.reference.front().point == plan.at(450));
    CHECK(rest.reference.back().tick == 250);
    CHECK(plan.rest_after(800).reference.size() == 1);
    CHECK(plan.beginning(120).reference.back().point == plan.at(120));
}

TEST_CASE("A plan that is held, or asked for more than it has, stays at its last point") {
    const Plan plan = curved_plan();
    for (const Plan& longer : {plan.held_for(200), plan.beginning(900)}) {
        CHECK(longer.reference.size() == 4);
        CHECK(longer.reference.back().tick == 900);
        CHECK(longer.at(800) == plan.reference.back().point);
    }
    CHECK(Plan{}.followed_by(plan).reference.size() == 3);
}

TEST_CASE("A divided plan is the same reference with knots near to each other") {
    const Plan plan = curved_plan();
    const Plan parts = plan.divided(50);
    REQUIRE(parts.reference.size() == 700 / 50 + 1);
    for (std::size_t i = 1; i < parts.reference.size(); ++i) {
        CHECK(parts.reference[i].tick - parts.reference[i - 1].tick == 50);
    }
    for (const std::int64_t tick : {0, 17, 300, 431, 699}) {
        for (std::size_t axis = 0; axis < plan.axes.size(); ++axis) {
            CHECK(parts.at(tick).position[axis] == Approx(plan.at(tick).position[axis]).margin(1e-12));
            CHECK(parts.at(tick).velocity[axis] == Approx(plan.at(tick).velocity[axis]).margin(1e-11));
        }
    }
    CHECK(plan.divided(290).reference.size() == 5);  // the knots of the plan stay
    CHECK(plan.divided(290).reference[2].point == plan.reference[1].point);
    CHECK(plan.divided(1000).reference.size() == 3);
}

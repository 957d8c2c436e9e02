#include <catch2/catch.hpp>
#include <memory>
#include <span>

#include "../support/space_robots.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/space_pool.hpp"

// The rules that a pool keeps beside those of a flight: margins, bounds, limits and goals.

using namespace downwash;
using namespace downwash::test;

TEST_CASE("a job in space may end before its first tick, and margins count") {
    const SpaceRobot robot = space_robot(0);
    const SpacePlan plan = space_plan(0);
    const SpaceRobotShape shape{{{Sphere{0.3}, {0, 0, 0}}}, {}};
    const SpaceChecker checker(
        std::make_shared<const Scene>(std::vector<Obstacle>{{"deck", Box{{6, 6, 0.2}}, {0, 0, 2.45}, {}}}), shape);
    SpacePoolSetup setup{robot};
    setup.checker = &checker;
    const auto flown_from = [&](const SpaceMotion& start) {
        SpacePool pool(setup);
        SpaceFlightJob job{pool.state_at(start), {{plan.segment_to(1)}}};
        pool.fly({&job, 1});
        return job;
    };
    SpaceMotion start = motion_at_rest(plan.reference.front().point);
    setup.margin_m = 0.06;
    const SpaceFlightJob too_near = flown_from(start);
    CHECK(too_near.rejection() == Rejection::collision);
    CHECK(too_near.legs[0].flight.ticks == 0);
    CHECK(downwash::is_same(too_near.legs[0].end, too_near.start));
    setup.margin_m = 0.04;
    const SpaceFlightJob rising = flown_from(start);
    CHECK(rising.rejection() == Rejection::collision);
    CHECK(rising.legs[0].flight.ticks > 10);
    // It ends in the first tick that is too near: the vehicle rises.
    const double top_m = rising.legs[0].end.plant.q[2] + 0.3;
    CHECK(top_m > 2.35 - 0.04);
    CHECK(top_m - 0.01 * rising.legs[0].end.plant.u[2] < 2.35 - 0.04 + 1e-3);
    setup.checker = nullptr;
    CHECK(flown_from(start).rejection() == Rejection::none);
    start.position_m[0] = 3.1;
    const SpaceFlightJob too_far = flown_from(start);
    CHECK(too_far.rejection() == Rejection::unstable);
    CHECK(too_far.legs[0].flight.ticks == 0);
}

TEST_CASE("a planned flight in space keeps its bounds, its joints' limits, and what else it is asked to keep") {
    SpaceRobot robot = space_robot(2);
    for (SpaceLinkLimits& link : robot.links) {
        link.is_limited = true;
        link.lower_limit_rad = -1;
        link.upper_limit_rad = 1;
    }
    const SpaceChecker checker(std::make_shared<const Scene>(std::vector<Obstacle>{}), shape_of(robot));
    const SpacePlan plan = space_plan(2);
    SpacePoolSetup setup{robot};
    setup.checker = &checker;
    SpacePlanningRules wide;
    wide.low_m = {-5, -5, 0};
    wide.high_m = {5, 5, 5};
    wide.max_tracking_error_m = 1;
    wide.max_saturation = 2;
    const auto rejection = [&](const SpacePlanningRules& rules) {
        setup.rules = rules;
        SpacePool pool(setup);
        SpaceFlightJob job{pool.state_at(motion_at_rest(plan.reference.front().point)), {}};
        for (const SpaceSegment& segment : plan.segments()) {
            job.legs.push_back({segment});
        }
        pool.fly(std::span(&job, 1));
        return job.rejection();
    };
    CHECK(rejection(wide) == Rejection::none);
    SpacePlanningRules narrow = wide;
    narrow.high_m[0] = 1.1;  // the plan leads to 1.2 m
    CHECK(rejection(narrow) == Rejection::bounds);
    SpacePlanningRules exact = wide;
    exact.max_tracking_error_m = 1e-6;
    CHECK(rejection(exact) == Rejection::tracking);
    SpacePlanningRules idle = wide;
    idle.max_saturation = 1e-6;
    CHECK(rejection(idle) == Rejection::saturation);
    SpacePlanningRules calm = wide;
    calm.max_tilt_rate_rad_s = 2;
    CHECK(rejection(calm) == Rejection::none);
    calm.max_tilt_rate_rad_s = 0.01;
    CHECK(rejection(calm) == Rejection::unstable);
    robot.links[0].upper_limit_rad = 0.4;  // the plan leads to 0.6 rad
    CHECK(rejection(wide) == Rejection::arm_limits);
}

TEST_CASE("flights in space side by side sum up length, tilt rate and clearance as one flight alone does") {
    const int joints = GENERATE(0, 2);
    const SpaceRobot robot = space_robot(joints);
    const SpacePlan plan = space_plan(joints);
    const auto scene =
        std::make_shared<const Scene>(std::vector<Obstacle>{{"post", Box{{0.2, 0.2, 3}}, {1.95, -0.55, 1.5}, {}}});
    const SpaceChecker checker(scene, {{{Box{{0.9, 0.9, 0.1}}, {0, 0, 0}}}, {}});
    SpaceFlightSettings settings;
    settings.checker = &checker;
    settings.is_refined = false;
    const SpaceFlight alone = fly(robot, plan, motion_at_rest(plan.at(0)), settings);
    REQUIRE(alone.outcome == Outcome::ok);
    double tilt_rate_rad_s = 0, way_m = 0;
    for (std::size_t i = 1; i < alone.rows.size(); ++i) {
        const Vector3& rates = alone.rows[i].motion.body_rates_rad_s;
        const Vector3 step_m = alone.rows[i].motion.position_m - alone.rows[i - 1].motion.position_m;
        tilt_rate_rad_s = std::max(tilt_rate_rad_s, std::sqrt(rates[0] * rates[0] + rates[1] * rates[1]));
        way_m += std::sqrt(dot(step_m, step_m));
    }
    CHECK(alone.length_m == Approx(way_m).epsilon(1e-12));

    const auto flown_with = [&](bool measures_clearance, std::optional<ClearanceError> finds_min_clearance) {
        SpacePoolSetup setup{robot};
        setup.checker = &checker;
        setup.measures_clearance = measures_clearance;
        setup.finds_min_clearance = finds_min_clearance;
        SpacePool pool(setup);
        SpaceFlightJob job{pool.state_at(motion_at_rest(plan.at(0))), {}};
        for (const SpaceSegment& segment : plan.segments()) {
            job.legs.push_back({segment});
        }
        pool.fly(std::span(&job, 1));
        REQUIRE(job.rejection() == Rejection::none);
        return job;
    };
    const SpaceFlightJob measured = flown_with(true, {});
    double length_m = 0, clearance_integral = 0, fastest_rad_s = 0;
    for (const SpaceFlightLeg& leg : measured.legs) {
        length_m += leg.flight.length_m;
        clearance_integral += leg.flight.clearance_integral;
        fastest_rad_s = std::max(fastest_rad_s, leg.flight.max_tilt_rate_rad_s);
    }
    CHECK(length_m == Approx(way_m).epsilon(1e-12));
    CHECK(fastest_rad_s == tilt_rate_rad_s);
    CHECK(clearance_integral == Approx(alone.clearance_integral).epsilon(1e-9));
    CHECK(measured.legs.back().flight.min_clearance_m == Approx(alone.min_clearance_m).margin(1e-7));
    const ClearanceError rough{0.1, 0.02};
    const double found_m = flown_with(false, rough).legs.back().flight.min_clearance_m;
    CHECK(found_m >= alone.min_clearance_m - 1e-7);
    CHECK(found_m <= alone.min_clearance_m + rough.at_m(alone.min_clearance_m));
    CHECK(std::isinf(flown_with(false, {}).legs.back().flight.min_clearance_m));
}

TEST_CASE("a flight in space that hovers where its goal is not, or is not yet slow enough, misses it") {
    const SpaceRobot robot = space_robot(1);
    const auto scene = std::make_shared<const Scene>(std::vector<Obstacle>{});
    SpaceGoal goal;
    SpaceConfigurationGoal at;
    at.x_m = 1;
    at.z_m = 2;
    goal.kind = at;
    const SpaceGoalRule rule(robot, scene, {goal});
    SpacePoolSetup setup{robot};
    setup.goal = &rule;
    SpacePool pool(setup);
    const auto rejection_at = [&](double x_m, std::int64_t hover_ticks, std::int64_t way_ticks = 400) {
        SpacePoint from, to;
        from.position[space::z] = to.position[space::z] = 2;
        to.position[space::x] = x_m;
        SpaceFlightJob job{pool.state_at(motion_at_rest(from)),
                           {{{from, to, way_ticks, 0.01}}, {{to, to, hover_ticks, 0.01}}}};
        job.judged_ticks = 100;
        pool.fly(std::span(&job, 1));
        return job.rejection();
    };
    CHECK(rejection_at(1, 500) == Rejection::none);
    CHECK(rejection_at(1.3, 500) == Rejection::goal_missed);
    CHECK(rejection_at(1, 500, 130) == Rejection::none);
    CHECK(rejection_at(1, 100, 130) == Rejection::goal_missed);  // it still settles
}

#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "../support/space_robots.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/judge/space_judge.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/space_flight.hpp"

// Whole flights in space: the judge and an execution tell the same story, each with a plant, laws, sensors and
// distances of its own.

using namespace downwash;
using namespace downwash::test;

namespace {

AeroSettings free_air() {
    AeroSettings aero;
    aero.enabled = false;
    return aero;
}

/// The judge integrates a link's drag finely, the planner by two points: linear drag alone is the same to both.
SpaceRobot judged_robot(int joints) {
    SpaceRobot robot = space_robot(joints);
    robot.plant.thrust_coefficient_n_s2 = 1e-5;
    robot.plant.rotor_inertia_kg_m2 = 1e-4;
    for (SpaceLink& link : robot.plant.links) {
        link.drag = {0.02, 0};
    }
    return robot;
}

SpaceInversion& inversion_of(SpaceRobot& robot) {
    return std::get<SpaceInversion>(robot.controller.law);
}

SpaceWorld some_world() {
    SpaceWorld world;
    world.mass_scale = 0.05;
    world.inertia_scale = -0.1;
    world.link_mass_scale[0] = 0.1;
    world.center_of_mass_m = {0.01, -0.005, 0.003};
    world.thrust_scale = -0.03;
    world.rotor_thrust_scale[2] = 0.02;
    world.rotor_time_constant_s = 0.01;
    world.delay_s = 0.004;
    world.position_bias_m = {0.03, 0.02, -0.01};
    world.attitude_bias_rad = {0.01, -0.02, 0.03};
    world.joint_offset_rad[1] = 0.02;
    world.wind_m_s = {1, -0.5, 0.1};
    world.position_noise_m = 0.005;
    world.velocity_noise_m_s = 0.01;
    world.gyro_noise_rad_s = 0.005;
    world.gust_m_s = 0.4;
    world.gust_length_level_m = 20;
    world.gust_length_up_m = 3;
    world.tape = 77;
    return world;
}

judge::SpaceJudgedMotion judged(const SpaceMotion& motion) {
    return {motion.position_m,   motion.attitude,         motion.joints_rad,
            motion.velocity_m_s, motion.body_rates_rad_s, motion.joint_rates_rad_s};
}

/// The greatest distance between both [m], or difference of a joint [rad], at any tick.
double difference(const judge::SpaceJudgedFlight& judged, const SpaceFlight& flight) {
    REQUIRE(judged.rows.size() == flight.rows.size());
    double worst = 0;
    for (std::size_t i = 0; i < flight.rows.size(); ++i) {
        const SpaceMotion& a = flight.rows[i].motion;
        const judge::SpaceJudgedMotion& b = judged.rows[i].motion;
        const Vector3 apart = a.position_m - b.position_m;
        worst = std::max(worst, std::sqrt(dot(apart, apart)));
        for (std::size_t k = 0; k < max_joints; ++k) {
            worst = std::max(worst, std::abs(a.joints_rad[k] - b.joints_rad[k]));
        }
    }
    return worst;
}

/// Flies a plan by both. @return the greatest difference
double flown_apart(const SpaceRobot& robot, const SpacePlan& plan, std::optional<SpaceWorld> world = {}) {
    const SpaceMotion start = motion_at_rest(plan.at(0));
    SpaceFlightSettings settings;
    settings.hold_ticks = 100;
    settings.settles = world.has_value();
    settings.world = world.value_or(SpaceWorld{});
    const SpaceFlight flight = fly(robot, plan, start, settings);
    judge::SpaceFlightConditions conditions;
    conditions.start = judged(start);
    conditions.hold_ticks = 100;
    conditions.world = world;
    const judge::SpaceJudgedFlight mine = judge::SpaceJudge(robot, {}, free_air()).fly(plan, conditions);
    CHECK(flight.outcome == Outcome::ok);
    CHECK(mine.outcome == judge::Outcome::ok);
    CHECK(mine.duration_s == Approx(flight.duration_s));
    CHECK(mine.energy_j == Approx(flight.energy_j).epsilon(1e-6));
    CHECK(mine.max_tracking_error_m == Approx(flight.max_tracking_error_m).epsilon(1e-4));
    return difference(mine, flight);
}

/// A robot of boxes, so that distances are plain: the body 0.5 m wide and 0.1 m high.
SpaceRobot boxed_robot(int joints) {
    SpaceRobot robot = judged_robot(joints);
    robot.body = {{Box{{0.5, 0.5, 0.1}}, {0, 0, 0}}};
    for (SpaceLinkLimits& link : robot.links) {
        link.body = {{Capsule{0.02, {0, 0, 0}, {0.02, 0, -0.12}}, {0, 0, 0}}};
    }
    return robot;
}

Obstacle box(const Vector3& size_m, const Vector3& center_m) {
    return {"box", Box{size_m}, center_m, {}};
}

judge::SpaceJudgedFlight judged_flight(const SpaceRobot& robot, const SpacePlan& plan,
                                       const std::vector<Obstacle>& obstacles, const AeroSettings& aero,
                                       const std::optional<SpaceWorld>& world = {},
                                       const std::optional<SpaceMotion>& start = {}) {
    judge::SpaceFlightConditions conditions;
    conditions.start = judged(start.value_or(motion_at_rest(plan.at(0))));
    conditions.world = world;
    return judge::SpaceJudge(robot, obstacles, aero).fly(plan, conditions);
}

/// A straight way from rest to rest.
SpacePlan straight(int joints, const Vector3& from_m, const Vector3& to_m, std::int64_t ticks) {
    SpacePlan plan;
    plan.tick_s = 0.01;
    plan.joints = joints;
    plan.reference.resize(2);
    plan.reference[1].tick = ticks;
    for (int axis = 0; axis < 3; ++axis) {
        plan.reference[0].point.position[axis] = from_m[static_cast<std::size_t>(axis)];
        plan.reference[1].point.position[axis] = to_m[static_cast<std::size_t>(axis)];
    }
    return plan;
}

}  // namespace

TEST_CASE("The judge and an execution fly the same in the nominal world") {
    for (int joints = 0; joints <= 3; ++joints) {
        INFO("joints " << joints);
        const SpacePlan plan = space_plan(joints);
        SpaceRobot robot = judged_robot(joints);
        CHECK(flown_apart(robot, plan) < 1e-6);
        inversion_of(robot).observer_gain_1_s = 3;
        inversion_of(robot).rate_feed_forward = true;
        robot.controller.delay_s = 0.013;
        CHECK(flown_apart(robot, plan) < 1e-6);
        robot.controller.law = Px4Cascade{};
        robot.controller.delay_s = 0;
        CHECK(flown_apart(robot, plan) < 1e-6);
    }
}

TEST_CASE("The judge and an execution fly the same in a world, noise and gusts included") {
    for (const int joints : {0, 2}) {
        INFO("joints " << joints);
        SpaceRobot robot = judged_robot(joints);
        inversion_of(robot).observer_gain_1_s = 3;
        CHECK(flown_apart(robot, space_plan(joints), some_world()) < 1e-6);
    }
}

TEST_CASE("The judge and an execution clip alike") {
    SpaceRobot robot = judged_robot(2);
    robot.max_thrust_n.assign(6, 5.2);
    robot.links[0].max_torque_nm = 0.25;
    SpacePlan plan = space_plan(2);
    for (SpaceKnot& knot : plan.reference) {
        knot.tick /= 2;
    }
    const SpaceFlight flight = fly(robot, plan, motion_at_rest(plan.at(0)));
    CHECK(flight.max_saturation > 1.1);
    CHECK(flown_apart(robot, plan) < 1e-6);
}

TEST_CASE("The judge sees a fault of a percent in the plant") {
    const SpacePlan plan = space_plan(2);
    const SpaceRobot robot = judged_robot(2);
    SpaceRobot wrong = robot;
    wrong.plant.links[1].body.mass_kg *= 1.01;
    const SpaceFlight flight = fly(wrong, plan, motion_at_rest(plan.at(0)));
    CHECK(difference(judged_flight(robot, plan, {}, free_air()), flight) > 1e-5);
}

TEST_CASE("The judge and an execution feel the same surfaces, over tilted rotors and in a turned scene") {
    SpaceRobot robot = boxed_robot(1);
    inversion_of(robot).feed_forward = true;
    const std::vector<Obstacle> slabs = {box({3, 0.9, 0.2}, {0, 0.1, 2.6}), box({4, 4, 0.2}, {0.5, 0, 1.5})};
    const SpacePlan plan = straight(1, {-0.6, 0, 2.25}, {0.7, 0.3, 2.3}, 300);
    AeroSettings aero;
    aero.tilt_loss = {0.37, 0.2};
    SpaceWorld world;
    world.ceiling_scale = -0.2;
    world.ground_scale = 0.3;
    world.scene_m = {0.03, -0.02, 0.01};
    world.scene_yaw_rad = 0.1;
    const auto scene = std::make_shared<const Scene>(slabs);
    simulation::DirectSpaceEffect effect(scene, aero, robot);
    for (const auto& in : {std::optional<SpaceWorld>{}, std::optional<SpaceWorld>{world}}) {
        INFO("in a world: " << in.has_value());
        SpaceFlightSettings settings;
        settings.effect = &effect;
        settings.aero = simulation::space_aero(aero, robot.rotor_radius_m);
        settings.world = in.value_or(SpaceWorld{});
        settings.settles = in.has_value();
        SpaceRobotShape shape{robot.body, {}};
        const SpaceLink& link = robot.plant.links[0];
        SpaceLinkShape arm;
        arm.joint_m = link.joint_m;
        arm.axis = link.axis;
        arm.bodies = robot.links[0].body;
        shape.links.push_back(arm);
        const SpaceChecker checker(scene, shape);
        settings.checker = &checker;
        const SpaceFlight flight = fly(robot, plan, motion_at_rest(plan.at(0)), settings);
        const judge::SpaceJudgedFlight mine = judged_flight(robot, plan, slabs, aero, in);
        CHECK(flight.outcome == Outcome::ok);
        CHECK(mine.outcome == judge::Outcome::ok);
        double strongest = 1;
        for (const SpaceFlightRow& row : flight.rows) {
            strongest = std::max(strongest, row.rotor_factor[0]);
        }
        CHECK(strongest > 1.02);
        CHECK(difference(mine, flight) < 1e-5);
        CHECK(mine.min_clearance_m == Approx(flight.min_clearance_m).margin(1e-5));
    }
}

TEST_CASE("The judge and an execution agree on flights near surfaces and walls, by models of several rotors") {
    const std::vector<Obstacle> site = {box({3, 3, 0.4}, {0.3, 0, -0.2}), box({1.2, 5, 0.3}, {0.2, 0, 1.75}),
                                        box({0.2, 3, 3}, {1.6, 0.4, 1}), box({0.3, 0.3, 1}, {-1, 0.9, 0.5})};
    const auto scene = std::make_shared<const Scene>(site);
    Random random(4);
    int ended_ok = 0, ended_early = 0;
    double by_surfaces_m = 0;  // how far they move a vehicle
    for (int number = 0; number < 16; ++number) {
        const int joints = number % 4;
        INFO("flight " << number);
        SpaceRobot robot = boxed_robot(joints);
        if (number % 6 == 5) {
            robot.controller.law = cascade_gains_for(robot.plant.time_constant_s, {});
        } else {
            inversion_of(robot).feed_forward = number % 2 == 0;
        }
        AeroSettings aero;
        aero.ground = number % 3 == 0 ? EffectModel::multirotor_images : EffectModel::multirotor_body;
        aero.ceiling = number % 5 == 0 ? EffectModel::sanchez_cuevas : EffectModel::multirotor_images;
        aero.wall = {0.03, -0.02, 1};
        const auto near_something = [&] {
            return Vector3{random.uniform(-1, 1.1), random.uniform(-1, 1), random.uniform(0.3, 1.5)};
        };
        SpacePlan plan = straight(joints, near_something(), near_something(), 250);
        for (int axis = space::yaw; axis < space::first_joint + joints; ++axis) {
            plan.reference[0].point.position[axis] = random.uniform(-1, 1);
            plan.reference[1].point.position[axis] = random.uniform(-1, 1);
        }
        std::optional<SpaceWorld> world;
        if (number % 4 >= 2) {
            world.emplace();
            world->ground_scale = random.uniform(-0.3, 0.3);
            world->ceiling_scale = random.uniform(-0.3, 0.3);
            world->scene_m = {random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), 0.01};
            world->scene_yaw_rad = random.uniform(-0.1, 0.1);
            world->rotor_thrust_scale[1] = 0.02;
            world->center_of_mass_m = {0.005, -0.005, 0};
        }
        SpaceRobotShape shape{robot.body, {}};
        for (std::size_t i = 0; i < robot.links.size(); ++i) {
            SpaceLinkShape link;
            link.joint_m = robot.plant.links[i].joint_m;
            link.axis = robot.plant.links[i].axis;
            link.bodies = robot.links[i].body;
            shape.links.push_back(link);
        }
        const SpaceChecker checker(scene, shape);
        simulation::DirectSpaceEffect effect(scene, aero, robot);
        SpaceFlightSettings settings;
        settings.effect = &effect;
        settings.aero = simulation::space_aero(aero, robot.rotor_radius_m);
        settings.world = world.value_or(SpaceWorld{});
        settings.checker = &checker;
        SpaceMotion start = motion_at_rest(plan.at(0));
        start.velocity_m_s = {0.05, -0.05, 0};  // one that moves does not hover in a world first
        const SpaceFlight flight = fly(robot, plan, start, settings);
        const judge::SpaceJudgedFlight mine = judged_flight(robot, plan, site, aero, world, start);
        CHECK(judge::name_of(mine.outcome) == name_of(flight.outcome));
        if (flight.outcome != Outcome::ok || mine.outcome != judge::Outcome::ok) {
            ++ended_early;
            continue;
        }
        ++ended_ok;
        CHECK(std::abs(mine.min_clearance_m - flight.min_clearance_m) < 0.01);
        CHECK(mine.energy_j == Approx(flight.energy_j).epsilon(0.01));
        CHECK(difference(mine, flight) < 1e-3);
        settings.effect = nullptr;
        settings.aero = {};
        const SpaceFlight without = fly(robot, plan, start, settings);
        if (without.rows.size() == mine.rows.size()) {
            by_surfaces_m = std::max(by_surfaces_m, difference(mine, without));
        }
    }
    CHECK(ended_ok > 5);
    CHECK(ended_early > 0);
    CHECK(by_surfaces_m > 0.02);
}

TEST_CASE("The judge finds a plate between two ticks") {
    // At some 2.6 m/s a ball of 10 mm moves by 26 mm in a tick, through a plate of a millimetre halfway.
    SpaceRobot robot = boxed_robot(0);
    robot.body = {{Sphere{0.005}, {0, 0, 0}}};
    const SpacePlan plan = straight(0, {0, 0, 2}, {5.6, 0, 2}, 400);
    const auto without = judged_flight(robot, plan, {}, free_air());
    const Vector3 before_m = without.rows[200].motion.position_m;
    const Vector3 after_m = without.rows[201].motion.position_m;
    REQUIRE(after_m[0] - before_m[0] > 0.02);
    const double plate_m = 0.5 * (before_m[0] + after_m[0]);
    const std::vector<Obstacle> plate = {box({0.001, 3, 3}, {plate_m, 0, 2})};
    const auto flight = judged_flight(robot, plan, plate, free_air());
    CHECK(flight.outcome == judge::Outcome::collision);
    CHECK_FALSE(flight.is_self_collision);
    CHECK(flight.min_clearance_m == 0);
    CHECK(flight.rows.size() == 202);
    CHECK(flight.rows[200].clearance_m > 0.005);
    CHECK(flight.rows[201].clearance_m > 0.005);
    CHECK(judged_flight(robot, plan, {box({0.001, 3, 3}, {plate_m, 3, 2})}, free_air()).outcome == judge::Outcome::ok);
    // A world moves the plate out of the way.
    SpaceWorld world;
    world.scene_m = {0, 3, 0};
    CHECK(judged_flight(robot, plan, plate, free_air(), world).outcome == judge::Outcome::ok);
}

TEST_CASE("The judge finds a robot that touches itself, and not neighbours") {
    SpaceRobot robot = boxed_robot(2);
    SpacePlan plan = straight(2, {0, 0, 2}, {0, 0, 2}, 300);
    CHECK(judged_flight(robot, plan, {}, free_air()).outcome == judge::Outcome::ok);
    // The second link turns up against the body: it may meet it, the first may not.
    robot.plant.links[1].axis = {0, 1, 0};
    robot.plant.links[1].joint_m = {0, 0, -0.1};
    robot.links[1].body = {{Capsule{0.02, {0, 0, 0}, {0, 0, -0.15}}, {0, 0, 0}}};
    plan.reference[1].point.position[space::first_joint + 1] = 3;
    const auto flight = judged_flight(robot, plan, {}, free_air());
    CHECK(flight.outcome == judge::Outcome::collision);
    CHECK(flight.is_self_collision);
    CHECK(flight.rows.back().motion.joints_rad[1] > 1.5);
}

TEST_CASE("The judge ends flights by the rules") {
    const SpaceRobot robot = boxed_robot(0);
    SECTION("unstable") {
        SpacePlan plan = straight(0, {0, 0, 2}, {40, 0, 2}, 300);
        CHECK(judged_flight(robot, plan, {}, free_air()).outcome == judge::Outcome::unstable);
    }
    SECTION("a vehicle that starts upside down may recover") {
        const SpacePlan plan = straight(0, {0, 0, 20}, {0, 0, 20}, 600);
        judge::SpaceFlightConditions conditions;
        conditions.start = judged(motion_at_rest(plan.at(0)));
        conditions.start.attitude = {0.05, 0.99, 0, 0.1};
        const auto flight = judge::SpaceJudge(robot, {}, free_air()).fly(plan, conditions);
        CHECK(flight.outcome == judge::Outcome::ok);
        CHECK(std::abs(flight.rows.back().motion.position_m[2] - 20) < 0.1);
    }
    SECTION("left the flyable area") {
        const SpacePlan plan = straight(0, {0, 0, 2}, {0, 0, 0.06}, 400);
        const std::vector<Obstacle> ground = {box({5, 5, 1}, {0, 0, -0.5})};
        AeroSettings aero;
        aero.min_distance_radii = 1.5;
        CHECK(judged_flight(robot, plan, ground, aero).outcome == judge::Outcome::left_flyable_area);
        CHECK(judged_flight(robot, plan, ground, free_air()).outcome == judge::Outcome::ok);
    }
    SECTION("over the budget") {
        const SpacePlan plan = straight(0, {0, 0, 2}, {0, 0, 2}, 100);
        judge::SpaceFlightConditions conditions;
        conditions.start = judged(motion_at_rest(plan.at(0)));
        conditions.energy_budget_j = 1;
        CHECK(judge::SpaceJudge(robot, {}, free_air()).fly(plan, conditions).outcome == judge::Outcome::over_budget);
    }
}

TEST_CASE("The judge names a setting of the air that is out of range") {
    AeroSettings aero;
    aero.wall = {0.1, 0, 0};
    CHECK_THROWS_WITH(judge::SpaceJudge(boxed_robot(0), {}, aero), Catch::Contains("aero.wall.decay_radii"));
}

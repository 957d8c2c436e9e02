#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "../support/random.hpp"
#include "../support/test_problem.hpp"
#include "downwash/controllers/configuration.hpp"
#include "downwash/controllers/control.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/touch_places.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "downwash/simulation/plane_in_space.hpp"
#include "downwash/simulation/pose.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/space_loop.hpp"
#include "space_twin.hpp"

// The shipped planar robot in space, along references of the plane: the plane's own closed loop is the oracle.

using namespace downwash;
using namespace downwash::test;

namespace {

/// K near a surface below and another one above, both of which end.
SidedFactor<double> factor_at(double x_m, double z_m) {
    const double above = 1 + 0.15 / (1 + 4 * (z_m - 2.6) * (z_m - 2.6)) / (1 + x_m * x_m);
    const double below = 0.1 / (1 + 6 * (z_m - 0.8) * (z_m - 0.8)) / (1 + (x_m - 1) * (x_m - 1));
    return {above + below, above};
}

class PlanarSurfaces final : public simulation::FlightEffect {
 public:
    SidedFactor<double> at_rotor(int /*rotor*/, double x_m, double z_m) override { return factor_at(x_m, z_m); }
    SidedFactor<double> at_body(double /*x_m*/, double /*z_m*/) override { return {1, 1}; }
    double wall_nearness(double /*x_m*/, double /*z_m*/) override { return 0; }
};

class SurfacesInSpace final : public simulation::SpaceEffect {
 public:
    SidedFactor<double> at_rotor(int /*rotor*/, const dynamics::LaneVector<double>& hub_m) override {
        return factor_at(hub_m.x, hub_m.z);
    }
};

/// Differences that move nothing beside the plane. Rotors that are not alike are so left and right.
World planar_world(Random& random) {
    World world;
    world.ceiling_scale = random.uniform(-0.3, 0.3);
    world.ground_scale = random.uniform(-0.3, 0.3);
    world.scene_x_m = random.uniform(-0.04, 0.04);
    world.scene_z_m = random.uniform(-0.04, 0.04);
    world.mass_scale = random.uniform(-0.05, 0.05);
    world.inertia_scale = random.uniform(-0.1, 0.1);
    world.arm_mass_scale = random.uniform(-0.1, 0.1);
    world.center_of_mass_x_m = random.uniform(-0.01, 0.01);
    world.center_of_mass_z_m = random.uniform(-0.01, 0.01);
    world.thrust_scale = random.uniform(-0.05, 0.05);
    world.rotor_thrust_scale[0] = world.rotor_thrust_scale[1] = random.uniform(-0.02, 0.02);
    world.rotor_thrust_scale[2] = world.rotor_thrust_scale[3] = random.uniform(-0.02, 0.02);
    world.arm_wash_scale = random.uniform(-0.3, 0.3);
    world.rotor_time_constant_s = random.uniform(-0.01, 0.02);
    world.delay_s = random.uniform(-0.005, 0.005);
    world.position_bias_x_m = random.uniform(-0.02, 0.02);
    world.position_bias_z_m = random.uniform(-0.02, 0.02);
    world.pitch_bias_rad = random.uniform(-0.01, 0.01);
    world.wind_x_m_s = random.uniform(-1, 1);
    world.wind_z_m_s = random.uniform(-0.3, 0.3);
    return world;
}

/// The knots of a plan of 20 s from rest to rest by way of points in motion, the arm along.
std::vector<ReferenceKnot> planar_knots(double rate_hz) {
    const auto second = std::llround(rate_hz);
    ReferencePoint between = at_rest({1.5, 2.3, 0.3});
    between.velocity[0] = 0.7;
    between.velocity[2] = -0.4;
    return {{0, at_rest({0, 1.5, 1.2})},
            {5 * second, between},
            {10 * second, at_rest({0.4, 1.2, -1})},
            {15 * second, at_rest({0.2, 2.2, 1.57})},
            {20 * second, at_rest({-0.8, 1.6, 2.5})}};
}

SpacePlan plan_in_space(const std::vector<ReferenceKnot>& knots, double tick_s) {
    SpacePlan plan;
    plan.tick_s = tick_s;
    plan.joints = 1;
    for (const ReferenceKnot& knot : knots) {
        plan.reference.push_back({knot.tick, in_space(knot.point, {})});
    }
    return plan;
}

struct Difference {
    double place_m = 0, angle_rad = 0, command_n = 0, energy_j = 0;
    double max_saturation = 0, way_m = 0;
};

Difference difference_of(const Robot& robot, const World& world, bool has_surfaces) {
    const TiltLoss tilt_loss{default_ground_tilt_loss, 0.1};
    const simulation::TickModel model{plant_of(robot), controllers::flown_law(robot.controller.law),
                                      1 / robot.controller.rate_hz, tilt_loss, slipstreams_of(robot.arm, robot.rotors)};
    const FlownWorld flown = make_world(robot, world);
    PlanarSurfaces planar_surfaces;
    simulation::FlightEffectOf<simulation::NoEffect> no_surfaces{simulation::NoEffect{}};
    simulation::FlightEffect& planar_effect =
        has_surfaces ? static_cast<simulation::FlightEffect&>(planar_surfaces) : no_surfaces;
    const simulation::FlightLoop loop(model, &flown, planar_effect);

    SurfacesInSpace surfaces_in_space;
    simulation::NoEffectInSpace no_surfaces_in_space;
    simulation::SpaceEffect& effect =
        has_surfaces ? static_cast<simulation::SpaceEffect&>(surfaces_in_space) : no_surfaces_in_space;
    const SpaceRobot twin = twin_of(robot);
    const auto space = simulation::make_space_loop({twin, in_space(world, {}), effect, {tilt_loss}, false});

    const std::vector<ReferenceKnot> knots = planar_knots(robot.controller.rate_hz);
    const SpacePlan plan = plan_in_space(knots, model.tick_s);
    FlightState state{};
    state.plant.q[1] = 1.5;
    state.plant.q[3] = 1.2;
    for (int i = 0; i < 4; ++i) {
        state.plant.thrust_n[i] = model.plant.force_share[i] * model.plant.total_mass_kg * standard_gravity_m_s2;
    }
    state.memory = controllers::visit_flown(model.law, [&]<class Flown>(const Flown& law) {
        if constexpr (controllers::is_aided<Flown>) {
            return controllers::remembered(law.rested(model.plant, state.plant, model.tick_s));
        } else {
            return controllers::remembered(law.rested(model.plant, state.plant));
        }
    });
    state.world = memory_at_start(flown, state.plant);
    SpaceMotion start;
    start.position_m = {0, 0, 1.5};
    start.joints_rad[0] = 1.2;
    space->start(start);

    Difference worst;
    for (std::size_t leg = 1; leg < knots.size(); ++leg) {
        const ReferenceSegment segment(knots[leg - 1].point, knots[leg].point, knots[leg].tick - knots[leg - 1].tick,
                                       model.tick_s);
        for (std::int64_t tick = 0; tick < segment.ticks(); ++tick) {
            const std::int64_t number = knots[leg - 1].tick + tick;
            controllers::Actuation<double> given;
            state = loop.tick(number, state, segment.at_tick(tick), given);
            SpaceFlightRow row;
            space->tick(number, plan.at(number), row);
            space->describe(row);
            const double* q = state.plant.q;
            const SpaceMotion& motion = row.motion;
            worst.place_m = std::max({worst.place_m, std::abs(motion.position_m[0] - q[0]),
                                      std::abs(motion.position_m[1]), std::abs(motion.position_m[2] - q[1])});
            worst.angle_rad = std::max(
                {worst.angle_rad, std::abs(2 * std::atan2(motion.attitude[2], motion.attitude[0]) - q[2]),
                 std::abs(motion.attitude[1]), std::abs(motion.attitude[3]), std::abs(motion.joints_rad[0] - q[3])});
            for (int i = 0; i < 4; ++i) {
                worst.command_n =
                    std::max(worst.command_n, std::abs(row.rotor_command_n[i] - given.command.thrust_n[i]));
            }
            worst.energy_j = std::max(worst.energy_j, std::abs(row.energy_j - state.plant.energy_j));
            worst.max_saturation = std::max(worst.max_saturation, row.saturation);
            worst.way_m = std::max(worst.way_m, std::abs(q[0]));
        }
    }
    return worst;
}

}  // namespace

TEST_CASE("The shipped robot flies planar references in space as in the plane, to 1e-6 m over 20 s") {
    const bool has_surfaces = GENERATE(false, true);
    const bool has_wash = GENERATE(false, true);
    Robot robot = shipped_robot_in_air();
    if (has_wash) {
        robot.arm.wash = WashParameters{};
    }
    const Difference found = difference_of(robot, {}, has_surfaces);
    CAPTURE(has_surfaces, has_wash, found.angle_rad, found.command_n, found.energy_j);
    CHECK(found.way_m > 1);
    CHECK(found.max_saturation < 1);
    CHECK(found.place_m < 1e-6);
    CHECK(found.angle_rad < 1e-6);
    CHECK(found.energy_j < 1e-2);
}

TEST_CASE("So it does in worlds with the parameters of the plane") {
    Random random(6);
    for (int trial = 0; trial < 6; ++trial) {
        Robot robot = shipped_robot_in_air();
        if (trial % 2 == 1) {
            robot.arm.wash = WashParameters{};
        }
        World world = planar_world(random);
        if (trial == 5) {
            robot.controller.rate_hz = 400;  // the delay is longer than what every state remembers
            world.delay_s = 0.005;
        }
        const Difference found = difference_of(robot, world, true);
        CAPTURE(trial, found.angle_rad, found.command_n, found.energy_j, found.max_saturation);
        CHECK(found.way_m > 1);
        CHECK(found.max_saturation < 1);
        CHECK(found.place_m < 1e-6);
        CHECK(found.angle_rad < 1e-6);
    }
}

TEST_CASE("The end of an arm presses on a wall in space as in the plane") {
    Problem problem = ceiling_problem();
    problem.robot = shipped_robot_in_air();
    problem.robot.body = {{Box{{1.04, 1.04, 0.22}}, {0, 0, 0}}};
    problem.aero.enabled = false;
    problem.obstacles.push_back(box("wall", {0.3, 8, 5}, {4.5, 0, 2.5}));
    problem.goal = Goal{};
    ContactGoal& contact = problem.goal.kind.emplace<ContactGoal>();
    contact.obstacle = "wall";
    contact.part = TouchingPart::end_effector;
    contact.force_n = 5;
    contact.z_m = 2;
    problem.goal.hold_s = 4;
    problem = with_touches(problem);
    REQUIRE(problem.goal.places.size() == 1);
    const auto model = make_flight_model(problem);
    const Configuration at = placed_at(problem.goal.places[0], model->tick().plant, {0, 0, 0}, 0, 0);
    const std::vector<ReferenceKnot> knots{{0, at_rest(at)}};
    const Execution planar = execute(*model, model->state_at(level_at(at)), knots, std::span(&problem.goal, 1), false);

    SpaceRobot twin = twin_of(problem.robot);
    twin.body = {{Box{{1.04, 1.04, 0.22}}, {0, 0, 0}}};
    twin.links[0].body = {{Capsule{problem.robot.arm.radius_m, {0, 0, 0}, twin.plant.end_effector_m}, {}}};
    const auto scene = std::make_shared<const Scene>(problem.obstacles);
    const SpaceChecker checker(scene, shape_of(twin));
    SpaceContactGoal goal;
    goal.obstacle = "wall";
    goal.force_n = 5;
    const SpaceGoalRule rule(twin, scene, {SpaceGoal{goal, 4, {}}});
    SpaceFlightSettings settings;
    settings.goals = &rule;
    settings.checker = &checker;
    settings.leads_touches = false;  // no law of the plane is told of the force
    SpaceMotion start;
    start.position_m = {at[plane::x], 0, at[plane::z]};
    const SpaceFlight flight = fly(twin, plan_in_space(knots, model->tick().tick_s), start, settings);

    CHECK(planar.outcome == Outcome::ok);
    CHECK(flight.outcome == Outcome::ok);
    REQUIRE(planar.goals[0].touch);
    REQUIRE(flight.goals[0].touch);
    const SpaceTouchRecord& touch = *flight.goals[0].touch;
    CHECK(touch.touched_s == planar.goals[0].touch->touched_s);
    CHECK(touch.force_n == Approx(planar.goals[0].touch->force_n).epsilon(1e-3));
    CHECK(touch.force_n == Approx(5).epsilon(0.05));
    CHECK(touch.power_w == Approx(planar.goals[0].touch->power_w).epsilon(1e-3));
    double before_m = 0, in_all_m = 0;  // apart, before the touch and in all
    for (std::size_t i = 0; i < std::min(flight.rows.size(), planar.rows.size()); ++i) {
        const Vector3& place_m = flight.rows[i].motion.position_m;
        const double apart_m = std::hypot(place_m[0] - planar.rows[i].q[0], place_m[2] - planar.rows[i].q[1]);
        in_all_m = std::max(in_all_m, apart_m);
        before_m = flight.rows[i].t_s < touch.touched_s ? in_all_m : before_m;
    }
    CHECK(before_m < 1e-6);
    CHECK(in_all_m < 1e-3);
}

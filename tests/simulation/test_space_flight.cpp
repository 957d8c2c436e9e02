#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "../support/error_of.hpp"
#include "../support/space_robots.hpp"
#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/simulation/space_flight.hpp"

// Whole flights in space and how they end.

using namespace downwash;
using namespace downwash::test;

namespace {

SpaceFlight flown(const SpaceRobot& robot, const SpaceFlightSettings& settings) {
    const SpacePlan plan = space_plan(robot.joints());
    return fly(robot, plan, motion_at_rest(plan.reference.front().point), settings);
}

/// Nothing acts on the rotors, but they may not go beyond a plane.
class Fenced final : public simulation::SpaceEffect {
 public:
    SidedFactor<double> at_rotor(int /*rotor*/, const dynamics::LaneVector<double>& /*hub_m*/) override {
        return {1, 1};
    }
    bool is_flyable(int /*rotor*/, const dynamics::LaneVector<double>& hub_m) override { return hub_m.x < 1.2; }
};

std::shared_ptr<const Scene> deck_at(double z_m) {
    return std::make_shared<const Scene>(std::vector<Obstacle>{{"deck", Box{{6, 6, 0.2}}, {0, 0, z_m + 0.1}, {}}});
}

}  // namespace

TEST_CASE("A plan in space is flown to its end by robots with any arm, under either law") {
    const int joints = GENERATE(range(0, max_built_joints() + 1));
    const bool has_cascade = GENERATE(false, true);
    SpaceRobot robot = space_robot(joints);
    if (has_cascade && joints > 3) {
        SUCCEED("a cascade knows no arm, and such a long one pulls it half a metre aside");
        return;
    }
    if (has_cascade) {
        robot.controller.law = cascade_gains_for(robot.plant.time_constant_s, {});
    }
    CAPTURE(joints, has_cascade);
    SpaceFlightSettings settings;
    settings.hold_ticks = 300;
    const SpaceFlight flight = flown(robot, settings);
    REQUIRE(flight.outcome == Outcome::ok);
    REQUIRE(flight.rows.size() == 1501);
    CHECK(flight.duration_s == Approx(15));
    CHECK(flight.max_saturation < 1);
    CHECK(flight.max_tracking_error_m < 0.5);
    const SpaceFlightRow& last = flight.rows.back();
    CHECK(last.motion.position_m[0] == Approx(0).margin(0.05));
    CHECK(last.motion.position_m[2] == Approx(2).margin(0.05));
    CHECK(std::isinf(flight.min_clearance_m));
    // Energy is the integral of power: by the trapezoidal rule, whose error is small where power is smooth.
    double energy_j = 0;
    for (std::size_t i = 1; i < flight.rows.size(); ++i) {
        energy_j += 0.005 * (flight.rows[i - 1].power_w + flight.rows[i].power_w);
    }
    CHECK(flight.energy_j == Approx(energy_j).epsilon(2e-3));
    CHECK(flight.energy_j > 15 * 6 * 6 * std::pow(robot.plant.multirotor.mass_kg * 9.8 / 6, 1.5) * 0.9);
    // The end effector is where the links are: of a level vehicle without joints straight below.
    if (joints == 0) {
        CHECK(last.end_effector_m[2] == Approx(last.motion.position_m[2] - 0.12).margin(1e-3));
    }
}

TEST_CASE("Rows of a flight follow from one another, whoever asks") {
    const SpaceRobot robot = space_robot(1);
    SpaceFlightSettings settings;
    int calls = 0;
    settings.after_tick = [&](const SpaceFlightRow& row) {
        ++calls;
        return row.t_s >= 1.0 - 1e-9 ? Rejection::interrupted : Rejection::none;
    };
    const SpaceFlight part = flown(robot, settings);
    CHECK(part.rejection == Rejection::interrupted);
    CHECK(calls == 101);
    settings.after_tick = {};
    const SpaceFlight whole = flown(robot, settings);
    for (std::size_t i = 0; i < 101; ++i) {
        CHECK(part.rows[i].motion == whole.rows[i].motion);
    }
    settings.is_over = [] { return true; };
    CHECK_THROWS_AS(flown(robot, settings), WorkStopped);
}

TEST_CASE("Flights in space end where vehicles are lost, touch something, leave the flyable area or miss the goal") {
    const SpaceRobot robot = space_robot(0);
    SpaceFlightSettings settings;
    settings.hold_ticks = 200;
    CHECK(flown(robot, settings).outcome == Outcome::ok);

    SpaceFlightSettings weak = settings;
    weak.world.thrust_scale = -0.6;
    const SpaceFlight fallen = flown(robot, weak);
    CHECK(fallen.outcome == Outcome::unstable);
    CHECK(fallen.max_tracking_error_m > 3);

    Fenced fence;
    SpaceFlightSettings fenced = settings;
    fenced.effect = &fence;
    CHECK(flown(robot, fenced).outcome == Outcome::left_flyable_area);
    fenced.world.scene_m = {2, 0, 0};  // the fence is farther away than believed
    CHECK(flown(robot, fenced).outcome == Outcome::ok);

    const SpaceRobotShape shape{{{Sphere{0.4}, {0, 0, 0}}}, {}};
    const SpaceChecker checker(deck_at(2.9), shape);
    SpaceFlightSettings below = settings;
    below.checker = &checker;
    const SpaceFlight free = flown(robot, below);
    CHECK(free.outcome == Outcome::ok);
    CHECK(free.min_clearance_m > 0);
    CHECK(free.min_clearance_m < 0.2);
    below.world.scene_m = {0, 0, -0.2};
    const SpaceFlight touched = flown(robot, below);
    CHECK(touched.outcome == Outcome::collision);
    CHECK(touched.min_clearance_m <= 0);

    SpaceFlightSettings aimed = settings;
    aimed.meets_goal = [](const SpaceMotion& motion, const Vector3& /*end_effector_m*/) {
        return std::abs(motion.position_m[2] - 2) < 0.05;
    };
    CHECK(flown(robot, aimed).outcome == Outcome::ok);
    aimed.meets_goal = [](const SpaceMotion& motion, const Vector3& /*end_effector_m*/) {
        return std::abs(motion.position_m[2] - 2.3) < 0.05;
    };
    CHECK(flown(robot, aimed).outcome == Outcome::goal_missed);

    SpaceFlightSettings frugal = settings;
    frugal.energy_budget_j = 100;
    CHECK(flown(robot, frugal).outcome == Outcome::over_budget);
}

TEST_CASE("A vehicle in space may start upside down, but may not fall over") {
    SpaceRobot robot = space_robot(0);
    SpacePlan plan;
    plan.tick_s = 0.01;
    SpacePoint here;
    here.position[space::z] = 5;
    plan.reference = {{0, here}, {400, here}};
    SpaceMotion start = motion_at_rest(here);
    start.attitude = {std::cos(1.45), std::sin(1.45), 0, 0};  // 166 degrees about x
    const SpaceFlight recovered = fly(robot, plan, start);
    CHECK(recovered.outcome == Outcome::ok);
    CHECK(recovered.rows.back().motion.attitude[1] == Approx(0).margin(0.1));
    // One without roll torque on one side falls over from the upright.
    SpaceFlightSettings settings;
    settings.world.rotor_thrust_scale[0] = settings.world.rotor_thrust_scale[1] = -0.95;
    const SpaceFlight fallen = fly(robot, plan, motion_at_rest(here), settings);
    CHECK(fallen.outcome == Outcome::unstable);
}

TEST_CASE("A vehicle that has settled in its world starts there without a jerk") {
    const SpaceRobot robot = space_robot(1);
    SpacePlan plan;
    plan.tick_s = 0.01;
    plan.joints = 1;
    SpacePoint here;
    here.position[space::z] = 2;
    here.position[space::yaw] = 0.5;
    plan.reference = {{0, here}, {300, here}};
    SpaceFlightSettings settings;
    settings.world.mass_scale = 0.05;
    settings.world.thrust_scale = -0.05;
    settings.world.center_of_mass_m = {0.01, 0.01, 0};
    const SpaceFlight at_once = fly(robot, plan, motion_at_rest(here), settings);
    settings.settles = true;
    const SpaceFlight settled = fly(robot, plan, motion_at_rest(here), settings);
    CHECK(at_once.max_tracking_error_m > 0.01);
    CHECK(settled.max_tracking_error_m < 0.1 * at_once.max_tracking_error_m);
    CHECK(settled.rows.front().energy_j == 0);
}

TEST_CASE("Direct effects in space are those of a rotor at its hub, and walls are near on whatever side") {
    const SpaceRobot robot = space_robot(0);
    AeroSettings aero;
    const auto scene = deck_at(3);
    simulation::DirectSpaceEffect effect(scene, aero, robot);
    const DirectEffect direct(scene, aero, robot.rotor_radius_m);
    for (const double z_m : {0.5, 2.0, 2.7, 2.85}) {
        const auto k = effect.at_rotor(0, {0.3, -0.2, z_m});
        CHECK(k.all == direct.sided_factor({0.3, -0.2, z_m}).all);
        CHECK(effect.at_rotor(3, {0.3, -0.2, z_m}).above == k.above);
    }
    CHECK(effect.at_rotor(0, {0, 0, 2.85}).above > 1.02);
    CHECK(effect.is_flyable(0, {0, 0, 2.7}));
    CHECK_FALSE(effect.is_flyable(0, {0, 0, 2.99}));

    // A flight under the deck feels it: the vehicle hovers with less command.
    SpacePlan plan;
    plan.tick_s = 0.01;
    SpacePoint here;
    here.position[space::z] = 2.8;
    plan.reference = {{0, here}, {1500, here}};
    SpaceFlightSettings settings;
    const SpaceFlight away = fly(robot, plan, motion_at_rest(here), settings);
    settings.effect = &effect;
    settings.aero = simulation::space_aero(aero, robot.rotor_radius_m);
    const SpaceFlight near = fly(robot, plan, motion_at_rest(here), settings);
    REQUIRE(near.outcome == Outcome::ok);
    CHECK(near.rows.back().rotor_lag_n[0] * near.rows.back().rotor_factor[0] ==
          Approx(away.rows.back().rotor_lag_n[0]).epsilon(1e-3));
    CHECK(near.rows.back().rotor_factor[0] > 1.01);

    aero.wall = {0.02, 0.04, 0.7};
    const auto wall =
        std::make_shared<const Scene>(std::vector<Obstacle>{{"wall", Box{{0.2, 40, 40}}, {2.1, 0, 0}, {}}});
    simulation::DirectSpaceEffect beside(wall, aero, robot);
    const double gap_m = 0.5 - 0.275 - robot.rotor_radius_m;
    const auto towards = beside.wall_nearness({1.5, 0.4, 1});
    CHECK(towards.x == Approx(std::exp(-gap_m / (0.7 * robot.rotor_radius_m))).epsilon(1e-6));
    CHECK(towards.y == Approx(0).margin(1e-9));
}

TEST_CASE("An arm with more joints than the build flies is an error that says how to build") {
    SpaceRobot robot = space_robot(3);
    while (robot.joints() <= max_built_joints()) {
        robot.plant.links.push_back(robot.plant.links.back());
        robot.links.push_back(robot.links.back());
    }
    if (robot.joints() > max_joints) {
        SUCCEED("this build flies every arm");
        return;
    }
    SpacePlan plan = space_plan(robot.joints());
    CHECK(error_of([&] { static_cast<void>(fly(robot, plan, {})); }).find("DOWNWASH_MAX_JOINTS") != std::string::npos);
}

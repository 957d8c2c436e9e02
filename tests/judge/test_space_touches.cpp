#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>

#include "../support/space_robots.hpp"
#include "downwash/base/direction.hpp"
#include "downwash/judge/space_judge.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/space_tool.hpp"

// Flights in space that touch surfaces: the judge and an execution tell the same story, each with a contact, a course
// and rules of its own.

using namespace downwash;
using namespace downwash::test;

namespace {

AeroSettings no_effects() {
    AeroSettings aero;
    aero.enabled = false;
    return aero;
}

SpaceRobot hexa370() {
    return read_space_robot(DOWNWASH_PROBLEMS "/robots/hexa370_arm3.yaml");
}

Obstacle turned_box(const std::string& name, const Vector3& size_m, const Vector3& center_m,
                    const Vector3& rpy_rad = {}) {
    return {name, Box{size_m}, center_m, rpy_rad};
}

/// A way from rest to rest that ends in front of a surface, without a turn.
SpacePlan way_to(const SpaceRobot& robot, SpacePoint from, SpacePoint to, std::int64_t ticks) {
    SpacePlan plan;
    plan.tick_s = 1 / robot.controller.rate_hz;
    plan.joints = robot.joints();
    plan.reference = {{0, from}, {ticks, to}};
    return plan;
}

SpacePoint point_at(const Vector3& position_m, double yaw_rad = 0, std::vector<double> joints_rad = {}) {
    SpacePoint point;
    std::copy(position_m.begin(), position_m.end(), point.position);
    point.position[space::yaw] = yaw_rad;
    std::copy(joints_rad.begin(), joints_rad.end(), point.position + space::first_joint);
    return point;
}

struct Told {
    SpaceFlight flown;
    judge::SpaceJudgedFlight judged;
};

/// Flies a plan for goals by both.
Told told(const SpaceRobot& robot, const SpacePlan& plan, const std::vector<Obstacle>& obstacles,
          const std::vector<SpaceGoal>& goals, const std::optional<SpaceWorld>& world = {},
          const AeroSettings& aero = no_effects()) {
    const auto scene = std::make_shared<const Scene>(obstacles);
    const SpaceChecker checker(scene, shape_of(robot));
    const SpaceGoalRule rule(robot, scene, goals);
    const SpaceMotion start = motion_at_rest(plan.at(0));
    SpaceFlightSettings settings;
    settings.checker = &checker;
    settings.goals = &rule;
    settings.settles = world.has_value();
    settings.world = world.value_or(SpaceWorld{});
    std::unique_ptr<simulation::DirectSpaceEffect> effect;
    if (aero.enabled) {
        effect = std::make_unique<simulation::DirectSpaceEffect>(scene, aero, robot);
        settings.effect = effect.get();
        settings.aero = simulation::space_aero(aero, robot.rotor_radius_m);
    }
    judge::SpaceFlightConditions conditions;
    conditions.start = {start.position_m,   start.attitude,         start.joints_rad,
                        start.velocity_m_s, start.body_rates_rad_s, start.joint_rates_rad_s};
    conditions.world = world;
    conditions.goals = goals;
    return {fly(robot, plan, start, settings), judge::SpaceJudge(robot, obstacles, aero).fly(plan, conditions)};
}

/// The touch of a flight whose reference and law do not hear of its force.
SpaceTouchRecord touch_without_lead(const SpaceRobot& robot, const SpacePlan& plan,
                                    const std::vector<Obstacle>& obstacles, const std::vector<SpaceGoal>& goals) {
    const SpaceGoalRule rule(robot, std::make_shared<const Scene>(obstacles), goals);
    SpaceFlightSettings settings;
    settings.goals = &rule;
    settings.leads_touches = false;
    const SpaceFlight flight = fly(robot, plan, motion_at_rest(plan.at(0)), settings);
    REQUIRE(flight.goals[0].touch);
    return *flight.goals[0].touch;
}

/// Both agree, and the touch is met.
void check_met(const Told& told, double force_n, double place_tolerance_m) {
    const SpaceGoalVisit& flown = told.flown.goals.back();
    const judge::SpaceJudgedGoal& judged = told.judged.goals.back();
    REQUIRE(flown.touch);
    REQUIRE(judged.touch);
    INFO("end " << name_of(flown.touch->end) << ", force " << flown.touch->force_n << " and " << judged.touch->force_n
                << " N, slip " << flown.touch->slip_m << " and " << judged.touch->slip_m);
    CHECK(told.flown.outcome == Outcome::ok);
    CHECK(told.judged.outcome == judge::Outcome::ok);
    CHECK(flown.is_met);
    CHECK(judged.is_met);
    CHECK(flown.touch->end == SpaceTouchEnd::met);
    // The last contact may be a few ticks apart: it depends on the last digits of a bounce.
    CHECK(std::abs(told.flown.duration_s - told.judged.duration_s) < 0.05);
    CHECK(flown.touch->force_n == Approx(force_n).epsilon(0.1));
    CHECK(judged.touch->force_n == Approx(flown.touch->force_n).epsilon(0.01));
    const Vector3 apart_m = flown.touch->place_m - judged.touch->place_m;
    CHECK(std::sqrt(dot(apart_m, apart_m)) < place_tolerance_m);
    CHECK(std::abs(flown.touch->slip_m - judged.touch->slip_m) < place_tolerance_m);
    CHECK(flown.error_m == Approx(judged.error_m).margin(place_tolerance_m));
}

SpaceContactGoal contact(const std::string& obstacle, TouchingPart part, double force_n) {
    SpaceContactGoal goal;
    goal.obstacle = obstacle;
    goal.part = part;
    goal.force_n = force_n;
    return goal;
}

const std::vector<Obstacle> under_a_deck = {turned_box("ground", {20, 20, 1}, {0, 0, -0.5}),
                                            turned_box("deck", {6, 6, 1}, {0, 0, 4.5})};

/// From half a metre away to 0.3 m under the deck, whose underside is at 4 m. The top is 0.111 m up.
SpacePlan way_under_the_deck(const SpaceRobot& robot) {
    return way_to(robot, point_at({-0.5, 0.2, 3.2}, 0.4), point_at({0, 0, 3.589}, 0.4), 300);
}

/// A vehicle with a stiff arm of 0.6 m that points ahead.
SpaceRobot long_armed() {
    SpaceRobot robot = space_robot(1);
    SpaceLink& link = robot.plant.links[0];
    link.joint_m = {0.05, 0, 0};
    link.axis = {0, 1, 0};
    link.center_of_mass_m = {0.2, 0, 0};
    robot.plant.end_effector_m = {0.6, 0, 0};
    robot.tool_direction = {1, 0, 0};
    robot.links[0].body = {{Capsule{0.02, {0.1, 0, 0}, {0.58, 0, 0}}, {}}};
    robot.links[0].max_torque_nm = 5;
    robot.body = {{Box{{0.5, 0.5, 0.1}}, {0, 0, 0.03}}};
    return robot;
}

}  // namespace

TEST_CASE("A hexarotor presses on a deck with its top, and the judge agrees") {
    const SpaceRobot robot = hexa370();
    const SpaceGoal goal{contact("deck", TouchingPart::frame, 5), 4, {}};
    SECTION("nominal") {
        const Told flight = told(robot, way_under_the_deck(robot), under_a_deck, {goal});
        check_met(flight, 5, 1e-3);
        // The force is in the rows, and the touch is no loss of clearance.
        double most_n = 0;
        for (const SpaceFlightRow& row : flight.flown.rows) {
            most_n = std::max(most_n, row.contact_force_n);
        }
        CHECK(most_n == flight.flown.goals[0].touch->peak_force_n);
        CHECK(flight.flown.rows.back().contact_force_n == 0);
        CHECK(flight.flown.min_clearance_m > 0.25);
        CHECK(flight.judged.min_clearance_m == Approx(flight.flown.min_clearance_m).margin(1e-4));
    }
    SECTION("with suction, in a world that moves and turns the deck") {
        SpaceWorld world;
        world.scene_m = {0.03, -0.02, 0.04};
        world.scene_yaw_rad = 0.02;
        world.mass_scale = 0.03;
        world.center_of_mass_m = {0.004, -0.003, 0.002};
        AeroSettings aero;
        check_met(told(robot, way_under_the_deck(robot), under_a_deck, {goal}, world, aero), 5, 2e-3);
    }
}

TEST_CASE("A hexarotor presses on a plate with the end of its arm, and the judge agrees") {
    // The arm hangs: its tip is 0.346 m below the centre of mass, and a capsule ends 15 mm below the tip. A force along
    // three hinges in line buckles them where it times the last link's length is more than what its joint answers to a
    // radian, 22 / s2 times 2.6e-5 kg m2: above 0.01 N. Stiffer joints take 0.1 N.
    SpaceRobot robot = hexa370();
    robot.controller.delay_s = 0;
    std::get<SpaceInversion>(robot.controller.law).joint = {.kp_1_s2 = 400, .kd_1_s = 40};
    SpaceContactGoal wanted = contact("plate", TouchingPart::end_effector, 0.1);
    wanted.position_m = Vector3{0, 0, 1};
    const std::vector<Obstacle> obstacles = {turned_box("plate", {2, 2, 0.1}, {0, 0, 0.95})};
    const SpacePlan plan = way_to(robot, point_at({0.3, -0.2, 1.9}), point_at({0, 0, 1.661}), 300);
    check_met(told(robot, plan, obstacles, {{wanted, 4, {}}}), 0.1, 1e-3);
    // Elsewhere: the robot hovers too far from the wanted place.
    wanted.position_m = Vector3{0.2, 0, 1};
    const Told elsewhere = told(robot, plan, obstacles, {{wanted, 4, {}}});
    CHECK(elsewhere.flown.outcome == Outcome::goal_missed);
    CHECK(elsewhere.judged.outcome == judge::Outcome::goal_missed);
}

TEST_CASE("An arm presses on walls of any heading and slope along their normals") {
    const SpaceRobot robot = long_armed();
    const double yaw_rad = 0.7;
    const double slope_rad = GENERATE(0.0, 0.3);
    // A wall whose outer normal points back at the vehicle, its middle at (1.2, 0, 2) in the vehicle's heading.
    const Vector3 way{std::cos(yaw_rad) * std::cos(slope_rad), std::sin(yaw_rad) * std::cos(slope_rad),
                      -std::sin(slope_rad)};
    const Vector3 middle_m = Vector3{1, 2, 2} + 1.2 * way;
    const std::vector<Obstacle> obstacles = {
        turned_box("wall", {0.2, 3, 3}, middle_m + 0.1 * way, {0, slope_rad, yaw_rad})};
    // The tip waits 0.3 m in front of the wall.
    const SpacePoint there = point_at({}, yaw_rad, {slope_rad});
    const SpacePose level{{0, 0, 0}, {std::cos(yaw_rad / 2), 0, 0, std::sin(yaw_rad / 2)}, {slope_rad}};
    const SpaceToolPose tool = tool_at(robot, level);
    CHECK(dot(tool.direction, way) == Approx(1));
    const Vector3 at_m = middle_m - 0.3 * way - tool.position_m;
    SpacePoint to = there;
    std::copy(at_m.begin(), at_m.end(), to.position);
    SpacePoint from = to;
    from.position[0] -= 0.4;
    const SpaceGoal goal{contact("wall", TouchingPart::end_effector, 2), 4, {}};
    CAPTURE(slope_rad);
    check_met(told(robot, way_to(robot, from, to, 300), obstacles, {goal}), 2, 1e-3);
}

TEST_CASE("A vehicle that presses leans, and the end of its arm stays where it touched, by both") {
    // ARS-LRM presses with as much as its joint alone can stand, along an arm of 1.2 m: it leans by 6 degrees.
    const SpaceRobot robot = read_space_robot(DOWNWASH_PROBLEMS "/robots/ars_lrm_space.yaml");
    const std::vector<Obstacle> obstacles = {turned_box("wall", {0.2, 6, 6}, {2.6, 0, 3})};
    const SpacePlan plan = way_to(robot, point_at({0.5, 0, 3}), point_at({1, 0, 3}), 300);
    SpaceContactGoal wanted = contact("wall", TouchingPart::end_effector, 5);
    wanted.position_m = Vector3{2.5, 0, 3};
    const Told led = told(robot, plan, obstacles, {{wanted, 5, {}}});
    check_met(led, 5, 1e-3);
    const SpaceTouchRecord& touch = *led.flown.goals[0].touch;
    CHECK(length_of(touch.place_m - Vector3{2.47, 0, 3}) < 0.02);  // the capsule ends 3 cm beyond the end effector
    CHECK(touch.slip_m < 0.01);
    double most_lean_rad = 0;
    for (const SpaceFlightRow& row : led.flown.rows) {
        most_lean_rad = std::max(most_lean_rad, 2 * std::hypot(row.motion.attitude[1], row.motion.attitude[2]));
    }
    CHECK(most_lean_rad > 0.1);
    // As in the plane, where neither reference nor law hear of the force.
    const SpaceTouchRecord unled = touch_without_lead(robot, plan, obstacles, {{wanted, 5, {}}});
    CHECK(length_of(unled.place_m - Vector3{2.47, 0, 3}) > 0.05);
}

TEST_CASE("An arm of two light links in line presses, and buckles only where its law does not hear of the force") {
    const SpaceRobot robot = read_space_robot(DOWNWASH_PROBLEMS "/robots/hexa960_arm2.yaml");
    constexpr double ahead_rad = std::numbers::pi / 2;
    const SpacePoint there = point_at({1, 0, 3}, 0, {ahead_rad});
    const SpaceToolPose tool = tool_at(robot, SpacePose{{1, 0, 3}, {1, 0, 0, 0}, {ahead_rad}});
    REQUIRE(tool.direction[0] == Approx(1));
    const std::vector<Obstacle> obstacles = {turned_box("wall", {0.2, 6, 6}, tool.position_m + Vector3{0.43, 0, 0})};
    SpacePoint from = there;
    from.position[0] -= 0.4;
    const SpacePlan plan = way_to(robot, from, there, 300);
    const std::vector<SpaceGoal> goals = {{contact("wall", TouchingPart::end_effector, 3), 4, {}}};
    const Told flight = told(robot, plan, obstacles, goals);
    check_met(flight, 3, 2e-3);
    CHECK(flight.flown.goals[0].touch->slip_m < 0.01);
    const SpaceTouchEnd unled = touch_without_lead(robot, plan, obstacles, goals).end;
    CHECK(name_of(unled) != name_of(SpaceTouchEnd::met));
}

TEST_CASE("A flight meets its goals one after the other, touches among them, and goes on") {
    const SpaceRobot robot = hexa370();
    SpacePlan plan = way_under_the_deck(robot);
    const SpacePoint under = plan.reference.back().point;
    plan.reference.push_back({plan.reference.back().tick + 200, under});
    plan.reference.push_back({plan.reference.back().tick + 300, point_at({0.5, 0, 2.5}, 0.4)});
    SpaceConfigurationGoal end;
    end.x_m = 0.5;
    end.z_m = 2.5;
    const Told flight = told(robot, plan, under_a_deck,
                             {SpaceGoal{contact("deck", TouchingPart::frame, 4), 2, {}}, SpaceGoal{end, 3, {}}});
    CHECK(flight.flown.outcome == Outcome::ok);
    CHECK(flight.judged.outcome == judge::Outcome::ok);
    REQUIRE(flight.flown.goals.size() == 2);
    CHECK(flight.flown.goals[0].touch->end == SpaceTouchEnd::met);
    CHECK_FALSE(flight.flown.goals[1].touch);
    CHECK(std::abs(flight.flown.duration_s - flight.judged.duration_s) < 0.05);
    CHECK(flight.judged.goals[0].touch->force_n == Approx(flight.flown.goals[0].touch->force_n).epsilon(0.01));
    CHECK(flight.judged.goals[1].error_m == Approx(flight.flown.goals[1].error_m).margin(1e-3));
}

TEST_CASE("A touch that is missed, too fast, too strong or of something else ends the flight, by both") {
    const SpaceRobot robot = hexa370();
    SpaceContactGoal goal = contact("deck", TouchingPart::frame, 5);
    const auto fly_for = [&](const SpaceContactGoal& wanted, const std::vector<Obstacle>& obstacles,
                             const std::optional<SpaceWorld>& world = {}) {
        return told(robot, way_under_the_deck(robot), obstacles, {{wanted, 2, {}}}, world);
    };
    const auto both_end = [](const Told& flight, Outcome flown, judge::Outcome judged, SpaceTouchEnd end) {
        CHECK(flight.flown.outcome == flown);
        CHECK(flight.judged.outcome == judged);
        REQUIRE(flight.flown.goals[0].touch);
        CHECK(name_of(flight.flown.goals[0].touch->end) == name_of(end));
        CHECK_FALSE(flight.flown.goals[0].is_met);
        CHECK_FALSE(flight.judged.goals[0].is_met);
    };
    SECTION("nothing is there") {
        SpaceWorld world;
        world.scene_m = {0, 0, 1};
        both_end(fly_for(goal, under_a_deck, world), Outcome::goal_missed, judge::Outcome::goal_missed,
                 SpaceTouchEnd::missed);
    }
    SECTION("too fast") {
        // A heavy vehicle that comes with a single point.
        SpaceRobot ram = space_robot(0);
        ram.plant.multirotor.mass_kg = 4.5;
        ram.body = {{Sphere{0.1}, {0, 0, 0.05}}};
        goal.speed_m_s = 1;
        goal.standoff_m = 1;
        const SpacePlan plan = way_to(ram, point_at({0, 0, 2.5}), point_at({0, 0, 2.85}), 200);
        both_end(told(ram, plan, under_a_deck, {{goal, 2, {}}}), Outcome::collision, judge::Outcome::collision,
                 SpaceTouchEnd::too_deep);
    }
    SECTION("a force that it does not hold well enough") {
        goal.force_tolerance_n = 1e-5;
        both_end(fly_for(goal, under_a_deck), Outcome::goal_missed, judge::Outcome::goal_missed,
                 SpaceTouchEnd::wrong_force);
    }
    SECTION("something else") {
        // A beam below the deck, in the way of a rotor alone. It hangs 5 cm deeper, and the top of a rotor is 3.5 cm
        // lower than the frame.
        std::vector<Obstacle> obstacles = under_a_deck;
        obstacles.push_back(turned_box("beam", {0.02, 0.02, 0.05}, {0.24, 0.05, 3.975}));
        both_end(fly_for(goal, obstacles), Outcome::collision, judge::Outcome::collision, SpaceTouchEnd::cut_short);
    }
}

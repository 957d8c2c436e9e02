#include <catch2/catch.hpp>
#include <cmath>

#include "../support/test_problem.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/touch_places.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/touch.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

/// A vehicle that hovers where it may touch the ceiling with its frame, or a wall with the end of its arm.
Problem touching_problem(TouchingPart part, double force_n) {
    Problem problem = ceiling_problem();
    // Gains of a real vehicle, which is stiff against the suction of a ceiling and soft in pitch.
    ModelInversion& gains = gains_of(problem.robot);
    gains.height_kp = 12;
    gains.height_kd = 7;
    gains.height_ki = 6;
    gains.attitude_kp = 2;
    gains.attitude_rate_kp = 14;
    gains.attitude_rate_ki = 8;
    gains.pitch_rate_filter_s = 0.25;
    gains.arm_kp = 34;
    gains.arm_kd = 9.5;
    gains.arm_ki = 10;
    problem.robot.body = {{Box{{1.04, 1.04, 0.22}}, {0, 0, 0}}};  // a frame that reaches 5 cm over the rotors
    problem.obstacles.push_back(box("wall", {0.3, 8, 5}, {4.5, 0, 2.5}));
    problem.goal = Goal{};
    ContactGoal& contact = problem.goal.kind.emplace<ContactGoal>();
    contact.obstacle = part == TouchingPart::frame ? "ceiling" : "wall";
    contact.part = part;
    contact.force_n = force_n;
    (part == TouchingPart::frame ? contact.x_m : contact.z_m) = part == TouchingPart::frame ? -1 : 2;
    problem.goal.hold_s = 4;
    problem.aero.min_distance_radii = 0.05;
    problem = with_touches(problem);
    REQUIRE(problem.goal.places.size() == 1);
    return problem;
}

Execution touch_from_hover(const Problem& problem, const FlightWorld& in = {}, bool aero = true) {
    const auto model = make_flight_model(problem);
    const Goal& place = problem.goal.places.front();
    Configuration at{0, 0, quarter_turn};
    if (part_of(place) == GoalPart::end_effector) {
        at[plane::arm] = *test::end_effector(place).direction_rad;
    }
    at = placed_at(place, model->tick().plant, at, 0, 0);
    const std::vector<ReferenceKnot> knots{{0, at_rest(at)}};
    return execute(*model, model->state_at(level_at(at)), knots, std::span(&problem.goal, 1), aero, in);
}

}  // namespace

TEST_CASE("a vehicle presses on a ceiling and on a wall with the force that is asked for, and leaves") {
    const auto part = GENERATE(TouchingPart::frame, TouchingPart::end_effector);
    const double force_n = GENERATE(3.0, 8.0);
    CAPTURE(static_cast<int>(part), force_n);
    const Execution flight = touch_from_hover(touching_problem(part, force_n));
    CHECK(flight.outcome == Outcome::ok);
    REQUIRE(flight.goals[0].touch);
    CHECK(flight.goals[0].touch->is_met);
    CHECK(flight.goals[0].touch->force_n == Approx(force_n).epsilon(0.05));
    CHECK(flight.goals[0].touch->max_depth_m < max_touch_depth_m);
    CHECK(flight.goals[0].touch->left_s - flight.goals[0].touch->touched_s > 5 / (0.4 * std::sqrt(12.0)) + 4);
    CHECK(flight.min_clearance_m > 0.1);  // the touch does not count
    CHECK(flight.rows.back().contact_force_n == 0);
}

TEST_CASE("an observer does not take a surface that is touched for a disturbance") {
    const auto part = GENERATE(TouchingPart::frame, TouchingPart::end_effector);
    const double gain_1_s = GENERATE(3.0, 10.0);
    const bool is_in_noise = GENERATE(false, true);
    CAPTURE(static_cast<int>(part), gain_1_s, is_in_noise);
    Problem problem = touching_problem(part, 5);
    gains_of(problem.robot).aids.observer = controllers::DisturbanceObserver{gain_1_s};
    World noisy;
    noisy.velocity_noise_m_s = is_in_noise ? 0.01 : 0;
    const FlownWorld world = make_world(problem.robot, noisy);
    const Execution flight = touch_from_hover(problem, {&world});
    REQUIRE(flight.goals[0].touch);
    CHECK(flight.goals[0].touch->is_met);
    CHECK(flight.goals[0].touch->force_n == Approx(5).epsilon(0.05));
    CHECK(flight.outcome == Outcome::ok);
}

TEST_CASE("the thrust under a ceiling that is touched carries the weight and the force, with its K") {
    const Execution flight = touch_from_hover(touching_problem(TouchingPart::frame, 5));
    REQUIRE(flight.goals[0].touch);
    const double weight_n = (4.5 + 0.45) * standard_gravity_m_s2;
    int held = 0;
    for (const FlightRow& row : flight.rows) {
        if (row.t_s > flight.goals[0].touch->left_s - 4 && row.t_s < flight.goals[0].touch->left_s - 1) {
            CHECK(row.thrust_n == Approx(weight_n + row.contact_force_n).epsilon(0.01));
            CHECK(row.thrust_command_n < 0.9 * weight_n);
            ++held;
        }
    }
    CHECK(held > 100);
}

TEST_CASE("a surface that is not where it is believed to be is found by touch, up to half a metre behind") {
    const Problem problem = touching_problem(TouchingPart::end_effector, 5);
    const auto touched = [&](double scene_x_m) {
        World world;
        world.scene_x_m = scene_x_m;
        const FlownWorld flown = make_world(problem.robot, world);
        return touch_from_hover(problem, {&flown});
    };
    for (const double scene_x_m : {-0.05, 0.05, 0.3}) {
        CAPTURE(scene_x_m);
        const Execution flight = touched(scene_x_m);
        CHECK(flight.outcome == Outcome::ok);
        CHECK(flight.goals[0].touch->force_n == Approx(5).epsilon(0.05));
    }
    const Execution missed = touched(0.8);
    CHECK(missed.outcome == Outcome::goal_missed);
    CHECK_FALSE(missed.goals[0].touch->is_met);
    CHECK(missed.goals[0].touch->touched_s == 0);
}

TEST_CASE("a touch that is too fast, or not with the part that is meant to, is a collision") {
    Problem problem = touching_problem(TouchingPart::end_effector, 5);
    problem.goal.places.front().touch->speed_m_s = 0.8;
    problem.goal.places.front().touch->standoff_m = 0.3;
    CHECK(touch_from_hover(problem).outcome == Outcome::collision);

    problem = touching_problem(TouchingPart::frame, 5);
    // Between the rotors, 2 mm lower than the top of the body will be.
    problem.obstacles.push_back(box("lamp", {0.1, 0.1, 0.022}, {-1, 0, 4.989}));
    CHECK(touch_from_hover(problem).outcome == Outcome::collision);
}

TEST_CASE("a touch through the map of a planner ends as the one with effects evaluated directly") {
    for (const TouchingPart part : {TouchingPart::frame, TouchingPart::end_effector}) {
        const Problem problem = touching_problem(part, 5);
        const auto model = make_flight_model(problem);
        const auto map = model->make_map(problem.bounds);
        const Goal& place = problem.goal.places.front();
        Configuration at{
            0, 0, part_of(place) == GoalPart::end_effector ? *test::end_effector(place).direction_rad : quarter_turn};
        at = placed_at(place, model->tick().plant, at, 0, 0);
        // Both begin as the hover before has left the vehicle.
        const Execution direct = touch_from_hover(problem);
        FlightState state = model->state_at(level_at(at));
        const ReferenceSegment hover(at_rest(at), at_rest(at), 200, model->tick().tick_s);
        static_cast<void>(fly(*model, map.get(), rules_of_execution(), hover, state));
        const TouchFlight flight = fly_touch(*model, map.get(), *place.touch, at_rest(at), state, {nullptr, 200});
        CHECK(flight.rejection == Rejection::none);
        CHECK(flight.record.force_n == Approx(direct.goals[0].touch->force_n).epsilon(0.01));
        CHECK(flight.record.touched_s == Approx(direct.goals[0].touch->touched_s).margin(0.05));
        CHECK(flight.record.power_w == Approx(direct.goals[0].touch->power_w).epsilon(0.02));
    }
}

TEST_CASE("hover, touch, hover and touch are one flight, which goes on as long as touches take") {
    const Problem problem = touching_problem(TouchingPart::frame, 5);
    const auto model = make_flight_model(problem);
    const PlantModel& plant = model->tick().plant;
    const Goal under_ceiling = problem.goal;
    const Goal before_wall = touching_problem(TouchingPart::end_effector, 5).goal;
    const Configuration ceiling = placed_at(under_ceiling.places[0], plant, {0, 0, quarter_turn}, 0, 0);
    const Configuration wall = placed_at(before_wall.places[0], plant, {0, 0, 0}, 0, 0);
    const Configuration middle{0, 2, quarter_turn};
    std::vector<Goal> goals{configuration_goal(0, 2), under_ceiling, configuration_goal(0, 2), before_wall};
    goals[0].hold_s = goals[2].hold_s = 1;
    const auto hovering = [](std::int64_t from, std::int64_t to, const Configuration& at) {
        return std::vector<ReferenceKnot>{{from, at_rest(at)}, {to, at_rest(at)}};
    };
    std::vector<ReferenceKnot> knots = hovering(0, 100, middle);
    for (const auto& more : {hovering(1100, 1300, ceiling), hovering(2300, 2400, middle)}) {
        knots.insert(knots.end(), more.begin(), more.end());
    }
    knots.push_back({3400, at_rest(wall)});
    const std::vector<PlannedTouch> planned = touches_of(*model, knots, goals);
    REQUIRE(planned.size() == 2);
    CHECK(planned[0].tick == 1300);
    CHECK(planned[0].goal == 1);
    CHECK(planned[1].tick == 3400 + 200);  // after the hover in front of the wall
    CHECK(planned[1].goal == 3);

    const FlightState start = model->state_at(level_at(middle));
    const Execution flight = execute(*model, start, knots, goals, true);
    CHECK(flight.outcome == Outcome::ok);
    REQUIRE(flight.goals.size() == 4);
    for (const GoalVisit& visit : flight.goals) {
        CHECK(visit.is_met);
    }
    REQUIRE(flight.goals[1].touch);
    REQUIRE(flight.goals[3].touch);
    CHECK_FALSE(flight.goals[0].touch);
    CHECK_FALSE(flight.goals[2].touch);
    CHECK(flight.goals[1].touch->touched_s > 13);
    CHECK(flight.goals[3].touch->touched_s > flight.goals[1].touch->left_s + 10 + 1 + 10);
    // It waits for the first touch: one that touches alone is through with it after as long a time.
    const Execution alone =
        execute(*model, start, {knots.begin(), knots.begin() + 3}, std::span(goals).subspan(1, 1), true);
    CHECK(alone.goals[0].touch->touched_s == flight.goals[1].touch->touched_s);
    CHECK(flight.duration_s - (alone.duration_s - 13) > 36);
    const FlightRow& back = flight.rows[static_cast<std::size_t>(std::llround(alone.duration_s / 0.01))];
    CHECK(back.q[1] == alone.rows.back().q[1]);
    CHECK(back.reference == alone.rows.back().reference);
    // A part of it is the same flight.
    const std::vector<ReferenceSegment> segments = Plan{knots, 0.01}.segments();
    const FlightPart part = execute_part(*model, start, segments, true, {}, {}, std::span(planned).first(1));
    CHECK(part.rejection == Rejection::none);
    const auto end = static_cast<std::size_t>(3400 + std::llround(alone.duration_s / 0.01) - 1300);
    CHECK(part.end.plant.q[0] == flight.rows[end].q[0]);
    CHECK(part.end.plant.energy_j == flight.rows[end].energy_j);

    // A touch that is not met ends the flight there.
    std::vector<Goal> hard = goals;
    hard[1].places[0].touch->force_tolerance_n = 1e-9;
    const Execution missed = execute(*model, start, knots, hard, true);
    CHECK(missed.outcome == Outcome::goal_missed);
    CHECK(missed.goals[0].is_met);
    CHECK_FALSE(missed.goals[1].is_met);
    CHECK_FALSE(missed.goals[2].is_met);
    CHECK_FALSE(missed.goals[3].touch);
    CHECK(missed.duration_s == Approx(alone.duration_s));
}

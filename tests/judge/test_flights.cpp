#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "../support/repetitions.hpp"
#include "../support/test_problem.hpp"
#include "downwash/judge/plan_judge.hpp"
#include "downwash/judge/reference.hpp"
#include "downwash/judge/simulated_vehicle.hpp"
#include "downwash/planner/planner.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/visit_order.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/world_parameters.hpp"
#include "shipped.hpp"

// The judge's flights against the planner's.

using namespace downwash;
using namespace downwash::test;

namespace {

Plan plan_of(Problem problem, std::uint64_t iterations) {
    problem.planner.max_iterations = iterations;
    problem.planner.time_limit_s.reset();
    problem.uncertainty.reset();
    const Solution solution = solve(problem);
    REQUIRE(solution.plan);
    return *solution.plan;
}

/// The flight of `downwash execute`, in a world if one is given.
std::optional<Execution> executed(const Problem& problem, const Plan& plan, bool aero,
                                  const std::optional<World>& world) {
    const auto model = make_flight_model(problem);
    const std::optional<FlownWorld> flown = world ? std::optional(make_world(problem.robot, *world)) : std::nullopt;
    const FlightWorld in{flown ? &*flown : nullptr, 0};
    FlightState nominal = start_state(*model, problem.start);
    if (flown) {
        nominal.world = memory_at_start(*flown, nominal.plant);
    }
    const auto start = flown && is_at_rest(problem.start) ? hovering_start(*model, nominal, aero, in) : nominal;
    if (!start) {
        return std::nullopt;
    }
    return execute(*model, *start, plan.reference, goals_of(problem), aero, in, {}, problem.energy_budget_j);
}

void compare(const judge::JudgedFlight& mine, const Execution& theirs) {
    CHECK(name_of(mine.outcome) == name_of(theirs.outcome));
    if (theirs.outcome != Outcome::collision && std::isfinite(theirs.min_clearance_m)) {
        CHECK(mine.min_clearance_m == Approx(theirs.min_clearance_m).margin(1e-3));
        CHECK(mine.clearance_integral == Approx(theirs.clearance_integral).epsilon(1e-3));
    }
    CHECK(mine.duration_s == Approx(theirs.duration_s).margin(1e-9));
    CHECK(mine.energy_j == Approx(theirs.energy_j).epsilon(1e-3));
    CHECK(mine.length_m == Approx(theirs.length_m).epsilon(1e-3));
    CHECK(mine.goal_error_m == Approx(theirs.goal_error_m).margin(1e-3));
    CHECK(mine.max_tracking_error_m == Approx(theirs.max_tracking_error_m).margin(1e-3));
}

/// Rotors that lag, drag, and sight that is late.
void make_real(Robot& robot) {
    robot.rotors.time_constant_s = 0.02;
    robot.controller.delay_s = 0.006;
    robot.multirotor.drag = {0.3, 0.1};
    robot.arm.drag = {0.05, 0.05};
}

}  // namespace

TEST_CASE("The judge flies on from the middle of a flight as the planner does, with every law") {
    const ControlLaw shipped_law = shipped("along_the_deck").robot.controller.law;
    for (const ControlLaw& law : {shipped_law, ControlLaw(CascadedPid{}), ControlLaw(PlanarLyapunov{})}) {
        for (const double observer_1_s : {0.0, 3.0}) {
            CAPTURE(law.index(), observer_1_s);
            Problem problem = shipped("along_the_deck");
            problem.uncertainty.reset();
            problem.robot.controller.law = law;
            if (observer_1_s > 0) {
                std::visit([&](auto& own) { own.aids.observer = controllers::DisturbanceObserver{observer_1_s}; },
                           problem.robot.controller.law);
            }
            const auto model = make_flight_model(problem);
            ReferencePoint there = at_rest(problem.start.at);
            there.position[0] += 2.5;
            there.velocity[0] = 0.4;
            ReferencePoint end = at_rest(configuration_of(there));
            end.position[0] += 1;
            end.position[2] -= 0.3;
            const Plan whole{{{0, at_rest(problem.start.at)}, {600, there}, {1000, end}}, 0.01};
            FlightState vehicle = start_state(*model, problem.start);
            const auto map = model->make_map(problem.bounds);
            REQUIRE(fly_along(*model, map.get(), whole, 600, vehicle));
            problem.start = start_of(*model, vehicle, there);
            problem.goal = Goal{};
            problem.goal.kind = ConfigurationGoal{end.position[0], end.position[1], {}};
            const Plan rest = whole.rest_after(600);
            const judge::JudgedFlight mine = judge::PlanJudge(problem).fly(rest, {});
            const auto theirs = executed(problem, rest, true, std::nullopt);
            REQUIRE(theirs);
            CHECK(theirs->max_tracking_error_m > 0.01);
            compare(mine, *theirs);
        }
    }
}

TEST_CASE("A vehicle that is told the plan tick by tick flies as the judge flies the plan") {
    const Problem problem = shipped("bridge_inspection");
    const Plan plan = plan_of(problem, 100);
    const judge::FlightConditions in{true, draw_world(*problem.uncertainty, problem.robot, 7, 3)};
    const judge::JudgedFlight whole = judge::PlanJudge(problem).fly(plan, in);
    judge::SimulatedVehicle vehicle(problem, in);
    const auto end = static_cast<std::int64_t>(whole.rows.size()) - 1;
    judge::Reference reference(plan);
    ReferencePoint now = reference.at(0);
    double noise_m = 0;
    for (std::int64_t tick = 0; tick < end; ++tick) {
        noise_m = std::max(noise_m, std::abs(vehicle.readings().pose.x_m - vehicle.flight().rows.back().pose.x_m));
        const ReferencePoint next = reference.at(tick + 1);
        vehicle.follow(now, next);
        now = next;
    }
    REQUIRE(vehicle.flight().rows.size() == whole.rows.size());
    const PlanarPose& there = vehicle.flight().rows.back().pose;
    CHECK(std::memcmp(&there, &whole.rows.back().pose, sizeof(there)) == 0);
    CHECK(vehicle.flight().energy_j == whole.energy_j);
    CHECK(vehicle.flight().min_clearance_m == whole.min_clearance_m);
    CHECK(noise_m > 0.005);  // it tells what its sensors see
    CHECK(noise_m < 0.1);
    CHECK(vehicle.readings().rotor_thrust_n.size() == 4);
    // It flies no farther than to where its flight ends: here it is told to leave for the deck.
    while (vehicle.flight().rows.size() < whole.rows.size() + 2000 && vehicle.follow(now, now)) {
        now.position[1] += 0.01;
    }
    CHECK(vehicle.flight().outcome != judge::Outcome::ok);
    const std::size_t rows = vehicle.flight().rows.size();
    CHECK_FALSE(vehicle.follow(now, now));
    CHECK(vehicle.flight().rows.size() == rows);
}

TEST_CASE("The judge's flight of a plan is the planner's on every shipped problem") {
    for (const char* name : shipped_names) {
        const Problem problem = shipped(name);
        const Plan plan = plan_of(problem, 100);
        const judge::PlanJudge judge(problem);
        for (const bool aero : {true, false}) {
            CAPTURE(name, aero);
            compare(judge.fly(plan, {aero, std::nullopt}), *executed(problem, plan, aero, std::nullopt));
        }
    }
}

TEST_CASE("It is in worlds as well, with lag, delay, drag, noise and gusts") {
    for (const char* name : {"bridge_inspection", "window", "culvert", "box_girder_bay"}) {
        Problem problem = shipped(name);
        const Plan plan = plan_of(problem, 100);
        make_real(problem.robot);
        problem.uncertainty.emplace();
        const judge::PlanJudge judge(problem);
        for (std::uint64_t index = 0; index < 5; ++index) {
            CAPTURE(name, index);
            const World world = draw_world(*problem.uncertainty, problem.robot, 7, index);
            const auto theirs = executed(problem, plan, true, world);
            const judge::JudgedFlight mine = judge.fly(plan, {true, world});
            if (theirs) {
                compare(mine, *theirs);
            } else {
                CHECK(mine.outcome == judge::Outcome::unstable);
            }
        }
        CAPTURE(name);
        // Without a world, lag, delay and drag act as the robot file says.
        compare(judge.fly(plan, {true, std::nullopt}), *executed(problem, plan, true, std::nullopt));
    }
}

TEST_CASE("It is where the controller sees many ticks late") {
    Problem problem = shipped("bridge_inspection");
    const Plan plan = plan_of(problem, 100);
    make_real(problem.robot);
    problem.robot.controller.delay_s = 0.036;
    problem.robot.uncertainty.reset();
    problem.uncertainty.emplace();
    const judge::PlanJudge judge(problem);
    const auto nominal = executed(problem, plan, true, std::nullopt);
    compare(judge.fly(plan, {true, std::nullopt}), *nominal);
    problem.robot.controller.delay_s = 0.03;
    CHECK(nominal->energy_j != executed(problem, plan, true, std::nullopt)->energy_j);  // or the rest is not seen
    problem.robot.controller.delay_s = 0.036;
    for (std::uint64_t index = 1; index < 4; ++index) {
        CAPTURE(index);
        World world = draw_world(*problem.uncertainty, problem.robot, 7, index);
        world.delay_s = 0.003 * static_cast<double>(index);
        const auto theirs = executed(problem, plan, true, world);
        const judge::JudgedFlight mine = judge.fly(plan, {true, world});
        if (theirs) {
            compare(mine, *theirs);
        } else {
            CHECK(mine.outcome == judge::Outcome::unstable);
        }
    }
}

TEST_CASE("A vehicle that starts in motion meets gusts from the first tick on") {
    Problem problem = shipped("bridge_inspection");
    const Plan plan = plan_of(problem, 100);
    make_real(problem.robot);
    problem.start.velocity[plane::x] = 0.3;
    problem.uncertainty.emplace();
    const judge::PlanJudge judge(problem);
    for (std::uint64_t index = 1; index < 4; ++index) {
        CAPTURE(index);
        const World world = draw_world(*problem.uncertainty, problem.robot, 3, index);
        compare(judge.fly(plan, {true, world}), *executed(problem, plan, true, world));
    }
}

TEST_CASE("The fountain pushes the vehicle in a world as the planner says") {
    Problem problem = shipped("box_girder_bay");
    const Plan plan = plan_of(problem, 100);
    problem.aero.ground = EffectModel::multirotor_body;
    problem.uncertainty.emplace();
    const judge::PlanJudge judge(problem);
    for (std::uint64_t index = 0; index < 5; ++index) {
        CAPTURE(index);
        const World world = draw_world(*problem.uncertainty, problem.robot, 1, index);
        compare(judge.fly(plan, {true, world}), *executed(problem, plan, true, world));
    }
}

TEST_CASE("Walls push and turn the vehicle in a world as the planner says") {
    Problem problem = shipped("box_girder_bay");
    const Plan plan = plan_of(problem, 100);
    problem.aero.wall = {0.02, 0.04, 1};
    const judge::PlanJudge judge(problem);
    const judge::JudgedFlight beside = judge.fly(plan, {true, std::nullopt});
    compare(beside, *executed(problem, plan, true, std::nullopt));
    problem.uncertainty.emplace();
    const judge::PlanJudge uncertain(problem);
    for (std::uint64_t index = 0; index < 5; ++index) {
        CAPTURE(index);
        const World world = draw_world(*problem.uncertainty, problem.robot, 1, index);
        compare(uncertain.fly(plan, {true, world}), *executed(problem, plan, true, world));
    }
    problem.aero.wall = {};
    problem.uncertainty.reset();
    const judge::JudgedFlight without = judge::PlanJudge(problem).fly(plan, {true, std::nullopt});
    CHECK(std::abs(without.energy_j - beside.energy_j) > 1e-5 * without.energy_j);  // or nothing was compared
}

TEST_CASE("An arm in the wash of its rotors flies as the planner says, in worlds too") {
    Problem problem = shipped("bridge_inspection");
    problem.robot.rotors.positions_m = {{0.45, 0, 0.06}, {-0.45, 0, 0.06}, {0, 0.45, 0.06}, {0, -0.45, 0.06}};
    problem.robot.arm.wash.emplace();
    const Plan plan = plan_of(problem, 100);
    problem.uncertainty.emplace();
    const judge::PlanJudge judge(problem);
    const judge::JudgedFlight washed = judge.fly(plan, {true, std::nullopt});
    compare(washed, *executed(problem, plan, true, std::nullopt));
    for (std::uint64_t index = 1; index < 4; ++index) {
        CAPTURE(index);
        const World world = draw_world(*problem.uncertainty, problem.robot, 1, index);
        REQUIRE(world.arm_wash_scale != 0);
        const auto theirs = executed(problem, plan, true, world);
        REQUIRE(theirs);
        compare(judge.fly(plan, {true, world}), *theirs);
    }
    problem.robot.arm.wash.reset();
    const judge::JudgedFlight without = judge::PlanJudge(problem).fly(plan, {true, std::nullopt});
    CHECK(without.energy_j < 0.995 * washed.energy_j);  // or nothing was compared
}

TEST_CASE("Other control laws fly as the planner says, with an observer, with a feed-forward and in worlds") {
    CascadedPid cascade;
    cascade.rotor_lead = 1;
    cascade.vertical_velocity_kd = 0.05;
    cascade.pitch_rate_kd = 0.01;
    PlanarLyapunov lyapunov;
    lyapunov.rotor_lead = 1;
    lyapunov.horizontal_k = 0.8;
    lyapunov.joint_k_rate = 5.5;
    const ControlLaw inversion = shipped("bridge_inspection").robot.controller.law;
    struct Kind {
        ControlLaw law;
        bool observes, reads;
    };
    const std::vector<const char*> names{"bridge_inspection", "box_girder_bay"};
    for (int i = 0; i < test::repetitions(1, 2); ++i) {
        const char* name = names[static_cast<std::size_t>(i)];
        Problem problem = shipped(name);
        const Plan plan = plan_of(problem, 100);
        problem.aero.ground = EffectModel::multirotor_body;
        for (const Kind& kind : {Kind{cascade, false, false}, Kind{inversion, true, false},
                                 Kind{inversion, false, true}, Kind{inversion, true, true}, Kind{cascade, true, true},
                                 Kind{lyapunov, false, false}, Kind{lyapunov, true, true}}) {
            problem.robot.controller.law = kind.law;
            controllers::Aids aids;
            if (kind.observes) {
                aids.observer = controllers::DisturbanceObserver{8};
            }
            if (kind.reads) {
                aids.feed_forward = controllers::FeedForward{-0.02, 0.03};
            }
            give_aids(problem.robot.controller.law, aids);
            problem.uncertainty.reset();
            CAPTURE(name, kind.law.index(), kind.observes, kind.reads);
            const judge::PlanJudge judge(problem);
            compare(judge.fly(plan, {true, std::nullopt}), *executed(problem, plan, true, std::nullopt));
            compare(judge.fly(plan, {false, std::nullopt}), *executed(problem, plan, false, std::nullopt));
            for (std::uint64_t index = 1; index < 4; ++index) {
                CAPTURE(index);
                const World world = draw_world(Uncertainty{}, problem.robot, 5, index);
                const auto theirs = executed(problem, plan, true, world);
                const judge::JudgedFlight mine = judge.fly(plan, {true, world});
                if (theirs) {
                    compare(mine, *theirs);
                } else {
                    CHECK(mine.outcome == judge::Outcome::unstable);
                }
            }
        }
    }
}

TEST_CASE("A start in motion means the same to a law that observes") {
    Problem problem = shipped("bridge_inspection");
    const Plan plan = plan_of(problem, 100);
    problem.start.velocity[plane::x] = 0.3;
    problem.start.velocity[plane::arm] = 0.2;
    for (const bool is_cascaded : {false, true}) {
        CAPTURE(is_cascaded);
        if (is_cascaded) {
            CascadedPid law;
            law.rotor_lead = 1;
            problem.robot.controller.law = law;
        }
        give_aids(problem.robot.controller.law, {controllers::DisturbanceObserver{}, std::nullopt});
        compare(judge::PlanJudge(problem).fly(plan, {true, std::nullopt}),
                *executed(problem, plan, true, std::nullopt));
    }
}

TEST_CASE("Straight plans that end in trouble end the same way") {
    Problem problem = ceiling_problem();
    Plan plan;
    plan.tick_s = 0.01;
    plan.reference = {{0, at_rest({-4, 2, quarter_turn})}, {}};
    const auto end = [&](const Configuration& at, std::int64_t tick, judge::Outcome outcome) {
        plan.reference.back() = {tick, at_rest(at)};
        const judge::PlanJudge judge(problem);
        const judge::JudgedFlight mine = judge.fly(plan, {});
        CHECK(name_of(mine.outcome) == name_of(outcome));
        compare(mine, *executed(problem, plan, true, std::nullopt));
    };
    SECTION("in the ceiling") {
        problem.aero.min_distance_radii = 0.03;
        end({3, 5.5, quarter_turn}, 800, judge::Outcome::collision);
    }
    SECTION("with a rotor too close to the ground") {
        problem.aero.min_distance_radii = 4;
        end({3, 0.5, 0}, 800, judge::Outcome::left_flyable_area);
    }
    SECTION("somewhere else than in the goal") {
        end({0, 2, 0}, 800, judge::Outcome::goal_missed);
    }
    SECTION("far behind a reference that nothing can follow") {
        end({5, 4, 0}, 100, judge::Outcome::unstable);
    }
}

TEST_CASE("Goals in a row and alternatives are met as the planner meets them") {
    Problem problem = ceiling_problem();
    problem.goal = configuration_goal(2, 2.5);
    problem.goals_before = {configuration_goal(-2, 2)};
    Goal either;
    either.any_of = {tip_goal(5, 1), configuration_goal(2, 2.5)};
    problem.goal = either;
    Plan plan;
    plan.tick_s = 0.01;
    const ReferencePoint stop = at_rest({-2, 2, quarter_turn});
    const bool stays = GENERATE(true, false);
    plan.reference = {
        {0, at_rest({-4, 2, quarter_turn})}, {500, stop}, {stays ? 1100 : 700, stop}, {2000, at_rest({2, 2.5, 0})}};
    const judge::JudgedFlight mine = judge::PlanJudge(problem).fly(plan, {});
    CHECK(mine.outcome == (stays ? judge::Outcome::ok : judge::Outcome::goal_missed));
    compare(mine, *executed(problem, plan, true, std::nullopt));
}

TEST_CASE("A flight that takes more energy than the budget is over it, for the judge as for the planner") {
    Problem problem = ceiling_problem();
    problem.targets = {configuration_goal(-2, 2), configuration_goal(2, 2.5)};
    VisitOrder order;
    order.visits = {{1, std::nullopt}, {0, std::nullopt}};
    Problem flown = in_order(problem, order);
    const Plan plan{{{0, at_rest({-4, 2, quarter_turn})},
                     {2000, at_rest({2, 2.5, quarter_turn})},
                     {2500, at_rest({2, 2.5, quarter_turn})},
                     {4000, at_rest({-2, 2, quarter_turn})}},
                    0.01};
    const double energy_j = judge::PlanJudge(flown).fly(plan, {}).energy_j;
    for (const double share : {0.99, 1.01}) {
        CAPTURE(share);
        flown.energy_budget_j = share * energy_j;
        const judge::JudgedFlight mine = judge::PlanJudge(flown).fly(plan, {});
        CHECK(mine.outcome == (share < 1 ? judge::Outcome::over_budget : judge::Outcome::ok));
        compare(mine, *executed(flown, plan, true, std::nullopt));
    }
    // Not in the order of the file.
    CHECK(judge::PlanJudge(in_order(problem, given_order(problem))).fly(plan, {}).outcome ==
          judge::Outcome::goal_missed);
}

TEST_CASE("the judge and the planner agree about touches, in the nominal world and in others") {
    for (const char* name : {"contact/deck_with_frame", "contact/pier_with_arm", "contact/deck_and_pier"}) {
        CAPTURE(name);
        const Problem problem = shipped(name);
        const Plan plan = plan_of(problem, 300);
        const judge::PlanJudge judge(problem);
        const std::uint64_t worlds = problem.goals_before.empty() ? 6 : 2;  // flights through a list are long
        for (std::uint64_t index = 0; index <= worlds; ++index) {
            CAPTURE(index);
            const std::optional<World> world =
                index == 0 ? std::nullopt : std::optional(draw_world(*problem.uncertainty, problem.robot, 11, index));
            const std::optional<Execution> flight = executed(problem, plan, true, world);
            REQUIRE(flight);
            const judge::JudgedFlight judged = judge.fly(plan, {true, world});
            CHECK(name_of(judged.outcome) == name_of(flight->outcome));
            REQUIRE(judged.goals.size() == flight->goals.size());
            int touches = 0;
            for (std::size_t goal = 0; goal < judged.goals.size(); ++goal) {
                CAPTURE(goal);
                CHECK(judged.goals[goal].is_met == flight->goals[goal].is_met);
                const std::optional<TouchRecord>& touch = flight->goals[goal].touch;
                REQUIRE(judged.goals[goal].touch_force_n.has_value() == touch.has_value());
                if (touch) {
                    ++touches;
                    CHECK(*judged.goals[goal].touch_force_n == Approx(touch->force_n).epsilon(0.02));
                }
            }
            CHECK(touches == (judged.goals.size() == 4 ? 2 : 1));
            CHECK(judged.energy_j == Approx(flight->energy_j).epsilon(0.01));
        }
    }
}

TEST_CASE("Beside a wall along the plane the judge has the vehicle where the planner has it, with every law") {
    constexpr double gap_m = 0.15;
    const double half_width_m = 0.52;  // of the shipped robot
    CascadedPid soft;
    soft.horizontal_velocity_ki = 0;
    const ControlLaw shipped_law = shipped("open_air").robot.controller.law;
    for (const ControlLaw& law : {shipped_law, ControlLaw(soft), ControlLaw(PlanarLyapunov{})}) {
        Problem problem = shipped("open_air");
        problem.robot.controller.law = law;
        make_real(problem.robot);
        problem.uncertainty.emplace();
        problem.obstacles = {box("wall", {60, 0.2, 60}, {0, half_width_m + gap_m + 0.1, 0})};
        const Configuration from = problem.start.at;
        const Configuration to{from[plane::x] + 1, from[plane::z], from[plane::arm]};
        problem.goal = configuration_goal(to[plane::x], to[plane::z], to[plane::arm]);
        problem.goal.hold_s = 1;
        const Plan plan{{{0, at_rest(from)}, {400, at_rest(to)}}, 0.01};
        const judge::PlanJudge judge(problem);
        World world;
        world.scene_y_m = -0.02;
        world.position_bias_y_m = 0.01;
        world.wind_y_m_s = 0.4;
        world.gust_y_m_s = 0.3;
        world.lateral_error_m = -0.005;
        const double lateral_m = make_world(problem.robot, world).lateral_m;
        CAPTURE(law.index(), lateral_m);
        CHECK(lateral_m != Approx(0.005).margin(1e-3));  // the wind is part of it
        const judge::JudgedFlight mine = judge.fly(plan, {true, world});
        compare(mine, *executed(problem, plan, true, world));
        CHECK(mine.min_clearance_m == Approx(gap_m - lateral_m).margin(1e-4));
        // Too far to the left, and what ends such a flight is named.
        world.lateral_error_m = 0.2;
        const judge::JudgedFlight touching = judge.fly(plan, {true, world});
        CHECK(touching.outcome == judge::Outcome::collision);
        CHECK(touching.is_lateral_collision);
        compare(touching, *executed(problem, plan, true, world));
        // Nor does what is in its way count as beside it.
        problem.obstacles = {box("rail", {0.1, 10, 0.1}, {to[plane::x], 0, to[plane::z] - 0.8})};  // before the arm
        world.lateral_error_m = 0.01;
        const judge::JudgedFlight stopped = judge::PlanJudge(problem).fly(plan, {true, world});
        CHECK(stopped.outcome == judge::Outcome::collision);
        CHECK_FALSE(stopped.is_lateral_collision);
    }
}

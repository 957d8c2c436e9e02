#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stop_token>
#include <utility>

#include "../support/same_bytes.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/goal_sequence.hpp"
#include "downwash/planner/search_clock.hpp"
#include "downwash/planner/solve.hpp"
#include "searched_problems.hpp"

using namespace downwash;

namespace {

Goal place(double x_m, double z_m, double hold_s) {
    Goal goal = test::configuration_goal(x_m, z_m);
    goal.hold_s = hold_s;
    return goal;
}

/// The ceiling problem with a choice of goals.
Problem choice_of(std::vector<Goal> goals, Variant variant, std::uint64_t iterations) {
    Problem problem = test::ceiling_problem();
    problem.planner.variant = variant;
    problem.planner.max_iterations = iterations;
    problem.goal = {};
    problem.goal.any_of = std::move(goals);
    return problem;
}

/// From (-4, 2) to three places in turn.
Problem tour(Variant variant) {
    Problem problem = test::ceiling_problem();
    problem.planner.variant = variant;
    problem.planner.max_iterations = variant == Variant::mp_arm ? 3000 : 180;
    problem.goal.hold_s = 3;  // the tip to (3, 4.8)
    problem.goals_before = {place(0, 3, 2), place(-2, 2, 1.5)};
    return problem;
}

/// The first tick at which the reference stands at a place for so long; -1 without one.
std::int64_t standing_tick(const Plan& plan, const ConfigurationGoal& at, double hold_s) {
    for (std::size_t i = 1; i < plan.reference.size(); ++i) {
        const ReferenceKnot& a = plan.reference[i - 1];
        const ReferenceKnot& b = plan.reference[i];
        const double* p = a.point.position;
        if (a.point == b.point && std::hypot(p[0] - *at.x_m, p[1] - *at.z_m) <= at.tolerance_m) {
            CHECK(static_cast<double>(b.tick - a.tick) * plan.tick_s == Approx(hold_s));
            return a.tick;
        }
    }
    return -1;
}

/// What a search for a part comes to.
enum class PartOutcome { found, too_late, hopeless, first_part_is_weak };

/// Solves a tour of three goals with searches that come to what they are told, and found from then on. Gives the
/// numbers of the goals that were searched for, and the seeds.
struct ScriptedTour {
    std::vector<std::size_t> goals;
    std::vector<std::uint64_t> seeds;
    Found found;
    SearchRecord record;

    explicit ScriptedTour(const std::vector<PartOutcome>& script) {
        Problem problem = tour(Variant::mp_arm);
        problem.aero.enabled = false;
        problem.planner.max_iterations = 1200;
        const planning::PlannerModel model{problem.planner.variant, make_flight_model(problem), nullptr};
        SolveOptions options;
        options.stop_at_first_solution = true;
        planning::GoalSequence sequence(problem, model, options, {}, 0);
        while (const auto part = sequence.next()) {
            const PartOutcome outcome = goals.size() < script.size() ? script[goals.size()] : PartOutcome::found;
            goals.push_back(part->before->goals.size());
            seeds.push_back(part->problem.planner.seed);
            planning::SearchResult result;
            result.record.iterations = outcome == PartOutcome::too_late   ? *part->problem.planner.max_iterations
                                       : outcome == PartOutcome::hopeless ? 0
                                                                          : 10;
            const Configuration start = part->problem.start.at;
            result.found.plan =
                Plan{{{0, at_rest(start)}, {500, at_rest({start[plane::x] + 1, 2, 0})}}, model.flight->tick().tick_s};
            result.found.cost = 1;
            result.found.status = outcome == PartOutcome::found ? Status::solved : Status::approximate;
            if (outcome == PartOutcome::first_part_is_weak) {
                result.weak_goal = 0;
            }
            sequence.add(std::move(result));
        }
        planning::SearchResult whole = std::move(sequence).result();
        found = std::move(whole.found);
        record = std::move(whole.record);
    }
};

}  // namespace

TEST_CASE("a tour goes back to the part that is to blame, which is searched with other samples") {
    using enum PartOutcome;
    const ScriptedTour tour({found, found, first_part_is_weak, found, found, found});
    CHECK(tour.goals == std::vector<std::size_t>{0, 1, 2, 0, 1, 2});
    CHECK(tour.seeds[3] != tour.seeds[0]);
    CHECK(tour.seeds[4] != tour.seeds[1]);
    CHECK(tour.found.status == Status::solved);
    CHECK(tour.found.cost == 3);
    CHECK(tour.record.iterations == 60);
    CHECK(tour.found.plan->last()[plane::x] == -1);  // three parts of a metre each, whatever was found before
}

TEST_CASE("a part of a tour that takes too long is searched anew, the second time from another place, for longer") {
    using enum PartOutcome;
    const ScriptedTour tour({found, too_late, too_late, found, found, found});
    CHECK(tour.goals == std::vector<std::size_t>{0, 1, 1, 0, 1, 2});
    CHECK(tour.found.status == Status::solved);
    CHECK(tour.record.iterations == 10 + 100 + 200 + 30);
}

TEST_CASE("the check of a plan may take what is left of a first round, the search for it a share") {
    Problem problem = tour(Variant::mp_arm);
    problem.aero.enabled = false;
    problem.planner.time_limit_s = 12;
    for (const bool has_iterations : {false, true}) {
        CAPTURE(has_iterations);
        problem.planner.max_iterations = has_iterations ? std::optional<std::uint64_t>(100) : std::nullopt;
        const planning::PlannerModel model{problem.planner.variant, make_flight_model(problem), nullptr};
        const SolveOptions options;
        planning::GoalSequence sequence(problem, model, options, {}, 0);
        const auto first = sequence.next();
        REQUIRE(first);
        CHECK(first->check_time_s == 12);
        CHECK(*first->problem.planner.time_limit_s == Approx(has_iterations ? 12 : 1));
        planning::SearchResult result;
        result.record.wall_s = 5;  // five times its share, and it has found what it searched for
        result.record.iterations = 10;
        result.found.status = Status::solved;
        result.found.plan =
            Plan{{{0, at_rest(first->problem.start.at)}, {500, at_rest({0, 3, 0})}}, model.flight->tick().tick_s};
        sequence.add(std::move(result));
        const auto second = sequence.next();
        REQUIRE(second);
        CHECK(second->before->goals.size() == 1);
        CHECK(second->check_time_s == Approx(7));
    }
}

TEST_CASE("a check that has begun ends later than its search, where it may") {
    PlannerSettings settings;
    settings.time_limit_s = 1e-9;
    settings.max_iterations.reset();
    const SolveOptions options;
    planning::SearchClock patient(settings, options, 1000), other(settings, options);
    CHECK(patient.is_over());
    CHECK_FALSE(patient.is_over_for_checks());
    CHECK(other.is_over());
    CHECK(other.is_over_for_checks());
}

TEST_CASE("a tour in which the way to one goal takes longer than one has patience for ends there") {
    Problem problem = tour(Variant::mp_arm);
    problem.aero.enabled = false;
    problem.planner.max_iterations.reset();
    problem.planner.time_limit_s = 60;
    const planning::PlannerModel model{problem.planner.variant, make_flight_model(problem), nullptr};
    const SolveOptions options;
    constexpr double short_s = 1e-3, with_long_check_s = 8;  // a check counts no longer than the search
    for (const auto& [patience_s, search_s] :
         {std::pair(7.0, short_s), std::pair(7.0, with_long_check_s), std::pair(1000.0, short_s)}) {
        CAPTURE(patience_s, search_s);
        planning::SequenceEffort effort;
        PlannerSettings patience;
        patience.time_limit_s = patience_s;
        effort.patience.emplace(patience);
        planning::GoalSequence sequence(problem, model, options, effort, 0);
        std::size_t to_second = 0;
        while (const auto part = sequence.next()) {
            planning::SearchResult result;
            result.record.wall_s = search_s;
            const bool is_second = part->before->goals.size() == 1;
            to_second += is_second ? 1 : 0;
            if (!is_second) {
                result.found.status = Status::solved;
                result.found.plan = Plan{{{0, at_rest(part->problem.start.at)}, {500, at_rest({0, 3, 0})}},
                                         model.flight->tick().tick_s};
            }
            sequence.add(std::move(result));
        }
        const planning::SearchResult whole = std::move(sequence).result();
        CHECK(whole.found.status == Status::approximate);
        CHECK(whole.found.missed_goal == std::optional<std::size_t>(2));
        if (patience_s < 60) {
            CHECK(whole.hard_goal == std::optional<std::size_t>(1));
            CHECK(to_second == 2);  // searches of 2.5 and 5 s
        } else {
            CHECK_FALSE(whole.hard_goal);
            CHECK(to_second > 2);
        }
    }
}

TEST_CASE("a tour with a part that gives up at once comes to an end") {
    const ScriptedTour tour(std::vector<PartOutcome>(1000, PartOutcome::hopeless));
    CHECK(tour.found.status == Status::approximate);
    CHECK(tour.goals.size() < 10);
}

TEST_CASE("goals in a row are visited in their order, each held for its own time, in one flight") {
    for (const Variant variant : test::variants) {
        CAPTURE(name_of(variant));
        const Problem problem = tour(variant);
        const Solution solution = solve(problem);
        REQUIRE(solution.status == Status::solved);
        const Plan& plan = *solution.plan;
        const std::int64_t first = standing_tick(plan, test::configuration(problem.goals_before[0]), 2);
        const std::int64_t second = standing_tick(plan, test::configuration(problem.goals_before[1]), 1.5);
        CHECK(first > 0);
        CHECK(second > first + 200);
        CHECK(plan.reference.back().tick > second + 150);

        const Execution& flight = *solution.execution;
        CHECK(flight.duration_s == Approx(plan.duration_s() + 3).margin(0.011));
        REQUIRE(flight.goals.size() == 3);
        CHECK(flight.goal_error_m ==
              std::max({flight.goals[0].error_m, flight.goals[1].error_m, flight.goals[2].error_m}));
        if (variant == Variant::mp_arm_ada) {
            CHECK(flight.outcome == Outcome::ok);
            // The rows themselves: where the vehicle is over the last second of each hold.
            for (std::size_t tick = 0; tick <= 100; ++tick) {
                const FlightRow& at_first = flight.rows[static_cast<std::size_t>(first) + 100 + tick];
                const FlightRow& at_second = flight.rows[static_cast<std::size_t>(second) + 50 + tick];
                REQUIRE(std::hypot(at_first.q[0], at_first.q[1] - 3) <= 0.1);
                REQUIRE(std::hypot(at_second.q[0] + 2, at_second.q[1] - 2) <= 0.1);
            }
            for (const GoalVisit& goal : flight.goals) {
                CHECK(goal.is_met);
                CHECK(goal.error_m <= 0.1);
            }
            CHECK(solution.execution_cost == Approx(solution.cost).epsilon(0.01));
            REQUIRE(!solution.planning.improvements.empty());
            CHECK(solution.planning.improvements.back().cost == Approx(solution.cost));
            CHECK(solution.planning.iterations <= 180);
        }
    }
}

TEST_CASE("the parts of a tour are planned from the vehicle that the part before leaves behind") {
    // Without surfaces the planner's model is the one that flies in the end, so its cost comes out but for rounding;
    // it could not if a part began with the vehicle at rest and its integrators empty.
    Problem problem = tour(Variant::mp_arm_da);
    problem.aero.enabled = false;
    const Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    CHECK(solution.execution->outcome == Outcome::ok);
    // The reported flight is integrated with finer steps.
    CHECK(solution.execution_cost == Approx(solution.cost).epsilon(1e-6));
}

TEST_CASE("a tour has a whole way as soon as one that ends with it, and better ways follow") {
    for (const Variant variant : {Variant::mp_arm_da, Variant::mp_arm_ada}) {
        CAPTURE(name_of(variant));
        Problem problem = tour(variant);
        problem.planner.max_iterations = 600;
        SolveOptions first_only;
        first_only.stop_at_first_solution = true;
        const Solution first = solve(problem, first_only);
        REQUIRE(first.status == Status::solved);
        CHECK(first.planning.iterations < 300);

        std::vector<Plan> plans;
        std::vector<double> costs;
        SolveOptions watching;
        watching.on_plan = [&](const FoundPlan& found) {
            plans.push_back(found.plan);
            costs.push_back(found.flown_cost.value_or(found.cost));
        };
        const Solution best = solve(problem, watching);
        REQUIRE(plans.size() > 1);
        CHECK(test::same_bytes(plans.front(), *first.plan));
        CHECK(test::same_bytes(plans.back(), *best.plan));
        CHECK(std::is_sorted(costs.begin(), costs.end(), std::greater<>()));
        CHECK(best.cost < first.cost);
        CHECK(best.planning.iterations <= 600);
        REQUIRE(best.planning.improvements.size() > 1);
        CHECK(best.planning.improvements.front().cost == first.planning.improvements.front().cost);
    }
}

TEST_CASE("a tour that is interrupted after its first whole way gives a whole way") {
    Problem problem = tour(Variant::mp_arm_ada);
    problem.planner.max_iterations = 400;
    problem.planner.time_limit_s.reset();
    for (int reports_to_go = 0; reports_to_go < 12; reports_to_go += 3) {
        CAPTURE(reports_to_go);
        std::stop_source stop;
        SolveOptions options;
        options.stop = stop.get_token();
        bool has_plan = false;
        std::uint64_t nodes = 0, rejected = 0;
        int left = reports_to_go;
        options.on_plan = [&](const FoundPlan&) {
            has_plan = true;
            if (left == 0) {
                stop.request_stop();
            }
        };
        options.on_progress = [&](const Progress& progress) {
            CHECK(progress.goals == 3);
            CHECK(progress.goal >= 1);
            CHECK(progress.goal <= 3);
            CHECK(progress.nodes >= nodes);
            CHECK(progress.rejected >= rejected);
            nodes = progress.nodes;
            rejected = progress.rejected;
            CHECK(progress.best_cost.has_value() == has_plan);
            if (has_plan && --left <= 0) {
                stop.request_stop();
            }
        };
        const Solution solution = solve(problem, options);
        REQUIRE(solution.status == Status::solved);
        REQUIRE(solution.execution->goals.size() == 3);
        CHECK(solution.execution->outcome == Outcome::ok);
    }
}

TEST_CASE("a tour comes out the same byte by byte") {
    const Problem problem = tour(Variant::mp_arm_ada);
    SolveOptions two;
    two.threads = 2;
    const Solution a = solve(problem);
    const Solution b = solve(problem, two);
    CHECK(a.cost == b.cost);
    CHECK(test::same_bytes(*a.execution, *b.execution));
}

TEST_CASE("a tour with a goal behind a wall ends before it and is not called solved") {
    for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_da}) {
        CAPTURE(name_of(variant));
        Problem problem = tour(variant);
        test::add_wall_with_slit(problem, 1.5);
        problem.planner.max_iterations = 300;
        const Solution solution = solve(problem);
        CHECK(solution.status == Status::approximate);
        CHECK_FALSE(solution.planning.first_solution_wall_s);
        CHECK(solution.planning.improvements.empty());
        REQUIRE(solution.execution);
        CHECK(solution.execution->outcome != Outcome::ok);
        REQUIRE(solution.execution->goals.size() == 3);
        CHECK(solution.execution->goals[0].is_met);
        CHECK_FALSE(solution.execution->goals[2].is_met);
        CHECK(solution.execution->goal_error_m > 1);
        if (variant == Variant::mp_arm_da) {
            REQUIRE(solution.nearest_approach_m);
            CHECK(*solution.nearest_approach_m > 0.2);  // the tip to (3, 4.8), the wall at 1.35
            CHECK(*solution.nearest_approach_m < 4);    // nearer than from the stop before
            CHECK(solution.obstruction);
        }
    }
}

TEST_CASE("the same place twice is held twice") {
    Problem problem = tour(Variant::mp_arm_da);
    problem.goal = place(-4, 2, 2);
    problem.goals_before = {place(-4, 2, 1), place(-4, 2, 1.5)};
    const Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    CHECK(solution.execution->outcome == Outcome::ok);
    CHECK(solution.execution->duration_s >= 4.5);
}

TEST_CASE("of several goals the cheap one is flown to and held for its own time") {
    for (const Variant variant : test::variants) {
        CAPTURE(name_of(variant));
        const Solution solution = solve(choice_of({place(5, 2, 2), place(-2, 2.5, 3), place(4, 3, 1)}, variant,
                                                  variant == Variant::mp_arm ? 1500 : 100));
        REQUIRE(solution.status == Status::solved);
        CHECK(solution.execution->outcome == Outcome::ok);
        CHECK(solution.execution->rows.back().q[0] == Approx(-2).margin(0.1));
        CHECK(solution.execution->rows.back().q[1] == Approx(2.5).margin(0.1));
        CHECK(solution.execution->duration_s == Approx(solution.plan->duration_s() + 3).margin(0.011));
    }
    // A long hold makes a near goal dearer than a far one.
    const Solution solution = solve(choice_of({place(-2, 2.5, 30), place(0, 2.5, 2)}, Variant::mp_arm_da, 100));
    REQUIRE(solution.status == Status::solved);
    CHECK(solution.execution->rows.back().q[0] == Approx(0).margin(0.1));
    CHECK(solution.execution->duration_s < 12);
}

TEST_CASE("a wide tolerance along the goal is made use of, the narrow one across it is kept") {
    Problem problem = test::ceiling_problem();
    problem.planner.max_iterations = 150;
    test::end_effector(problem.goal).x_m = 0;
    test::end_effector(problem.goal).tolerance_x_m = 2;
    test::end_effector(problem.goal).tolerance_z_m = 0.05;
    test::end_effector(problem.goal).direction_rad = -test::quarter_turn;
    const Solution solution = solve(problem);
    REQUIRE(solution.status == Status::solved);
    REQUIRE(solution.execution->outcome == Outcome::ok);
    const FlightRow& last = solution.execution->rows.back();
    CHECK(last.end_effector_z_m == Approx(4.8).margin(0.05));
    // From -4 the near edge, less what is left to the flight, is at -1.8.
    CHECK(last.end_effector_x_m < -1);
}

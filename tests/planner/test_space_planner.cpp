#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "../support/error_of.hpp"
#include "downwash/judge/space_plan_judge.hpp"
#include "downwash/planner/planner.hpp"
#include "downwash/planner/takeover.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/simulation/space_place.hpp"

using namespace downwash;

namespace {

/// Under a girder to its other side.
SpaceProblem under_a_girder() {
    SpaceProblem problem = read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
    problem.uncertainty.reset();
    problem.planner.max_iterations = 400;
    problem.planner.time_limit_s = 100;
    return problem;
}

SpaceGoal at_place(double x_m, double y_m, double z_m) {
    SpaceConfigurationGoal at;
    at.x_m = x_m;
    at.y_m = y_m;
    at.z_m = z_m;
    return {at, 1};
}

SpaceSolveOptions first_in_space(int threads = 1) {
    SpaceSolveOptions options;
    options.threads = threads;
    options.stop_at_first_solution = true;
    return options;
}

SpaceReplanOptions space_iterations(std::uint64_t number) {
    SpaceReplanOptions options;
    options.max_iterations = number;
    return options;
}

bool is_same_reference(const SpacePlan& a, const SpacePlan& b) {
    return std::ranges::equal(a.reference, b.reference, [](const SpaceKnot& one, const SpaceKnot& other) {
        return one.tick == other.tick && one.point == other.point;
    });
}

/// The flange of the girder, lower.
SpaceSceneChange lower_flange(const SpaceProblem& problem, double by_m) {
    SpaceSceneChange change;
    const auto flange = std::ranges::find(problem.obstacles, "bottom_flange", &Obstacle::name);
    change.put.push_back(*flange);
    change.put.front().center_world_m[2] -= by_m;
    return change;
}

double between_m(const SpaceMotion& a, const SpaceMotion& b) {
    const Vector3 d = a.position_m - b.position_m;
    return std::sqrt(dot(d, d));
}

}  // namespace

TEST_CASE("what is left of a plan in space starts where its flight is, without the goals of before") {
    SpaceProblem problem = under_a_girder();
    problem.goals.insert(problem.goals.begin(), at_place(-1, -1.5, 2));
    const auto model = std::make_shared<const SpaceProblemModel>(problem);
    const SpaceSearchResult found = solve(model, first_in_space());
    REQUIRE(found.status == Status::solved);
    const SpacePlan& plan = *found.plan;
    const std::int64_t first_end = model->goals().hovers(plan).front().end_tick;
    for (const std::int64_t tick : {std::int64_t{0}, first_end / 2, first_end, first_end + 60}) {
        CAPTURE(tick);
        const auto from = take_over(problem, plan, {}, tick);
        CHECK(from.visited.size() == (tick < first_end ? 0 : 1));
        CHECK(from.left.size() + from.visited.size() == 2);
        const SpaceFlightRow& row = found.execution->rows[static_cast<std::size_t>(tick)];
        CHECK(between_m(start_motion(from.start), row.motion) < 1e-9);
        CHECK(from.energy_j == Approx(row.energy_j).epsilon(1e-9));
        CHECK(from.rest.reference.front().point == plan.at(tick));
        CHECK(reference_at(from.start).velocity[0] == Approx(plan.at(tick).velocity[0]));
        CHECK(same_reference_s(plan.rest_after(tick), from.rest) == from.rest.duration_s());
        const SpaceProblem next = remaining(from, problem);
        CHECK(next.goals.size() == from.left.size());
        CHECK(space_problem_errors(next).empty());
        // The rest of the plan is a plan of what is left, and flies on as the whole plan did, but for what the
        // controller saw a delay before.
        const SpaceFlight rest = SpaceProblemModel(next).execute(from.rest);
        CHECK(rest.outcome == Outcome::ok);
        const std::size_t later = 100;
        CHECK(between_m(rest.rows[later].motion, found.execution->rows[static_cast<std::size_t>(tick) + later].motion) <
              1e-4);
        if (tick == first_end / 2) {
            // A vehicle that forgot what its controller knows flies another way; the judge's law knows it, too.
            SpaceProblem forgetful = next;
            forgetful.start.carry.controller_memory.clear();
            const SpaceFlight other = SpaceProblemModel(forgetful).execute(from.rest);
            const double forgot_m = between_m(other.rows[30].motion, rest.rows[30].motion);
            CHECK(forgot_m > 1e-5);
            const auto judged = judge::SpacePlanJudge(next).fly(from.rest);
            CHECK(judged.outcome == judge::Outcome::ok);
            const Vector3 off = judged.rows[30].motion.position_m - rest.rows[30].motion.position_m;
            CHECK(std::sqrt(dot(off, off)) < 0.1 * forgot_m);
        }
    }
    CHECK(same_reference_s(plan, plan.rest_after(first_end)) < 1);
    SpaceProblem faster = problem;
    faster.robot.controller.rate_hz = 200;
    const auto from = take_over(problem, plan, {}, 10);
    CHECK_THAT(test::error_of([&] { static_cast<void>(remaining(from, faster)); }),
               Catch::Contains("robot.controller.rate_hz: is 200: expected 100"));
}

TEST_CASE("in space, too, nothing has changed: a stop, then the last plan, then one that is no more expensive") {
    SpacePlanner planner(under_a_girder(), first_in_space());
    REQUIRE(planner.solve().status == Status::solved);
    const std::int64_t tick = planner.plan()->reference.back().tick / 2;
    const SpaceStart here = planner.predicted(planner.problem().start, *planner.plan(), tick);
    std::vector<Advice> advice;
    std::vector<double> costs;
    SpaceReplanOptions options = space_iterations(100);
    options.on_answer = [&](const SpaceAnswer& answer) {
        advice.push_back(answer.advice);
        costs.push_back(answer.cost);
    };
    const SpaceAnswer answer = planner.replan(here, tick, {}, options);
    REQUIRE(advice.size() >= 2);
    CHECK(advice[0] == Advice::stop);
    CHECK(advice[1] == Advice::keep);
    CHECK(std::is_sorted(costs.rbegin(), costs.rend() - 1));
    CHECK(planner.model().execute(answer.plan).outcome == Outcome::ok);
    REQUIRE(planner.latest());
    CHECK(is_same_reference(planner.latest()->plan, answer.plan));
}

TEST_CASE("a plan in space below what turned out to be lower is safe, and the same on any number of threads") {
    std::vector<SpaceAnswer> answers;
    for (const int threads : {1, 2}) {
        SpacePlanner planner(under_a_girder(), first_in_space(threads));
        REQUIRE(planner.solve().status == Status::solved);
        const std::int64_t tick = planner.plan()->reference.back().tick / 4;
        const SpaceStart here = planner.predicted(planner.problem().start, *planner.plan(), tick);
        answers.push_back(planner.replan(here, tick, lower_flange(planner.problem(), 0.05), space_iterations(300)));
        const SpaceAnswer& answer = answers.back();
        REQUIRE((answer.advice == Advice::follow || answer.advice == Advice::keep));
        CHECK(answer.plan.reference.front().point == reference_at(here));
        const SpaceFlight flight = planner.model().execute(answer.plan);
        CHECK(flight.outcome == Outcome::ok);
        CHECK(flight.min_clearance_m >= planner.problem().planner.safety_margin_m);
        CHECK(planner.problem().obstacles.size() == under_a_girder().obstacles.size());
        CHECK(answer.cost == Approx(flight.energy_j));
        CHECK(is_same_reference(*planner.plan(), answer.plan));
    }
    CHECK(is_same_reference(answers[0].plan, answers[1].plan));
}

TEST_CASE("a change in space that is wrong changes nothing, and no start but the robot's is taken") {
    SpacePlanner planner(under_a_girder(), first_in_space());
    REQUIRE(planner.solve().status == Status::solved);
    const SpacePlan plan = *planner.plan();
    const SpaceStart here = planner.predicted(planner.problem().start, plan, 100);
    SpaceSceneChange change = lower_flange(planner.problem(), 0.05);
    change.removed.emplace_back("walkway");
    const std::vector<KeyError> errors = test::errors_of([&] { return planner.replan(here, 100, change); });
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].message.find("no obstacle 'walkway'") != std::string::npos);
    CHECK(planner.problem().obstacles[2].center_world_m == under_a_girder().obstacles[2].center_world_m);
    SpaceStart misfit = here;
    misfit.carry.controller_memory.pop_back();
    CHECK_THROWS_AS(planner.replan(misfit, 100, {}), InputError);
    misfit = here;
    misfit.joints_rad.push_back(0);
    CHECK_THROWS_AS(planner.replan(misfit, 100, {}), InputError);
    misfit = here;
    misfit.reference->velocity.pop_back();
    CHECK_THROWS_AS(planner.replan(misfit, 100, {}), InputError);
    misfit = here;
    misfit.velocity_m_s[0] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(planner.replan(misfit, 100, {}), InputError);
    CHECK(is_same_reference(*planner.plan(), plan));
    // However fast the vehicle is said to be, there is an answer.
    SpaceStart runaway = here;
    runaway.reference->velocity[0] = 1e4;
    CHECK(planner.replan(runaway, 100, {}, space_iterations(10)).advice == Advice::none);
}

TEST_CASE("a goal in space that moved is planned for, and goals that were visited are not visited again") {
    SpaceProblem problem = under_a_girder();
    problem.goals.insert(problem.goals.begin(), at_place(-1, -1.5, 2));
    SpacePlanner planner(problem, first_in_space());
    REQUIRE(planner.solve().status == Status::solved);
    const SpacePlan plan = *planner.plan();
    const std::int64_t hover = planner.model().goals().hovers(plan).front().end_tick;
    const SpaceStart here = planner.predicted(problem.start, plan, hover + 50);
    const SpaceAnswer answer = planner.replan(here, hover + 50, {}, space_iterations(50));
    CHECK(planner.problem().goals.size() == 1);
    CHECK(answer.advice != Advice::none);
    CHECK(planner.model().execute(answer.plan).outcome == Outcome::ok);
    SpaceSceneChange elsewhere;
    elsewhere.goal = at_place(-1.5, -1, 1.5);
    const SpaceAnswer other = planner.replan(here, hover + 50, elsewhere, space_iterations(200));
    REQUIRE(other.advice == Advice::follow);
    CHECK(std::abs(other.plan.reference.back().point.position[space::x] + 1.5) < 0.15);
}

TEST_CASE("an obstacle in space that turns out to stand at the goal leaves the vehicle a stop") {
    SpacePlanner planner(under_a_girder(), first_in_space());
    REQUIRE(planner.solve().status == Status::solved);
    const SpaceStart here = planner.predicted(planner.problem().start, *planner.plan(), 100);
    SpaceSceneChange change;
    change.put.push_back({"crate", Box{{1, 1, 1}}, {0.41, 0.35, 3.77}});
    CHECK(planner.replan(here, 100, change, space_iterations(10)).advice == Advice::stop);
    // Before a flight it is an error.
    SpaceProblem problem = under_a_girder();
    problem.obstacles.push_back(change.put.front());
    const std::vector<KeyError> errors = space_problem_errors(problem);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].key == "goal.end_effector.position_m");
}

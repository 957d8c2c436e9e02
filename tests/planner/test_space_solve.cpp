#include <catch2/catch.hpp>
#include <memory>
#include <string>

#include "downwash/planner/space_solve.hpp"
#include "downwash/problems/space_problem_reader.hpp"

using namespace downwash;

namespace {

SpaceProblem girder() {
    SpaceProblem problem = read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
    problem.uncertainty.reset();
    problem.planner.max_iterations = 400;
    problem.planner.time_limit_s = 100;
    return problem;
}

SpaceSearchResult solved(const SpaceProblem& problem, int threads, bool stops_at_first) {
    SpaceSolveOptions options;
    options.threads = threads;
    options.stop_at_first_solution = stops_at_first;
    options.keep_tree = true;
    return solve(std::make_shared<const SpaceProblemModel>(problem), options);
}

/// Keys of what cannot be planned.
std::vector<std::string> refused(const SpaceProblem& problem) {
    std::vector<std::string> keys;
    for (const KeyError& error : space_planning_errors(problem)) {
        keys.push_back(error.key);
    }
    return keys;
}

bool is_same(const SpacePlan& a, const SpacePlan& b) {
    return std::equal(a.reference.begin(), a.reference.end(), b.reference.begin(), b.reference.end(),
                      [](const SpaceKnot& x, const SpaceKnot& y) { return x.tick == y.tick && x.point == y.point; });
}

}  // namespace

TEST_CASE("a plan around a girder is found in space, and its flight with direct aerodynamics meets the goal") {
    const SpaceSearchResult found = solved(girder(), 1, true);
    REQUIRE(found.status == Status::solved);
    REQUIRE(found.execution);
    CHECK(found.execution->outcome == Outcome::ok);
    CHECK(found.execution->min_clearance_m >= girder().planner.safety_margin_m);
    CHECK(found.plan->joints == 3);
    CHECK(found.plan->reference.front().tick == 0);
    CHECK(found.tree.size() > 1);
    // The far side of the web is reached under the bottom flange or over the top one.
    CHECK(found.plan->reference.back().point.position[space::y] > 0);
}

TEST_CASE("a search in space gives the same plan on one thread and on two, and goes on to cheaper ones") {
    const SpaceProblem problem = girder();
    const SpaceSearchResult one = solved(problem, 1, false);
    const SpaceSearchResult two = solved(problem, 2, false);
    REQUIRE(one.status == Status::solved);
    REQUIRE(two.status == Status::solved);
    CHECK(is_same(*one.plan, *two.plan));
    CHECK(one.cost == two.cost);
    CHECK(one.planning.edges_simulated == two.planning.edges_simulated);
    CHECK(one.planning.rejected == two.planning.rejected);
    CHECK(one.cost < solved(problem, 1, true).cost);
}

TEST_CASE("a vehicle that starts upside down falls, recovers and hovers at its goal") {
    SpaceProblem problem = girder();
    problem.robot = read_space_robot(DOWNWASH_PROBLEMS "/../bench/dynobench/quadrotor_v0.yaml");
    problem.obstacles.clear();
    problem.bounds = {{-2, -2, -2}, {2, 2, 2}};
    problem.aero.ground.model = problem.aero.ceiling.model = EffectModel::none;
    problem.planner.variant = Variant::mp_arm_da;
    problem.planner.max_saturation = 1000;
    problem.start = {};
    problem.start.position_m = {0, 0, 1};
    problem.start.attitude = {0.0436194, -0.9990482, 0, 0};  // by 175 degrees about x
    SpaceConfigurationGoal place;
    place.x_m = 0;
    place.y_m = 0.8;
    place.z_m = 1;
    problem.goals.assign(1, SpaceGoal{});
    problem.goals.front().kind = place;
    problem.goals.front().hold_s = 4;
    const SpaceSearchResult found = solved(problem, 1, true);
    REQUIRE(found.status == Status::solved);
    CHECK_FALSE(found.map);  // no surface changes thrust
    CHECK(found.execution->max_tracking_error_m > 0.5);
}

TEST_CASE("several goals in space are visited in their order") {
    SpaceProblem problem = girder();
    SpaceGoal before;
    SpaceConfigurationGoal place;
    place.x_m = -1;
    place.y_m = -1.5;
    place.z_m = 2;
    before.kind = place;
    before.hold_s = 2;
    problem.goals.insert(problem.goals.begin(), before);
    const SpaceSearchResult found = solved(problem, 1, true);
    REQUIRE(found.status == Status::solved);
    REQUIRE(found.execution->goals.size() == 2);
    CHECK(found.execution->goals[0].is_met);
    CHECK(found.execution->goals[1].is_met);
}

TEST_CASE("what cannot be planned in space yet is refused by the key that asks for it") {
    SpaceProblem problem = girder();
    CHECK(refused(problem).empty());
    problem.planner.parameters["passage_share"] = 0.1;
    CHECK(refused(problem) == std::vector<std::string>{"planner.parameters.passage_share"});
    problem = girder();
    problem.planner.algorithm = "rrt";
    problem.motion.yaw.mode = YawMode::along;
    CHECK(refused(problem) == std::vector<std::string>{"motion.yaw"});
    problem = girder();
    problem.bounds = {{-30, -30, 0}, {30, 30, 50}};
    CHECK(refused(problem).empty());
    problem.bounds = {{-2e4, -2e4, 0}, {2e4, 2e4, 1e4}};
    CHECK(refused(problem) == std::vector<std::string>{"environment.bounds"});
    problem.aero.enabled = false;  // no map then
    CHECK(refused(problem).empty());
}

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/judge/space_disagreements.hpp"
#include "downwash/judge/space_plan_judge.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/claims.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

// The judge of plans in space, on the shipped problem.

using namespace downwash;

namespace {

const SpaceProblem& problem() {
    static const SpaceProblem girder = read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
    return girder;
}

const SpaceClaims& shipped() {
    static const SpaceClaims claims = read_claims(DOWNWASH_PROBLEMS "/space/around_a_girder.json", problem());
    return claims;
}

/// The shipped plan up to its second knot.
SpacePlan beginning() {
    SpacePlan plan = shipped().plan;
    plan.reference.resize(2);
    return plan;
}

/// The shipped problem with that end for a goal, and a hover of a second there.
SpaceProblem short_problem() {
    SpaceProblem quick = problem();
    const double* end = shipped().plan.reference[1].point.position;
    SpaceConfigurationGoal goal;
    goal.x_m = end[0];
    goal.y_m = end[1];
    goal.z_m = end[2];
    goal.tolerance_m = 0.3;
    quick.goals = {{goal, 1, {}}};
    return quick;
}

std::vector<std::string> named(const std::vector<judge::Disagreement>& found) {
    std::vector<std::string> names;
    for (const judge::Disagreement& each : found) {
        names.push_back(each.what);
    }
    return names;
}

/// What a file would say about a flight of ours.
SpaceClaims claims_of(const SpaceFlight& flight) {
    SpaceClaims claims = shipped();
    FlightClaims& said = claims.flight.emplace();
    said.outcome = name_of(flight.outcome);
    said.min_clearance_m = flight.min_clearance_m;
    said.energy_j = flight.energy_j;
    said.duration_s = flight.duration_s;
    said.cost = flight.energy_j;
    said.goal_error_m = flight.goals.at(0).error_m;
    claims.has_cost = true;
    return claims;
}

}  // namespace

TEST_CASE("The judge finds the shipped plan in space sound, and its flight as our execution says") {
    CHECK(judge::disagreements_in_plan(shipped(), problem()).empty());
    const SpaceFlight flight = SpaceProblemModel(problem()).execute(shipped().plan);
    REQUIRE(flight.outcome == Outcome::ok);
    const judge::SpaceJudgedFlight judged = judge::SpacePlanJudge(problem()).fly(shipped().plan);
    CHECK(judged.outcome == judge::Outcome::ok);
    CHECK(judged.duration_s == Approx(flight.duration_s));
    CHECK(judged.energy_j == Approx(flight.energy_j).epsilon(1e-4));
    CHECK(judged.min_clearance_m == Approx(flight.min_clearance_m).margin(1e-3));
    CHECK(judged.max_tracking_error_m == Approx(flight.max_tracking_error_m).margin(1e-3));
    SpaceClaims claims = claims_of(flight);
    CHECK(judge::disagreements_about_flight(claims, judged).empty());
    claims.flight->energy_j *= 1.02;
    CHECK(named(judge::disagreements_about_flight(claims, judged)) == std::vector<std::string>{"execution.energy_j"});
    claims = claims_of(flight);
    claims.flight->outcome = "collision";
    claims.flight->min_clearance_m = *claims.flight->min_clearance_m + 0.02;
    claims.flight->cost *= 0.98;
    CHECK(named(judge::disagreements_about_flight(claims, judged)) ==
          std::vector<std::string>{"execution.outcome", "execution.min_clearance_m", "execution.cost"});
    claims.objective = Objective::length;  // of which flights in space have no figure
    CHECK(named(judge::disagreements_about_flight(claims, judged)).size() == 2);
}

TEST_CASE("A flight in space that takes more energy than it may is over budget, for the judge and for us") {
    SpaceProblem mission = problem();
    mission.in_any_order = true;
    mission.energy_budget_j = 1e6;
    const SpaceFlight flight = SpaceProblemModel(mission).execute(shipped().plan);
    REQUIRE(flight.outcome == Outcome::ok);
    mission.energy_budget_j = 0.99 * flight.energy_j;
    CHECK(SpaceProblemModel(mission).execute(shipped().plan).outcome == Outcome::over_budget);
    CHECK(judge::SpacePlanJudge(mission).fly(shipped().plan).outcome == judge::Outcome::over_budget);
    // With a place to return to, the plan ends elsewhere.
    mission.energy_budget_j.reset();
    SpaceConfigurationGoal start;
    start.x_m = mission.start.position_m[0];
    mission.return_to = SpaceGoal{start, 2, {}};
    CHECK(judge::SpacePlanJudge(mission).fly(shipped().plan).outcome == judge::Outcome::goal_missed);
    CHECK(SpaceProblemModel(mission).execute(shipped().plan).outcome == Outcome::goal_missed);
}

TEST_CASE("The judge finds what is wrong with a plan in space") {
    SpaceClaims claims = shipped();
    claims.plan.reference[1].tick = 300;
    auto found = judge::disagreements_in_plan(claims, problem());
    REQUIRE(found.size() == 3);
    CHECK(found[0].what == "plan.reference[0] to [1]: speed_m_s");
    CHECK(std::get<double>(found[0].judge) == 1);
    CHECK(found[1].what == "plan.reference[0] to [1]: acceleration_m_s2");
    CHECK(found[2].what == "plan.reference[0] to [1]: jerk_m_s3");
    claims = shipped();
    claims.plan.reference[3].tick -= 200;
    CHECK(named(judge::disagreements_in_plan(claims, problem())).at(0) ==
          "plan.reference[2] to [3]: acceleration_m_s2");
    claims = shipped();
    claims.plan.reference.back().point.velocity[space::first_joint] = 0.1;
    CHECK(named(judge::disagreements_in_plan(claims, problem())).back() == "plan.reference, its end: speed");
    claims = shipped();
    SpaceProblem elsewhere = problem();
    elsewhere.start.yaw_rad = 0.1;
    CHECK(named(judge::disagreements_in_plan(claims, elsewhere)) ==
          std::vector<std::string>{"plan.reference[0].yaw_rad"});
    elsewhere.start.attitude = {1, 1, 0, 0};  // recovers to any yaw
    CHECK(judge::disagreements_in_plan(claims, elsewhere).empty());
    claims.has_waypoints = true;
    claims.waypoints.resize(2);
    CHECK(named(judge::disagreements_in_plan(claims, problem())).at(0) == "plan.waypoints: their number");
}

TEST_CASE("Agile limits are judged in space") {
    SpaceClaims claims = shipped();
    SpaceProblem agile = problem();
    agile.motion.max_thrust_ratio = 1.001;
    agile.motion.max_tilt_rate_rad_s = 0.001;
    const auto found = judge::disagreements_in_plan(claims, agile);
    bool has_ratio = false, has_rate = false;
    for (const judge::Disagreement& each : found) {
        has_ratio = has_ratio || each.what == "plan.reference[0] to [1]: thrust_ratio";
        has_rate = has_rate || each.what == "plan.reference[0] to [1]: tilt_rate_rad_s";
    }
    CHECK(has_ratio);
    CHECK(has_rate);
}

TEST_CASE("Flights in worlds in space are the same on any number of threads, and those of single worlds") {
    const SpaceProblem quick = short_problem();
    const judge::SpacePlanJudge judge(quick);
    const SpacePlan plan = beginning();
    const auto one = judge::fly_in_worlds(judge, plan, {3, 5, 1, 0, {}, {}});
    REQUIRE(one);
    REQUIRE(one->runs.size() == 3);
    CHECK(one->failures == 0);
    CHECK(one->sensitivity.size() > 10);
    CHECK(one->worst.size() == 3);
    for (const int threads : {2, 3}) {
        const auto more = judge::fly_in_worlds(judge, plan, {3, 5, threads, 0, {}, {}});
        for (std::size_t i = 0; i < 3; ++i) {
            CHECK(more->runs[i].energy_j == one->runs[i].energy_j);
            CHECK(more->runs[i].min_clearance_m == one->runs[i].min_clearance_m);
        }
        for (std::size_t i = 0; i < one->sensitivity.size(); ++i) {
            CHECK(more->sensitivity[i].parameter == one->sensitivity[i].parameter);
            CHECK(more->sensitivity[i].rank_correlation == one->sensitivity[i].rank_correlation);
        }
    }
    const SpaceWorld second = draw_space_world(*quick.uncertainty, quick.robot, 5, 2);
    const judge::SpaceJudgedFlight single = judge.fly(plan, true, second);
    CHECK(single.energy_j == one->runs[1].energy_j);
    // Our execution in the same world tells the same story.
    SpaceExecutionSettings settings;
    settings.world = second;
    const SpaceFlight flight = SpaceProblemModel(quick).execute(plan, settings);
    CHECK(single.duration_s == Approx(flight.duration_s));
    CHECK(single.energy_j == Approx(flight.energy_j).epsilon(1e-3));
    CHECK(single.min_clearance_m == Approx(flight.min_clearance_m).margin(2e-3));
}

TEST_CASE("A vehicle that starts tilted in a world does not hover first, for the judge and for our execution") {
    SpaceProblem tilted = short_problem();
    tilted.start.attitude = {1, 0.3, 0, 0};
    SpacePlan plan = shipped().plan;
    plan.reference.resize(1);
    SpaceWorld world;
    world.wind_m_s = {1, 0, 0};
    const judge::SpaceJudgedFlight judged = judge::SpacePlanJudge(tilted).fly(plan, true, world);
    SpaceExecutionSettings settings;
    settings.world = world;
    const SpaceFlight flight = SpaceProblemModel(tilted).execute(plan, settings);
    CHECK(judged.rows.front().motion.position_m == tilted.start.position_m);
    REQUIRE(judged.rows.size() == flight.rows.size());
    for (std::size_t i = 0; i < flight.rows.size(); i += 10) {
        const Vector3 apart = judged.rows[i].motion.position_m - flight.rows[i].motion.position_m;
        REQUIRE(std::sqrt(dot(apart, apart)) < 1e-4);
    }
}

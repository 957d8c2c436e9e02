#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "downwash/bench/campaign_experiment.hpp"
#include "downwash/bench/plan_evaluation.hpp"
#include "downwash/bench/uncertainty_study/uncertainty_study.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/space_solution_file.hpp"
#include "downwash/simulation/space_world_parameters.hpp"
#include "small_campaign.hpp"

// Campaigns and studies with problems in space.

using namespace downwash;         // NOLINT(google-build-using-namespace): a test
using namespace downwash::bench;  // NOLINT(google-build-using-namespace): a test
using namespace downwash::test;   // NOLINT(google-build-using-namespace): a test
using Catch::Contains;

namespace {

SpaceProblem girder() {
    return read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
}

/// A problem in a plane and one in space without an uncertainty.
ReadCampaign mixed_campaign(std::uint64_t seeds) {
    ReadCampaign read = small_campaign(seeds);
    SpaceProblem certain = girder();
    certain.uncertainty.reset();
    read.problems.emplace_back(certain);
    read.campaign.problems.emplace_back("girder.yaml");
    read.campaign.variants = {Variant::mp_arm_da};
    read.campaign.max_iterations = 60;
    return read;
}

/// The shipped reference under the girder.
SpacePlan shipped_plan(const SpaceProblem& problem) {
    return read_solution(DOWNWASH_PROBLEMS "/space/around_a_girder.json", problem).plan.value();
}

}  // namespace

TEST_CASE("a campaign runs problems in space beside planar ones, whatever the number of threads") {
    const ScratchFolder alone, together;
    ReadCampaign read = mixed_campaign(2);
    read.campaign.jobs = 1;
    CHECK(run_into(alone, read).done == 4);
    read.campaign.jobs = 2;
    run_into(together, read);
    const CampaignResults results = results_in(alone);
    CHECK(repeatable(results) == repeatable(results_in(together)));
    REQUIRE(results.plan.experiments.size() == 2);
    CHECK(results.plan.experiments[1].problem == "around_a_girder");
    std::size_t in_space = 0;
    for (const Run& run : results.runs) {
        if (run.experiment != 1) {
            continue;
        }
        ++in_space;
        // The same as a search outside a campaign.
        SpaceProblem problem = std::get<SpaceProblem>(read.problems[1]);
        problem.planner.variant = Variant::mp_arm_da;
        problem.planner.time_limit_s.reset();
        problem.planner.max_iterations = 60;
        problem.planner.seed = run.seed;
        const SpaceSearchResult found = solve(std::make_shared<const SpaceProblemModel>(problem));
        CHECK(static_cast<int>(run.status) == static_cast<int>(found.status));
        CHECK(run.iterations == found.planning.iterations);
        CHECK(run.edges_simulated == found.planning.edges_simulated);
        if (found.status == Status::solved) {
            CHECK(run.cost == found.cost);
            REQUIRE(run.flight);
            CHECK(run.flight->outcome == found.execution->outcome);
            CHECK(run.flight->energy_j == found.execution->energy_j);
            CHECK(run.flight->cost == cost_of(*found.execution, problem.planner.objective));
            CHECK(run.flight->goal_error_m == worst_goal_error_m(*found.execution));
        }
    }
    CHECK(in_space == 2);
    CHECK(answer(alone, "SELECT count(*) FROM flights") ==
          std::to_string(std::ranges::count_if(results.runs, [](const Run& run) { return run.flight.has_value(); })));
}

TEST_CASE("plans in space are flown in the same worlds as by execute, which no search has seen") {
    SpaceProblem problem = girder();
    const SpacePlan plan = shipped_plan(problem);
    constexpr std::uint64_t worlds = 3;
    const auto figures = SpacePlanEvaluation(problem, worlds).evaluate(plan, {}, {});
    REQUIRE(figures);
    CHECK(figures->worlds == worlds);
    const SpaceProblemModel model(problem);
    std::uint64_t failures = 0;
    for (std::uint64_t i = 1; i <= worlds; ++i) {
        SpaceExecutionSettings settings;
        settings.world = draw_space_world(*problem.uncertainty, problem.robot, evaluation_seed, i);
        failures += model.execute(plan, settings).outcome != Outcome::ok ? 1 : 0;
    }
    CHECK(figures->failures == failures);
    // A scene that is 0.4 m lower is in the way of a plan that passes 0.25 m below the girder.
    problem.uncertainty->scene_z_m = downwash::Spread::over(-0.4, -0.4);
    const auto lower = SpacePlanEvaluation(problem, worlds).evaluate(plan, {}, {});
    CHECK(lower->failures == worlds);
    const auto alone = std::ranges::find(lower->alone, "aero.scene_offset_m.z", &ParameterFlights::parameter);
    REQUIRE(alone != lower->alone.end());
    CHECK(alone->fails_low);
    CHECK(alone->fails_high);
    // Not all parameters are to blame.
    CHECK(std::ranges::count_if(lower->alone, [](const ParameterFlights& of) { return of.fails_low; }) <
          static_cast<std::ptrdiff_t>(lower->alone.size()));
    std::stop_source stop;
    stop.request_stop();
    CHECK_FALSE(SpacePlanEvaluation(problem, worlds).evaluate(plan, {}, stop.get_token()).has_value());
}

TEST_CASE("what a campaign cannot plan in space is left out for all, with the reason") {
    ReadCampaign read = mixed_campaign(1);
    read.campaign.parameters = {{}, {{"passage_share", 0.2}}};
    const CampaignPlan plan = plan_of(read);
    CHECK(plan.planners.size() == 1);
    REQUIRE(plan.left_out.size() == 1);
    CHECK_THAT(plan.left_out[0], Contains("mp-arm-da rrt-star") && Contains("passage_share") && Contains("in space"));
    // A problem itself that cannot be planned is a run that says why.
    ReadCampaign holding = mixed_campaign(1);
    std::get<SpaceProblem>(holding.problems[1]).motion.yaw.mode = YawMode::hold;
    holding.campaign.algorithms = {"rrt"};
    const ScratchFolder folder;
    run_into(folder, holding);
    const CampaignResults results = results_in(folder);
    const auto impossible = std::ranges::find(results.runs, std::size_t{1}, &Run::experiment);
    REQUIRE(impossible != results.runs.end());
    CHECK(impossible->status == RunStatus::impossible);
    CHECK_THAT(impossible->error, Contains("motion.yaw"));
}

TEST_CASE("the study of uncertainty plans problems in space for the nominal world, one pessimistic and several") {
    StudySettings settings;
    settings.problems = {girder()};
    settings.worlds = 3;
    const std::vector<StudyPart> parts = parts_of(settings);
    CHECK(parts.size() == 8);
    CHECK_FALSE(uncertainty_of(parts[0].read.problems[0]).has_value());
    // All worlds of the pessimistic planner are the same.
    const auto& pessimistic = std::get<SpaceProblem>(parts[1].read.problems[0]);
    for (const std::uint64_t index : {1U, 2U}) {
        const SpaceWorld world = draw_space_world(*pessimistic.uncertainty, pessimistic.robot, 1, index);
        CHECK(world.ceiling_scale == 0.4);
        CHECK(world.scene_m == Vector3{0, 0, -0.04});
    }
    for (const StudyPart& part : parts) {
        CHECK_FALSE(plan_of(part.read).planners.empty());
    }
}

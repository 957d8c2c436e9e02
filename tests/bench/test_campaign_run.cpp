#include "downwash/bench/campaign_run.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <string>
#include <tuple>

#include "small_campaign.hpp"

using namespace downwash;         // NOLINT(google-build-using-namespace): a test
using namespace downwash::bench;  // NOLINT(google-build-using-namespace): a test
using namespace downwash::test;   // NOLINT(google-build-using-namespace): a test

namespace {

/// All figures of a run but its improvements and its flight.
auto figures_of(const Run& run) {
    return std::tie(run.experiment, run.planner, run.seed, run.status, run.wall_s, run.first_solution_s, run.cost,
                    run.nearest_approach_m, run.iterations, run.edges_simulated, run.states_checked, run.simulated_s,
                    run.discarded, run.rejections, run.error, run.certificate, run.first_certified_s, run.in_worlds,
                    run.made_on);
}

}  // namespace

TEST_CASE("a campaign runs everything with every seed, whatever the number of threads") {
    const ScratchFolder alone, together;
    ReadCampaign read = small_campaign(3);
    read.campaign.jobs = 1;
    const CampaignProgress progress = run_into(alone, read);
    CHECK(progress.planned == 6);
    CHECK(progress.done == 6);
    read.campaign.jobs = 3;
    run_into(together, read);
    const CampaignResults results = results_in(alone);
    CHECK(repeatable(results) == repeatable(results_in(together)));
    CHECK(results.plan.seeds == std::vector<std::uint32_t>{1, 2, 3});
    for (const Run& run : results.runs) {
        CHECK(run.status == RunStatus::solved);
        CHECK(run.flight.has_value());
        CHECK(run.first_solution_s <= run.wall_s);
        REQUIRE_FALSE(run.improvements.empty());
        CHECK(run.improvements.back().cost == run.cost);
        CHECK(run.iterations > 0);
    }
}

TEST_CASE("what is read from a file of results is what was written, by one program at a time") {
    const ScratchFolder folder;
    ReadCampaign campaign = small_campaign();
    campaign.campaign.parameters = {{{"goal_bias", 0.1 + 0.2}}};
    const CampaignPlan plan = plan_of(campaign);
    Run written;
    written.planner = 1;
    written.seed = 2;
    written.status = RunStatus::solved;
    written.wall_s = 0.1 + 0.2;
    written.first_solution_s = 1.0 / 3;
    written.cost = 1e-7 / 3;
    written.nearest_approach_m = 0.7 / 3;
    written.iterations = 1234567890123;
    written.edges_simulated = 5;
    written.states_checked = 6;
    written.simulated_s = 7.5;
    written.discarded = 8;
    written.improvements = {{0.25, 3, 12.5, {}}, {0.5, 9, 1.0 / 7, 2.0 / 7}};
    for (std::uint64_t i = 10; i < 50; ++i) {  // more rows than one statement inserts
        const auto number = static_cast<double>(i);
        written.improvements.push_back({number, i, 1 / number, i % 3 == 0 ? std::nullopt : std::optional(2 / number)});
    }
    written.rejections = {{"collision", 11}, {"bounds", 12}};
    written.flight = FlightFigures{Outcome::left_flyable_area, 1, 2, 3, 4, HUGE_VAL, 0.1};
    written.error = "a 'quoted'; error";
    written.certificate = CertificateFigures{true, 437, 1, 3};
    written.first_certified_s = 0.7;
    written.in_worlds = WorldFigures{200, 7, {{"aero.ceiling_scale", false, true}, {"wind.steady_m_s.x", true, false}}};
    written.made_on = RunMachine{{"node 7", "AMD EPYC 7B13", "avx2"}, 1.25};
    {
        CampaignStore store(folder / "results", plan, false);
        store.add(written);
        CHECK(store.has(0, 1, 2));
        CHECK_FALSE(store.has(0, 1, 1));
        CHECK_THROWS_WITH(run_into(folder, small_campaign(), true),
                          Catch::Contains("another program is running the campaign"));
    }
    const CampaignResults results = results_in(folder);
    CHECK(results.plan.settings == plan.settings);
    CHECK(results.plan.experiments == plan.experiments);
    CHECK(results.plan.planners == plan.planners);
    REQUIRE(results.runs.size() == 1);
    const Run& read = results.runs[0];
    CHECK(figures_of(read) == figures_of(written));
    REQUIRE(read.improvements.size() == written.improvements.size());
    for (std::size_t i = 0; i < written.improvements.size(); ++i) {
        INFO("improvement " << i);
        const Improvement &of = read.improvements[i], &expected = written.improvements[i];
        CHECK(of.wall_s == expected.wall_s);
        CHECK(of.iteration == expected.iteration);
        CHECK(of.cost == expected.cost);
        CHECK(of.flown_cost == expected.flown_cost);
    }
    REQUIRE(read.flight.has_value());
    CHECK(read.flight->outcome == Outcome::left_flyable_area);
    CHECK(read.flight->min_clearance_m == HUGE_VAL);
}

TEST_CASE("plans are flown in worlds that do not depend on threads, and certificates are kept") {
    const ScratchFolder alone, together;
    ReadCampaign read = small_campaign(2);
    planar(read.problems[0]).uncertainty = Uncertainty();
    planar(read.problems[0]).planner.max_failure_probability = 0.3;
    read.campaign.variants = {Variant::mp_arm, Variant::mp_arm_ada};
    read.campaign.evaluation_worlds = 9;
    read.campaign.jobs = 1;
    run_into(alone, read);
    read.campaign.jobs = 2;
    run_into(together, read);
    CampaignResults results = results_in(alone);
    CHECK(results.plan.evaluation_worlds == 9);
    const auto flights_of = [](CampaignResults of) {
        std::sort(of.runs.begin(), of.runs.end(),
                  [](const Run& a, const Run& b) { return std::tie(a.planner, a.seed) < std::tie(b.planner, b.seed); });
        std::vector<std::tuple<std::optional<WorldFigures>, std::optional<CertificateFigures>>> flights;
        for (const Run& run : of.runs) {
            flights.emplace_back(run.in_worlds, run.certificate);
        }
        return flights;
    };
    CHECK(flights_of(results) == flights_of(results_in(together)));
    for (const Run& run : results.runs) {
        CHECK(run.in_worlds.has_value() == (run.status == RunStatus::solved));
        if (run.in_worlds) {
            CHECK(run.in_worlds->worlds == 9);
            CHECK(run.in_worlds->alone.size() >= 10);
            CHECK(run.certificate.has_value());
        }
    }
    CHECK(std::count_if(results.runs.begin(), results.runs.end(), [](const Run& run) { return run.in_worlds; }) >= 2);
}

TEST_CASE("plans made for one uncertainty are flown in the worlds of another") {
    const ScratchFolder folder;
    ReadCampaign read = small_campaign(1);
    read.campaign.evaluation_worlds = 4;
    read.evaluated_in = read.problems;
    planar(read.evaluated_in[0]).uncertainty = Uncertainty();
    run_into(folder, read);
    for (const Run& run : results_in(folder).runs) {
        CHECK_FALSE(run.certificate.has_value());
        REQUIRE(run.in_worlds.has_value());
        CHECK(run.in_worlds->worlds == 4);
    }
    planar(read.evaluated_in[0]).uncertainty->mass_scale = downwash::Spread::of_sd(0.1);
    CHECK_THROWS_WITH(run_into(folder, read, true), Catch::Contains("evaluated in ceiling"));
}

TEST_CASE("a campaign varies the parameters of its algorithms") {
    const ScratchFolder folder;
    ReadCampaign read = small_campaign(1);
    planar(read.problems[0]).planner.parameters = {{"local_bias", 0.0}};
    read.campaign.parameters = {{}, {{"goal_bias", 0.9}}, {{"first_goal_bias", 0.9}}, {{"rewire_factor", 2.0}}};
    run_into(folder, read);
    const CampaignResults results = results_in(folder);
    std::vector<std::string> names;
    for (const PlannerSetup& planner : results.plan.planners) {
        names.push_back(planner.name());
    }
    CHECK(names == std::vector<std::string>{"mp-arm rrt-star", "mp-arm rrt-star, goal_bias 0.9",
                                            "mp-arm rrt-star, first_goal_bias 0.9", "mp-arm-da rrt-star",
                                            "mp-arm-da rrt-star, goal_bias 0.9",
                                            "mp-arm-da rrt-star, first_goal_bias 0.9"});
    CHECK(results.plan.left_out ==
          std::vector<std::string>{
              "mp-arm rrt-star, rewire_factor 2: the algorithm has no parameter rewire_factor for this variant",
              "mp-arm-da rrt-star, rewire_factor 2: the algorithm has no parameter rewire_factor for this variant"});
    // A set that matters makes a search of its own.
    std::vector<std::uint64_t> work(names.size());
    for (const Run& run : results.runs) {
        REQUIRE(run.status == RunStatus::solved);
        work[run.planner] = run.states_checked + run.edges_simulated;
    }
    CHECK(work[0] != work[2]);
    CHECK(work[3] != work[5]);
    CHECK(answer(folder, "SELECT settings FROM plannerConfigs WHERE id = 2") == "goal_bias 0.9");
}

TEST_CASE("the file has the tables and columns that Planner Arena reads") {
    const ScratchFolder folder;
    run_into(folder, small_campaign());
    CHECK_FALSE(answer(folder, "SELECT name || ' ' || timelimit IS NULL || ' ' || runcount FROM experiments").empty());
    CHECK(answer(folder, "SELECT count(*) FROM plannerConfigs WHERE name = 'mp-arm rrt-star'") == "1");
    CHECK(answer(folder, "SELECT description FROM enums WHERE name = 'status' AND value = 2") == "solved");
    CHECK(answer(folder,
                 "SELECT count(*) FROM runs JOIN experiments ON experimentid = experiments.id JOIN "
                 "plannerConfigs ON plannerid = plannerConfigs.id WHERE time > 0 AND solved = 1") == "4");
    CHECK(answer(folder, "SELECT count(DISTINCT runid) FROM progress WHERE best_cost > 0 AND time > 0") == "4");
    CHECK(answer(folder, "PRAGMA integrity_check") == "ok");
    // As OMPL 1.6's ompl_benchmark_statistics.py makes them; what else a table has comes behind.
    for (const auto& [table, columns] : std::map<std::string, std::string>{
             {"experiments",
              "id,name,totaltime,timelimit,memorylimit,runcount,version,hostname,cpuinfo,date,seed,setup"},
             {"plannerConfigs", "id,name,settings"},
             {"enums", "name,value,description"},
             {"runs", "id,experimentid,plannerid"},
             {"progress", "runid,time"}}) {
        CAPTURE(table);
        CHECK_THAT(answer(folder, "SELECT group_concat(name) FROM pragma_table_info('" + table + "')"),
                   Catch::StartsWith(columns));
    }
}

TEST_CASE("a campaign that was stopped goes on where it was and ends as if it never had been") {
    const ScratchFolder whole, parts;
    const ReadCampaign read = small_campaign(3);
    run_into(whole, read);

    std::stop_source stop;
    CampaignRunOptions options;
    options.out = parts / "results";
    options.stop = stop.get_token();
    options.on_progress = [&](double share) {
        if (share > 0.3) {
            stop.request_stop();
        }
    };
    const CampaignProgress first = run_campaign(read, options);
    CHECK(first.done >= 1);
    CHECK(first.done < first.planned);
    const std::string first_key = answer(parts, "SELECT min(id) || ' ' || time FROM runs");

    const CampaignProgress second = run_into(parts, read, true);
    CHECK(second.done == second.planned);
    CHECK(answer(parts, "SELECT min(id) || ' ' || time FROM runs") == first_key);  // not run again
    CHECK(repeatable(results_in(parts)) == repeatable(results_in(whole)));
}

TEST_CASE("results are neither overwritten nor mixed with those of other settings") {
    const ScratchFolder folder;
    const ReadCampaign read = small_campaign();
    run_into(folder, read);
    CHECK_THROWS_WITH(run_into(folder, read), Catch::Contains("holds runs already; --resume continues with them"));

    ReadCampaign other = read;
    other.campaign.max_iterations = 151;
    planar(other.problems[0]).goal.hold_s = 6;
    CHECK_THROWS_WITH(run_into(folder, other, true), Catch::Contains("was begun with max_iterations 150, not 151") &&
                                                         Catch::Contains("was begun with problem ceiling ") &&
                                                         Catch::Contains("choose another folder with --out"));
    CHECK(results_in(folder).runs.size() == 4);
}

TEST_CASE("what is no file of results is an error") {
    const ScratchFolder folder;
    std::filesystem::create_directories(folder / "results");
    CHECK_THROWS_WITH(results_in(folder), Catch::Contains("does not exist"));
    std::ofstream(folder / "results" / results_file) << "SQLite format 3, but not really";
    CHECK_THROWS_AS(results_in(folder), std::runtime_error);
    CHECK_THROWS_AS(run_into(folder, small_campaign(), true), std::runtime_error);
    std::filesystem::remove(folder / "results" / results_file);
    CHECK(answer(folder, "CREATE TABLE other (x)").empty());
    CHECK_THROWS_WITH(results_in(folder), Catch::Contains("holds no results of a campaign"));
}

TEST_CASE("a margin that makes a problem impossible is a run that failed, with the reason") {
    const ScratchFolder folder;
    ReadCampaign read = small_campaign(1);
    read.campaign.variants = {Variant::mp_arm};
    read.campaign.margins_m = {0.05, 3};
    CHECK(run_into(folder, read).done == 2);
    for (const Run& run : results_in(folder).runs) {
        const bool is_wide = run.planner == 1;
        CHECK(run.status == (is_wide ? RunStatus::impossible : RunStatus::solved));
        CHECK((run.error.find("nearer than planner.safety_margin_m, 3") != std::string::npos) == is_wide);
    }
}

TEST_CASE("experiments are problems under the campaign's objectives, or under their own") {
    ReadCampaign read = small_campaign();
    planar(read.problems[0]).planner.objective.weight(Objective::time) = 50;
    CHECK(plan_of(read).experiments == std::vector<Experiment>{{"ceiling", "energy + 50 time"}});
    read.campaign.objectives = {Objective::time, Objective::length};
    CHECK(plan_of(read).experiments == std::vector<Experiment>{{"ceiling", "time"}, {"ceiling", "length"}});

    const ScratchFolder folder;
    read.campaign.variants = {Variant::mp_arm};
    read.campaign.seeds.count = 1;
    run_into(folder, read);
    for (const Run& run : results_in(folder).runs) {
        REQUIRE(run.flight.has_value());
        CHECK(run.flight->cost == (run.experiment == 0 ? run.flight->duration_s : run.flight->length_m));
    }
}

TEST_CASE("a plan says which combinations do not exist, and an impossible one is no campaign") {
    ReadCampaign read = small_campaign();
    read.campaign.algorithms = {"rrt-star", "no-such"};
    const CampaignPlan plan = plan_of(read);
    CHECK(plan.planners.size() == 2);
    REQUIRE(plan.left_out.size() == 2);
    CHECK(plan.left_out[0].starts_with("mp-arm no-such: planner.algorithm is 'no-such'"));
    read.campaign.algorithms = {"no-such"};
    CHECK_THROWS_AS(plan_of(read), CampaignError);
}

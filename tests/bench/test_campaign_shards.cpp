#include "downwash/bench/campaign_shards.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <numeric>
#include <string>

#include "downwash/base/files.hpp"
#include "downwash/bench/campaign_merge.hpp"
#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/saved_copy.hpp"
#include "small_campaign.hpp"

using namespace downwash;         // NOLINT(google-build-using-namespace): a test
using namespace downwash::bench;  // NOLINT(google-build-using-namespace): a test
using namespace downwash::test;   // NOLINT(google-build-using-namespace): a test
using Catch::Contains;

namespace {

/// A plan that is never run.
CampaignPlan plan_for(std::size_t experiments, std::size_t planners, std::uint32_t seeds, const ShardPlan& shards) {
    CampaignPlan plan;
    plan.experiments.resize(experiments);
    plan.planners.resize(planners);
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        plan.seeds.push_back(seed);
    }
    plan.shards = shards;
    return plan;
}

/// The work of every shard [us], where a run of a cell costs so much.
std::map<std::uint64_t, std::uint64_t> loads_of(const CampaignPlan& plan, const std::vector<std::uint64_t>& costs_us) {
    const ShardAssignment shards(plan);
    std::map<std::uint64_t, std::uint64_t> loads_us;
    for (std::size_t cell = 0; cell < costs_us.size(); ++cell) {
        for (std::size_t seed = 0; seed < plan.seeds.size(); ++seed) {
            loads_us[shards.shard_of(cell / plan.planners.size(), cell % plan.planners.size(), seed)] += costs_us[cell];
        }
    }
    return loads_us;
}

std::uint64_t spread_of(const std::map<std::uint64_t, std::uint64_t>& loads) {
    std::uint64_t min = UINT64_MAX, max = 0;
    for (const auto& [shard, load] : loads) {
        min = std::min(min, load);
        max = std::max(max, load);
    }
    return max - min;
}

ReadCampaign quick_campaign(std::uint64_t seeds = 3) {
    ReadCampaign read = small_campaign(seeds);
    read.campaign.max_iterations = 5;
    return read;
}

std::filesystem::path folder_of(const ScratchFolder& folder, std::uint64_t shard, std::uint64_t count) {
    return folder / shard_folder_name(shard, count);
}

CampaignProgress run_shard(const ScratchFolder& folder, const ReadCampaign& read, std::uint64_t shard,
                           std::uint64_t count, bool resumes = false) {
    CampaignRunOptions options;
    options.out = folder_of(folder, shard, count);
    options.shard = ShardRequest{shard, count, {}};
    options.resumes = resumes;
    return run_campaign(read, options);
}

/// All shards of a campaign, and their folders.
std::vector<std::filesystem::path> run_shards(const ScratchFolder& folder, const ReadCampaign& read,
                                              std::uint64_t count) {
    std::vector<std::filesystem::path> folders;
    for (std::uint64_t shard = 1; shard <= count; ++shard) {
        run_shard(folder, read, shard, count);
        folders.push_back(folder_of(folder, shard, count));
    }
    return folders;
}

}  // namespace

TEST_CASE("shards have as many runs of every planner, and with a pilot as much work") {
    const std::vector<std::uint64_t> equal(6, 1);
    const CampaignPlan plan = plan_for(2, 3, 7, {4, {}});
    const auto loads = loads_of(plan, equal);
    CHECK(loads.size() == 4);
    CHECK(spread_of(loads) <= 1);  // 42 runs
    CHECK(ShardAssignment(plan).run_count(1) == loads.at(1));

    const std::vector<std::uint64_t> costs_us{1000000, 40, 300, 250000, 7, 90000};
    const CampaignPlan measured = plan_for(2, 3, 100, {8, costs_us});
    CHECK(spread_of(loads_of(measured, costs_us)) <= 20000);  // of two seconds
    CHECK(spread_of(loads_of(plan_for(2, 3, 100, {8, {}}), costs_us)) > 100000);
}

TEST_CASE("a pilot is a campaign with the same planners, and says how long their runs take") {
    const ScratchFolder folder;
    const ReadCampaign pilot = quick_campaign(1);
    run_into(folder, pilot);
    ReadCampaign read = quick_campaign(4);
    const CampaignPlan plan = plan_of(read, ShardRequest{1, 2, folder / "results"});
    REQUIRE(plan.shards->cell_costs_us.size() == 2);
    const CampaignResults measured = results_in(folder);
    for (const Run& run : measured.runs) {
        CHECK(static_cast<double>(plan.shards->cell_costs_us[run.planner]) == Approx(1e6 * run.wall_s).margin(1));
    }
    CHECK(setting(plan, "shard_costs").size() == 64);
    CHECK(plan_of(read, ShardRequest{2, 2, folder / "results"}).settings == plan.settings);
    read.campaign.variants = {Variant::mp_arm_ada};
    CHECK_THROWS_WITH(plan_of(read, ShardRequest{1, 2, folder / "results"}), Contains("has no run of the campaign's"));
    CHECK_THROWS_WITH(plan_of(read, ShardRequest{1, 5, {}}), Contains("5 shards are more than the campaign has runs"));
}

TEST_CASE("shards that are merged are the campaign, whatever their order, and name the machine of each run") {
    const ScratchFolder folder;
    const ReadCampaign read = quick_campaign();
    run_into(folder, read);
    const auto shards = run_shards(folder, read, 4);
    const MergedCampaign merged = merge_shards(folder / "merged", shards, false);
    CHECK(merged.done == 6);
    CHECK(merged.missing.empty());
    CHECK(merged.processors == 1);
    const CampaignResults results = read_results(folder / "merged");
    CHECK(repeatable(results) == repeatable(results_in(folder)));
    for (const Run& run : results.runs) {
        REQUIRE(run.made_on.has_value());
        CHECK_FALSE(run.made_on->machine.host.empty());
        CHECK_FALSE(run.made_on->machine.instruction_set.empty());
    }
    merge_shards(folder / "again", {shards.rbegin(), shards.rend()}, false);
    CHECK(read_results(folder / "again").runs.front().wall_s == results.runs.front().wall_s);
    CHECK_THROWS_WITH(merge_shards(folder / "merged", shards, false), Contains("exists: choose another folder"));
    CHECK(merge_shards(folder / "merged", shards, true).done == 6);
    CHECK_THROWS_WITH(merge_shards(shards[0], shards, true), Contains("is one of the shards"));
}

TEST_CASE("a merge names what is missing, and where it belongs") {
    const ScratchFolder folder;
    const ReadCampaign read = quick_campaign();
    auto shards = run_shards(folder, read, 3);
    CHECK(answer_in(shards[0], "DELETE FROM runs WHERE id = 1").empty());
    CHECK_THROWS_WITH(merge_shards(folder / "merged", shards, false),
                      Contains(shards[0].string()) && Contains("2 runs were written, 1 are there"));
    CHECK_FALSE(std::filesystem::exists(folder / "merged" / results_file));
    CHECK(run_shard(folder, read, 1, 3, true).done == 2);
    shards.pop_back();
    const MergedCampaign merged = merge_shards(folder / "merged", shards, false);
    CHECK(merged.done == 4);
    REQUIRE(merged.missing.size() == 1);
    CHECK(merged.missing[0].shard == 3);
    CHECK(merged.missing[0].count == 2);
    CHECK(merged.missing[0].runs ==
          "ceiling, energy, mp-arm rrt-star: seed 3; ceiling, energy, mp-arm-da rrt-star: seed 3");
    CHECK(merged.missing[0].folder == folder_of(folder, 3, 3));
    CHECK(read_results(folder / "merged").runs.size() == 4);
}

TEST_CASE("a shard in which nothing was written yet has no runs for a merge") {
    const ScratchFolder folder;
    auto shards = run_shards(folder, quick_campaign(), 2);
    std::filesystem::resize_file(shards[1] / results_file, 0);
    const MergedCampaign merged = merge_shards(folder / "merged", shards, false);
    CHECK(merged.done == 3);
    REQUIRE(merged.missing.size() == 1);
    CHECK(merged.missing[0].shard == 2);
    shards.erase(shards.begin());
    CHECK_THROWS_WITH(merge_shards(folder / "merged", shards, true), Contains("none of the folders has results yet"));
}

TEST_CASE("a merge rejects what does not belong together, and leaves nothing behind") {
    const ScratchFolder folder;
    const ReadCampaign read = quick_campaign();
    auto shards = run_shards(folder, read, 2);
    const auto rejects = [&](const std::string& expected) {
        CHECK_THROWS_WITH(merge_shards(folder / "merged", shards, false), Contains(expected));
        CHECK((!std::filesystem::exists(folder / "merged") || std::filesystem::is_empty(folder / "merged")));
    };
    SECTION("other settings") {
        ReadCampaign other = read;
        other.campaign.max_iterations = 6;
        std::filesystem::remove_all(shards[1]);
        run_shard(folder, other, 2, 2);
        rejects("was begun with max_iterations 6, " + (shards[0] / results_file).string() + " with 5");
    }
    SECTION("another number of shards") {
        run_shard(folder, read, 1, 3);
        shards.push_back(folder_of(folder, 1, 3));
        rejects("was begun with shards 3, ");
    }
    SECTION("a run in two files") {
        std::filesystem::copy(shards[0], folder / "copy");
        shards.push_back(folder / "copy");
        rejects("both have the run of ceiling, energy, mp-arm rrt-star, seed 1");
    }
    SECTION("a whole campaign") {
        run_into(folder, read);
        shards.push_back(folder / "results");
        rejects("holds no shard but a whole campaign");
    }
    SECTION("nothing") {
        shards.push_back(folder / "nowhere");
        rejects("does not exist: expected the folder of a shard");
    }
}

TEST_CASE("a shard goes on with its own results only") {
    const ScratchFolder folder;
    const ReadCampaign read = quick_campaign();
    run_shard(folder, read, 1, 2);
    CampaignRunOptions options;
    options.out = folder_of(folder, 1, 2);
    options.resumes = true;
    options.shard = ShardRequest{2, 2, {}};
    CHECK_THROWS_WITH(run_campaign(read, options), Contains("holds shard 1 of the campaign, not shard 2"));
    options.shard.reset();
    CHECK_THROWS_WITH(run_campaign(read, options), Contains("was begun with shards 2, not without"));
}

TEST_CASE("a copy of the results brings back what a node has lost, and nothing runs twice") {
    const ScratchFolder folder;
    const ReadCampaign read = quick_campaign();
    CampaignRunOptions options;
    options.out = folder / "local";
    options.shard = ShardRequest{1, 2, {}};
    options.saved = folder / "kept";
    CHECK(run_campaign(read, options).done == 3);
    const std::string times = answer_in(folder / "kept", "SELECT group_concat(time) FROM runs");
    std::filesystem::remove_all(folder / "local");
    options.resumes = true;
    CHECK(run_campaign(read, options).done == 3);
    CHECK(answer_in(folder / "local", "SELECT group_concat(time) FROM runs") == times);

    // Results that have less do not replace the copy.
    CHECK(answer_in(folder / "local", "DELETE FROM runs WHERE id > 1; UPDATE campaign_checksum SET finished_runs = 1")
              .empty());
    SavedCopy(options.out, options.saved).save();
    CHECK(answer_in(folder / "kept", "SELECT group_concat(time) FROM runs") == times);
    options.stop = [] {
        std::stop_source stop;
        stop.request_stop();
        return stop.get_token();
    }();
    CHECK(run_campaign(read, options).done == 3);
    CHECK(answer_in(folder / "kept", "SELECT group_concat(time) FROM runs") == times);

    options.stop = {};
    options.resumes = false;
    options.out = folder / "new";
    CHECK_THROWS_WITH(run_campaign(read, options), Contains("holds runs already; --resume continues"));
    CHECK_FALSE(std::filesystem::exists(folder / "new" / results_file));
    options.resumes = true;
    options.out = folder / "other";
    options.shard = ShardRequest{2, 2, {}};
    options.saved.clear();
    CHECK(run_campaign(read, options).done == 3);
    options.saved = folder / "kept";
    CHECK_THROWS_WITH(run_campaign(read, options), Contains("or of another shard: choose another folder with --save"));
    CHECK_THROWS_WITH(SavedCopy(options.out, options.saved).save(), Contains("or of another shard"));
    options.out = folder / "fresh";
    CHECK_THROWS_WITH(run_campaign(read, options), Contains("or of another shard"));
    CHECK_FALSE(std::filesystem::exists(folder / "fresh" / results_file));
    CHECK(answer_in(folder / "kept", "SELECT group_concat(time) FROM runs") == times);

    std::ofstream(folder / "file") << "in the way";
    options.saved = folder / "file" / "kept";
    CHECK_THROWS_WITH(run_campaign(read, options), Contains("cannot be made a folder"));
}

TEST_CASE("a file of results that is taken away is noticed before a run is lost") {
    const ScratchFolder folder;
    CampaignStore store(folder / "results", plan_of(quick_campaign()), false);
    Run run;
    run.seed = 1;
    store.add(run);
    std::filesystem::rename(folder / "results", folder / "elsewhere");
    run.seed = 2;
    CHECK_THROWS_WITH(store.add(run), Contains("was removed or replaced while the campaign ran"));
    CHECK(read_results(folder / "elsewhere").runs.size() == 1);
}

TEST_CASE("a shard of a campaign with very many seeds has a small file") {
    const ScratchFolder folder;
    CampaignPlan plan = plan_of(quick_campaign(2));
    plan.seeds.resize(max_campaign_runs / 2);
    std::iota(plan.seeds.begin(), plan.seeds.end(), 7U);
    plan.seeds.push_back(3);
    { const CampaignStore store(folder / "results", plan, false); }
    CHECK(std::filesystem::file_size(folder / "results" / results_file) < 200000);
    CHECK((read_report(folder / "results").plan.seeds == plan.seeds));
}

TEST_CASE("a report that pools times of several models of processors says so") {
    const ScratchFolder folder;
    CampaignPlan plan = plan_of(quick_campaign(2));
    {
        CampaignStore store(folder / "results", plan, false);
        for (const std::uint32_t seed : {1U, 2U}) {
            Run run;
            run.seed = seed;
            run.made_on = RunMachine{{"node " + std::to_string(seed), seed == 1 ? "old" : "new", "avx2"}, 0.5 * seed};
            store.add(run);
        }
    }
    const CampaignReport report = read_report(folder / "results");
    CHECK(report.processor_models() == 2);
    const std::string warning = "2 models of processors together";
    CHECK_THAT(markdown_of(report), Contains(warning) && Contains("| node 2 | new | avx2 | 1 | 1 | 1 |"));
    CHECK_THAT(latex_of(report), Contains(warning));
    CHECK_THAT(json_of(report), Contains("\"processor_models\": 2"));
}

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <string>

#include "../support/scarce_memory.hpp"
#include "downwash/base/files.hpp"
#include "downwash/bench/campaign_report.hpp"
#include "small_campaign.hpp"

using namespace downwash;         // NOLINT(google-build-using-namespace): a test
using namespace downwash::bench;  // NOLINT(google-build-using-namespace): a test
using namespace downwash::test;   // NOLINT(google-build-using-namespace): a test

namespace {

std::string report_in(const ScratchFolder& folder) {
    return json_of(read_report(folder / "results"));
}

}  // namespace

TEST_CASE("a file of results of another version says what to do") {
    const ScratchFolder folder;
    run_into(folder, small_campaign(1));
    CHECK(answer(folder, "PRAGMA user_version = 5").empty());
    CHECK_THROWS_WITH(results_in(folder), Catch::Contains("its layout is number 5, not 8") &&
                                              Catch::Contains("run the campaign again into another folder"));
}

TEST_CASE("a run that was changed in the file of results is named, and run again by the next resume") {
    const std::string change =
        GENERATE("UPDATE runs SET status = 99 WHERE id = 2", "UPDATE runs SET plannerid = NULL WHERE id = 2",
                 "UPDATE flights SET outcome = 'fine' WHERE runid = 2", "UPDATE runs SET time = 'soon' WHERE id = 2",
                 "UPDATE runs SET solved = 0 WHERE id = 2", "UPDATE runs SET best_cost = best_cost + 1e-9 WHERE id = 2",
                 "DELETE FROM progress WHERE runid = 2", "DELETE FROM checksums WHERE runid = 2",
                 "UPDATE rejections SET runid = 99 WHERE runid = 2", "DELETE FROM runs WHERE id = 2");
    const ScratchFolder folder;
    const ReadCampaign read = small_campaign(1);
    run_into(folder, read);
    CHECK(answer(folder, change).empty());
    CAPTURE(change);
    const std::string named = change.find("plannerid") != std::string::npos ? "run 2: problem ceiling, energy"
                              : change.starts_with("DELETE FROM runs")
                                  ? "2 runs were written, 1 are there"
                                  : "rrt-star, seed 1: is not what was written";  // whichever of both ended last
    CHECK_THROWS_WITH(results_in(folder), Catch::Contains(named) && Catch::Contains("--resume"));
    CHECK(run_into(folder, read, true).done == 2);
    CHECK(results_in(folder).runs.size() == 2);
    CHECK(answer(folder, "PRAGMA foreign_key_check").empty());
}

TEST_CASE("settings that were changed in the file of results are an error, not believed") {
    const std::string change = GENERATE(
        "UPDATE plannerConfigs SET variant = 'x'", "DELETE FROM campaign_seeds",
        "UPDATE campaign_seeds SET last = 9223372036854775807", "UPDATE campaign_seeds SET first = -1",
        "UPDATE campaign SET value = 'other' WHERE name = 'host'", "UPDATE campaign_limits SET evaluation_worlds = -1",
        "INSERT INTO planner_parameters VALUES (2, 'goal_bias', 0.5)");
    const ScratchFolder folder;
    run_into(folder, small_campaign(1));
    CHECK(answer(folder, change).empty());
    CAPTURE(change);
    CHECK_THROWS_WITH(results_in(folder), Catch::Contains("is damaged") && Catch::Contains("another folder"));
    CHECK_THROWS_AS(run_into(folder, small_campaign(1), true), CampaignError);
}

TEST_CASE("a damaged byte in a file of results is noticed or changes nothing") {
    const ScratchFolder folder;
    run_into(folder, small_campaign(3));
    const std::string whole_report = report_in(folder);
    const std::filesystem::path file = folder / "results" / results_file;
    const std::string bytes = read_whole_file(file, 1U << 24U);
    std::mt19937_64 random(1);
    int noticed = 0;
    constexpr int tries = 400;
    for (int i = 0; i < tries; ++i) {
        std::string damaged = bytes;
        const std::size_t place = random() % bytes.size();
        damaged[place] = static_cast<char>(static_cast<unsigned char>(damaged[place]) ^ (1 + random() % 255));
        std::ofstream(file, std::ios::binary) << damaged;
        CAPTURE(place, i);
        try {
            const std::string report = report_in(folder);
            CHECK((report == whole_report));
        } catch (const std::runtime_error& error) {
            ++noticed;
            CHECK_THAT(error.what(), Catch::Contains(file.string()));
        }
    }
    CHECK(noticed > 10);  // most bytes of a small file are unused
}

TEST_CASE("a schema that is not ours is an error before anything is asked of it") {
    const std::string change = GENERATE(
        "DROP TABLE left_out; CREATE VIEW left_out AS WITH RECURSIVE n(place) AS (SELECT 1 UNION ALL SELECT place + 1 "
        "FROM n) SELECT place, 'x' AS what FROM n",
        "CREATE TRIGGER more AFTER INSERT ON runs BEGIN DELETE FROM flights; END", "CREATE TABLE other (x)",
        "CREATE INDEX fast ON runs (seed)");
    const ScratchFolder folder;
    run_into(folder, small_campaign(1));
    CHECK(answer(folder, change).empty());
    CAPTURE(change);
    CHECK_THROWS_WITH(results_in(folder), Catch::Contains("has other tables than `downwash bench run` makes"));
    CHECK_THROWS_AS(run_into(folder, small_campaign(1), true), CampaignError);
}

TEST_CASE("texts, files and questions that are too large for results are errors within a second") {
    const ScratchFolder folder;
    run_into(folder, small_campaign(1));
    const auto begin = std::chrono::steady_clock::now();
    SECTION("a text of 300 MB") {
        CHECK(answer(folder, "UPDATE campaign SET value = hex(zeroblob(150000000)) WHERE name = 'host'").empty());
        CHECK_THROWS_WITH(results_in(folder), Catch::Contains("too big") && Catch::Contains("16 MiB"));
    }
    SECTION("a file of 8 GB") {
        std::filesystem::resize_file(folder / "results" / results_file, std::uintmax_t{1} << 33U);
        CHECK_THROWS_WITH(results_in(folder), Catch::Contains("is larger than 4096 MiB"));
    }
    SECTION("no file at all") {
        const std::filesystem::path file = folder / "results" / results_file;
        std::filesystem::remove(file);
        std::filesystem::create_symlink("/dev/zero", file);
        CHECK_THROWS_WITH(results_in(folder), Catch::Contains("is no ordinary file"));
    }
    SECTION("a question without an end") {
        const Database database(folder / "results" / results_file);
        CHECK_THROWS_WITH(database.number("WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT "
                                          "count(*) FROM n"),
                          Catch::Contains("takes longer to read than a file of its size can"));
    }
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(20));
}

TEST_CASE("what a killed program left half written is taken back by whoever reads next") {
    const ScratchFolder folder;
    run_into(folder, small_campaign(1));
    const std::filesystem::path file = folder / "results" / results_file, journal = file.string() + "-journal";
    const std::string report = report_in(folder);
    const std::string before = read_whole_file(file, 1U << 24U);
    std::string half_written, half_journal;
    {  // A cache of few pages has to write them before the end of the transaction.
        const Database database(file);
        database.execute("PRAGMA cache_size = 2");
        database.execute("BEGIN IMMEDIATE");
        for (int i = 0; i < 2000; ++i) {
            database.run("INSERT INTO left_out (what) VALUES (?)", std::string(100, 'x'));
        }
        half_written = read_whole_file(file, 1U << 24U);
        half_journal = read_whole_file(journal, 1U << 24U);
    }
    REQUIRE(half_written != before);
    std::ofstream(file, std::ios::binary) << half_written;
    std::ofstream(journal, std::ios::binary) << half_journal;
    CHECK((report_in(folder) == report));
    CHECK_FALSE(std::filesystem::exists(journal));
}

TEST_CASE("numbers that are not finite do not spoil a file of results") {
    const ScratchFolder folder;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Run run;
    run.seed = 1;
    run.status = RunStatus::solved;
    run.cost = nan;
    run.improvements = {{nan, 1, nan, nan}};
    run.flight = FlightFigures{Outcome::unstable, nan, nan, 2, nan, HUGE_VAL, nan};
    run.error = std::string(1U << 20U, 'x');
    CampaignStore(folder / "results", plan_of(small_campaign()), false).add(run);
    const CampaignResults results = results_in(folder);
    REQUIRE(results.runs.size() == 1);
    CHECK_FALSE(results.runs[0].cost.has_value());
    CHECK(results.runs[0].flight->energy_j == HUGE_VAL);
    CHECK(results.runs[0].flight->duration_s == 2);
    CHECK_FALSE(json_of(read_report(folder / "results")).empty());
}

TEST_CASE("a run that finds no memory is not finished, and the next resume repeats it") {
    const ScratchFolder folder;
    ReadCampaign read = small_campaign(2);
    read.campaign.jobs = 1;
    CampaignRunOptions options;
    options.out = folder / "results";
    options.on_progress = [&](double share) { memory_is_scarce = share < 0.5; };  // of the second run
    const CampaignProgress first = run_campaign(read, options);
    memory_is_scarce = false;
    CHECK(first.planned == 4);
    CHECK(first.done == 3);
    CHECK(first.out_of_memory == 1);
    for (const Run& run : results_in(folder).runs) {
        CHECK(run.error.empty());
    }
    const CampaignProgress second = run_into(folder, read, true);
    CHECK(second.done == 4);
    CHECK(second.out_of_memory == 0);
}

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <thread>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;
using Catch::StartsWith;

namespace {

/// A campaign over the open air, written into the folder in which the program runs.
void write_campaign(const Workspace& work, const std::string& limits, const std::string& rest = "") {
    write_file(work.in_run("campaign.yaml"), "schema: downwash/campaign/v1\nname: trial\nproblems: [" +
                                                 problem_file("open_air") + "]\nvariants: [mp-arm-ada, mp-arm]\n" +
                                                 limits + "\n" + rest);
}

constexpr const char* quick = "seeds: [3, 5]\nmax_iterations: 200\nstop_at_first_solution: true";
/// Runs that end within milliseconds, so that a kill likely comes while one is written, but far too many to end.
constexpr const char* endless = "seeds: {count: 20000}\nmax_iterations: 5\njobs: 2";

/// How many runs the report counts; none before the file of results holds a campaign.
std::size_t runs_in(const Workspace& work) {
    const Result report = work.run("bench report out --json");
    if (report.code == 2) {
        CHECK_THAT(report.err, Contains("does not exist") || Contains("holds no results"));
        return 0;
    }
    return succeeded(report).json().at("runs_done").get<std::size_t>();
}

/// Waits until so many runs are there, a minute at most, and gives how many there are then.
std::size_t wait_for_runs(const Workspace& work, std::size_t min_runs) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    std::size_t runs = runs_in(work);
    while (runs < min_runs && std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        runs = runs_in(work);
    }
    return runs;
}

}  // namespace

TEST_CASE("A campaign is run and reported") {
    const Workspace work;
    write_campaign(work, quick);
    CHECK(work.succeed("bench run campaign.yaml").out == std::string("4 of 4 runs are in downwash-out/bench-trial") +
                                                             (has_pages ? ", report.html shows them" : "") +
                                                             "; see downwash bench report downwash-out/bench-trial\n");
    const auto files = work.files("downwash-out");
    CHECK(files.size() == (has_pages ? 2 : 1));
    CHECK(files.contains("bench-trial/campaign.db"));

    const Result report = work.succeed("bench report downwash-out/bench-trial");
    CHECK_THAT(report.out, StartsWith("# Campaign trial\n") &&
                               Contains("| open_air, energy | mp-arm-ada rrt-star | 2/2 [34.2, 100.0 %] |"));
    CHECK(report.err.empty());
    const auto json = work.json("bench report downwash-out/bench-trial");
    CHECK(json.at("settings").at("seeds") == "3 5");
    CHECK(json.at("cells").size() == 2);
}

TEST_CASE("A report comes as a page, as JSON, as a table for LaTeX and as CSV, into a file where one is named") {
    const Workspace work;
    write_campaign(work, quick);
    work.succeed("bench run campaign.yaml --out out");
    CHECK_THAT(work.run("bench report out --latex").out, Contains("\\begin{tabular}"));
    CHECK_THAT(work.run("bench report out --csv").out, StartsWith("problem,objective,variant,"));
    CHECK(work.succeed("bench report out --json -o report.json").out.empty());
    CHECK(work.text("report.json") == work.run("bench report out --json").out);
    CHECK(work.run("bench report out --json --csv").code == 2);
    CHECK(work.run("bench report out --csv -o none/report.csv").code == 2);

    const Result page = work.run("bench report out --html");
    if (has_pages) {
        CHECK(page.out == work.text("out/report.html"));
        CHECK_THAT(page.out, Contains("downwash/campaign-report/v1"));
    } else {
        CHECK(page.code == 2);
    }
}

TEST_CASE("A target that a campaign misses is an exit code of its own") {
    const Workspace work;
    write_campaign(work, quick, "expect: [{variant: mp-arm, first_solution_median_s: 1.0e-9}]\n");
    work.succeed("bench run campaign.yaml --out out");
    const Result report = work.run("bench report out");
    CHECK(report.code == 1);
    CHECK_THAT(report.out, Contains("| median first solution within 1e-09 s |") && Contains("**missed**"));
}

TEST_CASE("A campaign that is killed keeps every finished run and goes on with --resume") {
    const Workspace work;
    write_campaign(work, endless);
    std::size_t kept = 0;
    for (int kill = 0; kill < 5; ++kill) {
        CAPTURE(kill);
        const Program program(work, words("bench run campaign.yaml --out out --quiet", kill > 0 ? "--resume" : ""));
        const std::size_t seen = wait_for_runs(work, kept + 3);
        program.send(SIGKILL);
        CHECK(program.wait().code == 128 + SIGKILL);
        REQUIRE(seen >= kept + 3);
        kept = runs_in(work);
        CHECK(kept >= seen);
    }
    CHECK(work.run("bench run campaign.yaml --out out").code == 2);
    const Program again(work, words("bench run campaign.yaml --out out --quiet --resume"));
    CHECK(wait_for_runs(work, kept + 2) >= kept + 2);
    again.send(SIGTERM);
    const Result ended = again.wait();
    CHECK(ended.code == 143);
    CHECK(ended.err.empty());
}

TEST_CASE("A signal ends a campaign at once, with what is finished") {
    const auto [signal, code] = GENERATE(std::pair(SIGINT, 130), std::pair(SIGTERM, 143));
    const Workspace work;
    write_campaign(work, "seeds: {count: 100}\ntime_limit_s: 600");
    const Program program(work, words("bench run campaign.yaml --out out"));
    REQUIRE(program.has_said("writing results to out"));
    program.send(signal);
    const Result result = program.wait();
    CHECK(result.code == code);
    CHECK(result.out == "0 of 200 runs are in out; --resume continues with the others\n");
}

TEST_CASE("Shards are run one by one and merged, and the merge names runs that are missing and the command for them") {
    const Workspace work;
    write_campaign(work, "seeds: {count: 3}\nmax_iterations: 5");
    for (const std::string shard : {"1/3", "3/3"}) {
        CHECK_THAT(work.succeed("bench run campaign.yaml --shard", shard).out,
                   StartsWith("2 of 2 runs are in downwash-out/bench-trial/shard-000" + shard.substr(0, 1)));
    }
    const std::string folder = "downwash-out/bench-trial/shard-000";
    const Result partial = work.run("bench merge merged", folder + "1-of-0003", folder + "3-of-0003");
    CHECK(partial.code == 1);
    const std::string command = "bench run CAMPAIGN --shard 2/3 --resume --jobs 1 --out " + folder + "2-of-0003";
    CHECK_THAT(partial.out, StartsWith("4 of 6 runs are in merged\n") && Contains("shard 2: 2 runs are missing: ") &&
                                Contains("downwash " + command + "\n"));
    work.succeed(words("bench run campaign.yaml", command.substr(std::string("bench run CAMPAIGN ").size()).c_str()));
    CHECK(work.succeed("bench merge merged --force", folder + "1-of-0003", folder + "2-of-0003", folder + "3-of-0003")
              .out == "6 of 6 runs are in merged\n");
    CHECK(work.json("bench report merged").at("runs_done") == 6);
    CHECK(work.text("merged/report.html").empty() != has_pages);
    // Standard input may name more shards than a command line can hold.
    const std::string named = folder + "1-of-0003\n" + folder + "2-of-0003\n" + folder + "3-of-0003\n";
    CHECK(work.run_in({}, named, words("bench merge again -")).out == "6 of 6 runs are in again\n");
    check_rejected(work.run_in({}, "", words("bench merge none -")), "standard input names no folder of a shard");
}

TEST_CASE("A campaign ends with its wall time, and --resume continues") {
    const Workspace work;
    write_campaign(work, endless);
    const Result ended = work.run("bench run campaign.yaml --out out --wall-limit 0.5");
    CHECK(ended.code == 1);
    CHECK_THAT(ended.out, Contains("--resume continues with the others"));
}

TEST_CASE("A shard that cannot be is rejected with what was expected") {
    const Workspace work;
    write_campaign(work, quick);
    for (const char* shard : {"0/3", "4/3", "3", "a/b", "1/", "1/999999999", "-1/3"}) {
        CAPTURE(shard);
        check_rejected(work.run("bench run campaign.yaml --shard", shard), "expected I/N, for example 3/16");
    }
    check_rejected(work.run("bench run campaign.yaml --shard 1/9"), "9 shards are more than the campaign has runs");
    check_rejected(work.run("bench run campaign.yaml --pilot out"), "--pilot deals out shards");
    check_rejected(work.run("bench merge merged nowhere"), "nowhere/campaign.db does not exist");
}

TEST_CASE("Errors in a campaign file are reported with their place") {
    const Workspace work;
    write_campaign(work, "seads: 3");
    const Result result = work.run("bench run campaign.yaml --out out");
    CHECK(result.code == 2);
    CHECK(result.err == "campaign.yaml:5:1: unknown key 'seads' at the top: did you mean 'seeds'?\n");
    CHECK(work.files().size() == 1);
    CHECK(work.run("bench report out").code == 2);
    CHECK(work.run("bench").code == 2);
}

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <thread>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

namespace {

/// A campaign over the open air, written into the folder in which the program runs.
void write_campaign(const ScratchFolder& folder, const std::string& limits, const std::string& rest = "") {
    write_file(folder.path() / "run/campaign.yaml", "schema: downwash/campaign/v1\nname: trial\nproblems: [" +
                                                        problem_file("open_air") +
                                                        "]\nvariants: [mp-arm-ada, mp-arm]\n" + limits + "\n" + rest);
}

constexpr const char* quick = "seeds: [3, 5]\nmax_iterations: 200\nstop_at_first_solution: true";
constexpr const char* slow = "seeds: {count: 100}\ntime_limit_s: 0.3\njobs: 2";

/// Waits until some runs are there, and gives the report's word on how many.
std::size_t runs_in(const ScratchFolder& folder) {
    const Result report = run(folder, {"bench", "report", "out", "--json"});
    return report.code == 2 ? 0 : report.json().at("runs_done").get<std::size_t>();
}

std::size_t wait_for_runs(const ScratchFolder& folder, std::size_t least) {
    for (int i = 0; i < 200; ++i) {
        if (const std::size_t runs = runs_in(folder); runs >= least) {
            return runs;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return 0;
}

}  // namespace

TEST_CASE("A campaign is run and reported") {
    const ScratchFolder folder;
    write_campaign(folder, quick);
    const Result ran = run(folder, {"bench", "run", "campaign.yaml"});
    CHECK(ran.code == 0);
    CHECK(ran.out == std::string("4 of 4 runs are in downwash-out/bench-trial") +
                         (has_pages ? ", report.html shows them" : "") +
                         "; see downwash bench report downwash-out/bench-trial\n");
    const auto files = files_in(folder.path() / "run/downwash-out");
    CHECK(files.size() == (has_pages ? 2 : 1));
    CHECK(files.contains("bench-trial/campaign.db"));

    const Result report = run(folder, {"bench", "report", "downwash-out/bench-trial"});
    CHECK(report.code == 0);
    CHECK(report.out.starts_with("# Campaign trial\n"));
    CHECK(report.out.find("| open_air, energy | mp-arm-ada rrt-star | 2/2 [34.2, 100.0 %] |") != std::string::npos);
    CHECK(report.err.empty());
    const auto json = run(folder, {"bench", "report", "downwash-out/bench-trial", "--json"}).json();
    CHECK(json.at("settings").at("seeds") == "3 5");
    CHECK(json.at("cells").size() == 2);
}

TEST_CASE("A report comes as a page, as JSON, as a table for LaTeX and as CSV, into a file where one is named") {
    const ScratchFolder folder;
    write_campaign(folder, quick);
    CHECK(run(folder, {"bench", "run", "campaign.yaml", "--out", "out"}).code == 0);
    CHECK(run(folder, {"bench", "report", "out", "--latex"}).out.find("\\begin{tabular}") != std::string::npos);
    CHECK(run(folder, {"bench", "report", "out", "--csv"}).out.starts_with("problem,objective,variant,"));
    const Result into_file = run(folder, {"bench", "report", "out", "--json", "-o", "report.json"});
    CHECK(into_file.code == 0);
    CHECK(into_file.out.empty());
    CHECK(read_file(folder.path() / "run/report.json") == run(folder, {"bench", "report", "out", "--json"}).out);
    CHECK(run(folder, {"bench", "report", "out", "--json", "--csv"}).code == 2);
    CHECK(run(folder, {"bench", "report", "out", "--csv", "-o", "none/report.csv"}).code == 2);

    const Result page = run(folder, {"bench", "report", "out", "--html"});
    if (has_pages) {
        CHECK(page.out == read_file(folder.path() / "run/out/report.html"));
        CHECK(page.out.find("downwash/campaign-report/v1") != std::string::npos);
    } else {
        CHECK(page.code == 2);
    }
}

TEST_CASE("A bar that a campaign misses is an exit code of its own") {
    const ScratchFolder folder;
    write_campaign(folder, quick, "expect: [{variant: mp-arm, first_solution_median_s: 1.0e-9}]\n");
    CHECK(run(folder, {"bench", "run", "campaign.yaml", "--out", "out"}).code == 0);
    const Result report = run(folder, {"bench", "report", "out"});
    CHECK(report.code == 1);
    CHECK(report.out.find("| median first solution within 1e-09 s |") != std::string::npos);
    CHECK(report.out.find("**missed**") != std::string::npos);
}

TEST_CASE("A campaign that is killed keeps every finished run and goes on with --resume") {
    const ScratchFolder folder;
    write_campaign(folder, slow);
    const Program program(folder, {"bench", "run", "campaign.yaml", "--out", "out", "--quiet"});
    const std::size_t seen = wait_for_runs(folder, 3);
    program.send(SIGKILL);
    CHECK(program.wait().code == 128 + SIGKILL);
    REQUIRE(seen >= 3);
    const std::size_t kept = runs_in(folder);
    CHECK(kept >= seen);

    CHECK(run(folder, {"bench", "run", "campaign.yaml", "--out", "out"}).code == 2);
    const Program again(folder, {"bench", "run", "campaign.yaml", "--out", "out", "--quiet", "--resume"});
    CHECK(wait_for_runs(folder, kept + 2) > kept);
    again.send(SIGTERM);
    const Result ended = again.wait();
    CHECK(ended.code == 143);
    CHECK(ended.err.empty());
}

TEST_CASE("A signal ends a campaign at once, with what is finished") {
    const auto [signal, code] = GENERATE(std::pair(SIGINT, 130), std::pair(SIGTERM, 143));
    const ScratchFolder folder;
    write_campaign(folder, "seeds: {count: 100}\ntime_limit_s: 600");
    const Program program(folder, {"bench", "run", "campaign.yaml", "--out", "out"});
    REQUIRE(program.has_said("running into out"));
    program.send(signal);
    const Result result = program.wait();
    CHECK(result.code == code);
    CHECK(result.out == "0 of 200 runs are in out; --resume goes on with the others\n");
}

TEST_CASE("Errors of a campaign file are reported with their place") {
    const ScratchFolder folder;
    write_campaign(folder, "seads: 3");
    const Result result = run(folder, {"bench", "run", "campaign.yaml", "--out", "out"});
    CHECK(result.code == 2);
    CHECK(result.err == "campaign.yaml:5:1: unknown key 'seads' at the top: did you mean 'seeds'?\n");
    CHECK(files_in(folder.path() / "run").size() == 1);
    CHECK(run(folder, {"bench", "report", "out"}).code == 2);
    CHECK(run(folder, {"bench"}).code == 2);
}

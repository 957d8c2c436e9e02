#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>
#include <thread>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;

namespace {

const std::string default_place = "downwash-out/open_air-mp-arm-ada-1";

/// The problem with another margin.
std::string edited(const std::string& margin_m) {
    return problem_text("open_air") + "planner: {safety_margin_m: " + margin_m + "}\n";
}

/// A workspace with a problem in `one.yaml`, and a run of it in the default folder.
class PlannedWorkspace : public Workspace {
 public:
    PlannedWorkspace() {
        write_file(in_run("one.yaml"), edited("0.05"));
        succeed("solve one.yaml", quick);
    }

    /// Entries of the folder with the results that are hidden.
    [[nodiscard]] std::size_t hidden() const {
        std::size_t count = 0;
        for (const auto& entry : std::filesystem::directory_iterator(in_run("downwash-out"))) {
            count += entry.path().filename().string()[0] == '.' ? 1 : 0;
        }
        return count;
    }

    const Words quick = words("--max-iterations 100 --quiet");
};

}  // namespace

TEST_CASE("A problem edited in place replaces its run, and an edited copy with the same name does not") {
    const PlannedWorkspace work;
    const std::string first = work.text(default_place + "/effective.yaml");
    write_file(work.in_run("one.yaml"), edited("0.06"));
    work.succeed("solve", work.in_run("one.yaml"), work.quick);  // the same file by another path
    CHECK(work.text(default_place + "/effective.yaml") != first);

    write_file(work.in_run("same.yaml"), edited("0.06"));
    work.succeed("solve same.yaml", work.quick);  // the same problem from another file
    work.succeed("solve one.yaml", work.quick);

    write_file(work.in_run("copy.yaml"), edited("0.07"));
    const auto before = work.files("downwash-out");
    for (const Words& place : {Words{}, words("--out", default_place + "/")}) {
        const Result refused = work.run("solve copy.yaml --max-iterations 100", place);
        check_rejected(refused, "holds a run of another problem");
        CHECK_THAT(refused.err, Contains(default_place) && Contains("one.yaml (name: open_air), not of copy.yaml") &&
                                    Contains("--out DIR") && Contains("--force") && !Contains("planning"));
    }
    CHECK(work.files("downwash-out") == before);
    CHECK(work.hidden() == 0);
    work.succeed("solve copy.yaml --force", work.quick);
    CHECK(work.json("solve copy.yaml", work.quick).at("problem").at("file") == "copy.yaml");
}

TEST_CASE("An executed plan does not replace the run of another problem either") {
    const PlannedWorkspace work;
    write_file(work.in_run("copy.yaml"), edited("0.04"));
    const Words place = words("--plan", default_place, "--out flown --quiet");
    work.succeed("execute one.yaml", place);
    work.succeed("execute one.yaml --aero off", place);
    check_rejected(work.run("execute copy.yaml", place), "flown holds a run of another problem");
    work.succeed("execute copy.yaml --force", place);
    check_rejected(work.run("execute copy.yaml --force --plan", default_place, "--out", default_place),
                   "holds the plan itself");
}

TEST_CASE("Files that are not of a run are not replaced unasked") {
    const PlannedWorkspace work;
    std::filesystem::create_directory(work.in_run("x"));
    const auto refused_by = [&work](const std::string& reason) {
        const Result refused = work.run("solve one.yaml --out x", work.quick);
        check_rejected(refused, reason);
        CHECK_THAT(refused.err, Contains("--force"));
    };
    write_file(work.in_run("x/trajectory.csv"), "mine");
    refused_by("x/trajectory.csv would be replaced");
    write_file(work.in_run("x/solution.json"), R"({"of": "another program"})");
    refused_by("x/solution.json: its schema is not downwash/solution/v1");
    CHECK(work.files("x").size() == 2);
    work.succeed("solve one.yaml --out x --force", work.quick);
    CHECK(work.files("x").size() == files_of_a_run);
}

TEST_CASE("Files of others stay in the folder of a run, which says that they are not of this run") {
    const PlannedWorkspace work;
    write_file(work.in_run(default_place + "/notes.txt"), "mine");
    work.succeed("export", default_place, "--format vtp");
    const Result again = work.succeed("solve one.yaml", work.quick);
    CHECK_THAT(again.out, Contains("kept              flight.vtp, notes.txt: of before, not of this run\n"));
    CHECK(work.text(default_place + "/notes.txt") == "mine");
    CHECK(work.files("downwash-out").size() == files_of_a_run + 2);
}

TEST_CASE("A second run into a folder is refused while the first one is planning, and what a kill leaves is removed") {
    const PlannedWorkspace work;
    const auto before = work.files("downwash-out");
    const Program planning(work, words("solve one.yaml --time-limit 600"));
    REQUIRE(planning.has_said("best planned cost"));
    CHECK(work.hidden() == 1);
    const Result refused = work.run("solve one.yaml", work.quick);
    check_rejected(refused, default_place + " cannot be written: process ");
    CHECK_THAT(refused.err, Contains("is about to write its results there; choose another folder with --out"));
    work.succeed("solve one.yaml --out elsewhere", work.quick);

    planning.send(SIGKILL);
    CHECK(planning.wait().code == 128 + SIGKILL);
    CHECK(work.files("downwash-out") == before);
    work.succeed("solve one.yaml", work.quick);
    CHECK(work.hidden() == 0);
}

TEST_CASE("After a kill at any time the folder holds a whole run") {
    const PlannedWorkspace work;
    std::mt19937 random(1);
    const auto begin = std::chrono::steady_clock::now();
    work.succeed("solve one.yaml", work.quick);
    const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begin;
    for (int i = 0; i < 6; ++i) {
        write_file(work.in_run("one.yaml"), edited("0.0" + std::to_string(i + 1)));
        const Program solving(work, words("solve one.yaml", work.quick));
        std::this_thread::sleep_for(whole * std::uniform_real_distribution(0.3, 1.0)(random));
        solving.send(SIGKILL);
        static_cast<void>(solving.wait());
        work.succeed("export", default_place, "--format vtp -o flight.vtp");
    }
}

TEST_CASE("Whoever reads the folder of a run refuses files of two runs, and a plan can be executed alone") {
    const PlannedWorkspace work;
    work.succeed("solve one.yaml --seed 2 --out other", work.quick);
    for (const char* name : {"trajectory.csv", "tree.csv", "effective.yaml"}) {
        const std::string own = work.text(default_place + "/" + name);
        write_file(work.in_run(default_place + "/" + name), work.text(std::string("other/") + name));
        for (const char* reader : {"report --svg", "export --format vtp", "execute one.yaml --out flown --plan",
                                   "validate one.yaml --out judged --plan"}) {
            CAPTURE(name, reader);
            const Result refused = work.run(reader, default_place);
            check_rejected(refused, "solution.json beside it wrote");
            CHECK_THAT(refused.err, Contains(name) && Contains("`downwash execute PROBLEM --plan " + default_place +
                                                               "/solution.json`"));
        }
        work.succeed("execute one.yaml --out flown --quiet --plan", default_place + "/solution.json");
        write_file(work.in_run(default_place + "/" + name), own);
    }
    if (has_pages) {
        work.succeed("report", default_place);
    }
}

TEST_CASE("What is made from a run is not written beside another one") {
    const Workspace work;
    const std::string text = problem_text("open_air");
    write_file(work.in_run("one.yaml"), text);
    write_file(work.in_run("uncertain.yaml"), replaced(text, "uncertainty: none", "uncertainty: {}"));
    work.succeed("solve one.yaml --max-iterations 100 --out x");
    const Program judge(work, words("validate uncertain.yaml --plan x --runs 30 --out x"));
    REQUIRE(judge.has_said("flying the plan in 30 worlds"));
    write_file(work.in_run("x/solution.json"), work.text("x/solution.json") + "\n");  // another run
    check_rejected(judge.wait(), "x/solution.json was replaced meanwhile");
    CHECK(work.files("x").size() == files_of_a_run);
}

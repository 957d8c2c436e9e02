#include <catch2/catch.hpp>
#include <csignal>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

namespace {

/// A search that goes on for ten minutes, running as far as it says `text`.
struct LongSearch : Workspace {
    explicit LongSearch(const std::string& text) { REQUIRE(program.has_said(text)); }

    Program program{*this, words("solve", problem_file("open_air"), "--time-limit 600 --out x")};
};

}  // namespace

TEST_CASE("A signal in the middle of a search writes the best plan so far") {
    const auto [signal, code] = GENERATE(std::pair(SIGINT, 130), std::pair(SIGTERM, 143));
    const LongSearch work("best cost");
    work.program.send(signal);
    const Result result = work.program.wait();
    CHECK(result.code == code);
    CHECK_THAT(result.out, Catch::StartsWith("Interrupted. Solved. "));

    const auto files = work.files("x");
    REQUIRE(files.size() == files_of_a_run);
    const auto solution = nlohmann::json::parse(files.at("solution.json"));
    CHECK(solution.at("interrupted") == true);
    CHECK(solution.at("status") == "solved");
    CHECK(solution.at("execution").at("outcome") == "ok");
    CHECK(files.at("trajectory.csv").ends_with("\n"));
}

TEST_CASE("A signal at the very beginning leaves valid files too") {
    const LongSearch work("planning");
    work.program.send(SIGINT);
    CHECK(work.program.wait().code == 130);
    const auto files = work.files("x");
    REQUIRE(files.size() == files_of_a_run);
    CHECK(nlohmann::json::parse(files.at("solution.json")).at("interrupted") == true);
}

TEST_CASE("Two signals end the program at once and leave no half file") {
    const LongSearch work("planning");
    work.program.send(SIGINT);
    work.program.send(SIGTERM);
    const Result result = work.program.wait();
    CHECK((result.code == 130 || result.code == 143));
    for (const auto& [name, text] : work.files()) {
        CHECK_FALSE(name.ends_with("solution.json"));
    }
}

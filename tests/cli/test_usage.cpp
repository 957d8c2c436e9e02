#include <catch2/catch.hpp>
#include <filesystem>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;
using Catch::StartsWith;

TEST_CASE("Help and version go to standard output and end well") {
    const Workspace work;
    CHECK(work.run("--version").out == "downwash " DOWNWASH_EXPECTED_VERSION "\n");
    for (const char* command : {"", "solve", "execute", "check", "aeromap query", "planners"}) {
        const Result result = work.run(command, "--help");
        CHECK(result.code == 0);
        CHECK_THAT(result.out, Contains("Usage"));
        CHECK(result.err.empty());
    }
}

TEST_CASE("Bad usage ends with 2 and says why on standard error alone") {
    const Workspace work;
    write_file(work / "plan.json", "{}");
    const std::string open_air = problem_file("open_air");
    std::vector<Words> usages{{""},
                              words("solve", open_air, "--objective", std::string()),
                              words("solve", open_air, "--out", std::string()),
                              words("solve", open_air, "--out", open_air),
                              words("solve", open_air, "--out", open_air + "/below"),
                              words("solve", open_air, open_air),
                              words("execute", open_air, "--plan", open_air)};
    for (const char* usage :
         {"", "fly", "--bogus", "check", "check missing.yaml", "check .", "solve", "solve missing.yaml", "solve .",
          "aeromap", "aeromap foo", "aeromap query", "aeromap query --model table --z-over-r 1",
          "aeromap query --model magic --z-over-r 1", "aeromap query --model cheeseman-bennett",
          "aeromap query --model cheeseman-bennett --z-over-r -1",
          "aeromap query --model cheeseman-bennett --z-over-r inf",
          "aeromap query --model cheeseman-bennett --z-over-r 1 --max-factor 0.5", "planners rrt-star"}) {
        usages.push_back(words(usage));
    }
    for (const auto& [command, options] : {std::pair{"check", "--bogus"},
                                           {"solve", "--seed"},
                                           {"solve", "--seed -1"},
                                           {"solve", "--seed 1.5"},
                                           {"solve", "--seed 0x10"},
                                           {"solve", "--seed 99999999999999999999999999"},
                                           {"solve", "--time-limit nan"},
                                           {"solve", "--time-limit -inf"},
                                           {"solve", "--time-limit 0"},
                                           {"solve", "--time-limit soon"},
                                           {"solve", "--max-iterations 0"},
                                           {"solve", "--max-iterations -5"},
                                           {"solve", "--max-iterations 1e3"},
                                           {"solve", "--margin -0.1"},
                                           {"solve", "--margin 1e400"},
                                           {"solve", "--margin 99"},
                                           {"solve", "--variant mp-arm-adda"},
                                           {"solve", "--algorithm magic"},
                                           {"solve", "--algorithm bit-star"},
                                           {"solve", "--algorithm rrt --variant mp-arm"},
                                           {"solve", "--threads 0"},
                                           {"solve", "--threads many"},
                                           {"solve", "--threads 99999999999999999999"},
                                           {"execute", ""},
                                           {"execute", "--plan missing.json"},
                                           {"execute", "--plan ."},
                                           {"execute", "--plan ../plan.json"},
                                           {"execute", "--plan ../plan.json --aero maybe"},
                                           {"aeromap query", ""},
                                           {"aeromap query", "--at 1 2"},
                                           {"aeromap query", "--at 1 2 nan"},
                                           {"aeromap query", "--z-over-r 1"},
                                           {"aeromap query", "--model none --z-over-r 1"}}) {
        usages.push_back(words(command, open_air, options));
    }
    for (const Words& arguments : usages) {
        CAPTURE(arguments);
        const Result result = work.run(arguments);
        CHECK(result.code == 2);
        CHECK(result.out.empty());
        CHECK_FALSE(result.err.empty());
    }
    CHECK(std::filesystem::is_empty(work.in_run()));
}

TEST_CASE("An error in an option names the option and a remedy") {
    const Workspace work;
    CHECK_THAT(
        work.run("solve", problem_file("open_air"), "--variant mp-arm-adda --seed -1").err,
        Contains("--variant is 'mp-arm-adda'") && Contains("did you mean 'mp-arm-ada'") && Contains("--seed is '-1'"));
}

TEST_CASE("Check tells of every error with file and line and column") {
    const Workspace work;
    const std::string bad = work / "bad.yaml";
    write_file(bad, "schema: downwash/problem/v1\nname: b a d\nrobot: nowhere.yaml\ngaol: {}\n");
    const std::string good = problem_file("open_air");

    const Result people = work.run("check", good, bad);
    CHECK(people.code == 2);
    CHECK(people.out == good + ": ok\n");
    CHECK_THAT(people.err, Contains(bad + ":2:7: ") && Contains(bad + ":4:1: "));

    const Result programs = work.run("check", good, bad, "--json");
    CHECK(programs.code == 2);
    const auto errors = programs.json().at("faults");
    REQUIRE(errors.size() >= 2);
    for (const auto& error : errors) {
        CHECK(error.at("file") == bad);
        CHECK(error.at("line").get<int>() >= 1);
        CHECK(error.at("column").get<int>() >= 1);
        CHECK_FALSE(error.at("message").get<std::string>().empty());
    }
    CHECK(work.run("check", good, "--json").json() == nlohmann::json{{"faults", nlohmann::json::array()}});
}

TEST_CASE("An unknown command is named, at any depth") {
    const Workspace work;
    CHECK_THAT(work.run("slove").err,
               StartsWith("downwash: there is no command 'slove': expected") && Contains("did you mean 'solve'?"));
    CHECK_THAT(work.run("aeromap foo").err,
               StartsWith("downwash: there is no command 'aeromap foo': expected query, build"));
    CHECK_THAT(work.run("aeromap biuld").err, Contains("did you mean 'build'?"));
}

#include <catch2/catch.hpp>
#include <filesystem>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

TEST_CASE("Help and version go to standard output and end well") {
    const ScratchFolder folder;
    CHECK(run(folder, {"--version"}).out == "downwash " DOWNWASH_EXPECTED_VERSION "\n");
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                      {"solve", "--help"},
                                                      {"execute", "--help"},
                                                      {"check", "--help"},
                                                      {"aeromap", "query", "--help"},
                                                      {"planners", "--help"}}) {
        const Result result = run(folder, arguments);
        CHECK(result.code == 0);
        CHECK(result.out.find("Usage") != std::string::npos);
        CHECK(result.err.empty());
    }
}

TEST_CASE("Bad usage ends with 2 and says why on standard error alone") {
    const ScratchFolder folder;
    const std::string open_air = problem_file("open_air");
    write_file(folder / "plan.json", "{}");
    const std::vector<std::vector<std::string>> usages{
        {},
        {""},
        {"fly"},
        {"--bogus"},
        {"check"},
        {"check", "missing.yaml"},
        {"check", "."},
        {"check", open_air, "--bogus"},
        {"aeromap", "query", "--model", "table", "--z-over-r", "1"},
        {"solve"},
        {"solve", "missing.yaml"},
        {"solve", "."},
        {"solve", open_air, open_air},
        {"solve", open_air, "--seed"},
        {"solve", open_air, "--seed", "-1"},
        {"solve", open_air, "--seed", "1.5"},
        {"solve", open_air, "--seed", "0x10"},
        {"solve", open_air, "--seed", "99999999999999999999999999"},
        {"solve", open_air, "--time-limit", "nan"},
        {"solve", open_air, "--time-limit", "-inf"},
        {"solve", open_air, "--time-limit", "0"},
        {"solve", open_air, "--time-limit", "soon"},
        {"solve", open_air, "--max-iterations", "0"},
        {"solve", open_air, "--max-iterations", "-5"},
        {"solve", open_air, "--max-iterations", "1e3"},
        {"solve", open_air, "--margin", "-0.1"},
        {"solve", open_air, "--margin", "1e400"},
        {"solve", open_air, "--margin", "99"},
        {"solve", open_air, "--variant", "mp-arm-adda"},
        {"solve", open_air, "--algorithm", "magic"},
        {"solve", open_air, "--algorithm", "bit-star"},
        {"solve", open_air, "--algorithm", "rrt", "--variant", "mp-arm"},
        {"solve", open_air, "--objective", ""},
        {"solve", open_air, "--threads", "0"},
        {"solve", open_air, "--threads", "many"},
        {"solve", open_air, "--threads", "99999999999999999999"},
        {"solve", open_air, "--out", ""},
        {"solve", open_air, "--out", open_air},
        {"solve", open_air, "--out", open_air + "/below"},
        {"execute", open_air},
        {"execute", open_air, "--plan", "missing.json"},
        {"execute", open_air, "--plan", "."},
        {"execute", open_air, "--plan", open_air},
        {"execute", open_air, "--plan", folder / "plan.json"},
        {"execute", open_air, "--plan", folder / "plan.json", "--aero", "maybe"},
        {"aeromap"},
        {"aeromap", "foo"},
        {"aeromap", "query"},
        {"aeromap", "query", open_air},
        {"aeromap", "query", open_air, "--at", "1", "2"},
        {"aeromap", "query", open_air, "--at", "1", "2", "nan"},
        {"aeromap", "query", open_air, "--z-over-r", "1"},
        {"aeromap", "query", open_air, "--model", "none", "--z-over-r", "1"},
        {"aeromap", "query", "--model", "magic", "--z-over-r", "1"},
        {"aeromap", "query", "--model", "cheeseman-bennett"},
        {"aeromap", "query", "--model", "cheeseman-bennett", "--z-over-r", "-1"},
        {"aeromap", "query", "--model", "cheeseman-bennett", "--z-over-r", "inf"},
        {"aeromap", "query", "--model", "cheeseman-bennett", "--z-over-r", "1", "--max-factor", "0.5"},
        {"planners", "rrt-star"},
    };
    for (const auto& arguments : usages) {
        std::string line;
        for (const std::string& argument : arguments) {
            line += " '" + argument + "'";
        }
        CAPTURE(line);
        const Result result = run(folder, arguments);
        CHECK(result.code == 2);
        CHECK(result.out.empty());
        CHECK_FALSE(result.err.empty());
    }
    CHECK(std::filesystem::is_empty(folder.path() / "run"));
}

TEST_CASE("A error in an option names the option and a remedy") {
    const ScratchFolder folder;
    const Result result = run(folder, {"solve", problem_file("open_air"), "--variant", "mp-arm-adda", "--seed", "-1"});
    CHECK(result.err.find("--variant is 'mp-arm-adda'") != std::string::npos);
    CHECK(result.err.find("did you mean 'mp-arm-ada'") != std::string::npos);
    CHECK(result.err.find("--seed is '-1'") != std::string::npos);
}

TEST_CASE("Check tells of every error with file and line and column") {
    const ScratchFolder folder;
    const std::string bad = folder / "bad.yaml";
    write_file(bad, "schema: downwash/problem/v1\nname: b a d\nrobot: nowhere.yaml\ngaol: {}\n");
    const std::string good = problem_file("open_air");

    const Result people = run(folder, {"check", good, bad});
    CHECK(people.code == 2);
    CHECK(people.out == good + ": ok\n");
    CHECK(people.err.find(bad + ":2:7: ") != std::string::npos);
    CHECK(people.err.find(bad + ":4:1: ") != std::string::npos);

    const Result programs = run(folder, {"check", good, bad, "--json"});
    CHECK(programs.code == 2);
    const auto errors = programs.json().at("faults");
    REQUIRE(errors.size() >= 2);
    for (const auto& error : errors) {
        CHECK(error.at("file") == bad);
        CHECK(error.at("line").get<int>() >= 1);
        CHECK(error.at("column").get<int>() >= 1);
        CHECK_FALSE(error.at("message").get<std::string>().empty());
    }
    CHECK(run(folder, {"check", good, "--json"}).json() == nlohmann::json{{"faults", nlohmann::json::array()}});
}

TEST_CASE("An unknown command is named, at any depth") {
    const ScratchFolder folder;
    CHECK_THAT(run(folder, {"slove"}).err, Catch::StartsWith("downwash: there is no command 'slove': expected") &&
                                               Catch::Contains("did you mean 'solve'?"));
    CHECK_THAT(run(folder, {"aeromap", "foo"}).err,
               Catch::StartsWith("downwash: there is no command 'aeromap foo': expected query, build"));
    CHECK_THAT(run(folder, {"aeromap", "biuld"}).err, Catch::Contains("did you mean 'build'?"));
}

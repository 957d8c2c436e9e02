#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;
using Catch::StartsWith;

TEST_CASE("Help and version go to standard output, and an unknown command is named, at any depth") {
    const Workspace work;
    CHECK(work.run("--version").out == "downwash " DOWNWASH_EXPECTED_VERSION "\n");
    for (const char* command : {"", "solve", "execute", "check", "aeromap query", "planners"}) {
        const Result result = work.succeed(command, "--help");
        CHECK_THAT(result.out, Contains("Usage"));
        CHECK(result.err.empty());
    }
    CHECK_THAT(work.run("slove").err,
               StartsWith("downwash: there is no command 'slove': expected") && Contains("did you mean 'solve'?"));
    CHECK_THAT(work.run("aeromap foo").err,
               StartsWith("downwash: there is no command 'aeromap foo': expected query, build"));
    CHECK_THAT(work.run("aeromap biuld").err, Contains("did you mean 'build'?"));
}

TEST_CASE("A reader that has seen enough is no error") {
    const Workspace work;
    const std::string program = DOWNWASH_PROGRAM;
    for (const std::string command : {"manual --markdown", "planners --json", "--help"}) {
        CAPTURE(command);
        // The reader is gone before the first byte comes.
        const std::string line = "{ sleep 0.2; '" + program + "' " + command + " 2>'" + (work / "err").string() +
                                 "'; echo $? >'" + (work / "code").string() + "'; } | true";
        REQUIRE(std::system(line.c_str()) == 0);
        CHECK(read_file(work / "code") == "0\n");
        CHECK(read_file(work / "err").empty());
    }
}

TEST_CASE("A command whose program is not there says how to build it, after its own check of the command line") {
    const Workspace work;
    std::filesystem::copy_file(DOWNWASH_PROGRAM, work / "downwash");
    const auto run_alone = [&](const std::string& command) {
        const std::string line = "'" + (work / "downwash").string() + "' " + command + " >'" + (work / "out").string() +
                                 "' 2>'" + (work / "err").string() + "'; echo $? >'" + (work / "code").string() + "'";
        REQUIRE(std::system(line.c_str()) == 0);
        CHECK(read_file(work / "code") == "2\n");
        return read_file(work / "err");
    };
    CHECK_THAT(run_alone("bench report somewhere"),
               StartsWith("downwash: this command is in the program downwash-bench, which is not in") &&
                   Contains("libsqlite3-dev"));
    CHECK_THAT(run_alone("aeromap fit data.csv --model table"), Contains("downwash-aeromap"));
    CHECK_THAT(run_alone("validate"), Contains("PROBLEM is required"));
    CHECK_THAT(run_alone("study no-such-study"), Contains("there is no command 'study no-such-study'"));
}

TEST_CASE("The program alone, and a group of commands alone, list their commands") {
    const Workspace work;
    check_rejected(work.run(""), "downwash: a command is missing, expected one of");
    CHECK_THAT(work.run("").err,
               Contains("  solve       Plan") && Contains("  completion  ") && Contains("See downwash --help."));
    CHECK_THAT(work.run("aeromap").err, Contains("downwash aeromap: a command is missing") && Contains("  query "));
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
    const auto with_problem = [&](const char* command, std::initializer_list<const char*> all_options) {
        for (const char* options : all_options) {
            usages.push_back(words(command, open_air, options));
        }
    };
    with_problem("check", {"--bogus"});
    with_problem("solve", {"--seed",
                           "--seed -1",
                           "--seed 1.5",
                           "--seed 0x10",
                           "--seed 99999999999999999999999999",
                           "--time-limit nan",
                           "--time-limit -inf",
                           "--time-limit 0",
                           "--time-limit soon",
                           "--max-iterations 0",
                           "--max-iterations -5",
                           "--max-iterations 1e3",
                           "--margin -0.1",
                           "--margin 1e400",
                           "--margin 99",
                           "--check-execution maybe",
                           "--certify 1",
                           "--certify",
                           "--variant mp-arm-adda",
                           "--algorithm magic",
                           "--algorithm bit-star",
                           "--algorithm rrt --variant mp-arm",
                           "--threads 0",
                           "--threads many",
                           "--threads 99999999999999999999"});
    with_problem("execute",
                 {"", "--plan missing.json", "--plan .", "--plan ../plan.json", "--plan ../plan.json --aero maybe"});
    with_problem("aeromap query", {"", "--at 1 2", "--at 1 2 nan", "--z-over-r 1", "--model none --z-over-r 1"});
    for (const Words& arguments : usages) {
        CAPTURE(arguments);
        check_rejected(work.run(arguments), "\n");
    }
    CHECK(std::filesystem::is_empty(work.in_run()));
    // An error in an option names the option and a remedy.
    CHECK_THAT(
        work.run("solve", open_air, "--variant mp-arm-adda --seed -1").err,
        Contains("--variant is 'mp-arm-adda'") && Contains("did you mean 'mp-arm-ada'") && Contains("--seed is '-1'"));
}

TEST_CASE("Check tells of every error with file and line and column") {
    const Workspace work;
    const std::string bad = work / "bad.yaml";
    write_file(bad, "schema: downwash/problem/v1\nname: b a d\nrobot: nowhere.yaml\ngaol: {}\n");
    const std::string good = problem_file("open_air");

    const Result people = work.run("check", good, bad);
    CHECK(people.code == 2);
    CHECK_THAT(people.out, StartsWith(good + ": ok\n  ") && !Contains(bad));
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
    const std::string other = work / "other.yaml";  // with the same robot
    write_file(work / "robot.yaml", "schema: downwash/robot/v1\nname: r\n");
    for (const std::string& file : {bad, other}) {
        write_file(file, "schema: downwash/problem/v1\nname: p\nrobot: robot.yaml\n");
    }
    const std::string once = work.run("check", bad, other).err;
    const std::string fault = "robot.yaml:1:1: ";
    REQUIRE(once.find(fault) != std::string::npos);
    std::set<std::string> lines;
    std::istringstream text(once);
    for (std::string line; std::getline(text, line);) {
        CHECK(lines.insert(line).second);
    }
    const auto found = work.json("check", good);
    CHECK(found.size() == 5);
    for (const char* list : {"faults", "warnings", "geometry", "data"}) {
        CHECK(found.at(list) == nlohmann::json::array());
    }
    CHECK(found.at("robots").size() == 1);
}

TEST_CASE("A manual page shows words to choose from without the name of their check") {
    const Workspace work;
    CHECK_THAT(work.succeed("manual explain").out,
               Catch::Contains("problem|robot|campaign|space") && !Catch::Contains("{problem"));
}

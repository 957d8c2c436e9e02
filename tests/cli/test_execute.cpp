#include <catch2/catch.hpp>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;

TEST_CASE("A plan flown again flies as before") {
    const std::string problem = problem_file("bridge_inspection");
    static const Workspace first;  // solved once for all sections
    static const nlohmann::json solved = first.json("solve", problem, "--max-iterations 200");
    const Workspace work;
    std::filesystem::copy(first.in_run(), work.in_run(), std::filesystem::copy_options::recursive);
    const std::string home = "downwash-out/bridge_inspection-mp-arm-ada-1";
    const std::string plan = home + "/solution.json";
    const auto before = work.files(home);

    SECTION("with the same trajectory and the same file") {
        auto expected = solved;
        auto found = work.json("execute", home + "/effective.yaml", "--plan", plan, "--out again");
        for (auto* solution : {&expected, &found}) {
            solution->at("planning").erase("flight_wall_s");
            solution->at("problem").erase("file");
            solution->at("files").erase("tree.csv");  // a flight has no tree
        }
        CHECK(found == expected);
        CHECK(work.text("again/trajectory.csv") == before.at("trajectory.csv"));
        CHECK(work.files("again").size() == files_of_a_run);
    }
    SECTION("and in free air without surface effects") {
        const Result flown = work.run("execute", problem, "--plan", plan, "--aero off --out off --json");
        CHECK_FALSE(flown.json().at("execution").at("aero").get<bool>());
        CHECK(flown.json().at("execution").at("energy_j") > solved.at("execution").at("energy_j"));
    }
    SECTION("and never replaces the file that the plan came from") {
        check_rejected(work.run("execute", problem, "--plan", plan, "--out", home), "holds the plan itself");
        work.succeed("execute", problem, "--plan", plan);
        CHECK(work.files(home) == before);
        CHECK(work.files(home + "-executed").size() == files_of_a_run);
    }
    SECTION("and otherwise in another world, the same each time, if the problem says what is uncertain") {
        check_rejected(work.run("execute", problem, "--plan", plan, "--world 3"), "has no `uncertainty:`");
        std::string text = work.text(home + "/effective.yaml");
        const std::string none = "uncertainty: none";
        text.replace(text.find(none), none.size(), "uncertainty: {}");
        write_file(work.in_run(home + "/uncertain.yaml"), text);
        const auto in_world = [&](const char* world, const std::string& out) {
            const int code = work.run("execute", home + "/uncertain.yaml", "--plan", plan, world, "--out", out).code;
            CHECK((code == 0 || code == 3));  // in some worlds it fails
            return work.text(out + "/trajectory.csv");
        };
        const std::string third = in_world("--world 3", "third");
        CHECK(in_world("--world 3", "again") == third);
        const auto flown = nlohmann::json::parse(work.text("third/solution.json"));
        CHECK(flown.at("execution").at("world") == nlohmann::json{{"index", 3}, {"seed", 1}});
        CHECK(in_world("--world 0", "nominal") != third);
        CHECK(in_world("--world 3 --seed 9", "other") != third);
    }
    SECTION("and replaces no run of a search by default") {
        const std::string again = home + "-executed";
        work.succeed("execute", problem, "--plan", home);
        work.succeed("execute", problem, "--plan", again);
        CHECK(work.files(home) == before);
        CHECK(work.files(again + "-executed").size() == files_of_a_run);
    }
    SECTION("and takes no certificate along into another problem, whatever planner settings are") {
        auto certified = solved;
        certified.at("certificate") = {{"given", true},
                                       {"worlds", 500},
                                       {"failures", 0},
                                       {"failure_probability", {{"estimate", 0}, {"low", 0}, {"high", 0.01}}},
                                       {"max_failure_probability", 0.01},
                                       {"confidence", 0.95},
                                       {"attempts", 1},
                                       {"clearance_m", {{"p01", 0.1}, {"p10", 0.1}, {"p50", 0.1}}},
                                       {"causes", nlohmann::json::object()},
                                       {"worst", nlohmann::json::array()}};
        write_file(work.in_run(plan), certified.dump(2));
        const auto executed = [&](const std::string& in, const std::string& from, const std::string& out) {
            const Result flown = work.run("execute", in, "--plan", from, "--json --out", out);
            INFO(flown.err);
            REQUIRE(!flown.out.empty());
            CHECK((flown.err.find("another problem") != std::string::npos) == flown.json().at("certificate").is_null());
            return flown.json();
        };
        const auto same = executed(problem, plan, "same");
        CHECK(same.at("certificate").at("given") == true);
        CHECK(same.at("status") == "solved");

        std::string text = work.text(home + "/effective.yaml");
        const std::string deck = "center_m: [0, 0, 10.5]";
        REQUIRE(text.find(deck) != std::string::npos);
        text.replace(text.find(deck), deck.size(), "center_m: [0, 0, 10.45]");
        write_file(work.in_run("lower.yaml"), text);
        const auto lower = executed("lower.yaml", plan, "lower");
        CHECK(lower.at("certificate").is_null());
        CHECK((lower.at("status") == "solved") == (lower.at("execution").at("outcome") == "ok"));
        CHECK(lower.at("warnings").size() > same.at("warnings").size());

        write_file(work.in_run("loose.json"), certified.dump(2));
        CHECK(executed(problem, "loose.json", "loose").at("certificate").is_null());  // nobody knows

        auto without_problem = certified;
        without_problem.erase("problem");
        write_file(work.in_run("by_hand.json"), without_problem.dump(2));
        CHECK(executed(problem, "by_hand.json", "by_hand").at("certificate").is_null());
    }
    SECTION("but not in a problem that starts elsewhere") {
        const Result rejected = work.run("execute", problem_file("open_air"), "--plan", plan);
        check_rejected(rejected, plan + ":");
        CHECK_THAT(rejected.err, Contains("plan.reference[0]: the plan begins at"));
    }
    SECTION("nor when waypoints and reference disagree") {
        auto edited = solved;
        edited.at("plan").at("waypoints").at(1).at("x_m") = 1.25;
        write_file(work / "edited.json", edited.dump(2));
        check_rejected(work.run("execute", problem, "--plan", work / "edited.json"), "plan.waypoints[1]");
    }
}

TEST_CASE("A plan whose flight fails ends with 3") {
    const Workspace work;
    write_file(work / "plan.json", plan_through_walkway);
    const Result flown =
        work.run("execute", problem_file("bridge_inspection"), "--plan", work / "plan.json", "--aero off");
    CHECK(flown.code == 3);
    CHECK_THAT(flown.out, Catch::StartsWith("The flight in free air ends in a collision."));
    CHECK(work.files().size() == files_of_a_run);
}

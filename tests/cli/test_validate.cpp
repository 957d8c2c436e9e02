#include <catch2/catch.hpp>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;

TEST_CASE("A plan is validated by an independent flight") {
    const std::string problem = problem_file("bridge_inspection");
    static const Workspace first;  // solved once for all sections
    static const nlohmann::json solved = first.json("solve", problem, "--max-iterations 100 --out run");
    const Workspace work;
    std::filesystem::copy(first.in_run(), work.in_run(), std::filesystem::copy_options::recursive);

    SECTION("which says what the file says") {
        const auto found = work.json("validate", problem, "--plan run");
        CHECK(found.at("outcome") == "ok");
        CHECK(found.at("disagreements").empty());
        for (const char* figure : {"min_clearance_m", "energy_j", "duration_s", "goal_error_m"}) {
            CHECK(found.at(figure).get<double>() ==
                  Approx(solved.at("execution").at(figure).get<double>()).margin(1e-4).epsilon(1e-6));
        }
        CHECK_FALSE(found.contains("runs"));
        CHECK(work.json("validate", problem, "--plan run/solution.json") == found);
        const Result told = work.succeed("validate", problem, "--plan run");
        CHECK_THAT(told.out, Contains("Valid. The flight reaches the goal and hovers there, as the file says."));
        CHECK(work.files().size() == work.files("run").size());  // nothing is written
    }
    SECTION("and ends with 3 where they differ, with both numbers") {
        auto edited = solved;
        const auto first_of = [&] {
            write_file(work / "edited.json", edited.dump());
            const Result result = work.run("validate", problem, "--plan", work / "edited.json", "--json");
            CHECK(result.code == 3);
            return result.json().at("disagreements").at(0);
        };
        SECTION("in a waypoint") {
            edited.at("plan").at("waypoints").at(1).at("x_m") = 1.25;
            CHECK(first_of().at("what") == "plan.waypoints[1].x_m");
            CHECK(first_of().at("file") == 1.25);
            CHECK(first_of().at("judge") == solved.at("plan").at("reference").at(1).at("x_m"));
        }
        SECTION("in a knot") {
            auto& z_m = edited.at("plan").at("reference").at(1).at("z_m");
            z_m = z_m.get<double>() + 0.05;
            CHECK(first_of().at("what") == "plan.waypoints[1].z_m");
        }
        SECTION("in the cost") {
            edited.at("execution").at("cost") = 0.98 * solved.at("cost").get<double>();
            CHECK(first_of().at("what") == "execution.cost");
            write_file(work / "edited.json", edited.dump());
            CHECK_THAT(work.run("validate", problem, "--plan", work / "edited.json").out,
                       Contains("Not valid.") && Contains("execution.cost: the file says"));
        }
        SECTION("in the outcome") {
            edited.at("execution").at("outcome") = "collision";
            CHECK(first_of().at("judge") == "ok");
        }
        SECTION("in the start") {
            edited.at("plan").at("reference").at(0).at("arm_rad") = 1.25;
            edited.at("plan").at("waypoints").at(0).at("arm_rad") = 1.25;
            CHECK(first_of().at("what") == "plan.reference[0].arm_rad");
        }
    }
    SECTION("that may have been flown without surface effects") {
        CHECK(work.run("execute", problem, "--plan run/solution.json --aero off --out off").code == 0);
        CHECK(work.json("validate", problem, "--plan off").at("disagreements").empty());
    }
    SECTION("and in worlds, if the problem says what is uncertain") {
        check_rejected(work.run("validate", problem, "--plan run --runs 3"), "has no `uncertainty:`");
        check_rejected(work.run("validate", problem, "--plan run --seed 3"), "expected --runs or --world");
        write_file(work.in_run("run/uncertain.yaml"),
                   replaced(work.text("run/effective.yaml"), "uncertainty: none", "uncertainty: {}"));
        const Words uncertain = words("validate run/uncertain.yaml --plan run --quiet --json");
        check_rejected(work.run(uncertain, "--runs 3 --world 3"), "expected one of them");
        check_rejected(work.run(uncertain, "--runs 0"), "expected 1 to");
        check_rejected(work.run(uncertain, "--runs -3"), "is -3: expected a whole number from 0");
        const Result one = work.succeed(uncertain, "--runs 12 --threads 1");
        const Result two = work.succeed(uncertain, "--runs 12 --threads 2");
        CHECK(one.out == two.out);
        CHECK(one.err.empty());
        const auto found = one.json();
        CHECK(found.at("runs") == 12);
        CHECK(found.at("failures").get<int>() >= found.at("collisions").get<int>());
        CHECK(found.at("failure_probability").at("high") > found.at("failure_probability").at("estimate"));
        CHECK(found.at("clearance_m").at("p01") <= found.at("clearance_m").at("p50"));
        CHECK(found.at("worst").size() == 10);
        CHECK(found.at("sensitivity").at(0).at("parameter") == "aero.ceiling_scale");
        CHECK(found.at("sensitivity").at(0).at("failure_share_by_decile").size() == 10);
        const auto& worst = found.at("worst").at(0);
        const std::string index = std::to_string(worst.at("world").get<int>());
        const Result alone = work.run(uncertain, "--world", index);
        CHECK(alone.json().at("outcome") == worst.at("outcome"));
        CHECK(alone.json().at("min_clearance_m") == worst.at("min_clearance_m"));
        CHECK(alone.code == (worst.at("outcome") == "ok" ? 0 : 3));
        // The suggested command can be pasted, and flies one of the worlds that were flown.
        std::filesystem::copy(work.in_run("run"), work.in_run("a run"));
        const Result told = work.run("validate run/uncertain.yaml --plan", std::string("a run"), "--runs 2 --seed 9");
        CHECK_THAT(told.out, Contains("downwash validate run/uncertain.yaml --plan 'a run' --seed 9 --world "));
        // A certificate that promises more than the flights keep is contradicted.
        write_file(work.in_run("run/blind.yaml"), replaced(work.text("run/effective.yaml"), "uncertainty: none",
                                                           "uncertainty: {sensing: {position_bias_m: {sd: 1}}}"));
        auto promising = solved;
        promising["certificate"] = {{"given", true}, {"max_failure_probability", 1e-6}};
        promising["problem"]["sha256"] =
            work.run("execute run/blind.yaml --plan run --out blind --json").json().at("problem").at("sha256");
        write_file(work.in_run("promising.json"), promising.dump());
        const Words judged = words("validate run/blind.yaml --quiet --json --plan promising.json");
        const Result broken = work.run(judged, "--runs 12");
        CHECK(broken.code == 3);
        CHECK(broken.json().at("disagreements").back().at("what") == "certificate: failure probability at most");
        CHECK(work.run(judged, "--runs 12").out == broken.out);
        promising["problem"]["sha256"] = solved.at("problem").at("sha256");  // of another problem: it says nothing here
        write_file(work.in_run("promising.json"), promising.dump());
        CHECK(work.run(judged, "--runs 12").code == 0);
        promising["problem"]["sha256"] =
            work.run("execute run/blind.yaml --plan run --out blind --json --force").json().at("problem").at("sha256");
        promising["certificate"]["max_failure_probability"] = 0.99;
        write_file(work.in_run("promising.json"), promising.dump());
        CHECK(work.run(judged, "--runs 12").code == 0);
        // Worlds are those of the plan's seed.
        promising["seed"] = 9;
        write_file(work.in_run("promising.json"), promising.dump());
        CHECK(work.run(judged, "--runs 12").json().at("worst") ==
              work.run("validate run/blind.yaml --quiet --json --plan run --runs 12 --seed 9").json().at("worst"));
        // What `execute` flew in a world is judged in that world.
        const int code =
            work.run("execute run/uncertain.yaml --plan run/solution.json --out there --world", index).code;
        CHECK((code == 0 || code == 3));
        CHECK(work.run("validate run/uncertain.yaml --plan there --json").json().at("disagreements").empty());
        check_rejected(work.run("validate", problem, "--plan there"), "was flown in world");
    }
    SECTION("and in a world whose gusts blow as a moving vehicle starts") {
        std::string text = replaced(work.text("run/effective.yaml"), "uncertainty: none", "uncertainty: {}");
        text = replaced(replaced(text, "vx_m_s: 0", "vx_m_s: 0.3"), "linear_n_s_m: 0", "linear_n_s_m: 1");
        write_file(work.in_run("run/moving.yaml"), text);
        const Result flown = work.run("execute run/moving.yaml --plan run/solution.json --world 2 --out moving --json");
        const auto found = work.run("validate run/moving.yaml --plan moving --world 2 --json").json();
        CHECK(found.at("energy_j").get<double>() ==
              Approx(flown.json().at("execution").at("energy_j").get<double>()).epsilon(1e-6));
    }
    SECTION("and rejected where there is nothing to judge") {
        check_rejected(work.run("validate", problem, "--plan nowhere"), "nowhere");
        check_rejected(work.run("validate", problem, "--plan", problem), "not JSON");
    }
}

TEST_CASE("A plan whose flight fails is not valid, and its file need not say anything") {
    const Workspace work;
    write_file(work / "plan.json", plan_through_walkway);
    const Result judged =
        work.run("validate", problem_file("bridge_inspection"), "--plan", work / "plan.json", "--json");
    CHECK(judged.code == 3);
    CHECK(judged.json().at("outcome") == "left_flyable_area");
    // Without `execution` in the file, the plan alone is checked: it ends outside of the goal.
    REQUIRE(judged.json().at("disagreements").size() == 1);
    CHECK(judged.json().at("disagreements").at(0).at("judge") == 1);
}

#include <catch2/catch.hpp>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

TEST_CASE("A plan flown again flies as before") {
    const ScratchFolder folder;
    const std::string problem = problem_file("bridge_inspection");
    const Result solved = run(folder, {"solve", problem, "--max-iterations", "200", "--json"});
    REQUIRE(solved.code == 0);
    const std::string home = "downwash-out/bridge_inspection-mp-arm-ada-1";
    const std::string plan = home + "/solution.json";
    const auto before = files_in(folder.path() / "run" / home);

    SECTION("with the same trajectory and the same file") {
        const Result flown =
            run(folder, {"execute", home + "/effective.yaml", "--plan", plan, "--out", "again", "--json"});
        CHECK(flown.code == 0);
        auto expected = solved.json();
        auto found = flown.json();
        expected.at("planning").erase("flight_wall_s");
        found.at("planning").erase("flight_wall_s");
        expected.at("problem").erase("file");
        found.at("problem").erase("file");
        CHECK(found == expected);
        CHECK(read_file(folder.path() / "run/again/trajectory.csv") == before.at("trajectory.csv"));
        CHECK(files_in(folder.path() / "run/again").size() == files_of_a_run);
    }
    SECTION("and in free air without surface effects") {
        const Result flown =
            run(folder, {"execute", problem, "--plan", plan, "--aero", "off", "--out", "off", "--json"});
        CHECK_FALSE(flown.json().at("execution").at("aero").get<bool>());
        CHECK(flown.json().at("execution").at("energy_j") > solved.json().at("execution").at("energy_j"));
    }
    SECTION("and never replaces the file that the plan came from") {
        const Result refused = run(folder, {"execute", problem, "--plan", plan, "--out", home});
        CHECK(refused.code == 2);
        CHECK(refused.err.find("holds the plan itself") != std::string::npos);
        CHECK(run(folder, {"execute", problem, "--plan", plan}).code == 0);
        CHECK(files_in(folder.path() / "run" / home) == before);
        CHECK(files_in(folder.path() / "run" / (home + "-executed")).size() == files_of_a_run);
    }
    SECTION("but not in a problem that starts elsewhere") {
        const Result refused = run(folder, {"execute", problem_file("open_air"), "--plan", plan});
        CHECK(refused.code == 2);
        CHECK(refused.err.find(plan + ":") != std::string::npos);
        CHECK(refused.err.find("plan.reference[0]: the plan begins at") != std::string::npos);
    }
    SECTION("nor when waypoints and reference disagree") {
        auto edited = solved.json();
        edited.at("plan").at("waypoints").at(1).at("x_m") = 1.25;
        write_file(folder / "edited.json", edited.dump(2));
        const Result refused = run(folder, {"execute", problem, "--plan", folder / "edited.json"});
        CHECK(refused.code == 2);
        CHECK(refused.err.find("plan.waypoints[1]") != std::string::npos);
    }
}

TEST_CASE("A plan whose flight fails ends with 3") {
    const ScratchFolder folder;
    const std::string problem = problem_file("bridge_inspection");
    // Straight through the walkway.
    const std::string plan = R"({"schema": "downwash/solution/v1", "plan": {
        "waypoints": [{"x_m": -10, "z_m": 8.5, "arm_rad": 1.5707963267948966}, {"x_m": 2, "z_m": 7, "arm_rad": 0}],
        "reference": [
            {"t_s": 0, "x_m": -10, "z_m": 8.5, "arm_rad": 1.5707963267948966, "vx_m_s": 0, "vz_m_s": 0,
             "arm_rate_rad_s": 0, "ax_m_s2": 0, "az_m_s2": 0, "arm_acceleration_rad_s2": 0},
            {"t_s": 30, "x_m": 2, "z_m": 7, "arm_rad": 0, "vx_m_s": 0, "vz_m_s": 0,
             "arm_rate_rad_s": 0, "ax_m_s2": 0, "az_m_s2": 0, "arm_acceleration_rad_s2": 0}]}})";
    write_file(folder / "plan.json", plan);
    const Result flown = run(folder, {"execute", problem, "--plan", folder / "plan.json", "--aero", "off"});
    CHECK(flown.code == 3);
    CHECK(flown.out.starts_with("The flight in free air ends in a collision."));
    const auto files = files_in(folder.path() / "run");
    CHECK(files.size() == files_of_a_run);
}

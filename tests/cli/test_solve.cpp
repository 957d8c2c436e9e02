#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <sstream>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

namespace {

const std::string csv_header =
    "t_s,ref_x_m,ref_z_m,ref_arm_rad,x_m,z_m,pitch_rad,arm_rad,vx_m_s,vz_m_s,pitch_rate_rad_s,arm_rate_rad_s,"
    "thrust_cmd_n,pitch_torque_cmd_nm,arm_torque_nm,thrust_n,pitch_torque_nm,aero_factor_min,aero_factor_max,"
    "clearance_m,ee_x_m,ee_z_m,power_w,energy_j,rotor_1_cmd_n,rotor_1_aero_factor,rotor_2_cmd_n,rotor_2_aero_factor,"
    "rotor_3_cmd_n,rotor_3_aero_factor,rotor_4_cmd_n,rotor_4_aero_factor";

std::set<std::string> keys_of(const nlohmann::json& group) {
    std::set<std::string> keys;
    for (const auto& [key, value] : group.items()) {
        keys.insert(key);
    }
    return keys;
}

/// A solution without what may differ between two runs of the same problem.
nlohmann::json repeatable(nlohmann::json value) {
    if (value.is_object()) {
        for (auto it = value.begin(); it != value.end();) {
            if (it.key().ends_with("wall_s") || it.key() == "threads" || it.key() == "file") {
                it = value.erase(it);
            } else {
                *it = repeatable(*it);
                ++it;
            }
        }
    } else if (value.is_array()) {
        for (auto& element : value) {
            element = repeatable(element);
        }
    }
    return value;
}

std::string without_obstacles(std::string problem) {
    const std::size_t begin = problem.find("  obstacles:");
    return problem.erase(begin, problem.find("start:") - begin);
}

}  // namespace

TEST_CASE("Solve writes a solution and a trajectory and the effective problem into its own folder") {
    const ScratchFolder folder;
    const Result result = run(folder, {"solve", problem_file("open_air"), "--max-iterations", "300", "--seed", "5"});
    CHECK(result.code == 0);
    CHECK(result.out.starts_with("Solved. "));
    CHECK(result.err.find("planning") != std::string::npos);

    const auto files = files_in(folder.path() / "run");
    const std::string place = "downwash-out/open_air-mp-arm-ada-5/";
    REQUIRE(files.size() == files_of_a_run);
    CHECK(files.at(place + "trajectory.csv").starts_with(csv_header + "\n0,-6,3,"));
    CHECK(files.at(place + "effective.yaml").starts_with("schema: downwash/problem/v1\n"));

    const auto solution = nlohmann::json::parse(files.at(place + "solution.json"));
    CHECK(keys_of(solution) == std::set<std::string>{"schema", "status", "interrupted", "problem", "variant",
                                                     "algorithm", "objective", "seed", "version", "threads", "cost",
                                                     "planning", "plan", "execution"});
    CHECK(keys_of(solution.at("problem")) == std::set<std::string>{"name", "file", "sha256"});
    CHECK(keys_of(solution.at("planning")) ==
          std::set<std::string>{"wall_s", "map_wall_s", "flight_wall_s", "first_solution_wall_s", "iterations",
                                "edges_simulated", "simulated_s", "states_checked", "improvements", "rejected",
                                "nearest_approach_m", "obstruction"});
    CHECK(keys_of(solution.at("plan").at("reference").at(0)) ==
          std::set<std::string>{"t_s", "x_m", "z_m", "arm_rad", "vx_m_s", "vz_m_s", "arm_rate_rad_s", "ax_m_s2",
                                "az_m_s2", "arm_acceleration_rad_s2"});
    CHECK(keys_of(solution.at("execution")) == std::set<std::string>{"aero", "outcome", "min_clearance_m", "energy_j",
                                                                     "duration_s", "cost", "max_tracking_error_m",
                                                                     "max_saturation", "goal_error_m", "goals"});
    CHECK(solution.at("schema") == "downwash/solution/v1");
    CHECK(solution.at("status") == "solved");
    CHECK(solution.at("seed") == 5);
    CHECK(solution.at("version") == DOWNWASH_EXPECTED_VERSION);
    CHECK(solution.at("problem").at("sha256").get<std::string>().size() == 64);
    CHECK(solution.at("execution").at("outcome") == "ok");
}

TEST_CASE("Json on standard output is the solution file and quiet leaves standard error empty") {
    const ScratchFolder folder;
    const Result result = run(folder, {"solve", problem_file("open_air"), "--variant", "mp-arm", "--max-iterations",
                                       "300", "--out", "here", "--json", "--quiet"});
    CHECK(result.err.empty());
    CHECK(result.json().at("variant") == "mp-arm");
    CHECK(result.out == read_file(folder.path() / "run/here/solution.json"));
    CHECK(files_in(folder.path() / "run").size() == files_of_a_run);
}

TEST_CASE("Solving the effective problem again gives the same bytes") {
    const ScratchFolder folder;
    for (const std::string variant : {"mp-arm", "mp-arm-da", "mp-arm-ada"}) {
        CAPTURE(variant);
        const auto first = run(folder, {"solve", problem_file("bridge_inspection"), "--variant", variant, "--seed", "3",
                                        "--max-iterations", "300", "--margin", "0.03", "--out", "a", "--threads", "1"});
        std::filesystem::rename(folder.path() / "run/a", folder.path() / "run/first");
        const auto second = run(
            folder, {"solve", "first/effective.yaml", "--max-iterations", "300", "--out", "second", "--threads", "2"});
        CHECK(first.code == second.code);
        const auto one = files_in(folder.path() / "run/first");
        const auto two = files_in(folder.path() / "run/second");
        CHECK(one.at("trajectory.csv") == two.at("trajectory.csv"));
        CHECK(one.at("effective.yaml") == two.at("effective.yaml"));
        CHECK(repeatable(nlohmann::json::parse(one.at("solution.json"))) ==
              repeatable(nlohmann::json::parse(two.at("solution.json"))));
        std::filesystem::remove_all(folder.path() / "run/first");
    }
}

TEST_CASE("The effective problem finds the meshes and scans of its problem again") {
    const ScratchFolder folder;
    const auto solve = [&folder](const std::string& problem, const std::string& out) {
        const Result result =
            run(folder, {"solve", problem, "--variant", "mp-arm", "--max-iterations", "100", "--out", out});
        REQUIRE(result.code != 2);
        return files_in(folder.path() / "run" / out);
    };
    const auto one = solve(problem_file("girder_mesh"), "first");
    const auto two = solve("first/effective.yaml", "deeper/down/second");
    CHECK(one.at("trajectory.csv") == two.at("trajectory.csv"));
    CHECK(repeatable(nlohmann::json::parse(one.at("solution.json"))) ==
          repeatable(nlohmann::json::parse(two.at("solution.json"))));
    CHECK(one.at("effective.yaml") != two.at("effective.yaml"));  // its paths are two folders longer
}

TEST_CASE("Without a solution within the limits the exit code is 1 and nobody says solved") {
    const ScratchFolder folder;
    const Result result = run(folder, {"solve", problem_file("bridge_inspection"), "--max-iterations", "1", "--variant",
                                       "mp-arm-da", "--out", "x"});
    CHECK(result.code == 1);
    CHECK(result.out.starts_with("No solution within the limits"));
    const auto files = files_in(folder.path() / "run/x");
    REQUIRE(files.size() == files_of_a_run);
    CHECK(files.at("trajectory.csv").starts_with(csv_header + "\n"));
    const auto solution = nlohmann::json::parse(files.at("solution.json"));
    CHECK(solution.at("status") != "solved");
    CHECK(solution.at("planning").at("first_solution_wall_s").is_null());
    CHECK(solution.at("plan").is_null() == (solution.at("status") == "none"));
    CHECK(solution.at("execution").is_null() == (solution.at("status") == "none"));
}

TEST_CASE("Stop at first ends with the first accepted plan") {
    const ScratchFolder folder;
    const Result result =
        run(folder, {"solve", problem_file("open_air"), "--time-limit", "60", "--stop-at-first", "--json"});
    CHECK(result.code == 0);
    CHECK(result.json().at("planning").at("improvements").size() == 1);
    CHECK(result.json().at("planning").at("wall_s") < 30);
}

TEST_CASE("Without obstacles there is no clearance to write") {
    const ScratchFolder folder;
    std::string text = without_obstacles(read_file(problem_file("open_air")));
    text.replace(text.find("robots/"), 7, std::string(DOWNWASH_PROBLEMS) + "/robots/");
    write_file(folder / "empty.yaml", text);
    const Result result =
        run(folder, {"solve", folder / "empty.yaml", "--max-iterations", "300", "--out", "x", "--json"});
    REQUIRE(result.code == 0);
    CHECK(result.json().at("execution").at("min_clearance_m").is_null());
    std::istringstream rows(read_file(folder.path() / "run/x/trajectory.csv"));
    std::string row;
    std::getline(rows, row);
    std::getline(rows, row);
    std::istringstream cells(row);
    std::string cell;
    for (int column = 0; column < 20; ++column) {
        std::getline(cells, cell, ',');
    }
    CHECK(cell.empty());
}

TEST_CASE("Rotors that lag have a column of their own") {
    const ScratchFolder folder;
    std::string robot = read_file(std::string(DOWNWASH_PROBLEMS) + "/robots/ars_lrm.yaml");
    const std::size_t at = robot.find("time_constant_s: 0");
    REQUIRE(at != std::string::npos);
    robot.replace(at, 18, "time_constant_s: 0.02");
    write_file(folder / "lagging.yaml", robot);
    std::string text = read_file(problem_file("open_air"));
    text.replace(text.find("robots/ars_lrm"), 14, "lagging");
    write_file(folder / "problem.yaml", text);
    const Result result = run(folder, {"solve", folder / "problem.yaml", "--max-iterations", "50", "--out", "x"});
    CHECK(result.code != 2);
    const std::string trajectory = read_file(folder.path() / "run/x/trajectory.csv");
    CHECK(trajectory.substr(0, trajectory.find('\n')).ends_with("rotor_4_cmd_n,rotor_4_aero_factor,rotor_4_lag_n"));
}

TEST_CASE("A folder that cannot be written is refused before planning") {
    const ScratchFolder folder;
    write_file(folder / "file", "not a folder");
    std::vector<std::string> unwritable{folder / "file", std::string(folder / "file") + "/below"};
    if (geteuid() != 0) {  // nothing is forbidden to root
        std::filesystem::create_directory(folder / "locked");
        chmod((folder / "locked").c_str(), 0500);
        unwritable.push_back(folder / "locked");
    }
    for (const std::string& out : unwritable) {
        CAPTURE(out);
        const Result result = run(folder, {"solve", problem_file("open_air"), "--out", out});
        CHECK(result.code == 2);
        CHECK(result.err.find(out) != std::string::npos);
        CHECK(result.err.find("planning") == std::string::npos);
    }
}

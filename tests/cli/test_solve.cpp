#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "../support/csv_rows.hpp"
#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;
using Catch::StartsWith;

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

/// The rows of a trajectory as numbers; NAN where a cell is empty.
std::vector<std::map<std::string, double>> numbers_of(const std::string& trajectory) {
    std::vector<std::map<std::string, double>> rows;
    for (const auto& cells : rows_of(trajectory)) {
        auto& row = rows.emplace_back();
        for (const auto& [name, cell] : cells) {
            row[name] = cell.empty() ? NAN : std::strtod(cell.c_str(), nullptr);
        }
    }
    return rows;
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
    const Workspace work;
    const Result result = work.succeed("solve", problem_file("open_air"), "--max-iterations 300 --seed 5");
    CHECK_THAT(result.out, StartsWith("Solved. "));
    CHECK_THAT(result.err, Contains("planning"));

    const auto files = work.files();
    const std::string place = "downwash-out/open_air-mp-arm-ada-5/";
    REQUIRE(files.size() == files_of_a_run);
    CHECK_THAT(files.at(place + "trajectory.csv"), StartsWith(csv_header + "\n0,-6,3,"));
    CHECK_THAT(files.at(place + "effective.yaml"), StartsWith("schema: downwash/problem/v1\n"));

    const auto solution = nlohmann::json::parse(files.at(place + "solution.json"));
    CHECK(keys_of(solution) == std::set<std::string>{"schema", "status", "interrupted", "problem", "variant",
                                                     "algorithm", "objective", "seed", "version", "threads", "cost",
                                                     "planning", "certificate", "plan", "stops", "execution", "files",
                                                     "warnings", "inputs"});
    CHECK(keys_of(solution.at("problem")) == std::set<std::string>{"name", "file", "sha256"});
    CHECK(keys_of(solution.at("planning")) ==
          std::set<std::string>{"wall_s", "map_wall_s", "flight_wall_s", "first_solution_wall_s",
                                "first_certified_wall_s", "iterations", "edges_simulated", "simulated_s",
                                "states_checked", "improvements", "rejected", "stopped_by", "candidates",
                                "nearest_approach_m", "obstruction", "goal"});
    CHECK(keys_of(solution.at("plan").at("reference").at(0)) ==
          std::set<std::string>{"t_s", "x_m", "z_m", "arm_rad", "vx_m_s", "vz_m_s", "arm_rate_rad_s", "ax_m_s2",
                                "az_m_s2", "arm_acceleration_rad_s2"});
    CHECK(keys_of(solution.at("execution")) == std::set<std::string>{"aero", "outcome", "min_clearance_m", "energy_j",
                                                                     "duration_s", "cost", "max_tracking_error_m",
                                                                     "max_saturation", "goal_error_m", "goals"});
    CHECK(solution.at("schema") == "downwash/solution/v1");
    CHECK(solution.at("status") == "solved");
    CHECK(solution.at("interrupted") == false);
    CHECK(solution.at("variant") == "mp-arm-ada");
    CHECK(solution.at("algorithm") == "rrt-star");
    CHECK(solution.at("objective") == "energy");
    CHECK(solution.at("seed") == 5);
    CHECK(solution.at("version") == DOWNWASH_EXPECTED_VERSION);
    CHECK(solution.at("problem").at("name") == "open_air");
    CHECK(solution.at("problem").at("file") == problem_file("open_air"));
    CHECK(solution.at("problem").at("sha256").get<std::string>().size() == 64);
}

TEST_CASE("What a solution says of its search and its flight is what the rows of the flight come to") {
    const Workspace work;
    const auto solution = work.json("solve", problem_file("open_air"), "--max-iterations 300 --seed 5 --out x");
    const auto rows = numbers_of(work.text("x/trajectory.csv"));
    REQUIRE(rows.size() > 1000);

    // The plan: from the start to within 0.1 m of (5, 6), its corners on its reference, held for 5 s at the end.
    const auto& reference = solution.at("plan").at("reference");
    const auto& waypoints = solution.at("plan").at("waypoints");
    REQUIRE(reference.size() == waypoints.size());
    for (std::size_t i = 0; i < reference.size(); ++i) {
        for (const char* key : {"x_m", "z_m", "arm_rad"}) {
            CHECK(reference[i].at(key) == waypoints[i].at(key));
        }
    }
    CHECK(reference.front().at("t_s") == 0);
    CHECK(reference.front().at("x_m") == -6);
    CHECK(reference.front().at("z_m") == 3);
    CHECK(reference.front().at("arm_rad").get<double>() == Approx(std::acos(0.0)));
    CHECK(std::hypot(reference.back().at("x_m").get<double>() - 5, reference.back().at("z_m").get<double>() - 6) < 0.1);
    CHECK(rows.back().at("ref_x_m") == reference.back().at("x_m"));
    CHECK(rows.back().at("t_s") == Approx(reference.back().at("t_s").get<double>() + 5));

    double clearance_m = HUGE_VAL, tracking_m = 0, goal_error_m = 0;
    const double end_s = rows.back().at("t_s");
    for (const auto& row : rows) {
        clearance_m = std::min(clearance_m, row.at("clearance_m"));
        tracking_m =
            std::max(tracking_m, std::hypot(row.at("x_m") - row.at("ref_x_m"), row.at("z_m") - row.at("ref_z_m")));
        if (row.at("t_s") > end_s - 1 - 1e-6) {  // the goal is judged over the last second
            goal_error_m = std::max(goal_error_m, std::hypot(row.at("x_m") - 5, row.at("z_m") - 6));
        }
    }
    const auto& flight = solution.at("execution");
    CHECK(flight.at("aero") == true);
    CHECK(flight.at("outcome") == "ok");
    CHECK(flight.at("duration_s").get<double>() == Approx(end_s));
    CHECK(flight.at("energy_j") == rows.back().at("energy_j"));
    CHECK(flight.at("cost") == flight.at("energy_j"));  // the objective is the energy
    CHECK(flight.at("min_clearance_m") == clearance_m);
    CHECK(flight.at("max_tracking_error_m").get<double>() == Approx(tracking_m));
    CHECK(flight.at("goal_error_m").get<double>() == Approx(goal_error_m));
    CHECK(flight.at("max_saturation").get<double>() > 0);
    CHECK(flight.at("max_saturation").get<double>() < 1);
    REQUIRE(flight.at("goals").size() == 1);
    CHECK(flight.at("goals")[0].at("met") == true);
    CHECK(flight.at("goals")[0].at("error_m") == flight.at("goal_error_m"));

    // Far from every surface the planner's model and the flight with direct aerodynamics agree.
    CHECK(solution.at("cost").get<double>() == Approx(flight.at("cost").get<double>()).epsilon(1e-3));
    const auto& planning = solution.at("planning");
    CHECK(planning.at("iterations") == 300);
    const auto& improvements = planning.at("improvements");
    REQUIRE_FALSE(improvements.empty());
    CHECK(planning.at("first_solution_wall_s") <= planning.at("wall_s"));
    CHECK(improvements.back().at("cost") == solution.at("cost"));
    for (std::size_t i = 0; i < improvements.size(); ++i) {
        CHECK(improvements[i].at("wall_s") <= planning.at("wall_s"));
        CHECK(improvements[i].at("iteration") <= 300);
        CHECK((i == 0 || improvements[i].at("cost") < improvements[i - 1].at("cost")));
    }
    // Each edge is one flight of a tick (10 ms) at least, checked for collisions.
    CHECK(planning.at("edges_simulated") > 100);
    CHECK(planning.at("simulated_s").get<double>() > 0.01 * planning.at("edges_simulated").get<double>());
    CHECK(planning.at("states_checked") > planning.at("edges_simulated"));
}

TEST_CASE(
    "Json on standard output is the solution file, quiet leaves standard error empty, and stop at first ends with one "
    "plan") {
    const Workspace work;
    const Result result =
        work.run("solve", problem_file("open_air"), "--variant mp-arm --max-iterations 300 --out here --json --quiet");
    CHECK(result.err.empty());
    CHECK(result.json().at("variant") == "mp-arm");
    CHECK(result.out == work.text("here/solution.json"));
    CHECK(work.files().size() == files_of_a_run);
    // Without that option the search would go on for an hour, longer than this test may take.
    const auto solution = work.json("solve", problem_file("open_air"), "--time-limit 3600 --stop-at-first");
    CHECK(solution.at("planning").at("improvements").size() == 1);
}

TEST_CASE("Solving the effective problem again gives the same bytes") {
    const Workspace work;
    for (const char* variant : {"mp-arm", "mp-arm-da", "mp-arm-ada"}) {
        CAPTURE(variant);
        const auto first =
            work.run("solve", problem_file("bridge_inspection"),
                     "--seed 3 --max-iterations 300 --margin 0.03 --out a --threads 1 --variant", variant);
        std::filesystem::rename(work.in_run("a"), work.in_run("first"));
        const auto second = work.run("solve first/effective.yaml --max-iterations 300 --out second --threads 2");
        CHECK(first.code == second.code);
        const auto one = work.files("first");
        const auto two = work.files("second");
        CHECK(one.at("trajectory.csv") == two.at("trajectory.csv"));
        CHECK(one.at("effective.yaml") == two.at("effective.yaml"));
        CHECK(repeatable(nlohmann::json::parse(one.at("solution.json"))) ==
              repeatable(nlohmann::json::parse(two.at("solution.json"))));
        std::filesystem::remove_all(work.in_run("first"));
    }
}

TEST_CASE("Without a solution within the limits the exit code is 1 and nobody says solved") {
    const Workspace work;
    const Result result =
        work.run("solve", problem_file("bridge_inspection"), "--max-iterations 1 --variant mp-arm-da --out x");
    CHECK(result.code == 1);
    CHECK_THAT(result.out, StartsWith("No solution within the limits"));
    const auto files = work.files("x");
    REQUIRE(files.size() == files_of_a_run);
    CHECK_THAT(files.at("trajectory.csv"), StartsWith(csv_header + "\n"));
    const auto solution = nlohmann::json::parse(files.at("solution.json"));
    CHECK(solution.at("status") != "solved");
    CHECK(solution.at("planning").at("first_solution_wall_s").is_null());
    CHECK(solution.at("plan").is_null() == (solution.at("status") == "none"));
    CHECK(solution.at("execution").is_null() == (solution.at("status") == "none"));
}

TEST_CASE("A scene that closes the plane is told at once, by check too") {
    const Workspace work;
    const std::string file = work / "closed.yaml";
    write_file(file, replaced(problem_text("open_air"), "    - {name: ground",
                              "    - {name: curtain, box: {size_m: [0.1, 4, 30], center_m: [0, 0, 0]}}\n"
                              "    - {name: ground"));
    const auto warnings = work.json("check", file).at("warnings");
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings.at(0).at("message"), Contains("goal is out of reach in this plane of motion") &&
                                                 Contains("get past 'curtain' within the bounds"));
    const Result result = work.run("solve", file, "--time-limit 1000 --out x");
    CHECK(result.code == 1);
    CHECK_THAT(result.out, StartsWith("No way leads to the goal in this plane of motion: 'curtain' closes it.") &&
                               Contains("closed by         'curtain'"));
    REQUIRE(work.files("x").size() == files_of_a_run);
    const auto solution = nlohmann::json::parse(work.files("x").at("solution.json"));
    CHECK(solution.at("status") == "none");
    CHECK(solution.at("planning").at("iterations") == 0);
    const auto& obstruction = solution.at("planning").at("obstruction");
    CHECK(obstruction.at("cause") == "closed_plane");
    CHECK(obstruction.at("obstacles") == nlohmann::json{"curtain"});
}

TEST_CASE("A flight through space that no sensor saw is a warning with its share") {
    const Workspace work;
    // Of the highest eighth of the tree the lowest eighth is occupied and the highest is free.
    write_file(work / "scan.bt", std::string("# Octomap OcTree binary file\nid OcTree\nsize 4\nres 0.1\ndata\n") +
                                     std::string("\x00\xc0\x02\x40", 4));
    const std::string file = work / "scanned.yaml";
    // The free cube begins at x = 0; before it, where the vehicle starts, nothing was seen.
    write_file(file, replaced(problem_text("open_air"), "    - {name: ground",
                              "    - {name: scan, octomap: {file: scan.bt, center_m: [-1638.4, -2000, -2000]}}\n"
                              "    - {name: ground"));
    const auto found = work.json("check", file);
    REQUIRE(found.at("geometry").size() == 1);
    CHECK(found.at("geometry").at(0).at("unknown") == "free");
    CHECK(found.at("geometry").at(0).at("unseen_share") == 0.75);
    CHECK_THAT(work.succeed("check", file).out, Contains("75.0 % of its box unseen (free)"));
    const Result result = work.run("solve", file, "--max-iterations 300 --out x");
    REQUIRE(result.code == 0);
    CHECK_THAT(result.err, Contains("a part of the robot is in space of an octree that no sensor saw"));
    CHECK_THAT(result.out, Contains("unseen space"));
    const auto solution = nlohmann::json::parse(work.files("x").at("solution.json"));
    const double share = solution.at("execution").at("unseen_share").get<double>();
    CHECK(share > 0.2);
    CHECK(share < 0.9);
    CHECK(solution.at("warnings").size() == found.at("warnings").size() + 1);
    const auto again = work.json("execute", file, "--plan x --out y");
    CHECK(again.at("execution").at("unseen_share") == share);
}

TEST_CASE("Without obstacles there is no clearance to write, and rotors that lag have a column of their own") {
    const Workspace work;
    write_file(work / "empty.yaml", without_obstacles(problem_text("open_air")));
    const auto solution = work.json("solve", work / "empty.yaml", "--max-iterations 300 --out x");
    CHECK(solution.at("execution").at("min_clearance_m").is_null());
    const auto rows = numbers_of(work.text("x/trajectory.csv"));
    CHECK(std::isnan(rows.front().at("clearance_m")));
    CHECK_FALSE(std::isnan(rows.front().at("ee_x_m")));
    CHECK(work.run("solve", shipped_file("open_air"), "--max-iterations 50 --out lagging").code != 2);
    const std::string trajectory = work.text("lagging/trajectory.csv");
    CHECK_THAT(trajectory.substr(0, trajectory.find('\n')),
               Catch::EndsWith("rotor_4_cmd_n,rotor_4_aero_factor,rotor_4_lag_n"));
}

TEST_CASE("A folder that cannot be written is rejected before planning") {
    const Workspace work;
    write_file(work / "file", "not a folder");
    std::vector<std::filesystem::path> unwritable{work / "file", work / "file/below"};
    if (geteuid() != 0) {  // nothing is forbidden to root
        std::filesystem::create_directory(work / "locked");
        chmod((work / "locked").c_str(), 0500);
        unwritable.push_back(work / "locked");
    }
    for (const std::filesystem::path& out : unwritable) {
        CAPTURE(out);
        const Result result = work.run("solve", problem_file("open_air"), "--out", out);
        check_rejected(result, out.string());
        CHECK_THAT(result.err, !Contains("planning"));
    }
}

TEST_CASE(
    "Targets in any order: solve names their order and what it leaves out, and the plan is flown and judged in it") {
    const Workspace work;
    const std::string text = problem_text("open_air");
    const std::string head = text.substr(0, text.find("\ngoal:") + 1);
    const std::string tail = "planner: {max_iterations: 1000}\n";
    const std::string targets =
        "goal:\n  in_any_order:\n    - {configuration: {x_m: 4, z_m: 3}, hold_s: 1}\n"
        "    - {configuration: {x_m: -3, z_m: 3}, hold_s: 1}\n"
        "    - {any_of: [{configuration: {x_m: -5, z_m: 8}, hold_s: 1}, {configuration: {x_m: 0, z_m: 3}, hold_s: "
        "1}]}\n";
    write_file(work.in_run("all.yaml"), head + targets + tail);
    const Result all = succeeded(work.run("solve", "all.yaml --out all --quiet"));
    CHECK_THAT(all.out, Contains("order             targets 2, 3 (alternative 2), 1\n") && !Contains("left out"));
    const auto solution = nlohmann::json::parse(work.text("all/solution.json"));
    CHECK(solution.at("order").at("visits").at(1) == nlohmann::json{{"target", 3}, {"alternative", 2}});
    CHECK_THAT(succeeded(work.run("validate", "all.yaml --plan all")).out, StartsWith("Valid. "));
    CHECK(work.json("execute", "all.yaml --plan all --out again --json").at("order") == solution.at("order"));

    const double energy_j = solution.at("execution").at("energy_j");
    write_file(work.in_run("some.yaml"),
               head + targets + "  energy_budget_j: " + std::to_string(0.8 * energy_j) + "\n" + tail);
    const Result some = succeeded(work.run("solve", "some.yaml --out some --quiet"));
    CHECK_THAT(some.out, Contains("left out          target 1: with it the flight takes about "));
    CHECK_THAT(succeeded(work.run("validate", "some.yaml --plan some")).out, StartsWith("Valid. "));
    // The plan to all of them takes more than that.
    const Result flown = work.run("execute", "some.yaml --plan all --out flown --quiet");
    CHECK(flown.code == 3);
    CHECK_THAT(flown.out, StartsWith("The flight with direct aerodynamics takes more energy than it may."));

    write_file(work.in_run("none.yaml"), head + targets + "  energy_budget_j: 1\n" + tail);
    const Result none = work.run("solve", "none.yaml --out none --quiet");
    CHECK(none.code == 1);
    CHECK_THAT(none.out, StartsWith("No solution: the energy budget is not enough for any target."));
    CHECK_THAT(none.out, Contains("order             none: no target is visited\n"));
}

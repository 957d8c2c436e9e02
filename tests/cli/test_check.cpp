#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <regex>
#include <string>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;
using Catch::StartsWith;

namespace {

const std::string robot_file = DOWNWASH_PROBLEMS "/robots/ars_lrm.yaml";

/// The shipped flight in open air over a ground whose K stands in a table with semicolons and decimal commas.
std::string with_table(const Workspace& work) {
    write_file(work / "k.csv", "z_over_r;d_over_r;factor;\n0,5;0;1,3;\n0,5;9;1,2;\n2;0;1,01;\n2;9;1;\n");
    const std::string file = work / "tabled.yaml";
    write_file(file, problem_text("open_air") + "aero: {ground: {model: table, file: k.csv}}\n");
    return file;
}

}  // namespace

TEST_CASE("Check tells what a robot amounts to, of a robot file alone and in a problem") {
    const Workspace work;
    const auto alone = work.json("check", robot_file).at("robots");
    REQUIRE(alone.size() == 1);
    CHECK(alone[0].at("problem").is_null());
    CHECK(alone[0].at("file") == robot_file);
    CHECK(alone[0].at("robot") == "ars_lrm");
    CHECK(alone[0].at("mass_kg").get<double>() == Approx(4.95));
    CHECK(alone[0].at("thrust_to_weight").get<double>() == Approx(4 * 28 / (4.95 * 9.80665)).epsilon(1e-5));
    CHECK(alone[0].at("reach_m").get<double>() == Approx(1.2));
    // The level arm's centre of mass is 0.72 m in front of rotors at 0.32 m.
    CHECK(alone[0].at("hover_share").get<double>() ==
          Approx((4.95 / 4 + 0.45 * 0.72 / (4 * 0.32)) * 9.80665 / 28).epsilon(0.02));
    CHECK(alone[0].at("hovers_stably") == true);

    double gain_db = HUGE_VAL, phase_deg = HUGE_VAL;
    const auto margins = work.json("margins", robot_file).at("margins");
    for (const auto& loop : margins) {
        gain_db =
            std::min(gain_db, loop.at("gain_margin_db").is_null() ? HUGE_VAL : loop.at("gain_margin_db").get<double>());
        phase_deg = std::min(
            phase_deg, loop.at("phase_margin_deg").is_null() ? HUGE_VAL : loop.at("phase_margin_deg").get<double>());
    }
    CHECK(alone[0].at("gain_margin_db").get<double>() == Approx(gain_db).epsilon(1e-5));
    CHECK(alone[0].at("phase_margin_deg").get<double>() == Approx(phase_deg).epsilon(1e-5));
    CHECK(alone[0].at("gain_margin_at").contains("loop"));

    auto in_problem = work.json("check", shipped_file("open_air")).at("robots");
    REQUIRE(in_problem.size() == 1);
    CHECK(in_problem[0].at("problem") == shipped_file("open_air"));
    in_problem[0]["problem"] = nullptr;
    in_problem[0]["file"] = robot_file;
    CHECK(in_problem == alone);

    const std::string line = "\n  ars_lrm: 4.95 kg, thrust 2.31 times the weight, reach 1.2 m, hover at ";
    CHECK_THAT(work.succeed("check", robot_file).out, StartsWith(robot_file + ": ok" + line) && Contains(" margins "));
    CHECK_THAT(work.succeed("check", shipped_file("open_air")).out, Contains(line));
    write_file(work / "weak.yaml", replaced(read_file(robot_file), "max_thrust_n: 28", "max_thrust_n: 13.5"));
    CHECK_THAT(work.succeed("check", work / "weak.yaml").out, Contains("not stable in every hover"));
}

TEST_CASE("Check tells how files of numbers were read, those of problems and by themselves") {
    const Workspace work;
    const std::string problem = with_table(work);
    const auto data = work.json("check", problem).at("data");
    REQUIRE(data.size() == 1);
    CHECK(data[0].at("problem") == problem);
    CHECK(data[0].at("key") == "aero.ground.file");
    CHECK(data[0].at("kind") == "effect_table");
    CHECK(data[0].at("rows") == 4);
    CHECK(data[0].at("separator") == ";");
    CHECK(data[0].at("decimal_sign") == ",");
    CHECK(data[0].at("columns").at(1) ==
          nlohmann::json{{"name", "d_over_r"}, {"unit", "rotor radii"}, {"low", 0}, {"high", 9}});
    CHECK_THAT(
        work.succeed("check", problem).out,
        Contains("  k.csv: effect table of 4 rows, z_over_r [rotor radii] 0.5 to 2, d_over_r [rotor radii] 0 to 9, "
                 "factor 1 to 1.3; separated by ';', decimal commas\n"));

    const auto measured = work.json("check", DOWNWASH_MEASUREMENTS, DOWNWASH_WALLS, work / "k.csv").at("data");
    REQUIRE(measured.size() == 3);
    CHECK(measured[0].at("kind") == "measurements");
    CHECK(measured[0].at("problem").is_null());
    CHECK(measured[0].at("key").is_null());
    CHECK(measured[0].at("other_columns") == nlohmann::json{"rotor_diameter_in", "pwm_level"});
    CHECK(measured[0].at("columns").at(1) ==
          nlohmann::json{{"name", "surface"}, {"unit", nullptr}, {"low", nullptr}, {"high", nullptr}});
    CHECK(measured[1].at("kind") == "wall_measurements");
    CHECK(measured[1].at("rows") == 55);
    CHECK(measured[2].at("kind") == "effect_table");

    work.succeed("aeromap build", shipped_file("open_air"), "-o grid.csv --step 1");
    CHECK_THAT(work.succeed("check grid.csv").out, Contains("  grid.csv: grid of ") && Contains("x_m [m]"));

    write_file(work / "bad.csv", "z_over_r,thrust_ratio\n1,1.1\n2,much\n");
    const Result bad = work.run("check", work / "bad.csv", "--json");
    CHECK(bad.code == 2);
    const auto fault = bad.json().at("faults").at(0);
    CHECK(fault.at("file") == (work / "bad.csv").string());
    CHECK(fault.at("line") == 3);
    CHECK(fault.at("column") == 3);
    CHECK_THAT(fault.at("message"), StartsWith("thrust_ratio is 'much'"));
    CHECK_THAT(bad.err, Contains("bad.csv:3:3: thrust_ratio is 'much'"));
    CHECK_THAT(work.run("check nowhere.csv").err, StartsWith("nowhere.csv:1:1: "));
    check_rejected(work.run("check pier.STL"),
                   "pier.STL:1:1: is part of a scene: expected a problem that names it in "
                   "environment.obstacles[].mesh.file");
}

TEST_CASE("Beside errors check tells what was read, and draws what it could read") {
    const Workspace work;
    write_file(work / "wall.obj", "v 3 0 0\nv 3 0 5\nv 3 3 5\nv 3 3 0\nf 1 2 3 4\n");
    const std::string file = work / "wall.yaml";
    write_file(file, std::regex_replace(problem_text("open_air"), std::regex("(    - \\{name: ground)"),
                                        "    - {name: wall, mesh: {file: wall.obj}}\n$1") +
                         "\nnot_a_key: 1\n");
    const Result found = work.run("check", file, "--picture before.svg");
    CHECK(found.code == 2);
    CHECK_THAT(found.err, Contains("not_a_key") && Contains("is open at 4 edges"));
    CHECK_THAT(found.out, StartsWith(file + ": 1 error, 1 warning\n") && Contains("\n  wall: mesh of 2 triangles, "));
    CHECK_THAT(work.text("before.svg"), Contains("<svg"));
    const auto json = work.run("check", file, "--json").json();
    CHECK(json.at("faults").size() == 1);
    CHECK(json.at("warnings").size() == 1);
    CHECK(json.at("geometry").size() == 1);
    CHECK(json.at("robots").size() == 1);
    write_file(file, replaced(read_file(file), "wall.obj", "nowhere.obj"));
    const Result unread = work.run("check", file, "--picture none.svg");
    CHECK_THAT(unread.out, !Contains("mesh of") && !Contains("none.svg"));
}

TEST_CASE("Solve tells the same in its summary and in its results, again from effective.yaml") {
    const Workspace work;
    const std::string problem = with_table(work);
    const std::string summary = work.run("solve", problem, "--max-iterations 20 --out out").out;
    CHECK_THAT(summary, Contains("\n  robot             ars_lrm_ideal: 4.95 kg, ") &&
                            Contains("\n  data              k.csv: effect table of 4 rows") &&
                            !Contains("  geometry "));
    const auto inputs = nlohmann::json::parse(work.text("out/solution.json")).at("inputs");
    CHECK(inputs.at("geometry") == nlohmann::json::array());
    CHECK(inputs.at("data").at(0).at("file") == "k.csv");
    auto robot = work.json("check", problem).at("robots").at(0);
    robot.erase("problem");
    robot.erase("file");
    CHECK(inputs.at("robot") == robot);
    static_cast<void>(work.run("solve out/effective.yaml --max-iterations 20 --out again"));
    CHECK(nlohmann::json::parse(work.text("again/solution.json")).at("inputs") == inputs);

    const std::string many = work.run("solve", shipped_file("girder_mesh"), "--max-iterations 1 --out girders").out;
    CHECK_THAT(many, Contains("\n  geometry          left_girder: mesh of 164 triangles, 11 pieces, solid, x -8.9 to"));
    CHECK(nlohmann::json::parse(work.text("girders/solution.json")).at("inputs").at("geometry").size() == 4);
}

TEST_CASE("Keys by their former names are warnings of check and of results") {
    const Workspace work;
    const std::string problem = work / "problem.yaml";
    write_file(problem, std::regex_replace(problem_text("open_air"), std::regex("robot: [^\n]*"), "robot: robot.yaml"));
    write_file(work / "robot.yaml",
               replaced(read_file(DOWNWASH_PROBLEMS "/robots/ars_lrm_ideal.yaml"), "rate_kp:", "ku5:"));
    const auto warnings = work.json("check", problem).at("warnings");
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0].at("message"), Contains("is now called rate_kp: rename it"));
    CHECK(work.json("check", work / "robot.yaml").at("warnings").size() == 1);
    const Result solved = work.run("solve", problem, "--max-iterations 1 --quiet --json --out out");
    CHECK(solved.json().at("warnings") == warnings);
    CHECK(solved.err.empty());
}

TEST_CASE("A problem in space is begun, checked, explained and solved") {
    const Workspace work;
    CHECK(work.run("init --space").out == "my_problem.yaml\nhexa370_arm3.yaml\n");
    const Result checked = work.succeed("check my_problem.yaml hexa370_arm3.yaml");
    CHECK_THAT(checked.out,
               Contains("my_problem.yaml: ok\n  hexa370_arm3: 2.56 kg, 3 joints, thrust 4.95 times the weight"));
    CHECK_THAT(checked.out, Contains("hexa370_arm3.yaml: ok\n  hexa370_arm3: "));
    const auto robots = work.json("check", "my_problem.yaml").at("robots");
    REQUIRE(robots.size() == 1);
    CHECK(robots.at(0).at("joints") == 3);
    CHECK(robots.at(0).at("hover_joints_deg").size() == 3);

    CHECK_THAT(work.succeed("solve my_problem.yaml --max-iterations 100 --stop-at-first --out planned").out,
               Contains("Solved. The flight with direct aerodynamics") &&
                   Contains("status            solved (mp-arm-ada, rrt-star, energy, seed 1)") &&
                   Contains(" J planned, ") && Contains(" or more in 99 % of the worlds") && Contains("rejected  "));
    CHECK_THAT(work.succeed("check my_problem.yaml --picture views.svg").out, Catch::EndsWith("\nviews.svg\n"));
    CHECK_THAT(work.text("views.svg"), Contains("from above") && Contains("from the front") && Contains("girder"));
    if (has_pages) {
        CHECK_THAT(work.succeed("check my_problem.yaml --page page.html").out, Catch::EndsWith("\npage.html\n"));
        CHECK_THAT(work.text("page.html"), Contains("downwash/space-report/v1"));
    }
    CHECK_THAT(work.succeed("explain joint_m --of space-problem").out, StartsWith("robot.arm.links[].joint_m\n"));
    CHECK_THAT(work.succeed("explain torque_ratio_m").out, Contains("--of space-problem"));
    CHECK_THAT(work.succeed("check --schema space-robot").out, Contains("\"torque_ratio_m\""));
}

TEST_CASE("A problem is drawn and shown as a page before it is planned") {
    const Workspace work;
    const Result drawn = work.succeed("check", shipped_file("bridge_inspection"), "--picture before.svg");
    CHECK_THAT(drawn.out,
               StartsWith(shipped_file("bridge_inspection") + ": ok\n") && Catch::EndsWith("\nbefore.svg\n"));
    const std::string picture = work.text("before.svg");
    CHECK_THAT(picture, Contains("<svg") && Contains("robot at the start") && Contains("tolerance of the goal"));
    work.succeed("check", shipped_file("bridge_inspection"), "--picture again.svg --json");
    CHECK(work.text("again.svg") == picture);
    CHECK(work.files().size() == 2);

    const Result page = work.run("check", shipped_file("bridge_inspection"), "--page before.html");
    if (!has_pages) {
        check_rejected(page, "this build contains no pages");
        return;
    }
    CHECK(page.code == 0);
    CHECK_THAT(work.text("before.html"), Contains("\"status\":\"unplanned\"") && Contains("</html>"));
}

TEST_CASE("What cannot be drawn is rejected with a remedy, and no file is left behind") {
    const Workspace work;
    const std::string problem = shipped_file("open_air");
    check_rejected(work.run("check", problem, "--picture a.jpg"),
                   "--picture 'a.jpg': expected a name that ends in .svg");
    check_rejected(work.run("check", problem, "--page a.htm"), "--page 'a.htm': expected a name that ends in .html");
    check_rejected(work.run("check", problem, problem, "--picture a.svg"), "expected one problem file");
    check_rejected(work.run("check --picture a.svg --schema problem"), "expected one problem file");
    check_rejected(work.run("check", robot_file, "--picture a.svg"), "is a robot file: expected the file of a problem");
    check_rejected(work.run("check", problem, "--picture nowhere/a.svg"), "--picture nowhere/a.svg");
    write_file(work / "bad.yaml", "schema: downwash/problem/v1\nname: b a d\n");
    CHECK(work.run("check", work / "bad.yaml", "--picture a.svg").code == 2);
    const Result without_gnuplot =
        work.run_in({{"PATH", work.path().string()}}, "", words("check", problem, "--picture a.svg"));
    CHECK(without_gnuplot.code == 2);
    CHECK_THAT(without_gnuplot.err, Contains("gnuplot"));
    CHECK(work.files().empty());
}

#include <catch2/catch.hpp>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;

TEST_CASE("A model query gives the formula's values") {
    const Workspace work;
    const Words query = words("aeromap query --model cheeseman-bennett --z-over-r 0.1");
    const auto answer = work.json(query, "0.5 1");
    CHECK(answer.at("model") == "cheeseman-bennett");
    const auto& points = answer.at("points");
    REQUIRE(points.size() == 3);
    CHECK(points[0].at("factor") == 2.0);  // below the pole at 1/4: the cap
    CHECK(points[1].at("z_over_r") == 0.5);
    CHECK(points[1].at("factor").get<double>() == Approx(4.0 / 3).epsilon(1e-12));
    CHECK(points[2].at("factor").get<double>() == Approx(16.0 / 15).epsilon(1e-12));
    CHECK(work.json(query, "--max-factor 1.5").at("points")[0].at("factor") == 1.5);
}

TEST_CASE("A model query takes parameters and the vehicle's other rotors") {
    const Workspace work;
    write_file(work.in_run("t.csv"), "z_over_r,factor\n0.5,1.2\n1,0.9\n3,1\n");
    const Words query = words("aeromap query --z-over-r 1 --model");
    const auto factor = [&](const char* model) {
        return work.json(query, model).at("points")[0].at("factor").get<double>();
    };
    CHECK(factor("multirotor-body") == Approx(1.45).margin(0.005));  // of a square quadrotor, d/R = 2.5
    CHECK(factor("multirotor-body --set k_b=0") == Approx(factor("multirotor-images")));
    CHECK(factor("multirotor-images --rotor-spacing 3.5") < factor("multirotor-images"));
    CHECK(factor("li --set rho=4") == Approx(4.0 / 3));
    CHECK(factor("table --table t.csv") == 0.9);
    for (const char* wrong : {"li --set rh=4", "li --set rho=-1", "li --rotor-spacing 3", "table", "he --table t.csv",
                              "table --table t.csv --d-over-r 1"}) {
        CAPTURE(wrong);
        CHECK(work.run(query, wrong).code == 2);
    }
}

TEST_CASE("Many points are read from a file or from standard input, after those of the command line") {
    const Workspace work;
    const Words query = words("aeromap query", problem_file("bridge_inspection"));
    write_file(work.in_run("points.txt"), "# hubs\nx_m,y_m,z_m\n0, 0.32, 9.8\n\n1 0 3 # free air\n");
    const auto points = work.json(query, "--points points.txt").at("points");
    REQUIRE(points.size() == 2);
    CHECK(points[0].at("factor").get<double>() > 1.05);
    CHECK(points[1].at("x_m") == 1);
    write_file(work.in_run("points.txt"), "0 0 1\n0 zero 1\n");
    check_rejected(work.run(query, "--points points.txt"), "points.txt:2:");
    write_file(work.in_run("points.txt"),
               "\xEF\xBB\xBF"
               "X_m;y_m;z_m\r\n0;0,32;9,8\r\n1;0;3\r\n");
    CHECK(work.json(query, "--points points.txt").at("points") == points);
    write_file(work.in_run("points.txt"), "0,0 # two\n");
    check_rejected(work.run(query, "--points points.txt"), "points.txt:1: '0,0': expected three numbers");
    CHECK(work.run(query, "--at 1 2 3 4").code == 2);
    check_rejected(work.run(query, "--at 1 2"), "--at takes 3 values: expected --at X Y Z: ");
    const auto asked = [&](const char* options, const std::string& input) {
        return work.run_in({}, input, words("aeromap query", problem_file("bridge_inspection"), options));
    };
    const auto piped = asked("--points - --at 1 0 3 --json", "x_m,y_m,z_m\n0 0.32 9.8\n\n1,0,4 # free air").json();
    REQUIRE(piped.at("points").size() == 3);
    CHECK(piped == asked("--at 1 0 3 --at 0 0.32 9.8 --at 1 0 4 --json", "").json());
    check_rejected(asked("--points -", "0 0 1\n0 zero 1\n"), "standard input:2: '0 zero 1': expected three numbers");
    check_rejected(asked("--points -", ""), "--points -: holds no point");
    check_rejected(work.run(query, "--points /dev/zero"), "/dev/zero:1: longer than 999 characters");
}

TEST_CASE("A grid that was built flies like its problem and tells what made it") {
    const Workspace work;
    const Words build = words("aeromap build", problem_file("open_air"));
    work.succeed(build, "--step 0.25 -o map.csv");
    const auto info = work.json("aeromap info map.csv");
    CHECK(info.at("kind") == "planar");
    CHECK(info.at("lateral_offsets_m").size() == 2);
    CHECK(info.at("x").at("step_m").get<double>() <= 0.25);
    CHECK_THAT(info.at("provenance").dump(), Contains("cheeseman-bennett"));
    work.succeed(build, "--step 1 --lateral -1 1 -o volume.csv");
    CHECK(work.json("aeromap info volume.csv").at("kind") == "volume");
}

TEST_CASE("A point query superposes both sides and is null where not flyable") {
    const Workspace work;
    // Under the deck; on a rotor's plane, where the map answers; and inside the walkway.
    const auto points =
        work.json("aeromap query", problem_file("bridge_inspection"), "--at 0 0 9.8 --at 0 0.32 9.8 --at -3 0 7.8")
            .at("points");
    REQUIRE(points.size() == 3);
    const auto& direct = points[0];
    CHECK(direct.at("flyable") == true);
    CHECK(direct.at("y_m") == 0);
    CHECK(direct.at("factor").get<double>() ==
          Approx(direct.at("ground").get<double>() + direct.at("ceiling").get<double>() - 1).epsilon(1e-12));
    const auto& mapped = points[1];
    const double difference =
        mapped.at("factor").get<double>() - mapped.at("ground").get<double>() - mapped.at("ceiling").get<double>() + 1;
    CHECK(difference != 0);
    CHECK(std::abs(difference) < 0.01);
    for (const char* key : {"factor", "ground", "ceiling"}) {
        CHECK(points[2].at(key).is_null());
    }
    CHECK(points[2].at("flyable") == false);
}

TEST_CASE("margins prints how far a robot's loops are from instability, as a table and as JSON") {
    const Workspace work;
    const std::string robot = std::string(DOWNWASH_PROBLEMS) + "/robots/ars_lrm.yaml";
    const auto printed = work.json("margins", robot);
    CHECK(printed.at("robot") == "ars_lrm");
    REQUIRE(printed.at("margins").size() == 9);  // arm up, level and down; three loops
    const std::string text = work.run("margins", robot).out;
    for (const auto& row : printed.at("margins")) {
        CHECK(row.at("gain_margin_db").get<double>() > 0);
        CHECK(row.at("phase_margin_deg").get<double>() > 0);
        CHECK(row.at("is_enough").get<bool>() == (row.at("gain_margin_db") >= 6 && row.at("phase_margin_deg") >= 45));
        CHECK_THAT(text, Contains(row.at("loop").get<std::string>()));
    }
    check_rejected(work.run("margins nowhere.yaml"), "nowhere.yaml");
}

TEST_CASE("margins of a robot in space have a row for every loop and pose, and tell how fast disturbances decay") {
    const Workspace work;
    const std::string robot = std::string(DOWNWASH_PROBLEMS) + "/robots/hexa370_arm3.yaml";
    const auto printed = work.json("margins", robot);
    CHECK(printed.at("robot") == "hexa370_arm3");
    REQUIRE(printed.at("margins").size() == 4 * 9);  // zero, aside, up and down; six loops and three joints
    REQUIRE(printed.at("stability").size() == 4);
    const std::string text = work.succeed("margins", robot).out;
    for (const auto& row : printed.at("margins")) {
        CHECK(row.at("bandwidth_rad_s").get<double>() > 0);
        CHECK(row.at("is_enough").get<bool>() == (row.at("gain_margin_db") >= 6 && row.at("phase_margin_deg") >= 45));
        CHECK_THAT(text, Contains(row.at("loop").get<std::string>()));
    }
    for (const auto& pose : printed.at("stability")) {
        CHECK(pose.at("growth_rate_1_s").get<double>() < 0);
        CHECK(pose.at("joints_deg").size() == 3);
    }
    const auto given = work.json("margins", robot, "--joints-deg 10 20 -30");
    CHECK(given.at("margins").size() == 9);
    CHECK(given.at("stability")[0].at("joints_deg")[2].get<double>() == Approx(-30));
    check_rejected(work.run("margins", robot, "--joints-deg 10 20"), "expected 3, one for each joint");
    check_rejected(work.run("margins", robot, "--joints-deg 10 20 300"), "beyond the limits of joint 3");
    check_rejected(work.run("margins", robot, "--yaw-rad-s 3"), "--design");
    check_rejected(work.run("margins", std::string(DOWNWASH_PROBLEMS) + "/robots/ars_lrm.yaml", "--joints-deg 10"),
                   "vertical plane");
}

TEST_CASE("margins --design prints a controller that a robot without one can have") {
    const Workspace work;
    const std::string robots = std::string(DOWNWASH_PROBLEMS) + "/robots/";
    for (const std::string name : {"hexa370_arm3", "ars_lrm"}) {
        CAPTURE(name);
        const std::string whole = read_file(robots + name + ".yaml");
        const std::size_t begin = whole.find("\ncontroller:") + 1;
        const std::size_t end = whole.find("\nuncertainty:");
        const std::string rest = end == std::string::npos ? "" : whole.substr(end);
        write_file(work / "bare.yaml", whole.substr(0, begin) + rest);
        check_rejected(work.run("margins", work / "bare.yaml"), "controller is missing");
        const std::string section = work.succeed("margins", work / "bare.yaml", "--design --height-rad-s 3").out;
        CHECK_THAT(section, Catch::StartsWith("controller:\n") && Contains("kp: 9\n") && Contains("# "));
        write_file(work / "full.yaml", whole.substr(0, begin) + section + rest);
        work.succeed("margins", work / "full.yaml");
        const auto design = work.json("margins", work / "full.yaml", "--design --height-rad-s 3");
        CHECK(design.at("controller").at("height").at("kp") == 9);
        CHECK(design.at("controller").at("type") == "model-inversion");
    }
    const auto cascade = work.json("margins", robots + "snu_f550_arm2.yaml", "--design --law px4-cascade");
    CHECK(cascade.at("controller").at("yaw_p_1_s") == 1.25);
    check_rejected(work.run("margins", robots + "ars_lrm.yaml", "--design --law px4-cascade"),
                   "is for robots in space");
}

TEST_CASE("Planners are listed for people and for programs") {
    const Workspace work;
    const auto planners = work.json("planners").at("planners");
    REQUIRE_FALSE(planners.empty());
    const std::string text = work.run("planners").out;
    for (const auto& planner : planners) {
        CHECK_THAT(text, Contains(planner.at("name").get<std::string>()));
        CHECK(planner.contains("kind"));
        CHECK_FALSE(planner.at("variants").empty());
        for (const auto& parameter : planner.at("parameters")) {
            CHECK_THAT(text, Contains(parameter.at("name").get<std::string>()));
            CHECK(parameter.at("value").is_number());
        }
    }
}

TEST_CASE("A query at a tilt gives what is left of the ground's effect, and all of a ceiling's") {
    const Workspace work;
    const auto at_tilt = [&](const char* model) {
        return work.json("aeromap query --z-over-r 1 --tilt-deg 30 --model", model).at("points").at(0).at("factor");
    };
    const double x = 1.0 / 15;  // Cheeseman and Bennett's K - 1; sin^2 of 30 degrees is 1/4
    CHECK(at_tilt("cheeseman-bennett").get<double>() == Approx(1 + x * x / (x + 0.37 / 4)).epsilon(1e-12));
    CHECK(at_tilt("sanchez-cuevas").get<double>() == Approx(1 / (1 - 1 / 6.924 / 1.3168 / 1.3168)).epsilon(1e-12));
    check_rejected(work.run("aeromap query --model he --z-over-r 1 --tilt-deg 91"), "expected degrees from -90 to 90");

    // Over the ground and under the deck of the bridge, by side and as a whole.
    const auto points = work.json("aeromap query", problem_file("bridge_inspection"),
                                  "--at 0 0 0.3 --at 0 0 9.8 --tilt-deg 20 --no-cache")
                            .at("points");
    const auto level =
        work.json("aeromap query", problem_file("bridge_inspection"), "--at 0 0 0.3 --at 0 0 9.8 --no-cache")
            .at("points");
    const auto number = [](const auto& of, std::size_t i, const char* name) {
        return of.at(i).at(name).template get<double>();
    };
    CHECK(number(points, 0, "ground") < number(level, 0, "ground"));
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(number(points, i, "ceiling") == number(level, i, "ceiling"));
        CHECK(number(points, i, "factor") ==
              Approx(number(points, i, "ground") + number(points, i, "ceiling") - 1).epsilon(1e-9));
    }
}

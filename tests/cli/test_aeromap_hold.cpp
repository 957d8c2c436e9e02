#include <catch2/catch.hpp>
#include <cmath>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;

TEST_CASE("A hold query tells flyable from stable points and says what competes there") {
    const Workspace work;
    // Far below the deck, close under it, inside the walkway, hanging arm in the ground.
    const auto answer = work.json("aeromap hold", problem_file("bridge_inspection"),
                                  "--arm-deg 90 --at -8 5 --at -8 9.75 --at -3 7.8 --at -8 1");
    CHECK(answer.at("arm_deg") == 90);
    const auto& points = answer.at("points");
    REQUIRE(points.size() == 4);

    const auto& far = points[0];
    CHECK(far.at("verdict") == "stable");
    CHECK(far.at("limit") == "none");
    CHECK(far.at("effect").at("force_factor").get<double>() == Approx(1).epsilon(0.01));
    CHECK(far.at("trim").at("reference").at("x_m").get<double>() == Approx(-8).epsilon(1e-9));
    CHECK(far.at("trim").at("rotor_commands_n").size() == 4);
    CHECK(far.at("stability").at("spectral_radius").get<double>() < 1);
    CHECK(far.at("stability").at("growth_rate_1_s").get<double>() < 0);

    const auto& near = points[1];
    CHECK(near.at("verdict") == "unstable");
    CHECK(near.at("effect").at("force_factor").get<double>() > 1.05);
    CHECK(near.at("stability").at("growth_rate_1_s").get<double>() > 0);
    CHECK(near.at("stability").at("growing_modes").get<int>() >= 1);
    CHECK(near.at("stability").at("force_slope_n_m").get<double>() >
          near.at("stability").at("force_gain_n_m").get<double>());

    CHECK(points[2].at("verdict") == "not_flyable");
    CHECK(points[2].at("effect").is_null());
    CHECK(points[3].at("verdict") == "in_collision");
    for (const char* key : {"trim", "stability"}) {
        CHECK(points[2].at(key).is_null());
        CHECK(points[3].at(key).is_null());
    }
}

TEST_CASE("Near a ceiling a low cap or a short table leaves a hold query without an answer") {
    const Workspace work;
    const auto verdicts = [&](const std::string& aero) {
        const std::string text = problem_text("bridge_inspection");
        REQUIRE(text.find("\naero:") == std::string::npos);
        write_file(work / "capped.yaml", text + aero);
        Words found;
        const nlohmann::json answer = work.json("aeromap hold", work / "capped.yaml",
                                                "--arm-deg 90 --at 1 9.7 --at 1 9.86 --at 1 9.87 --at 1 9.88");
        for (const auto& point : answer.at("points")) {
            CHECK(point.at("stability").is_object());
            found.push_back(point.at("verdict"));
        }
        return found;
    };
    CHECK(verdicts("") == words("unstable unstable unstable unstable"));
    CHECK(verdicts("aero: {max_factor: 1.3}\n") == words("unstable unknown unknown unknown"));
    write_file(work / "k.csv", "z_over_r,factor\n0.9,1.2\n3,1\n");
    const Words measured = verdicts("aero: {ceiling: {model: table, file: k.csv}}\n");
    CHECK(measured[2] == "unknown");
    CHECK(measured[3] == "unknown");
}

TEST_CASE("A hold query prints a table for people, and is rejected without a point or finite numbers") {
    const Workspace work;
    CHECK_THAT(
        work.succeed("aeromap hold", problem_file("bridge_inspection"), "--arm-deg 90 --at -8 5 --at -8 9.74955").out,
        Contains(" 9.74955 ") && Contains("verdict") && Contains("unstable"));
    for (const auto& [options, reason] : {std::pair{"--arm-deg 90", "--at is required"},
                                          {"--arm-deg 90 --at nan 5", "finite coordinates"},
                                          {"--arm-deg 90 --at 1 2 3", "3"},
                                          {"--arm-deg 1e9 --at 0 5", "at most 3600 degrees"}}) {
        CAPTURE(options);
        check_rejected(work.run("aeromap hold", problem_file("bridge_inspection"), options), reason);
    }
}

TEST_CASE("A hold query in space takes places and grids, yaw and joints") {
    const Workspace work;
    const std::string text = "schema: downwash/problem/v1\nname: hold\nrobot: " + std::string(DOWNWASH_PROBLEMS) +
                             "/robots/hexa370_arm3.yaml\n"
                             "environment:\n  bounds: {x_m: [-5, 5], y_m: [-5, 5], z_m: [0.5, 7]}\n"
                             "  obstacles:\n    - {box: {size_m: [20, 10, 1], center_m: [0, 5, 5.5]}}\n"
                             "start: {x_m: 0, y_m: -2, z_m: 2}\ngoal:\n  configuration: {x_m: 1, y_m: 0, z_m: 2}\n";
    write_file(work / "space.yaml", text);
    const auto answer =
        work.json("aeromap hold", work / "space.yaml",
                  "--place 0 -3 2 --place 0 0.1 4.85 --place 0 3 4.94 --yaw-deg 20 --joints-deg 0 10 20");
    CHECK(answer.at("yaw_deg").get<double>() == Approx(20));
    CHECK(answer.at("joints_deg").size() == 3);
    const auto& points = answer.at("points");
    REQUIRE(points.size() == 3);
    CHECK(points[0].at("verdict") == "stable");
    CHECK(points[0].at("trim").at("rotor_commands_n").size() == 6);
    CHECK(points[0].at("trim").at("reference").at("yaw_deg").get<double>() == Approx(20).epsilon(1e-6));
    CHECK(points[0].at("stability").at("growth_rate_1_s").get<double>() < 0);
    // Under the deck's edge the rotors on one side have less to do.
    const auto& commands = points[1].at("trim").at("rotor_commands_n");
    CHECK(std::abs(commands[1].get<double>() - commands[4].get<double>()) > 0.05);
    CHECK(points[2].at("verdict") == "not_flyable");
    CHECK(points[2].at("trim").is_null());

    const auto grid = work.json("aeromap hold", work / "space.yaml", "--low 0 -0.2 4 --high 0 0.2 4.1 --spacing 0.1");
    REQUIRE(grid.at("points").size() == 10);
    CHECK(grid.at("points")[9].at("y_m").get<double>() == Approx(0.2));
    CHECK(grid.at("points")[9].at("z_m").get<double>() == Approx(4.1));
    CHECK_THAT(work.succeed("aeromap hold", work / "space.yaml", "--place 0 -3 2").out,
               Contains("verdict") && Contains("stable"));
    for (const auto& [options, reason] : {std::pair{"", "--place X Y Z"},
                                          {"--at 0 1", "--place and --joints-deg"},
                                          {"--low 0 0 1", "expected both"},
                                          {"--place 0 nan 1", "finite coordinates"},
                                          {"--low 0 0 2 --high 0 0 1", "expected no end below the other"},
                                          {"--low -5 -5 1 --high 5 5 4 --spacing 0.01", "expected a larger one"},
                                          {"--place 0 0 1 --joints-deg 1", "expected 3, one for each joint"}}) {
        CAPTURE(options);
        check_rejected(work.run("aeromap hold", work / "space.yaml", options), reason);
    }
    check_rejected(work.run("aeromap hold", problem_file("bridge_inspection"), "--place 0 0 1"), "expected --at");
}

#include <catch2/catch.hpp>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

TEST_CASE("A hold query tells flyable from stable points and says what competes there") {
    const ScratchFolder folder;
    // Far below the deck, close under it, inside the walkway, hanging arm in the ground.
    const auto answer = run(folder, {"aeromap", "hold", problem_file("bridge_inspection"), "--arm-deg", "90", "--at",
                                     "-8", "5", "--at", "-8", "9.75", "--at", "-3", "7.8", "--at", "-8", "1", "--json"})
                            .json();
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
    const ScratchFolder folder;
    const auto verdicts = [&](const std::string& aero) {
        std::string text = read_file(problem_file("bridge_inspection"));
        const std::string robot = "robots/ars_lrm.yaml";
        const auto at = text.find(robot);
        REQUIRE(at != std::string::npos);
        const std::string problems = problem_file("bridge_inspection");
        text.replace(at, robot.size(), problems.substr(0, problems.rfind('/') + 1) + robot);
        REQUIRE(text.find("\naero:") == std::string::npos);
        write_file(folder / "capped.yaml", text + aero);
        std::vector<std::string> found;
        const auto answer =
            run(folder, {"aeromap", "hold", folder / "capped.yaml", "--arm-deg", "90", "--at", "1", "9.7", "--at", "1",
                         "9.86", "--at", "1", "9.87", "--at", "1", "9.88", "--json"})
                .json();
        for (const auto& point : answer.at("points")) {
            CHECK(point.at("stability").is_object());
            found.push_back(point.at("verdict"));
        }
        return found;
    };
    using Verdicts = std::vector<std::string>;
    CHECK(verdicts("") == Verdicts{"unstable", "unstable", "unstable", "unstable"});
    CHECK(verdicts("aero: {max_factor: 1.3}\n") == Verdicts{"unstable", "unknown", "unknown", "unknown"});
    write_file(folder / "k.csv", "z_over_r,factor\n0.9,1.2\n3,1\n");
    const Verdicts measured = verdicts("aero: {ceiling: {model: table, file: k.csv}}\n");
    CHECK(measured[2] == "unknown");
    CHECK(measured[3] == "unknown");
}

TEST_CASE("A hold query prints a table for people") {
    const ScratchFolder folder;
    const auto answer = run(folder, {"aeromap", "hold", problem_file("bridge_inspection"), "--arm-deg", "90", "--at",
                                     "-8", "5", "--at", "-8", "9.74955"});
    CHECK(answer.code == 0);
    CHECK(answer.out.find(" 9.74955 ") != std::string::npos);
    CHECK(answer.out.find("verdict") != std::string::npos);
    CHECK(answer.out.find("unstable") != std::string::npos);
}

TEST_CASE("A hold query without an arm angle, a point or finite numbers is refused") {
    const ScratchFolder folder;
    const std::string problem = problem_file("bridge_inspection");
    CHECK(run(folder, {"aeromap", "hold", problem, "--at", "0", "5"}).code == 2);
    CHECK(run(folder, {"aeromap", "hold", problem, "--arm-deg", "90"}).code == 2);
    const auto far = run(folder, {"aeromap", "hold", problem, "--arm-deg", "90", "--at", "nan", "5"});
    CHECK(far.code == 2);
    CHECK(far.err.find("finite coordinates") != std::string::npos);
    const auto turned = run(folder, {"aeromap", "hold", problem, "--arm-deg", "1e9", "--at", "0", "5"});
    CHECK(turned.code == 2);
    CHECK(turned.err.find("at most 3600 degrees") != std::string::npos);
}

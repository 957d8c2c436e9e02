#include <catch2/catch.hpp>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

TEST_CASE("A model query gives the formula's values") {
    const ScratchFolder folder;
    const auto answer =
        run(folder, {"aeromap", "query", "--model", "cheeseman-bennett", "--z-over-r", "0.1", "0.5", "1", "--json"})
            .json();
    CHECK(answer.at("model") == "cheeseman-bennett");
    const auto& points = answer.at("points");
    REQUIRE(points.size() == 3);
    CHECK(points[0].at("factor") == 2.0);  // below the pole at 1/4: the cap
    CHECK(points[1].at("z_over_r") == 0.5);
    CHECK(points[1].at("factor").get<double>() == Approx(4.0 / 3).epsilon(1e-12));
    CHECK(points[2].at("factor").get<double>() == Approx(16.0 / 15).epsilon(1e-12));
    const auto capped = run(folder, {"aeromap", "query", "--model", "cheeseman-bennett", "--z-over-r", "0.1",
                                     "--max-factor", "1.5", "--json"});
    CHECK(capped.json().at("points")[0].at("factor") == 1.5);
}

TEST_CASE("A model query takes parameters and the vehicle's other rotors") {
    const ScratchFolder folder;
    const auto factor = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"aeromap", "query", "--json", "--z-over-r", "1", "--model"});
        return run(folder, arguments).json().at("points")[0].at("factor").get<double>();
    };
    CHECK(factor({"multirotor-body"}) == Approx(1.45).margin(0.005));  // of a square quadrotor, d/R = 2.5
    CHECK(factor({"multirotor-body", "--set", "k_b=0"}) == Approx(factor({"multirotor-images"})));
    CHECK(factor({"multirotor-images", "--rotor-spacing", "3.5"}) < factor({"multirotor-images"}));
    CHECK(factor({"li", "--set", "rho=4"}) == Approx(4.0 / 3));
    write_file(folder / "t.csv", "z_over_r,factor\n0.5,1.2\n1,0.9\n3,1\n");
    CHECK(factor({"table", "--table", folder / "t.csv"}) == 0.9);
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"li", "--set", "rh=4"},
                                                  {"li", "--set", "rho=-1"},
                                                  {"li", "--rotor-spacing", "3"},
                                                  {"table"},
                                                  {"he", "--table", folder / "t.csv"},
                                                  {"table", "--table", folder / "t.csv", "--d-over-r", "1"}}) {
        std::vector<std::string> arguments{"aeromap", "query", "--z-over-r", "1", "--model"};
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        CHECK(run(folder, arguments).code == 2);
    }
}

TEST_CASE("Many points are read from a file, and a point has three coordinates") {
    const ScratchFolder folder;
    const std::string bridge = problem_file("bridge_inspection");
    write_file(folder / "points.txt", "# hubs\nx_m,y_m,z_m\n0, 0.32, 9.8\n\n1 0 3 # free air\n");
    const auto points =
        run(folder, {"aeromap", "query", bridge, "--points", folder / "points.txt", "--json"}).json().at("points");
    REQUIRE(points.size() == 2);
    CHECK(points[0].at("factor").get<double>() > 1.05);
    CHECK(points[1].at("x_m") == 1);
    write_file(folder / "points.txt", "0 0 1\n0 zero 1\n");
    const Result broken = run(folder, {"aeromap", "query", bridge, "--points", folder / "points.txt"});
    CHECK(broken.code == 2);
    CHECK(broken.err.find("points.txt:2:") != std::string::npos);
    CHECK(run(folder, {"aeromap", "query", bridge, "--at", "1", "2", "3", "4"}).code == 2);
    CHECK(run(folder, {"aeromap", "query", bridge, "--at", "1", "2"}).code == 2);
    CHECK(run(folder, {"aeromap", "hold", bridge, "--arm-deg", "90", "--at", "1", "2", "3"}).code == 2);
}

TEST_CASE("Many points are read from standard input, after those of the command line") {
    const ScratchFolder folder;
    const std::string bridge = problem_file("bridge_inspection");
    const auto query = [&](std::vector<std::string> arguments, const std::string& input) {
        arguments.insert(arguments.begin(), {"aeromap", "query", bridge});
        return run(folder, arguments, {}, input);
    };
    const auto piped =
        query({"--points", "-", "--at", "1", "0", "3", "--json"}, "x_m,y_m,z_m\n0 0.32 9.8\n\n1,0,4 # free air").json();
    REQUIRE(piped.at("points").size() == 3);
    CHECK(piped ==
          query({"--at", "1", "0", "3", "--at", "0", "0.32", "9.8", "--at", "1", "0", "4", "--json"}, "").json());
    const Result broken = query({"--points", "-"}, "0 0 1\n0 zero 1\n");
    CHECK(broken.code == 2);
    CHECK(broken.err.find("standard input:2: '0 zero 1': expected three numbers") != std::string::npos);
    const Result nothing = query({"--points", "-"}, "");
    CHECK(nothing.code == 2);
    CHECK(nothing.err.find("--points -: holds no point") != std::string::npos);
}

TEST_CASE("A grid that was built flies like its problem and tells what made it") {
    const ScratchFolder folder;
    const std::string file = folder / "map.vti";
    REQUIRE(run(folder, {"aeromap", "build", problem_file("open_air"), "--step", "0.25", "-o", file}).code == 0);
    const auto info = run(folder, {"aeromap", "info", file, "--json"}).json();
    CHECK(info.at("kind") == "planar");
    CHECK(info.at("lateral_offsets_m").size() == 2);
    CHECK(info.at("x").at("step_m").get<double>() <= 0.25);
    CHECK(info.at("provenance").dump().find("cheeseman-bennett") != std::string::npos);
    const std::string volume = folder / "volume.csv";
    REQUIRE(
        run(folder, {"aeromap", "build", problem_file("open_air"), "--step", "1", "--lateral", "-1", "1", "-o", volume})
            .code == 0);
    CHECK(run(folder, {"aeromap", "info", volume, "--json"}).json().at("kind") == "volume");
}

TEST_CASE("A point query superposes both sides and is null where not flyable") {
    const ScratchFolder folder;
    // Under the deck; on a rotor's plane, where the map answers; and inside the walkway.
    const auto points = run(folder, {"aeromap", "query", problem_file("bridge_inspection"), "--at", "0", "0", "9.8",
                                     "--at", "0", "0.32", "9.8", "--at", "-3", "0", "7.8", "--json"})
                            .json()
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

TEST_CASE("Planners are listed for people and for programs") {
    const ScratchFolder folder;
    const auto planners = run(folder, {"planners", "--json"}).json().at("planners");
    REQUIRE_FALSE(planners.empty());
    const std::string text = run(folder, {"planners"}).out;
    for (const auto& planner : planners) {
        CHECK(text.find(planner.at("name").get<std::string>()) != std::string::npos);
        CHECK(planner.contains("kind"));
        CHECK_FALSE(planner.at("variants").empty());
        for (const auto& parameter : planner.at("parameters")) {
            CHECK(text.find(parameter.at("name").get<std::string>()) != std::string::npos);
            CHECK(parameter.at("value").is_number());
        }
    }
}

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
        CHECK(planner.contains("parameters"));
    }
}

#include "downwash/report/validation_page.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "../support/test_problem.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/report/run_page.hpp"

using namespace downwash;
using nlohmann::json;

namespace {

ValidationRecord validation() {
    ValidationRecord record;
    record.findings = R"({"outcome": "collision", "disagreements": [{"what": "</script>", "file": 1, "judge": 2}]})";
    record.solution_text = R"({"plan": {"waypoints": [], "reference": []}, "execution": null})";
    record.seed = 7;
    record.command = "downwash validate problem.yaml --plan run --runs 3 --seed 7";
    record.clearance = ClearanceOverTime{0.1, {0, 1}, {0, 1}, {0.5, 1}, {0.5, INFINITY}};
    PlayableFlight flight;
    flight.world = 3;
    flight.outcome = "collision";
    flight.rows.names = {"t_s", "x_m"};
    flight.rows.columns = {{0, 0.01}, {1, 2}};
    flight.scene_x_m = 0.02;
    flight.lateral_m = -0.03;
    record.flights = {flight};
    return record;
}

}  // namespace

TEST_CASE("the page of a validation carries findings, plan, flights and the scene") {
    Problem problem = test::ceiling_problem();
    const auto model = make_flight_model(problem);
    const std::string text = validation_page_data(validation(), problem, *model);
    CHECK(text.find_first_of("<>&") == std::string::npos);
    const json data = json::parse(text);
    CHECK(data["schema"] == "downwash/validation-report/v1");
    CHECK(data["findings"] == json::parse(validation().findings));
    CHECK(data["plan"] == json::parse(validation().solution_text)["plan"]);
    CHECK(data["seed"] == 7);
    CHECK(data["clearance"]["p10"] == json({0.5, 1.0}));
    CHECK(data["clearance"]["p50"][1].is_null());  // no obstacles
    const json& flight = data["flights"][0];
    CHECK(flight["world"] == 3);
    CHECK(flight["scene_offset_m"] == json({0.02, 0.0}));
    CHECK(flight["lateral_m"] == -0.03);
    CHECK(flight["flight"]["rows"] == 2);
    CHECK(flight["flight"]["columns"] == json({"t_s", "x_m"}));
    CHECK(data["scene"]["obstacles"].size() == problem.obstacles.size());
    CHECK(data["map"]["factor_high"] > 1.05);
    problem.aero.enabled = false;
    CHECK(json::parse(validation_page_data(validation(), problem, *make_flight_model(problem)))["map"].is_null());
    problem.aero.enabled = true;
    if (has_pages()) {
        CHECK(validation_page(validation(), problem, *model).find(text) != std::string::npos);
    }
}

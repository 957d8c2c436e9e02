#include "downwash/report/run_page.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../support/solved_run.hpp"
#include "downwash/report/run_figures.hpp"
#include "packed_flights.hpp"

using namespace downwash;
using nlohmann::json;
using test::columns_of;
using test::SolvedRun;
using test::unpacked;

namespace {

json data_of(const SolvedRun& run) {
    const RunRecord record = read_run(run.folder());
    const auto model = make_flight_model(record.problem);
    return json::parse(run_page_data(record, *model));
}

template <class Number>
Number number_at(const std::string& bytes, std::size_t index) {
    Number number;
    std::memcpy(&number, bytes.data() + index * sizeof(Number), sizeof(Number));
    return number;
}

}  // namespace

TEST_CASE("the command of a page repeats an execution in another world or in free air") {
    const SolvedRun run;
    RunRecord record = read_run(run.folder());
    const auto command_with = [&](const json& execution) {
        json solution = json::parse(record.solution_text);
        solution["execution"].update(execution);
        RunRecord other = record;
        other.solution_text = solution.dump();
        return json::parse(run_page_data(other, *make_flight_model(run.problem)))["command"].get<std::string>();
    };
    CHECK(command_with({{"world", {{"index", 17}, {"seed", 3}}}}) ==
          "downwash execute effective.yaml --plan solution.json --world 17 --seed 3 --out again");
    // Of a file that somebody changed.
    for (const json& world : {json::object(), json{{"index", 17}}, json{{"index", "17; date"}, {"seed", 3}}}) {
        CHECK(command_with({{"world", world}}) == "downwash execute effective.yaml --plan solution.json --out again");
    }
    CHECK(command_with({{"aero", false}}) ==
          "downwash execute effective.yaml --plan solution.json --aero off --out again");
}

TEST_CASE("the page of a run says what its command does not repeat, and of which plan it takes over") {
    const SolvedRun run;
    RunRecord record = read_run(run.folder());
    const auto model = make_flight_model(run.problem);
    CHECK(json::parse(run_page_data(record, *model))["command_note"] == "");
    json solution = json::parse(record.solution_text);
    solution["planning"]["candidates"]["unfinished"] = 1;
    record.solution_text = solution.dump();
    CHECK(json::parse(run_page_data(record, *model))["command_note"] == "");  // iterations ended it
    record.problem.planner.max_iterations.reset();
    const json timed = json::parse(run_page_data(record, *model));
    CHECK(timed["command"] == "downwash solve effective.yaml --max-iterations 200");
    CHECK(timed["command_note"] ==
          "This repeats the search, but not byte for byte: its time ended while a plan was being checked.");
    solution["replanned"] = {{"plan", "first"}, {"t_s", 6.5}, {"rest", {{"outcome", "ok"}, {"cost", 1}}}};
    solution["problem"]["file"] = "changed.yaml";
    record.solution_text = solution.dump();
    const json taken_over = json::parse(run_page_data(record, *model));
    CHECK(taken_over["command"] == "downwash replan changed.yaml --plan first --after 6.5 --max-iterations 200");
    CHECK_THAT(taken_over["command_note"].get<std::string>(), Catch::Contains("Where the first command was given"));
}

TEST_CASE("a page carries the flight to the last bit, each column once, the solution, the command and the tree") {
    const SolvedRun run;
    const RunRecord record = read_run(run.folder());
    const json data = data_of(run);
    CHECK(data["schema"] == "downwash/report/v1");
    CHECK(data["flight"]["columns"] == json(record.flight.names));
    const auto columns = columns_of(data["flight"]);
    REQUIRE(columns.size() == record.flight.columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
        CAPTURE(record.flight.names[i]);
        CHECK(columns[i] == record.flight.columns[i]);
    }
    CHECK(data["flight"]["same_as"] != json(std::vector<int>(columns.size(), -1)));

    CHECK(data["solution"] == json::parse(record.solution_text));
    CHECK(data["command"] == "downwash solve effective.yaml --max-iterations 200");
    CHECK(data["goal_order"] == "single");
    CHECK(data["goals"].size() == 1);

    const std::vector<TreeNode>& tree = run.solution.tree;
    REQUIRE(data["tree"]["nodes"] == tree.size());
    const std::string bytes = unpacked(data["tree"]["data"], tree.size() * 16);
    for (std::size_t i = 0; i < tree.size(); ++i) {
        CHECK(number_at<float>(bytes, i) == static_cast<float>(tree[i].at[plane::x]));
        CHECK(number_at<float>(bytes, tree.size() + i) == static_cast<float>(tree[i].at[plane::z]));
        CHECK(number_at<std::int32_t>(bytes, 3 * tree.size() + i) == tree[i].parent);
    }
}

TEST_CASE("a page's aero map is that of the first rotor within its steps") {
    const SolvedRun run;
    const json map = data_of(run)["map"];
    const auto model = make_flight_model(run.problem);
    const auto columns = map["columns"].get<std::size_t>();
    const auto rows = map["rows"].get<std::size_t>();
    const double low = map["factor_low"], high = map["factor_high"], cell_m = map["cell_m"];
    CHECK(low <= 1);
    CHECK(high > 1.05);
    const std::string levels = unpacked(map["levels"], columns * rows);
    std::size_t flyable = 0;
    for (std::size_t i = 0; i < levels.size(); i += 7) {
        const std::size_t column = i % columns;
        const std::size_t row = i / columns;
        const double x_m = map["x_low_m"].get<double>() + cell_m * static_cast<double>(column);
        const double z_m = map["z_low_m"].get<double>() + cell_m * static_cast<double>(row);
        const int level = static_cast<unsigned char>(levels[i]);
        const Vector3 hub_m = run.problem.plane.to_world(x_m, model->rotor_lateral_m(0), z_m);
        REQUIRE(model->effect(0).is_flyable(hub_m) == (level != 255));
        if (level != 255) {
            ++flyable;
            REQUIRE(std::abs(low + (high - low) * level / 254 - model->effect(0).factor(hub_m)) <
                    0.501 * (high - low) / 254);
        }
    }
    CHECK(flyable > levels.size() / 14);
}

TEST_CASE("a page has the classes and colours of the pictures of the same problem") {
    const SolvedRun run;
    const json data = data_of(run), shown = data["map"]["scale"];
    const RunRecord record = read_run(run.folder());
    const ColorScale scale = snapshot_figure(record, *make_flight_model(record.problem)).scale;
    CHECK(scale.limits.front() == 1);
    CHECK(shown["limits"] == json(scale.limits));
    REQUIRE(shown["colors"].size() == scale.colors.size());
    for (std::size_t i = 0; i < scale.colors.size(); ++i) {
        const auto rgb =
            static_cast<std::uint32_t>(std::stoul(shown["colors"][i].get<std::string>().substr(1), nullptr, 16));
        CHECK(color_of(rgb) == scale.colors[i]);
    }
}

TEST_CASE("obstacles stand on a page as the plane cuts them, as they project, and as solids") {
    Problem problem = test::ceiling_problem();
    problem.obstacles.push_back({"ball", Sphere{0.5}, {-3, 4, 9}, {}});
    const SolvedRun run(problem);
    const json obstacles = data_of(run)["scene"]["obstacles"];
    const json& ball = obstacles.back();
    CHECK(ball["name"] == "ball");
    CHECK(ball["kind"] == "sphere");
    CHECK(ball["section"].empty());
    CHECK(ball["projection"][0].size() == 96);
    CHECK(ball["solid"]["sphere"]["center_m"] == json({-3., 4., 9.}));
    CHECK_FALSE(obstacles[0]["section"].empty());
    CHECK_FALSE(obstacles[0]["projection"].empty());
}

TEST_CASE("no text of a problem ends the script element that carries it") {
    Problem problem = test::ceiling_problem();
    problem.description = "</script><script>alert(1)</script> <!-- & \xE2\x80\xA8 \xF0\x9F\x98\x80 \xD7\xA9";
    problem.obstacles[0].name = "</script>\"'";
    const SolvedRun run(problem);
    const RunRecord record = read_run(run.folder());
    const auto model = make_flight_model(record.problem);
    const std::string text = run_page_data(record, *model);
    CHECK(text.find_first_of("<>&") == std::string::npos);
    CHECK(std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; }));
    const json data = json::parse(text);
    CHECK(data["description"] == problem.description);
    CHECK(data["scene"]["obstacles"][0]["name"] == problem.obstacles[0].name);
    if (has_pages()) {
        const std::string page = run_page(record, *model);
        CHECK(page.find(text) != std::string::npos);
        CHECK(page.find("{\"downwash\":\"run\"}") == std::string::npos);
    }
}

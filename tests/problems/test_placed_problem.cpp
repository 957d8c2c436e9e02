#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>

#include "downwash/base/key_error.hpp"
#include "downwash/problems/placed_problem.hpp"
#include "downwash/problems/problem_writer.hpp"

namespace {

using namespace downwash;
using Catch::Contains;

const std::string open_air = DOWNWASH_PROBLEMS "/open_air.yaml";

std::string text_of(const std::string& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// The errors of a change; empty if there are none.
std::string errors_of(const PlacedProblem& problem, const KeyChange& change) {
    try {
        static_cast<void>(changed_problem(problem, std::span(&change, 1)));
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("The text of a problem gives the problem of the file, with places in the text") {
    const std::string text = text_of(open_air);
    const PlacedProblem of_text = parse_problem(text, DOWNWASH_PROBLEMS "/<text>");
    CHECK(problem_sha256(of_text.plannable.problem) == problem_sha256(read_problem(open_air)));
    CHECK_THROWS_WITH(parse_problem(text + "\nfoo: 3\n", DOWNWASH_PROBLEMS "/<text>"),
                      Contains("<text>:") && Contains("unknown key 'foo'"));
}

TEST_CASE("A changed value changes nothing else of a problem") {
    const PlacedProblem before = read_placed_problem(open_air);
    const KeyChange changes[] = {{"planner.seed", "7"},
                                 {"planner.time_limit_s", "null"},
                                 {"environment.obstacles[0].box.size_m", "[30, 40, 1]"}};
    Problem expected = before.plannable.problem;
    expected.planner.seed = 7;
    expected.planner.time_limit_s.reset();
    std::get<Box>(expected.obstacles.at(0).shape).size_m = {30, 40, 1};
    const PlacedProblem after = changed_problem(before, changes);
    CHECK(effective_yaml(after.plannable.problem, "/") == effective_yaml(expected, "/"));
}

TEST_CASE("A change that is none says why") {
    const PlacedProblem problem = read_placed_problem(open_air);
    CHECK_THAT(errors_of(problem, {"planner.sed", "7"}), Contains("did you mean 'seed'"));
    CHECK_THAT(errors_of(problem, {"planner", "7"}), Contains("is a group of keys"));
    CHECK_THAT(errors_of(problem, {"goal.end_effector.x_m", "7"}), Contains("its group is not there"));
    CHECK_THAT(errors_of(problem, {"planner.seed", "7, 8"}), Contains("expected one value"));
    CHECK_THAT(errors_of(problem, {"planner.seed", "-1"}), Contains("expected a whole number"));
}

TEST_CASE("A change that makes a problem impossible is placed where the file has the key") {
    const PlacedProblem problem = read_placed_problem(open_air);
    const std::string error = errors_of(problem, {"start.z_m", "-0.5"});
    CHECK_THAT(error, Contains("open_air.yaml:") && Contains("start"));
}

TEST_CASE("Keys without a meaning are errors of a text unless they are to be left out") {
    const std::string text = text_of(open_air) + "\nplanner: {worlds: 3}\n";
    const std::size_t at = text.find("uncertainty: {}");
    REQUIRE(at != std::string::npos);
    const std::string certain = std::string(text).replace(at, 15, "uncertainty: none");
    CHECK_THROWS_WITH(parse_problem(certain, DOWNWASH_PROBLEMS "/<text>"),
                      Contains("planner.worlds has a meaning only with an uncertainty"));
    CHECK_FALSE(parse_problem(certain, DOWNWASH_PROBLEMS "/<text>", true).plannable.problem.uncertainty);
}

TEST_CASE("The JSON of a problem holds what its YAML does") {
    const Problem problem = read_problem(open_air);
    const auto json = nlohmann::json::parse(effective_json(problem, DOWNWASH_PROBLEMS));
    CHECK(json["name"] == "open_air");
    CHECK(json["planner"]["max_iterations"].is_null());
    CHECK(json["environment"]["bounds"]["x_m"] == nlohmann::json({-10, 10}));
    CHECK(json["planner"]["variant"] == "mp-arm-ada");
    const PlacedProblem again = parse_problem(json.dump(), DOWNWASH_PROBLEMS "/<json>");
    CHECK(effective_json(again.plannable.problem, DOWNWASH_PROBLEMS) == effective_json(problem, DOWNWASH_PROBLEMS));
}

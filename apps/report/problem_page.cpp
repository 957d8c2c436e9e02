#include "downwash/report/problem_page.hpp"

#include <nlohmann/json.hpp>
#include <optional>

#include "downwash/base/version.hpp"
#include "downwash/report/page_scene.hpp"
#include "downwash/report/page_template.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

/// The solution.json of a search that has not begun.
Json unplanned(const Problem& problem, const ProblemReference& reference) {
    Solution solution;
    solution.variant = problem.planner.variant;
    solution.algorithm = problem.planner.algorithm;
    solution.objective = problem.planner.objective;
    solution.seed = problem.planner.seed;
    Json json = Json::parse(solution_json(solution, reference));
    json["status"] = "unplanned";
    json.erase("planning");
    return json;
}

}  // namespace

std::string problem_page_data(const Problem& problem, const ProblemReference& reference, const std::string& text,
                              const FlightModel& model, int threads) {
    Json page{{"schema", "downwash/report/v1"},
              {"version", version()},
              {"command", nullptr},
              {"solution", unplanned(problem, reference)},
              {"cost_unit", unit_of(problem.planner.objective)},
              {"effective_yaml", text},
              {"flight", nullptr},
              {"tree", nullptr}};
    add_problem(page, problem, std::nullopt, model, threads);
    return page_data(page);
}

std::string problem_page(const Problem& problem, const ProblemReference& reference, const std::string& text,
                         const FlightModel& model, int threads) {
    return filled_page(run_page_template(), problem_page_data(problem, reference, text, model, threads));
}

}  // namespace downwash

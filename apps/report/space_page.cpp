#include "downwash/report/space_page.hpp"

#include <nlohmann/json.hpp>

#include "downwash/base/version.hpp"
#include "downwash/problems/objective.hpp"
#include "downwash/report/page_flight.hpp"
#include "downwash/report/page_template.hpp"
#include "downwash/report/space_page_scene.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

Json parsed_or_null(const std::string& text) {
    return text.empty() ? Json() : Json::parse(text);
}

Json list_of(const std::string& text) {
    return text.empty() ? Json::array() : Json::parse(text);
}

}  // namespace

SpaceRun shown_run(const SpaceRunRecord& record) {
    const Json solution = Json::parse(record.solution_text);
    return {record.flight,
            record.solution_text,
            record.problem_text,
            {},
            command_of_execution(solution),
            solution.value("warnings", Json::array()).dump(),
            record.order};
}

std::string space_page_data(const SpaceProblem& problem, const SpaceRun& run) {
    Json page{{"schema", "downwash/space-report/v1"},
              {"version", version()},
              {"name", problem.name},
              {"description", problem.description},
              {"command", run.command},
              {"solution", parsed_or_null(run.solution_text)},
              {"cost_unit", unit_of(problem.planner.objective)},
              {"warnings", list_of(run.warnings)},
              {"findings", parsed_or_null(run.findings)},
              {"effective_yaml", run.problem_text},
              {"flight", flight_json(run.flight)}};
    add_space_problem(page, problem, run.order);
    return page_data(page);
}

std::string space_page(const SpaceProblem& problem, const SpaceRun& run) {
    return filled_page(space_page_template(), space_page_data(problem, run));
}

}  // namespace downwash

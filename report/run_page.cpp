#include "downwash/report/run_page.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "downwash/base/version.hpp"
#include "downwash/report/packed_numbers.hpp"
#include "downwash/report/page_scene.hpp"
#include "downwash/report/page_template.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

bool are_same(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    });
}

/// Equal columns, such as those of rotors one behind the other, are stored once.
Json flight_json(const NumberTable& flight) {
    if (flight.rows() == 0) {
        return {};
    }
    PackedNumbers packed;
    std::vector<int> same_as;
    for (std::size_t i = 0; i < flight.columns.size(); ++i) {
        const auto end = flight.columns.begin() + static_cast<std::ptrdiff_t>(i);
        const auto twin = std::find_if(flight.columns.begin(), end,
                                       [&](const auto& column) { return are_same(column, flight.columns[i]); });
        same_as.push_back(twin == end ? -1 : static_cast<int>(twin - flight.columns.begin()));
        if (twin == end) {
            packed.add_smooth(flight.columns[i]);
        }
    }
    return {{"rows", flight.rows()}, {"columns", flight.names}, {"same_as", same_as}, {"data", packed.text()}};
}

Json tree_json(const NumberTable& tree) {
    if (tree.rows() == 0) {
        return {};
    }
    PackedNumbers packed;
    for (const char* name : {"x_m", "z_m", "arm_rad"}) {
        const std::vector<double>& column = *tree.find(name);
        packed.add(std::vector<float>(column.begin(), column.end()));
    }
    std::vector<std::int32_t> parents;
    for (const double parent : *tree.find("parent")) {
        parents.push_back(std::isnan(parent) ? -1 : static_cast<std::int32_t>(parent));
    }
    packed.add(parents);
    return {{"nodes", tree.rows()}, {"data", packed.text()}};
}

/// The command that repeats the run in its folder: to the byte, unless several goals in turn shared a time limit.
std::string command_of(const Problem& problem, const Json& solution) {
    const Json::json_pointer aero("/execution/aero"), iterations("/planning/iterations");
    if (solution.contains(aero) && solution[aero] == false) {
        return "downwash execute effective.yaml --plan solution.json --aero off --out again";
    }
    std::string command = "downwash solve effective.yaml";
    const bool is_split_by_time = !problem.stops.empty() && !problem.planner.max_iterations;
    if (!is_split_by_time && solution.contains(iterations) && solution[iterations].is_number_unsigned() &&
        solution[iterations] > 0) {
        command += " --max-iterations " + solution[iterations].dump();
    }
    return command;
}

}  // namespace

bool has_pages() noexcept {
    return !run_page_template().empty();
}

std::string run_page_data(const RunRecord& run, const FlightModel& model, const AeroMap* map) {
    const Problem& problem = run.problem;
    const Json solution = Json::parse(run.solution_text);
    const Json page{
        {"schema", "downwash/report/v1"},
        {"version", version()},
        {"command", command_of(problem, solution)},
        {"solution", solution},
        {"cost_unit", unit_of(problem.planner.objective)},
        {"effective_yaml", run.problem_text},
        {"description", problem.description},
        {"scene", scene_json(problem, model.effect(0).scene())},
        {"robot", robot_json(problem.robot)},
        {"start",
         {{"x_m", problem.start.x_m},
          {"z_m", problem.start.z_m},
          {"pitch_rad", problem.start.pitch_rad},
          {"arm_rad", problem.start.arm_rad}}},
        {"goals", goals_json(problem)},
        {"goal_order", goal_order(problem)},
        {"limits",
         {{"safety_margin_m", problem.planner.safety_margin_m},
          {"max_tilt_rad", std::visit([](const auto& law) { return law.max_tilt_rad; }, problem.robot.controller.law)},
          {"max_joint_torque_nm", problem.robot.arm.max_torque_nm}}},
        {"map", map != nullptr ? map_json(problem, model, *map) : Json()},
        {"flight", flight_json(run.flight)},
        {"tree", tree_json(run.tree)}};
    return page_data(page);
}

std::string run_page(const RunRecord& run, const FlightModel& model, const AeroMap* map) {
    return filled_page(run_page_template(), run_page_data(run, model, map));
}

}  // namespace downwash

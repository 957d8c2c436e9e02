#include "downwash/problems/run_record.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "downwash/base/fault.hpp"
#include "downwash/base/files.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/solution_file.hpp"

namespace downwash {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_file = 256UL * 1024 * 1024;  // bytes
constexpr int deepest_nesting = 32;

[[noreturn]] void refuse(const fs::path& file, const std::string& message) {
    throw InputError({Fault{"", file.string() + ": " + message}});
}

std::string text_of(const fs::path& file) {
    std::string text;
    try {
        text = read_file(file, largest_file + 1);
    } catch (const FileError& fault) {
        throw InputError({Fault{"", file.string() + " " + fault.what()}});
    }
    if (text.size() > largest_file) {
        refuse(file, "larger than " + std::to_string(largest_file >> 20U) + " MiB, more than any run leaves behind");
    }
    return text;
}

/// @return whether there is a plan
bool check_solution(const fs::path& file, const std::string& text) {
    using Json = nlohmann::json;
    bool is_deep = false;
    const Json solution = Json::parse(
        text,
        [&is_deep](int depth, Json::parse_event_t, Json&) {
            is_deep = is_deep || depth > deepest_nesting;
            return !is_deep;
        },
        false);
    if (solution.is_discarded() || is_deep || !solution.is_object()) {
        refuse(file, "this is not the JSON that `downwash solve` writes");
    }
    const auto schema = solution.find("schema");
    if (schema == solution.end() || *schema != solution_schema) {
        refuse(file, "its schema is not " + std::string(solution_schema));
    }
    const auto plan = solution.find("plan");
    return plan != solution.end() && !plan->is_null();
}

/// The parent of every node is a row of the table, or nothing.
void check_tree(const fs::path& file, const NumberTable& tree) {
    const std::vector<double>& parents = *tree.find("parent");
    const auto rows = static_cast<double>(parents.size());
    for (std::size_t i = 0; i < parents.size(); ++i) {
        const double parent = parents[i];
        if (!std::isnan(parent) && !(parent >= 0 && parent < rows && parent == std::floor(parent))) {
            throw InputError({Fault{"", file.string() + ":" + std::to_string(i + 2) + ": parent is " + to_text(parent) +
                                            ", expected a row of this file, counted from 0"}});
        }
    }
}

std::vector<std::string> flight_columns(const Robot& robot) {
    std::vector<std::string> names{"t_s",    "ref_x_m",   "ref_z_m",  "ref_arm_rad",     "x_m",
                                   "z_m",    "pitch_rad", "arm_rad",  "clearance_m",     "ee_x_m",
                                   "ee_z_m", "power_w",   "energy_j", "aero_factor_min", "aero_factor_max"};
    for (std::size_t i = 1; i <= robot.rotors.positions_m.size(); ++i) {
        const std::string rotor = "rotor_" + std::to_string(i);
        names.push_back(rotor + "_cmd_n");
        names.push_back(rotor + "_aero_factor");
    }
    return names;
}

/// Only the clearance may be empty, where there are no obstacles.
void check_flight(const fs::path& file, const NumberTable& flight) {
    for (std::size_t column = 0; column < flight.columns.size(); ++column) {
        for (std::size_t row = 0; row < flight.rows(); ++row) {
            if (flight.names[column] != "clearance_m" && std::isnan(flight.columns[column][row])) {
                throw InputError(
                    {{"", file.string() + ":" + std::to_string(row + 2) + ": " + flight.names[column] + " is empty"}});
            }
        }
    }
}

}  // namespace

RunRecord read_run(const fs::path& folder) {
    if (!fs::is_directory(folder)) {
        refuse(folder, "there is no such folder; expected one that `downwash solve` wrote");
    }
    RunRecord run;
    const fs::path solution = folder / "solution.json";
    run.solution_text = text_of(solution);
    const bool has_plan = check_solution(solution, run.solution_text);
    const fs::path problem = folder / "effective.yaml";
    run.problem_text = text_of(problem);
    run.problem = read_problem(problem);
    if (has_plan) {
        run.plan = read_solution(solution.string(), run.problem).plan;
    }
    const fs::path flight = folder / "trajectory.csv";
    run.flight = read_number_table(text_of(flight), flight.string(), flight_columns(run.problem.robot));
    check_flight(flight, run.flight);
    const fs::path tree = folder / "tree.csv";
    if (fs::exists(tree)) {
        run.tree = read_number_table(text_of(tree), tree.string(), {"x_m", "z_m", "arm_rad", "parent"});
        check_tree(tree, run.tree);
    }
    return run;
}

}  // namespace downwash

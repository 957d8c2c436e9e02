#include "downwash/results/run_record.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/sha256.hpp"
#include "downwash/base/text.hpp"
#include "downwash/controllers/space_axes.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/space_problem_writer.hpp"
#include "downwash/results/result_limits.hpp"
#include "downwash/results/solution_file.hpp"
#include "downwash/results/space_trajectory_csv.hpp"
#include "downwash/results/trajectory_csv.hpp"
#include "downwash/results/tree_csv.hpp"

namespace downwash {
namespace {

namespace fs = std::filesystem;

constexpr int deepest_nesting = 32;
constexpr char solution_name[] = "solution.json";

[[noreturn]] void report(const fs::path& file, const std::string& message) {
    throw InputError({KeyError{"", file.string() + ": " + message}});
}

std::string text_of(const fs::path& file, std::size_t max_bytes = max_table_bytes) {
    return naming(file, [&] { return read_whole_file(file, max_bytes); });
}

std::string text_at(const nlohmann::json& json, const char* pointer) {
    const nlohmann::json::json_pointer place(pointer);
    return json.contains(place) && json[place].is_string() ? json[place].get<std::string>() : "";
}

/// What solution.json says of itself and of the files beside it.
struct RunClaims {
    bool has_plan = false;
    ProblemReference problem;
    FileDigests files;  ///< empty in solutions of former versions
};

/// @param run a RunRecord or SpaceRunRecord
template <class Record>
RunClaims take_solution(const fs::path& file, Record& run) {
    using Json = nlohmann::json;
    bool is_deep = false;
    const Json solution = Json::parse(
        run.solution_text,
        [&is_deep](int depth, Json::parse_event_t, Json&) {
            is_deep = is_deep || depth > deepest_nesting;
            return !is_deep;
        },
        false);
    if (solution.is_discarded() || is_deep || !solution.is_object()) {
        report(file, "this is not the JSON that `downwash solve` writes");
    }
    if (text_at(solution, "/schema") != solution_schema) {
        report(file, "its schema is not " + std::string(solution_schema));
    }
    run.status = text_at(solution, "/status");
    run.outcome = text_at(solution, "/execution/outcome");
    RunClaims claims;
    const auto plan = solution.find("plan");
    claims.has_plan = plan != solution.end() && !plan->is_null();
    claims.problem = {text_at(solution, "/problem/name"), text_at(solution, "/problem/file"),
                      text_at(solution, "/problem/sha256")};
    if (const auto files = solution.find("files"); files != solution.end() && files->is_object()) {
        for (const auto& [name, digest] : files->items()) {
            claims.files[name] = digest.is_string() ? digest.template get<std::string>() : "";
        }
    }
    return claims;
}

/// @throws InputError if a digest that solution.json holds is another
void check_digest(const fs::path& file, const std::string& digest, const std::string& claimed) {
    if (!claimed.empty() && digest != claimed) {
        report(file,
               "this is not the file that the run of the solution.json beside it wrote: it was changed, or another "
               "run wrote into this folder. Plan again with `downwash solve`, or execute that plan alone again with "
               "`downwash execute PROBLEM --plan " +
                   (file.parent_path() / solution_name).string() + "`");
    }
}

/// The same for a file by its content.
void check_file(const fs::path& file, const std::string& content, const FileDigests& digests) {
    const auto claimed = digests.find(file.filename().string());
    if (claimed != digests.end()) {
        check_digest(file, sha256_hex(content), claimed->second);
    }
}

/// The same for the problem in effective.yaml.
template <class AnyProblem>
void check_problem(const fs::path& file, const AnyProblem& problem, const RunClaims& claims) {
    check_digest(file, problem_sha256(problem), claims.problem.sha256);
}

[[noreturn]] void throw_at_row(const fs::path& file, const NumberTable& table, std::size_t row,
                               const std::string& message) {
    throw InputError({KeyError{"", file.string() + ":" + std::to_string(table.lines[row]) + ": " + message}});
}

/// @param may_be_empty the one column whose cells may be
void check_numbers(const fs::path& file, const NumberTable& table, std::string_view may_be_empty) {
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
        for (std::size_t row = 0; row < table.rows(); ++row) {
            const double number = table.columns[column][row];
            if (std::isnan(number) && table.names[column] != may_be_empty) {
                throw_at_row(file, table, row, table.names[column] + " is empty");
            }
            if (std::abs(number) > max_result) {
                throw_at_row(file, table, row, table.names[column] + " is " + to_text(number) + ", beyond +-1e30");
            }
        }
    }
}

/// Every node leads back to a root.
void check_tree(const fs::path& file, const NumberTable& tree) {
    check_numbers(file, tree, "parent");
    const std::vector<double>& parents = *tree.find("parent");
    const auto rows = static_cast<double>(parents.size());
    for (std::size_t i = 0; i < parents.size(); ++i) {
        if (!std::isnan(parents[i]) &&
            !(parents[i] >= 0 && parents[i] < rows && parents[i] == std::floor(parents[i]))) {
            throw_at_row(file, tree, i,
                         "parent is " + to_text(parents[i]) + ", expected a row of this file, counted from 0");
        }
    }
    std::vector<std::size_t> seen_from(parents.size(), parents.size());  // the row from which each was reached first
    for (std::size_t i = 0; i < parents.size(); ++i) {
        std::size_t here = i;
        while (seen_from[here] == parents.size()) {
            seen_from[here] = i;
            if (std::isnan(parents[here])) {
                break;
            }
            here = static_cast<std::size_t>(parents[here]);
            if (seen_from[here] == i) {
                throw_at_row(file, tree, i, "its parents run in a circle");
            }
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

/// A flight without a row.
SpaceFlight no_flight(const SpaceRobot& robot) {
    SpaceFlight none;
    none.joints = robot.joints();
    none.rotor_count = static_cast<int>(robot.plant.rotors.size());
    none.has_rotor_lag = robot.plant.time_constant_s > 0;
    return none;
}

std::vector<std::string> flight_columns(const SpaceRobot& robot) {
    return trajectory_table(no_flight(robot)).names;
}

/// Reads solution.json and effective.yaml. @param read_model reads the latter
template <class Record, class Read>
RunClaims read_head(const fs::path& folder, Record& run, const Read& read_model) {
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) {
        report(folder, "there is no such folder; expected one that `downwash solve` wrote");
    }
    const fs::path solution = folder / solution_name;
    run.solution_text = text_of(solution, max_solution_bytes);
    RunClaims claims = take_solution(solution, run);
    const fs::path problem = folder / "effective.yaml";
    run.problem_text = text_of(problem);
    run.problem = read_model(problem);
    check_problem(problem, run.problem, claims);
    return claims;
}

/// Only the clearance may be empty, where there are no obstacles; time goes on.
void check_flight(const fs::path& file, const NumberTable& flight) {
    check_numbers(file, flight, "clearance_m");
    const std::vector<double>& times_s = *flight.find("t_s");
    for (std::size_t row = 0; row < times_s.size(); ++row) {
        if (row > 0 ? times_s[row] <= times_s[row - 1] : times_s[row] < 0) {
            throw_at_row(file, flight, row, "t_s is " + to_text(times_s[row]) + ", expected times that rise from 0 on");
        }
    }
}

/// Reads trajectory.csv. @param columns that it has to have
NumberTable read_flight(const fs::path& folder, const std::vector<std::string>& columns, const RunClaims& claims) {
    const fs::path file = folder / "trajectory.csv";
    const std::string text = text_of(file);
    NumberTable flight = read_number_table(text, file.string(), columns);
    check_flight(file, flight);
    check_file(file, text, claims.files);
    return flight;
}

}  // namespace

RunRecord run_record(const Problem& problem, const Solution& solution, const Execution& flight) {
    RunRecord run;
    run.problem = problem;
    run.status = name_of(solution.status);
    run.outcome = solution.execution ? name_of(solution.execution->outcome) : "";
    run.plan = solution.plan;
    run.order = solution.plan ? solution.order : std::nullopt;
    run.flight = trajectory_table(flight);
    run.tree = tree_table(solution.tree, problem.axes());
    return run;
}

std::vector<std::pair<std::string, std::string>> run_files(const Problem& problem, const std::string& problem_file,
                                                           const Solution& solution, const Execution& flight,
                                                           const fs::path& folder,
                                                           const std::vector<LocatedError>& warnings,
                                                           const std::optional<InputFacts>& inputs) {
    std::vector<std::pair<std::string, std::string>> files{{"effective.yaml", effective_yaml(problem, folder)},
                                                           {"trajectory.csv", trajectory_csv(flight)},
                                                           {"tree.csv", tree_csv(solution.tree, problem.axes())}};
    // effective.yaml depends on its folder; the digest of the problem stands for it.
    const FileDigests digests{{files[1].first, sha256_hex(files[1].second)},
                              {files[2].first, sha256_hex(files[2].second)}};
    files.emplace_back(
        solution_name,
        solution_json(solution, {problem.name, problem_file, problem_sha256(problem), warnings, problem.axes(), inputs},
                      digests));
    return files;
}

RunRecord read_run(const fs::path& folder) {
    RunRecord run;
    const RunClaims claims = read_head(folder, run, [](const fs::path& file) {
        if (is_space_problem_file(file)) {
            report(file, "this is a run in space, and one in a vertical plane is expected");
        }
        return read_problem(file);
    });
    if (claims.has_plan) {
        Solution read = read_solution((folder / solution_name).string(), run.problem);
        run.plan = std::move(read.plan);
        run.order = std::move(read.order);
    }
    run.flight = read_flight(folder, flight_columns(run.problem.robot), claims);
    const fs::path tree = folder / "tree.csv";
    if (std::error_code ignored; fs::exists(tree, ignored)) {
        const std::string tree_text = text_of(tree);
        run.tree = read_number_table(tree_text, tree.string(),
                                     tree_table(std::span<const TreeNode>(), run.problem.axes()).names);
        check_tree(tree, run.tree);
        check_file(tree, tree_text, claims.files);
    }
    return run;
}

SpaceRunRecord run_record(const SpaceProblem& problem, const SpaceSolution& solution) {
    SpaceRunRecord run;
    run.problem = problem;
    run.status = name_of(solution.status);
    run.outcome = solution.execution ? name_of(solution.execution->outcome) : "";
    run.plan = solution.plan;
    run.order = solution.plan ? solution.order : std::nullopt;
    run.flight = solution.execution ? trajectory_table(*solution.execution) : NumberTable();
    return run;
}

std::vector<std::pair<std::string, std::string>> run_files(const SpaceProblem& problem, const std::string& problem_file,
                                                           const SpaceSolution& solution, const fs::path& folder,
                                                           const std::vector<LocatedError>& warnings,
                                                           const std::optional<SpaceInputFacts>& inputs) {
    std::vector<std::pair<std::string, std::string>> files{
        {"effective.yaml", effective_yaml(problem, folder)},
        {"trajectory.csv", trajectory_csv(solution.execution.value_or(no_flight(problem.robot)))}};
    FileDigests digests{{files[1].first, sha256_hex(files[1].second)}};
    if (solution.search != nullptr) {
        files.emplace_back("tree.csv", tree_csv(solution.search->tree, axes_in_space(problem.robot.joints())));
        digests.emplace(files.back().first, sha256_hex(files.back().second));
    }
    files.emplace_back(
        solution_name,
        solution_json(solution, {problem.name, problem_file, problem_sha256(problem), warnings, inputs}, digests));
    return files;
}

SpaceRunRecord read_space_run(const fs::path& folder) {
    SpaceRunRecord run;
    const RunClaims claims = read_head(folder, run, [](const fs::path& file) { return read_space_problem(file); });
    if (claims.has_plan) {
        SpaceSolution read = read_solution((folder / solution_name).string(), run.problem);
        run.plan = std::move(read.plan);
        run.order = std::move(read.order);
    }
    run.flight = read_flight(folder, flight_columns(run.problem.robot), claims);
    return run;
}

bool is_space_run(const fs::path& folder) {
    return is_space_problem_file(folder / "effective.yaml");
}

ProblemReference problem_of_solution(const fs::path& file) {
    RunRecord run;
    run.solution_text = text_of(file);
    return take_solution(file, run).problem;
}

void require_whole_run(const fs::path& folder) {
    RunRecord run;
    run.solution_text = text_of(folder / solution_name);
    const RunClaims claims = take_solution(folder / solution_name, run);
    std::error_code ignored;
    for (const char* name : {"trajectory.csv", "tree.csv"}) {
        if (const fs::path file = folder / name; fs::exists(file, ignored)) {
            check_file(file, text_of(file), claims.files);
        }
    }
    if (const fs::path problem = folder / "effective.yaml"; fs::exists(problem, ignored)) {
        if (is_space_problem_file(problem)) {
            check_problem(problem, read_space_problem(problem), claims);
        } else {
            check_problem(problem, read_problem(problem), claims);
        }
    }
}

}  // namespace downwash

#include "downwash/results/run_folder.hpp"

#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/problems/space_problem_writer.hpp"

namespace downwash {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored);
}

/// Whether a run was planned from this file. A relative path counts from the current folder, as it did then.
bool is_from_file(const std::string& claimed, const std::string& file) {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored) && fs::equivalent(claimed, file, ignored);
}

/// The file that a run was planned from, for a message: its name and the folder that it is in.
std::string shown_file(const fs::path& file) {
    return file.empty() ? "an unknown file" : excerpt((file.parent_path().filename() / file.filename()).string());
}

/// @param problem a Problem or SpaceProblem
template <class AnyProblem>
void require_replaceable(const fs::path& folder, const AnyProblem& problem, const std::string& file) {
    const std::string& solution = run_file_names().front();
    if (!is_there(folder / solution)) {
        for (const std::string& name : run_file_names()) {
            if (is_there(folder / name)) {
                throw OtherRunError((folder / name).string() +
                                    " would be replaced, and is not part of a run, for there is no " + solution +
                                    " beside it");
            }
        }
        return;
    }
    ProblemReference there;
    try {
        there = problem_of_solution(folder / solution);
    } catch (const InputError& error) {
        throw OtherRunError(error.what());
    }
    if (!is_from_file(there.file, file) && there.sha256 != problem_sha256(problem)) {
        throw OtherRunError(folder.string() + " holds a run of another problem: " + shown_file(there.file) +
                            " (name: " + excerpt(there.name) + "), not of " + file);
    }
}

/// A flight that was not flown, for the header of its file.
Execution no_flight(const Robot& robot) {
    Execution execution;
    execution.rotor_count = static_cast<int>(robot.rotors.positions_m.size());
    execution.has_rotor_lag = robot.rotors.time_constant_s > 0;
    return execution;
}

}  // namespace

const std::vector<std::string>& run_file_names() {
    static const std::vector<std::string> names{"solution.json", "trajectory.csv", "tree.csv", "effective.yaml",
                                                run_page_name};
    return names;
}

RunFolder::RunFolder(fs::path path, const Problem& problem, const std::string& problem_file, bool force)
    : path_(std::move(path)), whole_(path_, run_file_names()) {
    if (!force) {
        require_replaceable(path_, problem, problem_file);
    }
}

RunFolder::RunFolder(fs::path path, const SpaceProblem& problem, const std::string& problem_file, bool force)
    : path_(std::move(path)), whole_(path_, run_file_names()) {
    if (!force) {
        require_replaceable(path_, problem, problem_file);
    }
}

/// Writes files, and keeps the texts of two of them.
template <class Record>
void RunFolder::write_files(std::vector<std::pair<std::string, std::string>>& files, Record& record) {
    whole_.write(files);
    for (auto& [name, content] : files) {
        if (name == "effective.yaml") {
            record.problem_text = std::move(content);
        } else if (name == "solution.json") {
            record.solution_text = std::move(content);
        }
    }
}

RunRecord RunFolder::write(const Problem& problem, const std::string& problem_file,
                           const std::vector<LocatedError>& warnings, const Solution& solution,
                           const std::optional<InputFacts>& inputs) {
    const Execution flight = solution.execution.value_or(no_flight(problem.robot));
    RunRecord record = run_record(problem, solution, flight);
    auto files = run_files(problem, problem_file, solution, flight, path_, warnings, inputs);
    write_files(files, record);
    return record;
}

SpaceRunRecord RunFolder::write(const SpaceProblem& problem, const std::string& problem_file,
                                const std::vector<LocatedError>& warnings, const SpaceSolution& solution,
                                const std::optional<SpaceInputFacts>& inputs) {
    SpaceRunRecord record = run_record(problem, solution);
    auto files = run_files(problem, problem_file, solution, path_, warnings, inputs);
    write_files(files, record);
    return record;
}

}  // namespace downwash

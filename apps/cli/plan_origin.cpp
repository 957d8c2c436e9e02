#include "downwash/cli/plan_origin.hpp"

#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/space_problem_writer.hpp"
#include "downwash/results/run_record.hpp"

namespace downwash::cli {
namespace {

/// Whether results in a folder would replace the plan's own file.
bool holds_plan(const std::filesystem::path& folder, const std::filesystem::path& plan) {
    std::error_code error;
    return std::filesystem::equivalent(folder / "solution.json", plan, error);
}

/// @param read reads the problem that the plan was made for
template <class AnyProblem, class Read>
bool is_of_another(const std::filesystem::path& plan, bool has_certificate, AnyProblem problem, const Read& read) {
    const std::string made_for_sha256 = problem_of_solution(plan).sha256;
    if (made_for_sha256.empty()) {
        return has_certificate;
    }
    if (made_for_sha256 == problem_sha256(problem)) {
        return false;
    }
    try {
        const AnyProblem made_for = read(plan.parent_path() / "effective.yaml");
        problem.planner = made_for.planner;
        return problem_sha256(made_for) != made_for_sha256 || problem_sha256(problem) != made_for_sha256;
    } catch (const std::runtime_error&) {  // there is none, or it cannot be read
        return true;
    }
}

}  // namespace

bool is_of_another_problem(const std::filesystem::path& plan, bool has_certificate, Problem problem) {
    return is_of_another(plan, has_certificate, std::move(problem),
                         [](const std::filesystem::path& file) { return read_problem(file); });
}

bool is_of_another_problem(const std::filesystem::path& plan, SpaceProblem problem) {
    return is_of_another(plan, false, std::move(problem),
                         [](const std::filesystem::path& file) { return read_space_problem(file); });
}

std::filesystem::path folder_beside_plan(const std::optional<std::string>& out, const std::filesystem::path& usual,
                                         const std::string& suffix, const std::filesystem::path& plan) {
    if (!out) {
        std::filesystem::path folder = usual;
        do {
            folder += suffix;
        } while (holds_plan(folder, plan));
        return folder;
    }
    if (holds_plan(*out, plan)) {
        throw UsageError("--out " + *out + " holds the plan itself, which would be replaced; choose another");
    }
    return *out;
}

}  // namespace downwash::cli

#include "downwash/cli/plan_origin.hpp"

#include <stdexcept>
#include <string>
#include <system_error>

#include "downwash/cli/results.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/results/run_record.hpp"

namespace downwash::cli {
namespace {

/// Whether results in a folder would replace the plan's own file.
bool holds_plan(const std::filesystem::path& folder, const std::filesystem::path& plan) {
    std::error_code error;
    return std::filesystem::equivalent(folder / "solution.json", plan, error);
}

}  // namespace

bool is_of_another_problem(const std::filesystem::path& plan, bool has_certificate, Problem problem) {
    const std::string made_for_sha256 = problem_of_solution(plan).sha256;
    if (made_for_sha256.empty()) {
        return has_certificate;
    }
    if (made_for_sha256 == problem_sha256(problem)) {
        return false;
    }
    try {
        const Problem made_for = read_problem((plan.parent_path() / "effective.yaml").string());
        problem.planner = made_for.planner;
        return problem_sha256(made_for) != made_for_sha256 || problem_sha256(problem) != made_for_sha256;
    } catch (const std::runtime_error&) {  // there is none, or it cannot be read
        return true;
    }
}

std::filesystem::path folder_beside_plan(const std::optional<std::string>& out, const Problem& problem,
                                         const std::string& suffix, const std::filesystem::path& plan) {
    if (!out) {
        std::filesystem::path folder = default_folder(problem);
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

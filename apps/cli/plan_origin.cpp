#include "downwash/cli/plan_origin.hpp"

#include <stdexcept>
#include <string>

#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/results/run_record.hpp"

namespace downwash::cli {

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

}  // namespace downwash::cli

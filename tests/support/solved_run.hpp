#pragma once

#include <filesystem>

#include "downwash/base/files.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/results/run_record.hpp"
#include "downwash/results/solution_file.hpp"
#include "downwash/results/trajectory_csv.hpp"
#include "downwash/results/tree_csv.hpp"
#include "scratch_folder.hpp"
#include "test_problem.hpp"

namespace downwash::test {

/// What `solve` leaves in a folder.
class SolvedRun {
 public:
    explicit SolvedRun(Problem of = ceiling_problem()) : problem(std::move(of)) {
        problem.planner.max_iterations = 200;
        SolveOptions options;
        options.keep_tree = true;
        solution = solve(problem, options);
        write_file(file("effective.yaml"), effective_yaml(problem, folder()));
        write_file(file("trajectory.csv"), trajectory_csv(solution.execution.value()));
        write_file(file("tree.csv"), tree_csv(solution.tree));
        write_file(file("solution.json"),
                   solution_json(solution, {problem.name, "problem.yaml", problem_sha256(problem)}));
    }

    [[nodiscard]] const std::filesystem::path& folder() const { return scratch_.path(); }
    [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder() / name; }

    Problem problem;
    Solution solution;

 private:
    ScratchFolder scratch_;
};

/// One run for all tests of a program.
inline const RunRecord& record() {
    static const RunRecord run = read_run(SolvedRun().folder());
    return run;
}

}  // namespace downwash::test

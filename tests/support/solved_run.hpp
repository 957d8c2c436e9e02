#pragma once

#include <filesystem>

#include "downwash/base/files.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/results/run_record.hpp"
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
        for (const auto& [name, content] :
             run_files(problem, "problem.yaml", solution, solution.execution.value(), folder())) {
            write_file(file(name), content);
        }
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

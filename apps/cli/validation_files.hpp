#pragma once

#include <cstdint>
#include <string>

#include "downwash/cli/output.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/validation.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/judge/plan_judge.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash::cli {

/// How finely validation.html shows the clearance over time [s].
inline constexpr double shown_clearance_step_s = 0.1;

/// What was validated, and how.
struct ValidationSource {
    std::string problem_file;  ///< as the user gave it
    std::string plan;          ///< as the user gave it: solution.json or its folder
    SourceFile solution;       ///< solution.json itself
    std::uint64_t seed = 1;    ///< seed of the worlds
    int threads = 1;
};

/// Writes validation.json and, if this build contains pages, validation.html. The page plays the flight that was judged
/// and the worst flights of the worlds, which the judge flies again.
void write_validation(const OutputFolder& folder, const Validation& validation, const judge::PlanJudge& judge,
                      const Plan& plan, const ValidationSource& source);
/// The same for a plan in space. The page shows the run that the plan is of with what the judge found; a plan without
/// a run of the same problem beside it is shown without a flight.
void write_validation(const OutputFolder& folder, const Validation& validation, const SpaceProblem& problem,
                      const SourceFile& solution);

}  // namespace downwash::cli

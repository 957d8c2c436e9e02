#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "downwash/cli/in_space.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/plan_origin.hpp"
#include "downwash/cli/replan_arguments.hpp"
#include "downwash/cli/results.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/planner/takeover.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/space_solution_file.hpp"

namespace downwash::cli {
namespace {

/// How the rest of the earlier plan flies in the problem as it is now.
Replanned fly_rest(const ReplanArguments& given, const TakeoverOf<planning::Space>& from,
                   const SpaceProblemModel& now) {
    const SpaceGoalRule left(now.problem().robot, now.shared_scene(), from.left, leaves_order_open(now.problem()));
    SpaceExecutionSettings settings;
    settings.goals = &left;
    const SpaceFlight rest = now.execute(from.rest, settings);
    return replanned_from(given, from, rest.outcome, cost_of(rest, now.problem().planner.objective));
}

}  // namespace

ExitCode replan_in_space(const ReplanArguments& given) {
    Interruption interruption(given.limits);
    require_whole_plan(given.plan);
    const TakeoverOf<planning::Space> from = takeover_of(given, read_space_problem(problem_of_plan(given)));
    std::vector<LocatedError> warnings;
    const SpaceProblem problem = read_space_problem(given.problem, leaving_rest(given, from),
                                                    noting(warnings, given.is_quiet), space_planning_errors);
    const auto usual = default_folder(problem.name, problem.planner);
    RunFolder folder = claimed_folder(folder_beside_plan(given.out, usual, "-replanned", plan_file(given.plan)),
                                      problem, given.problem, given.force);
    const auto model = std::make_shared<const SpaceProblemModel>(problem);
    const Replanned replanned = fly_rest(given, from, *model);
    return search_in_space({given.problem, model, folder, std::move(warnings), given.threads, given.stop_at_first,
                            given.no_cache, given.is_quiet, given.as_json,
                            takeover_announcement(problem.name, problem.planner.seed, replanned), from.rest, replanned},
                           interruption);
}

}  // namespace downwash::cli

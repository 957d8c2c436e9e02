#include <fmt/core.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/in_space.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/order_rows.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/results.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/cli/search_rows.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/planner/takeover.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/space_solution_file.hpp"

namespace downwash::cli {
namespace {

std::string announcement(const SpaceProblem& problem) {
    const PlannerSettings& planner = problem.planner;
    return fmt::format("{}: planning in space with {} {}, objective {}, seed {}", problem.name,
                       name_of(planner.variant), planner.algorithm, text_of(planner.objective), planner.seed);
}

std::string order_rows_of(const SpaceProblem& problem, const SpaceSearchResult& search) {
    return search.order ? order_rows(*search.order, search.plan.has_value(), problem.energy_budget_j) : std::string();
}

/// How the plan takes over from an earlier one, if it does.
std::string takeover_rows_of(const SpaceProblem& problem, const SpaceSolution& solution) {
    if (!solution.replanned) {
        return {};
    }
    const SpaceStart& start = problem.start;
    const Vector3& at = start.position_m;
    std::string place = fmt::format("x {:.3f} m, y {:.3f} m, z {:.3f} m, yaw {:.1f} deg", at[0], at[1], at[2],
                                    start.yaw_rad * degrees_per_radian);
    for (std::size_t i = 0; i < start.joints_rad.size(); ++i) {
        place += fmt::format("{}{:.1f}", i == 0 ? ", joints " : " ", start.joints_rad[i] * degrees_per_radian);
    }
    place += fmt::format("{}, {:.2f} m/s", start.joints_rad.empty() ? "" : " deg",
                         std::sqrt(dot(start.velocity_m_s, start.velocity_m_s)));
    return takeover_rows(*solution.replanned, place, problem.uncertainty.has_value(), unit_of(solution.objective));
}

}  // namespace

ExitCode solve_in_space(const SolveInSpace& given) {
    Interruption interruption(given.limits);
    std::vector<LocatedError> warnings;
    const SpaceProblem problem = read_space_problem(
        given.problem, [&given](SpaceProblem& settings) { given.planner.apply_to(settings); },
        noting(warnings, given.is_quiet), space_planning_errors);
    const std::filesystem::path out =
        given.out ? std::filesystem::path(*given.out) : default_folder(problem.name, problem.planner);
    RunFolder folder = claimed_folder(out, problem, given.problem, given.force);
    return search_in_space(
        {given.problem, std::make_shared<const SpaceProblemModel>(problem), folder, std::move(warnings), given.threads,
         given.stop_at_first, given.no_cache, given.is_quiet, given.as_json, announcement(problem)},
        interruption);
}

ExitCode search_in_space(SearchInSpace given, Interruption& interruption) {
    const SpaceProblem& problem = given.model->problem();
    SpaceSolveOptions options;
    options.threads = given.threads;
    options.stop_at_first_solution = given.stop_at_first;
    options.keep_tree = true;
    options.finds_stops = true;
    options.known_plan = given.known_plan;
    options.stop = interruption.token();
    options.map_cache = cache_folder(given.no_cache);
    interruption.expect_results();
    std::shared_ptr<const SpaceSearchResult> search;
    {
        ProgressDisplay display(given.is_quiet);
        display.say(given.announcement);
        options.on_progress = [&](const Progress& progress) { display.show(progress); };
        search = std::make_shared<const SpaceSearchResult>(downwash::solve(given.model, options));
    }
    SpaceSolution solution = solution_of(problem, search, given.threads);
    solution.replanned = std::move(given.replanned);
    if (solution.plan && solution.replanned) {
        solution.replanned->same_reference_s = same_reference_s(*solution.plan, *given.known_plan);
    }
    const SpaceRunRecord record = given.folder.write(problem, given.problem, given.warnings, solution,
                                                     input_facts(problem, given.model->scene()));
    write_page(given.folder.path(), record);
    if (given.as_json) {
        fmt::print("{}", record.solution_text);
    } else {
        fmt::print("{}{}",
                   space_summary(verdict_on_search(*search, solution.aero), solution,
                                 takeover_rows_of(problem, solution) + order_rows_of(problem, *search),
                                 search_rows(*search, given.folder.path())),
                   file_rows(given.folder.path(), "solution.json, trajectory.csv, tree.csv, effective.yaml"));
    }
    if (interruption.code() != ExitCode::done) {
        return interruption.code();
    }
    const bool is_good = solution.status == Status::solved && solution.execution->outcome == Outcome::ok;
    return is_good                             ? ExitCode::done
           : solution.status == Status::solved ? ExitCode::flight_failed
                                               : ExitCode::no_solution;
}

}  // namespace downwash::cli

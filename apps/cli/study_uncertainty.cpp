#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "downwash/bench/uncertainty_study/uncertainty_figures.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/study_commands.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/planner/space_solve.hpp"

namespace downwash::cli {
namespace {

/// The problems in the folder problems/, in the order of their names.
std::vector<std::string> shipped_problems() {
    std::vector<std::string> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator("problems", error)) {
        if (entry.path().extension() == ".yaml") {
            files.push_back(entry.path().string());
        }
    }
    std::sort(files.begin(), files.end());
    if (files.empty()) {
        throw UsageError("there is no problem in the folder problems/: expected --problem FILE...");
    }
    return files;
}

bench::StudySettings settings_of(const StudyUncertaintyArguments& given) {
    bench::StudySettings settings;
    settings.seeds = given.seeds.value_or(settings.seeds);
    settings.time_limit_s = given.time_limit_s.value_or(settings.time_limit_s);
    settings.worlds = given.worlds.value_or(settings.worlds);
    settings.jobs = given.jobs;
    for (const std::string& file : given.problems.empty() ? shipped_problems() : given.problems) {
        AnyProblem problem =
            read_any_problem(file, given.is_quiet ? nullptr : print_outdated, {}, space_planning_errors);
        const std::string& name = problem_name(problem);
        if (!uncertainty_of(problem)) {
            throw UsageError("{}: has no uncertainty to study: expected `uncertainty: {{}}` or more in it", file);
        }
        if (std::ranges::any_of(settings.problems,
                                [&](const AnyProblem& other) { return problem_name(other) == name; })) {
            throw UsageError("--problem: two problems have the name {}", name);
        }
        settings.problems.push_back(std::move(problem));
    }
    return settings;
}

}  // namespace

ExitCode study_uncertainty(const StudyUncertaintyArguments& given) {
    Interruption interruption;
    interruption.expect_results();
    const std::vector<bench::StudyPart> parts = bench::parts_of(settings_of(given));
    const OutputFolder folder(given.out);
    {
        bench::CampaignRunOptions options;
        options.out = folder.path();
        options.map_cache = cache_folder(given.no_cache);
        options.stop = interruption.token();
        ProgressDisplay display(given.is_quiet);
        display.say(fmt::format("study uncertainty: writing results to {}", given.out));
        options.on_progress = [&](double share) { display.show("study uncertainty", share); };
        options.on_map_progress = [&](const std::string& problem, double share) {
            display.show("aero map of " + problem, share);
        };
        bench::run_study(parts, options);
    }
    const bench::StudyFigures figures = bench::figures_of(parts, folder.path());
    write_together(folder.path(),
                   {{"study.json", bench::json_of(figures) + "\n"}, {"study.md", bench::markdown_of(figures)}});
    if (given.as_json) {
        fmt::print("{}\n", bench::json_of(figures));
    } else {
        fmt::print("{}", bench::markdown_of(figures));
    }
    return figures.done == figures.planned ? ExitCode::done : interruption.code();
}

}  // namespace downwash::cli

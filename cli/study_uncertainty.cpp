#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "downwash/bench/study/uncertainty_figures.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/usage_error.hpp"

namespace downwash::cli {
namespace {

struct StudyUncertaintyArguments {
    std::vector<std::string> problems;
    std::string out = "downwash-out/study-uncertainty";
    bench::StudySettings settings;
    bool no_cache = false, is_quiet = false, as_json = false;
};

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
    bench::StudySettings settings = given.settings;
    for (const std::string& file : given.problems.empty() ? shipped_problems() : given.problems) {
        Problem problem = read_problem(file, {}, given.is_quiet ? nullptr : print_outdated);
        if (!problem.uncertainty) {
            throw UsageError("{}: has no uncertainty to study: expected `uncertainty: {{}}` or more in it", file);
        }
        if (std::any_of(settings.problems.begin(), settings.problems.end(),
                        [&](const Problem& other) { return other.name == problem.name; })) {
            throw UsageError("--problem: two problems have the name {}", problem.name);
        }
        settings.problems.push_back(std::move(problem));
    }
    return settings;
}

ExitCode run(const StudyUncertaintyArguments& given) {
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

}  // namespace

void add_study_uncertainty(Command study, Action& action) {
    auto [command, given] =
        add_command(study, action, "uncertainty",
                    "Compare plans for the nominal world, with margins, in one pessimistic world and in "
                    "several worlds: how "
                    "often they are found and fail, what they cost. Continues with the results that are there",
                    run);
    command.add_option("--problem FILE...", given.problems, "problem files; default: all in the folder problems/");
    command.add_option("--seeds N", given.settings.seeds, "searches of each setup on each problem; default 20")
        .in_range(1, 100000);
    command.add_option("--time-limit S", given.settings.time_limit_s, "wall time of a search [s]; default 5")
        .in_range(0.01, 1e6);
    command
        .add_option("--worlds M", given.settings.worlds,
                    "fresh worlds in which every reported plan is flown; default 300")
        .in_range(1, 1000000);
    add_jobs(command, given.settings.jobs, "one per processor");
    add_out(command, "DIR", given.out, "folder for the results; default downwash-out/study-uncertainty/");
    add_no_cache(command, given.no_cache);
    add_quiet(command, given.is_quiet);
    add_json(command, given.as_json);
}

}  // namespace downwash::cli

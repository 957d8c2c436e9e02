#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/bench/awareness_study/awareness_figures.hpp"
#include "downwash/bench/awareness_study/awareness_run.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/study_commands.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

constexpr const char* shipped_folder = "problems";
constexpr const char* engineering_folder = "bench/awareness_study/problems";

/// Adds the problems in a folder, in the order of their names.
void add_problems(const std::filesystem::path& folder, bench::ProblemGroup group, bool is_quiet,
                  std::vector<bench::StudyProblem>& problems) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        if (entry.path().extension() == ".yaml") {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    if (files.empty()) {
        throw UsageError("there is no problem in the folder {}/: run the study in the folder of the sources",
                         folder.string());
    }
    for (const std::filesystem::path& file : files) {
        Problem problem = read_problem(file, {}, is_quiet ? nullptr : print_outdated);
        if (!problem.uncertainty) {
            throw UsageError("{}: has no uncertainty to study: expected `uncertainty: {{}}` or more in it",
                             file.string());
        }
        problems.push_back({std::move(problem), group});
    }
}

/// Those of all lines that are named; without a name the default ones.
std::vector<bench::CellLine> lines_of(const StudyAwarenessArguments& given) {
    std::vector<bench::CellLine> lines;
    for (const std::string& name : given.lines) {
        lines.push_back(entry_named(bench::cell_lines(), name, "line"));
    }
    if (lines.empty()) {
        std::copy_if(bench::cell_lines().begin(), bench::cell_lines().end(), std::back_inserter(lines),
                     [](const bench::CellLine& line) { return line.is_default; });
    }
    for (bench::CellLine& line : lines) {
        line.seeds = static_cast<std::uint32_t>(given.seeds.value_or(line.seeds));
        line.worlds = given.worlds.value_or(line.worlds);
    }
    return lines;
}

bench::AwarenessSettings settings_of(const StudyAwarenessArguments& given) {
    bench::AwarenessSettings settings;
    add_problems(shipped_folder, bench::ProblemGroup::shipped, given.is_quiet, settings.problems);
    add_problems(engineering_folder, bench::ProblemGroup::engineering, given.is_quiet, settings.problems);
    std::vector<bench::StudyProblem> chosen;
    for (const std::string& name : given.problems) {
        const auto found = std::find_if(settings.problems.begin(), settings.problems.end(),
                                        [&](const bench::StudyProblem& each) { return each.problem.name == name; });
        if (found == settings.problems.end()) {
            throw UsageError("--only: the study has no problem {}: expected one of {}", name,
                             joined(settings.problems, ", ", [](const auto& each) { return each.problem.name; }));
        }
        chosen.push_back(*found);
    }
    if (!chosen.empty()) {
        settings.problems = std::move(chosen);
    }
    settings.ideal = read_robot(std::filesystem::path(shipped_folder) / "robots/ars_lrm_ideal.yaml");
    settings.lines = lines_of(given);
    return settings;
}

bench::TaskShare share_of(const std::string& text) {
    const std::size_t slash = text.find('/');
    const auto number = parse_number<std::uint64_t>(text.substr(0, slash));
    const auto count = slash == std::string::npos ? std::nullopt : parse_number<std::uint64_t>(text.substr(slash + 1));
    if (!number || !count || *number < 1 || *number > *count) {
        throw UsageError("--share is {}: expected I/N with I from 1 to N", text);
    }
    return {*number, *count};
}

}  // namespace

ExitCode study_awareness(const StudyAwarenessArguments& given) {
    const bench::AwarenessSettings settings = settings_of(given);
    bench::AwarenessRunOptions options;
    options.out = given.out;
    options.share = share_of(given.share);
    options.jobs = given.jobs;
    options.same_as = given.same_as;
    const std::uint64_t jobs = given.jobs.value_or(bench::default_jobs());
    const auto rows = [&] { return bench::current_rows(settings, options.out, options.same_as); };
    if (given.only_estimates) {
        fmt::print("{}\n", given.as_json ? bench::plan_json(settings, rows(), jobs)
                                         : bench::plan_markdown(settings, rows(), jobs));
        return ExitCode::done;
    }
    Interruption interruption;
    interruption.expect_results();
    const OutputFolder folder(given.out);
    if (!given.only_reports) {
        options.map_cache = cache_folder(given.no_cache);
        options.stop = interruption.token();
        ProgressDisplay display(given.is_quiet);
        display.say(fmt::format("study awareness: writing results to {}", given.out));
        const std::vector<bench::AwarenessRow> earlier = rows();
        const double left_s =
            bench::estimated_s(settings, bench::missing_tasks(settings, options.share, earlier), earlier, jobs);
        display.say(fmt::format("study awareness: about {:.1f} hours with {} searches at a time", left_s / 3600, jobs));
        options.on_progress = [&](double share) { display.show("study awareness", share); };
        bench::run_awareness(settings, options);
    }
    const bench::AwarenessFigures figures = bench::awareness_figures(settings, rows());
    write_together(folder.path(),
                   {{"study.json", bench::json_of(figures) + "\n"}, {"study.md", bench::markdown_of(figures)}});
    fmt::print("{}", given.as_json ? bench::json_of(figures) + "\n" : bench::markdown_of(figures));
    return given.only_reports || options.share.count > 1 || figures.done == figures.planned ? ExitCode::done
                                                                                            : interruption.code();
}

}  // namespace downwash::cli

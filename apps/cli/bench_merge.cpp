#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "downwash/bench/campaign_merge.hpp"
#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/campaign_store.hpp"
#include "downwash/cli/bench_commands.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/report/campaign_page.hpp"
#include "downwash/report/run_page.hpp"

namespace downwash::cli {
namespace {

/// Which runs are missing, and the commands that make them.
std::string text_of_merge(const bench::MergedCampaign& merged) {
    constexpr std::size_t max_shards = 50, max_letters = 500;
    std::string text;
    const std::size_t shown = std::min(merged.missing.size(), max_shards);
    for (std::size_t i = 0; i < shown; ++i) {
        const bench::MissingRuns& of = merged.missing[i];
        const bool is_long = of.runs.size() > max_letters;
        text += fmt::format("shard {}: {} run{} missing: {}{}\n", of.shard, of.count, of.count == 1 ? " is" : "s are",
                            of.runs.substr(0, max_letters), is_long ? "..." : "");
    }
    if (shown < merged.missing.size()) {
        text += fmt::format("and {} more shards\n", merged.missing.size() - shown);
    }
    text +=
        fmt::format("\nThese commands make them, then merge again{}:\n\n",
                    merged.plan.shards->cell_costs_us.empty() ? "" : "; --pilot names the folder that dealt them out");
    for (std::size_t i = 0; i < shown; ++i) {
        const bench::MissingRuns& of = merged.missing[i];
        text += fmt::format("downwash bench run CAMPAIGN --shard {}/{}{} --resume --jobs {} --out {}\n", of.shard,
                            merged.plan.shards->count, merged.plan.shards->cell_costs_us.empty() ? "" : " --pilot DIR",
                            setting(merged.plan, "jobs"), shell_word(of.folder.string()));
    }
    return text;
}

}  // namespace

ExitCode merge_shards(const BenchMergeArguments& given) {
    std::vector<std::filesystem::path> shards(given.shards.begin(), given.shards.end());
    if (given.shards == std::vector<std::string>{"-"}) {  // more of them than a command line can hold
        shards.clear();
        for (std::string line; std::getline(std::cin, line);) {
            shards.emplace_back(line);
        }
        if (shards.empty()) {
            throw UsageError("standard input names no folder of a shard: expected one in each line");
        }
    }
    const std::filesystem::path out = given.out;
    const bench::MergedCampaign merged = bench::merge_shards(out, shards, given.replaces);
    if (has_pages() && merged.done > 0) {
        write_result(out / "report.html", campaign_page(bench::page_json_of(bench::read_report(out))));
    }
    fmt::print("{} of {} runs are in {}\n", merged.done, merged.plan.run_count(), out.string());
    if (merged.processors > 1) {
        fmt::print("they were made on {} models of processors: do not compare their times, see downwash bench report\n",
                   merged.processors);
    }
    if (merged.missing.empty()) {
        return ExitCode::done;
    }
    fmt::print("\n{}", text_of_merge(merged));
    return ExitCode::no_solution;
}

}  // namespace downwash::cli

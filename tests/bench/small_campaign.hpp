#pragma once

#include <sqlite3.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "../support/scratch_folder.hpp"
#include "../support/test_problem.hpp"
#include "campaign_results.hpp"
#include "downwash/bench/campaign_run.hpp"

namespace downwash::test {

using namespace bench;

/// A ceiling, two variants, a few seeds and a few iterations.
inline ReadCampaign small_campaign(std::uint64_t seeds = 2) {
    ReadCampaign read;
    read.problems = {test::ceiling_problem()};
    read.campaign.name = "trial";
    read.campaign.problems = {"ceiling.yaml"};
    read.campaign.variants = {Variant::mp_arm, Variant::mp_arm_da};
    read.campaign.seeds.count = seeds;
    read.campaign.max_iterations = 150;
    return read;
}

/// A problem of a campaign that is one in a plane.
inline Problem& planar(AnyProblem& problem) {
    return std::get<Problem>(problem);
}

inline CampaignProgress run_into(const ScratchFolder& folder, const ReadCampaign& read, bool resumes = false) {
    CampaignRunOptions options;
    options.out = folder / "results";
    options.resumes = resumes;
    return run_campaign(read, options);
}

inline CampaignResults results_in(const ScratchFolder& folder) {
    return read_results(folder / "results");
}

/// What does not depend on time, in the order of planners and seeds.
inline std::vector<std::tuple<std::size_t, std::uint32_t, RunStatus, double, double>> repeatable(
    const CampaignResults& results) {
    std::vector<std::tuple<std::size_t, std::uint32_t, RunStatus, double, double>> figures;
    for (const Run& run : results.runs) {
        figures.emplace_back(run.planner, run.seed, run.status, run.cost.value_or(-1),
                             run.flight ? run.flight->cost : -1);
    }
    std::sort(figures.begin(), figures.end());
    return figures;
}

/// The first value of the first row that SQLite answers.
inline std::string answer_in(const std::filesystem::path& results, const std::string& question) {
    sqlite3* database = nullptr;
    REQUIRE(sqlite3_open((results / results_file).c_str(), &database) == SQLITE_OK);
    std::string text;
    const auto keep = [](void* kept, int, char** values, char**) {
        *static_cast<std::string*>(kept) = values[0] != nullptr ? values[0] : "NULL";
        return 1;
    };
    const int result = sqlite3_exec(database, question.c_str(), keep, &text, nullptr);
    CHECK((result == SQLITE_OK || result == SQLITE_ABORT));
    sqlite3_close(database);
    return text;
}
inline std::string answer(const ScratchFolder& folder, const std::string& question) {
    return answer_in(folder / "results", question);
}

}  // namespace downwash::test

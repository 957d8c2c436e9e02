#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "downwash/bench/campaign_store.hpp"

namespace downwash::bench {

/// The results of a campaign so far.
struct CampaignResults {
    CampaignPlan plan;
    std::vector<Run> runs;
};

inline CampaignResults read_results(const std::filesystem::path& folder) {
    CampaignResults results;
    results.plan = read_runs(
        folder, [](const CampaignPlan&) {}, [&](Run&& run) { results.runs.push_back(std::move(run)); });
    return results;
}

}  // namespace downwash::bench

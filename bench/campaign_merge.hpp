#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "downwash/bench/campaign_data.hpp"

namespace downwash::bench {

/// Runs that no shard has made yet.
struct MissingRuns {
    std::uint64_t shard = 0;
    std::size_t count = 0;
    std::string runs;              ///< "bridge, energy, mp-arm rrt-star: seeds 3 17-19; ..."
    std::filesystem::path folder;  ///< where the shard's results are, or belong
};

/// A merge of shards.
struct MergedCampaign {
    CampaignPlan plan;
    std::size_t done = 0;
    std::vector<MissingRuns> missing;  ///< in the order of shards
    std::size_t processors = 0;        ///< models of processors on which the runs were made
};

/// Merges the results of shards into one file of results in another folder. It appears whole or not at all, and depends
/// on the shards alone, not on the order in which they are named.
/// @param folders of the shards   @param replaces whether results that are in the folder already may be replaced
/// @throws CampaignError, DatabaseError: a file is damaged or no shard of the same campaign, a run is in two files, the
/// folder holds results; the message names every file with its differences
MergedCampaign merge_shards(const std::filesystem::path& out, const std::vector<std::filesystem::path>& folders,
                            bool replaces);

}  // namespace downwash::bench

#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "downwash/bench/campaign_data.hpp"
#include "downwash/bench/campaign_shards.hpp"
#include "downwash/problems/campaign_reader.hpp"

namespace downwash::bench {

/// How to run a campaign.
struct CampaignRunOptions {
    std::filesystem::path out;                ///< folder of the results; made if need be
    bool resumes = false;                     ///< continues existing results
    std::optional<ShardRequest> shard;        ///< runs a part of the campaign alone
    std::filesystem::path saved;              ///< folder that keeps a copy of the results; empty: none. See SavedCopy
    std::filesystem::path map_cache;          ///< folder in which aero maps are kept between runs; empty: nowhere
    std::stop_token stop;                     ///< ends the campaign; an interrupted search is not kept
    std::function<void(double)> on_progress;  ///< share of all runs that is done; called from the calling thread
    /// Name of a problem and the share of its aero map that is begun, before the runs; likewise.
    std::function<void(const std::string&, double)> on_map_progress;
};

/// The progress of a campaign.
struct CampaignProgress {
    std::size_t planned = 0;        ///< runs of the campaign, or of its shard
    std::size_t done = 0;           ///< earlier ones included; fewer than planned after a stop
    std::size_t out_of_memory = 0;  ///< runs that ended for want of memory: not done, and repeated by the next resume
};

/// Everything that a campaign runs on this machine.
/// @param shard if the campaign is run in shards: the plan is the same for all of them
/// @throws CampaignError when no planner that it names exists, or it cannot be dealt out to shards
[[nodiscard]] CampaignPlan plan_of(const ReadCampaign& read, const std::optional<ShardRequest>& shard = std::nullopt);

/// Runs the missing runs of a campaign or of a shard, as many searches at a time as it has jobs, one thread each.
/// Without a number of jobs there are as many as processors; a shard has one. Every finished run
/// is committed at once, so that the campaign can be resumed whatever ends the program.
/// @throws CampaignError, DatabaseError
CampaignProgress run_campaign(const ReadCampaign& read, const CampaignRunOptions& options);

}  // namespace downwash::bench

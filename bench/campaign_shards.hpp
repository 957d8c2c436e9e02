#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "downwash/bench/campaign_data.hpp"

namespace downwash::bench {

/// One of the shards of a campaign, as a user asks for it: "3/16".
struct ShardRequest {
    std::uint64_t number = 1;     ///< 1 to count
    std::uint64_t count = 1;      ///< at most max_shards
    std::filesystem::path pilot;  ///< folder of a campaign that has measured the same planners; empty: none
};

/// More shards are no campaign but a mistake.
inline constexpr std::uint64_t max_shards = 100000;

/// Which shard makes which run. It depends on the plan alone. Runs that take longest are dealt out first, each to the
/// shard that has least to do, so that all shards take about as long and each has its part of every planner.
class ShardAssignment {
 public:
    /// @pre plan.shards
    explicit ShardAssignment(const CampaignPlan& plan);

    /// The number of a shard, from 1. @param seed_place of the seed in the plan
    [[nodiscard]] std::uint64_t shard_of(std::size_t experiment, std::size_t planner, std::size_t seed_place) const;

    /// How many runs a shard has.
    [[nodiscard]] std::size_t run_count(std::uint64_t shard) const;

 private:
    std::size_t planners_, seeds_;
    std::vector<std::uint32_t> shards_;  ///< by experiment, planner and seed
};

/// How a request deals out a campaign.
/// @throws CampaignError when there are more shards than runs, or the pilot has run none of its planners
[[nodiscard]] ShardPlan shard_plan_of(const CampaignPlan& plan, const ShardRequest& request);

/// How shards were dealt out, for settings: "all runs take as long", or a digest of what the pilot has measured.
[[nodiscard]] std::string costs_text(const ShardPlan& shards);

/// "shard-0003-of-0016": sorts as its number does.
[[nodiscard]] std::string shard_folder_name(std::uint64_t number, std::uint64_t count);

}  // namespace downwash::bench

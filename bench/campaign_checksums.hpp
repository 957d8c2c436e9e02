#pragma once

#include <string>

#include "downwash/bench/campaign_data.hpp"

namespace downwash::bench {

/// A digest of everything that a run consists of: equal if it was read back as it was written.
[[nodiscard]] std::string checksum_of(const Run& run);

/// A digest of everything that a campaign runs.
[[nodiscard]] std::string checksum_of(const CampaignPlan& plan);

}  // namespace downwash::bench

#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>

#include "downwash/bench/campaign_data.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/campaign_reader.hpp"

namespace downwash::bench {

/// How a campaign is run.
struct CampaignRunOptions {
    std::filesystem::path out;                ///< folder of the results; made if need be
    bool resumes = false;                     ///< goes on with results that are there
    std::filesystem::path map_cache;          ///< folder in which aero maps are kept between runs; empty: nowhere
    std::stop_token stop;                     ///< ends it; searches that are cut short are not kept
    std::function<void(double)> on_progress;  ///< share of all runs that is done; called from the calling thread
    /// Name of a problem and the share of its aero map that is begun, before the runs; likewise.
    std::function<void(const std::string&, double)> on_map_progress;
};

/// How far a campaign has come.
struct CampaignProgress {
    std::size_t planned = 0;
    std::size_t done = 0;  ///< earlier ones included; fewer than planned after a stop
};

/// Everything that a campaign is going to run on this machine.
/// @throws CampaignError when no planner that it names exists
[[nodiscard]] CampaignPlan plan_of(const ReadCampaign& read);

/// Runs what is missing of a campaign, as many searches at a time as it has jobs, one thread each. Every finished run
/// is committed at once: whatever ends the program, it can be resumed.
/// @throws CampaignError, DatabaseError
CampaignProgress run_campaign(const ReadCampaign& read, const CampaignRunOptions& options);

/// One run: the search and the flight of what it found. Whatever goes wrong is in the result, never thrown.
/// @param how the map to use, the stop token, and whether to stop at the first solution
[[nodiscard]] Run attempt(Problem problem, const PlannerSetup& planner, std::uint32_t seed, const SolveOptions& how);

}  // namespace downwash::bench

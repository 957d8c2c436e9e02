#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "downwash/bench/campaign_data.hpp"
#include "downwash/problems/any_problem.hpp"

namespace downwash::bench {

/// What the runs of a problem share.
struct ExperimentSetup {
    AnyProblem problem;                      ///< with the limits and the objective of the campaign
    std::optional<AnyProblem> evaluated_in;  ///< in whose worlds plans are flown after the search; empty: in none
    std::uint64_t worlds = 0;                ///< how many
    bool stops_at_first = false;             ///< whether a search ends with the first plan that is accepted
    std::filesystem::path map_cache;         ///< folder in which aero maps are kept; empty: nowhere
    std::stop_token stop;                    ///< ends a search
};

/// A problem of a campaign with an objective, ready to be planned. Safe to share between threads.
class CampaignExperiment {
 public:
    CampaignExperiment() = default;
    virtual ~CampaignExperiment() = default;
    CampaignExperiment(const CampaignExperiment&) = delete;
    CampaignExperiment& operator=(const CampaignExperiment&) = delete;

    /// One run on one thread: the search and the flights of its plan. An error is in the result, never thrown, apart
    /// from std::bad_alloc: that there was no memory left says nothing about the search.
    [[nodiscard]] virtual Run attempt(const PlannerSetup& planner, std::uint32_t seed) = 0;
};

/// The experiments of one problem: one for each objective.
/// @param planners of the campaign, which say whether an aero map is needed   @param jobs threads that build it
/// @param on_map_progress is told the share of it that is done
[[nodiscard]] std::vector<std::unique_ptr<CampaignExperiment>> experiments_of(
    const ExperimentSetup& setup, const std::vector<CostFunction>& objectives,
    const std::vector<PlannerSetup>& planners, int jobs, const std::function<void(double)>& on_map_progress);

/// Gives a problem the settings of a planner.
void apply(const PlannerSetup& planner, PlannerSettings& settings);

/// Why a problem cannot be planned with a planner; empty when it can.
[[nodiscard]] std::string error_of_combination(AnyProblem problem, const PlannerSetup& planner);

}  // namespace downwash::bench

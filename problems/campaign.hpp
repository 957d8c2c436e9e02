#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/parameter_table.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// Seeds of a campaign: those of a list or, without one, `count` seeds from `first` on.
struct CampaignSeeds {
    std::vector<std::uint64_t> list;
    std::uint64_t first = 1;
    std::uint64_t count = 10;

    /// Every seed once, in the order in which they are run.
    [[nodiscard]] DOWNWASH_EXPORT std::vector<std::uint32_t> all() const;
};

/// What a variant has to reach on every problem, or the campaign's report says that it failed. A seed without a
/// solution counts as an infinite time and cost.
struct CampaignExpectation {
    Variant variant = Variant::mp_arm_ada;
    std::optional<std::string> algorithm;           ///< empty: all of the campaign
    std::optional<double> solved_ratio;             ///< least share of the attempted seeds
    std::optional<std::uint64_t> failed_flights;    ///< greatest allowed
    std::optional<double> first_solution_median_s;  ///< greatest allowed
    std::optional<double> first_solution_95_s;      ///< greatest allowed 95 % quantile
    std::optional<double> verified_median_s;        ///< greatest allowed, to the first plan that may be reported
    /// The median cost after `cost_after_s` is at most `cost_to_best` times the least that any run of the campaign has
    /// flown there, and below the median that the algorithm `cheaper_than` has after `cheaper_than_after_s`.
    std::optional<double> cost_after_s;
    std::optional<double> cost_to_best;
    std::optional<std::string> cheaper_than;
    std::optional<double> cheaper_than_after_s;
    // On problems with an uncertainty:
    std::optional<double> max_failure_share;         ///< greatest share of the flights in the evaluation worlds
    std::optional<double> certified_ratio;           ///< least share of the attempted seeds
    std::optional<double> first_certified_median_s;  ///< greatest allowed
};

/// Problems x objectives x variants x algorithms x parameters x margins x seeds, each of which is one run.
struct Campaign {
    std::string name = "campaign";  ///< [A-Za-z0-9_-]{1,64}
    std::string description;
    std::vector<std::string> problems;  ///< files, as seen from where the program runs
    std::vector<Variant> variants{Variant::mp_arm_ada};
    std::vector<std::string> algorithms{"rrt-star"};
    std::optional<std::vector<Objective>> objectives;  ///< empty: each problem's own, which may be a sum
    std::optional<std::vector<double>> margins_m;      ///< safety margins [m]; empty: each problem's own
    /// Sets of the algorithms' parameters, each over the problem's own; empty: the problem's own alone.
    std::vector<ParameterValues> parameters;
    CampaignSeeds seeds;
    /// Wall time of one search [s]. Empty: default_time_limit_s, or none where max_iterations is set.
    std::optional<double> time_limit_s;
    std::optional<std::uint64_t> max_iterations;
    bool stop_at_first_solution = false;
    bool as_believed = false;     ///< plan as if nothing were uncertain
    bool check_execution = true;  ///< false: no plan is executed before it counts; otherwise each problem's own
    bool certify = true;          ///< false: no plan needs a certificate; otherwise each problem's own
    /// Worlds of the problem's uncertainty in which every reported plan is flown, the same for all plans of a problem.
    std::uint64_t evaluation_worlds = 0;
    std::optional<std::uint64_t> jobs;  ///< searches at a time; empty: one per processor, in a shard one
    std::vector<CampaignExpectation> expect;
};

/// More runs are no campaign but a mistake.
inline constexpr std::uint64_t max_campaign_runs = 1000000;

/// Every key of a campaign file, as problem_parameters() has those of problems.
[[nodiscard]] DOWNWASH_EXPORT const ParameterTable<Campaign>& campaign_parameters();

}  // namespace downwash

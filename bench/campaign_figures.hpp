#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/bench/campaign_data.hpp"
#include "downwash/bench/statistics.hpp"

namespace downwash::bench {

/// Quantiles over all attempted seeds; a seed without a value counts as infinite. NaN without seeds.
struct Spread {
    double min = 0, low_quartile = 0, median = 0, high_quartile = 0, quantile_95 = 0;
};

/// The cost of the best plan so far at a moment of the search: the executed cost where plans are executed before they
/// count, otherwise the planned cost.
struct CostAt {
    double time_s = 0;
    Spread cost;
};

/// The share of seeds that are solved at a moment of the search.
struct SolvedAt {
    double time_s = 0;
    Share solved;
};

/// How many seeds have a flight that held and cost no more.
struct HeldAt {
    double cost = 0;
    std::size_t held = 0;
};

/// The result of one seed.
struct SeedFigures {
    std::uint32_t seed = 0;
    std::size_t place = 0;        ///< among the campaign's seeds
    std::string cause;            ///< why there is no flight that held; empty when there is
    double first_solution_s = 0;  ///< infinite without a solution, as is flown_cost without a flight that held
    double answer_s = 0;
    double flown_cost = 0;
    std::optional<bool> is_certified = {};                 ///< empty: its plan was not tested
    std::optional<std::uint64_t> failures_in_worlds = {};  ///< empty: its plan was not flown in other worlds
};

/// How many plans fail with one parameter of the worlds alone at its 2 % or 98 % quantile, of those whose flight held
/// in the nominal world.
struct ParameterFigures {
    std::string parameter;
    std::size_t plans = 0;
    std::size_t failed_low = 0, failed_high = 0;
};

/// Flights of the plans in other worlds than the nominal one.
struct WorldsFigures {
    std::size_t tested = 0;    ///< seeds whose plan was tested for a certificate
    Share certified;           ///< certified among the attempted seeds
    Spread first_certified_s;  ///< first certificates of planners that ask for them while they search
    std::size_t flown = 0;     ///< seeds whose reported plan was flown in the evaluation worlds
    Share failed;              ///< failed among all these flights; interval of Clopper and Pearson (1934)
    std::vector<ParameterFigures> alone;

    [[nodiscard]] bool has_any() const { return tested > 0 || flown > 0; }
};

/// One planner on one experiment, over every seed that was attempted.
struct CellFigures {
    std::size_t experiment = 0, planner = 0;  ///< in the campaign's plan
    std::size_t missing = 0;                  ///< seeds without a run
    Share solved;
    Share failed_flights;  ///< solved, and the plan's flight with direct aerodynamics was not `ok`
    Share held;            ///< solved, and it was
    std::vector<std::pair<std::string, std::size_t>> failures_by_cause;  ///< outcomes and statuses, most frequent first
    Spread first_solution_s;
    Spread verified_s;           ///< to the first plan that may be reported, after all checks
    Spread answer_s;             ///< wall time of the whole run
    Spread flown_cost;           ///< executed costs of the flights that held
    double min_clearance_m = 0;  ///< over all flights of solved runs; NaN without any, infinite without obstacles
    std::uint64_t discarded = 0;
    std::vector<CostAt> cost_over_time;  ///< at cost_moments_s; empty where searches stop at the first solution
    std::vector<CostAt> cost_curve;      ///< costs at moments close enough to draw
    /// A step for every first solution, in the order of time; evenly chosen ones of more than max_steps.
    std::vector<SolvedAt> solved_over_time;
    std::vector<HeldAt> held_over_cost;  ///< shares of flights that held, over executed costs
    WorldsFigures in_worlds;
    std::vector<SeedFigures> seeds;  ///< seeds that were attempted
};

/// One planner on all experiments together.
struct PlannerTotals {
    std::size_t planner = 0;
    Share solved, failed_flights, held;  ///< as in CellFigures
    std::uint64_t discarded = 0;
    WorldsFigures in_worlds;
};

/// Two planners on equal seeds.
struct PlannerComparison {
    std::size_t experiment = 0, first = 0, second = 0;
    std::string measure;  ///< "first solution [s]", "flown cost"
    Pairing pairing;
};

/// Seeds of one planner and experiment that have no flight that held, for one cause.
struct FailureGroup {
    std::size_t experiment = 0, planner = 0;
    std::string cause;
    std::vector<std::uint32_t> seeds;
    /// From the goal region, where the search found no plan: how near it came; empty, or one for each seed [m].
    std::vector<double> nearest_approach_m;
};

/// The minimum margin from which on no flight of an experiment failed. It may be safe only because no plan was found.
struct SafeMargin {
    double margin_m = 0;
    Share solved;  ///< solved runs with this margin
};

/// The results of a variant and algorithm for increasing margins.
struct MarginFinding {
    PlannerSetup planner;  ///< without its margin
    /// The minimum margin from which on no flight failed on any problem; empty when there is none.
    std::optional<double> safe_margin_m;
    /// Solved shares at that margin by experiment; empty without one.
    std::vector<Share> solved_when_safe;
    /// Each experiment on its own; empty when no margin is safe there.
    std::vector<std::optional<SafeMargin>> alone;
};

/// A target that the campaign sets, for one experiment and planner.
struct TargetResult {
    std::size_t experiment = 0, planner = 0;
    std::string target;  ///< "solved at least 0.98"
    std::string found;   ///< "197/200"
    bool is_met = false;
};

/// A machine on which runs were made.
struct MachineFigures {
    Machine machine;
    std::size_t runs = 0;
    double median_load = 0, max_load = 0;
};

/// The results of a campaign, in figures.
struct CampaignReport {
    CampaignPlan plan;
    std::size_t done = 0;
    std::vector<CellFigures> cells;     ///< experiments outermost
    std::vector<PlannerTotals> totals;  ///< in the order of the plan's planners
    std::vector<PlannerComparison> comparisons;
    std::vector<MarginFinding> margins;  ///< empty unless the campaign sweeps margins
    std::vector<FailureGroup> failures;
    std::vector<TargetResult> targets;
    std::vector<MachineFigures> machines;  ///< those with most runs first; empty if they were not recorded

    /// How many models of processors the runs were made on; 0 if that was not recorded. Times of several models are
    /// not comparable, and a report that pools them says so.
    [[nodiscard]] std::size_t processor_models() const;
    /// Whether plans were tested for certificates or flown in worlds.
    [[nodiscard]] bool has_worlds() const;
    /// Whether every target is met; false too while runs are missing and there is a target.
    [[nodiscard]] bool meets_its_targets() const;
};

/// How many steps a curve of a report has at most.
inline constexpr std::size_t max_steps = 1000;

/// Moments at which costs are compared [s].
inline constexpr double cost_moments_s[] = {0.1, 0.3, 1, 5, 30};

}  // namespace downwash::bench

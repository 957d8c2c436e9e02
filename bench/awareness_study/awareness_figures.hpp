#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/bench/awareness_study/awareness_cells.hpp"
#include "downwash/bench/awareness_study/awareness_rows.hpp"
#include "downwash/bench/paired_statistics.hpp"

namespace downwash::bench {

/// A plan that fails in more than this share of the fresh worlds is unreliable: planner.max_failure_probability.
inline constexpr double max_fresh_failures = 0.01;

/// Median, quartiles and the 95 % quantile of some values, which may be infinite; NaN without any.
struct Quantiles {
    double low = 0, median = 0, high = 0, most = 0;
};

/// The runs of one condition on the problems of a group, or on one problem.
struct AwarenessCell {
    Condition condition;
    ProblemGroup group = ProblemGroup::shipped;
    std::string problem;                        ///< empty: all problems of the group
    std::size_t attempted = 0;                  ///< runs
    Share planned;                              ///< of them that have a plan that counts
    std::map<std::string, std::size_t> missed;  ///< runs without one, by what stopped them
    Share fails;                                ///< of the plans: executed in the nominal world, not ok
    Estimate fresh_failures;                    ///< of the plans: share of fresh worlds in which one fails, mean
    Share unreliable;                           ///< of the plans: fail in more than max_fresh_failures
    Quantiles cost_ratio;                       ///< of the plans that hold: executed cost over the best known one
    Quantiles clearance_m;                      ///< of the plans that hold: least clearance
    Quantiles first_candidate_s;                ///< of all runs, infinite without one
    Quantiles first_certified_s;                ///< likewise
    Quantiles wall_s;                           ///< of all runs
    std::uint64_t discarded = 0;                ///< plans that a check discarded
};

/// What two conditions are compared in.
enum class Metric : std::uint8_t {
    reach,            ///< a run has a plan that counts
    fails,            ///< that plan fails when it is executed in the nominal world
    unreliable,       ///< it fails in more than max_fresh_failures of the fresh worlds
    fresh_failures,   ///< share of fresh worlds in which it fails
    cost,             ///< executed cost, if it holds in the nominal world
    clearance,        ///< least clearance there [m]
    candidate_time,   ///< time to the first candidate
    certificate_time  ///< time to the first certificate, infinite without one
};

/// "reach", "fails in the nominal world", ...
[[nodiscard]] std::string_view name_of(Metric metric);

/// Two conditions, compared on runs of equal problem and seed.
struct Comparison {
    Condition first, second;
    ProblemGroup group = ProblemGroup::shipped;
    std::string problem;  ///< empty: all problems of the group
    Metric metric = Metric::reach;
    bool is_claim = false;     ///< one of the study's claims, whose p values are adjusted together
    std::size_t pairs = 0;     ///< compared
    std::size_t left_out = 0;  ///< pairs of runs in which one or both have no value
    std::size_t fewest = 0;    ///< pairs of runs of the problem that has the fewest
    PairCounts counts;         ///< of an event
    Estimate effect;           ///< event: risk difference; cost, time: ratio; others: difference. First to second
    Estimate odds;             ///< event: matched odds ratio
    double p = 1;
    double p_adjusted = 1;  ///< after Holm, among the claims or among all others
};

/// What the data say of a comparison: "first better", "second better", "no difference shown", or "no data".
[[nodiscard]] std::string_view verdict_of(const Comparison& comparison);

/// The comparisons of the study, declared before it is run.
[[nodiscard]] std::vector<Comparison> declared_comparisons(const AwarenessSettings& settings);

/// The least executed cost of a plan that holds in the nominal world, among all runs of a problem with a robot.
struct BestKnown {
    double cost = 0;
    Condition condition;  ///< under which it was found
};

/// What the study has found.
struct AwarenessFigures {
    std::string version, commit, processor;                         ///< of the program that reports
    std::set<std::string> other_commits;                            ///< of programs that made some of the runs
    std::size_t planned = 0, done = 0;                              ///< runs of the lines
    std::map<std::pair<std::string, RobotChoice>, BestKnown> best;  ///< by name of the problem
    std::vector<AwarenessCell> cells;                               ///< of groups
    std::vector<AwarenessCell> by_problem;
    std::vector<Comparison> comparisons;
};

/// @param rows as of current_rows()
[[nodiscard]] AwarenessFigures awareness_figures(const AwarenessSettings& settings,
                                                 const std::vector<AwarenessRow>& rows);

/// As pages of results and for programs.
[[nodiscard]] std::string markdown_of(const AwarenessFigures& figures);
[[nodiscard]] std::string json_of(const AwarenessFigures& figures);

/// The table of cells with what it takes, as Markdown and for programs: before anything is run.
[[nodiscard]] std::string plan_markdown(const AwarenessSettings& settings, const std::vector<AwarenessRow>& rows,
                                        std::uint64_t jobs);
[[nodiscard]] std::string plan_json(const AwarenessSettings& settings, const std::vector<AwarenessRow>& rows,
                                    std::uint64_t jobs);

}  // namespace downwash::bench

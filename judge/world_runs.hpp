#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/judge/clearance_fan.hpp"
#include "downwash/judge/plan_judge.hpp"
#include "downwash/judge/statistics.hpp"

namespace downwash::judge {

/// Which worlds to fly in, and how.
struct WorldRunOptions {
    std::uint64_t runs = 1000;  ///< worlds 1 to this number, > 0
    std::uint64_t seed = 1;     ///< Seed of the worlds.
    int threads = 1;
    double fan_step_s = 0;  ///< > 0: WorldRuns has a fan with steps of this length; it keeps four bytes for each
    std::stop_token stop;
    std::function<void(double)> on_progress;  ///< called from the calling thread with the share that is done
};

/// A flight in a world.
struct WorldRun {
    std::uint64_t world = 0;
    Outcome outcome = Outcome::ok;
    double min_clearance_m = 0, max_tracking_error_m = 0, energy_j = 0;
    bool is_lateral_collision = false;  ///< see JudgedFlight
};

/// How much a parameter of the worlds matters.
struct Sensitivity {
    std::string parameter;  ///< key below `uncertainty`
    /// With the least clearance; nothing where that is the same everywhere.
    std::optional<double> rank_correlation;
    std::optional<std::array<double, deciles>> failure_share_by_decile;  ///< from its least to its greatest values
};

/// What flights of a plan in many worlds say about it.
struct WorldRuns {
    std::vector<WorldRun> runs;  ///< worlds 1, 2, ...
    std::size_t collisions = 0;
    std::size_t lateral_collisions = 0;  ///< of them
    std::size_t failures = 0;            ///< flights with any outcome but ok
    Probability collision_probability, failure_probability;
    double clearance_p01_m = 0, clearance_p10_m = 0, clearance_p50_m = 0;
    /// p50, p90, p99
    std::array<double, 3> tracking_error_m{}, energy_j{};
    std::vector<Sensitivity> sensitivity;  ///< One for every parameter that worlds draw.
    std::vector<WorldRun> worst;           ///< failed flights first, then by clearance; ten at most
    std::optional<ClearanceFan> fan;       ///< if it was asked for
};

/// Flies a plan in worlds of the problem's uncertainty. The result does not depend on the number of threads.
/// @return nothing if the stop token ended it
/// @pre judge.problem().uncertainty
[[nodiscard]] DOWNWASH_EXPORT std::optional<WorldRuns> fly_in_worlds(const PlanJudge& judge, const Plan& plan,
                                                                     const WorldRunOptions& options);

/// A number that worlds draw, in each of them.
struct DrawnValues {
    std::string parameter;  ///< key below `uncertainty`
    std::vector<double> of_world;
};

/// The statistics of flights that were flown.
/// @param runs at least one   @param drawn what their worlds differ in; what does not vary says nothing
[[nodiscard]] DOWNWASH_EXPORT WorldRuns statistics_of(std::vector<WorldRun> runs,
                                                      const std::vector<DrawnValues>& drawn);

/// The same in the plane. @param worlds that of each run
[[nodiscard]] DOWNWASH_EXPORT WorldRuns statistics_of(std::vector<WorldRun> runs, const std::vector<World>& worlds,
                                                      const Problem& problem);

}  // namespace downwash::judge

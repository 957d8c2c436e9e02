#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "downwash/bench/campaign_data.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/planner/world_flights.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/visit_order.hpp"

namespace downwash::bench {

/// Seed of the worlds in which campaigns fly plans. Searches have seeds below 2^32: none of them has seen these worlds.
inline constexpr std::uint64_t evaluation_seed = std::uint64_t{1} << 32U;

/// The quantiles at which a parameter is tried alone: the planner's own dangerous worlds have them too.
inline constexpr double low_quantile = 0.02, high_quantile = 0.98;

/// Flies plans of one problem in the same worlds, through the aero map. Safe to share between threads.
class PlanEvaluation {
 public:
    /// @param problem has an uncertainty   @param worlds how many: indices 1 to `worlds` of evaluation_seed
    /// @param map of the problem; nullptr for none
    PlanEvaluation(Problem problem, std::uint64_t worlds, std::shared_ptr<const AeroMap> map);

    /// @param plan through all goals of the problem
    [[nodiscard]] WorldFigures evaluate(const Plan& plan);

 private:
    /// Flights that no other thread uses; given back when their owner is done.
    std::unique_ptr<WorldFlights> take();
    void give_back(std::unique_ptr<WorldFlights> flights);

    Problem problem_;
    std::uint64_t world_count_;
    std::shared_ptr<const FlightModel> model_;
    std::shared_ptr<const AeroMap> map_;
    std::vector<std::string> parameters_;  ///< parameters that are not exact
    std::vector<FlownWorld> worlds_;       ///< those drawn; then each parameter at its low and its high quantile

    std::once_flag has_starts_;
    std::vector<std::optional<FlightState>> starts_;  ///< vehicles that have hovered in each world, for all plans

    std::mutex free_mutex_;
    std::vector<std::unique_ptr<WorldFlights>> free_;
};

/// The same for plans of a problem in space, through volumes that are filled where flights ask.
class SpacePlanEvaluation {
 public:
    /// @param problem has an uncertainty   @param worlds how many: indices 1 to `worlds` of evaluation_seed
    SpacePlanEvaluation(SpaceProblem problem, std::uint64_t worlds);

    /// @param plan through all goals of the problem   @param order in which it visits targets, if the problem has any
    /// @return nothing if it was stopped
    [[nodiscard]] std::optional<WorldFigures> evaluate(const SpacePlan& plan, const std::optional<VisitOrder>& order,
                                                       const std::stop_token& stop) const;

 private:
    SpaceProblem problem_;
    std::uint64_t world_count_;
    std::shared_ptr<const SpaceProblemModel> model_;
    std::shared_ptr<const SurfaceVolumes> volumes_;
    std::vector<std::string> parameters_;  ///< parameters that are not exact
    std::vector<SpaceWorld> worlds_;       ///< those drawn; then each parameter at its low and its high quantile
};

}  // namespace downwash::bench

#pragma once

#include <optional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/search/family.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::planning {

/// A plan executed with direct aerodynamics.
template <class Family>
struct DirectFlightOf {
    using Execution = typename Family::Execution;

    Execution execution;
    double wall_s = 0;  ///< how long that took
};
using DirectFlight = DirectFlightOf<Plane>;

/// Executes a plan with direct aerodynamics, from the start through all goals.
/// @param energy_budget_j as for execute()   @throws WorkStopped when it is over before the flight ends
[[nodiscard]] DOWNWASH_EXPORT DirectFlight fly_directly(const FlightModel& model, const FlightState& start,
                                                        const Plan& plan, const std::vector<Goal>& goals,
                                                        std::optional<double> energy_budget_j,
                                                        const StopCondition& is_over);

/// Whether a plan counts after its direct flight: it reaches its goals and keeps the margin.
[[nodiscard]] DOWNWASH_EXPORT bool is_good(const Execution& flight, double safety_margin_m);

}  // namespace downwash::planning

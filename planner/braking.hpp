#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/planner/world_flights.hpp"

namespace downwash::planning {

/// For how long a stop hovers before it counts [s].
inline constexpr double stop_hold_s = 2;

/// Flights that brake to a hover, wherever a vehicle is: from the reference that it follows to rest nearby, as the
/// limits of motion allow, and a hover there for stop_hold_s.
class DOWNWASH_EXPORT Braking {
 public:
    /// @param problem whose rules count: bounds, obstacles, margin and, with an uncertainty, its worlds
    /// @param map of the planner's own model over the places of the stops; nullptr: surfaces do not act in worlds
    /// @param worlds in which stops have to be safe, too   @param threads at least 1
    /// @pre the problem outlives it
    Braking(const Problem& problem, std::shared_ptr<const FlightModel> model, std::shared_ptr<const AeroMap> map,
            std::vector<FlownWorld> worlds, int threads = 1);

    /// The first of some ways to brake that is safe: it touches nothing and hovers, and keeps the margin in the nominal
    /// world if the vehicle has it where it begins. Nothing where none is.
    [[nodiscard]] std::optional<Plan> safe_stop(const Start& from) const;

    /// The places around the way on which a vehicle may stop, for the map of stops.
    [[nodiscard]] static Bounds reach(const Problem& problem, const Start& from);

 private:
    [[nodiscard]] bool is_safe(const Problem& stop, const Plan& plan) const;

    const Problem& problem_;
    std::shared_ptr<const FlightModel> model_;
    std::shared_ptr<const AeroMap> map_;
    std::vector<FlownWorld> worlds_;
    int threads_;
};

}  // namespace downwash::planning

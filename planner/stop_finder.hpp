#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/planner/braking.hpp"
#include "downwash/planner/safe_stops.hpp"
#include "downwash/planner/space_worlds.hpp"
#include "downwash/planner/world_flights.hpp"

namespace downwash::planning {

/// Where vehicles can stop as they follow plans of a problem from its start, in every world from where they are in that
/// world. Reference and way to brake are the same in all of them.
template <class Family>
class DOWNWASH_EXPORT StopFinderOf {
 public:
    using Problem = typename Family::Problem;
    using FlightModel = typename Family::FlightModel;
    using Effects = typename Family::Effects;
    using FlownWorld = typename Family::FlownWorld;
    using FlightState = typename Family::FlightState;
    using FlightJob = typename Family::FlightJob;
    using Plan = typename Family::Plan;
    using SafeStops = SafeStopsOf<Family>;
    using Braking = BrakingOf<Family>;

    /// As for Braking, with one map over all places.
    StopFinderOf(const Problem& problem, std::shared_ptr<const FlightModel> model, std::shared_ptr<const Effects> map,
                 std::vector<FlownWorld> worlds, int threads = 1);

    /// @param plan from the problem's start on   @throws WorkStopped when it is over before all stops are known
    [[nodiscard]] SafeStops along(const Plan& plan, const StopCondition& is_over = {});

 private:
    /// What is known of moments of the plan before: most of them are those of the next plan.
    struct Known {
        typename Braking::Moment moment;
        typename SafeStops::Moment stop;
    };
    /// The vehicle in each world at each knot of a plan, or where its flight ended before.
    [[nodiscard]] std::vector<Known> moments_of(const Plan& plan, const StopCondition& is_over);
    [[nodiscard]] const Known* known(const Known& asked) const;

    const Problem& problem_;
    std::shared_ptr<const FlightModel> model_;
    std::vector<FlownWorld> worlds_;  ///< without the nominal one
    Braking braking_;
    typename Family::WorldFlights flights_;
    std::vector<std::optional<FlightState>> starts_;  ///< in the worlds; found when first needed
    std::vector<Known> known_;
};
using StopFinder = StopFinderOf<Plane>;

}  // namespace downwash::planning

#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/space_segment.hpp"
#include "downwash/simulation/flight_rules.hpp"
#include "downwash/simulation/flight_sums.hpp"
#include "downwash/simulation/space_flight_state.hpp"
#include "downwash/simulation/space_world_description.hpp"

namespace downwash {

/// Whether two vehicles have the same state and memory to the last bit.
[[nodiscard]] DOWNWASH_EXPORT bool is_same(const AnySpaceState& a, const AnySpaceState& b) noexcept;

/// The outcome of a flight along one segment in space.
struct SpaceSegmentFlight : FlightSums {
    Rejection rejection = Rejection::none;
    std::int64_t ticks = 0;           ///< simulated, the rejected one included
    double max_tracking_error_m = 0;  ///< at ticks, the start included
    double max_saturation = 0;        ///< greatest demand over its limit; above 1 something was clipped
    double max_tilt_rate_rad_s = 0;   ///< of roll and pitch together, at ends of ticks
    double clearance_integral = 0;    ///< integral of clearance_density() over time [s/m], when measured
    /// Least clearance since the job began, as well as it is found; infinite where nobody asked, or without obstacles.
    double min_clearance_m = std::numeric_limits<double>::infinity();
};

/// One segment of a planned flight in space, and its outcome.
struct SpaceFlightLeg {
    SpaceSegment segment;
    SpaceSegmentFlight flight = {};  ///< zero ticks if the flight ended before
    AnySpaceState end = {};          ///< the vehicle at its end, or where it was rejected
};

class SpaceGoalRule;  // space_goal_rule.hpp

/// A flight in space along one or more segments, each beginning where the one before ended.
struct SpaceFlightJob {
    AnySpaceState start;               ///< see SpacePool::state_at()
    std::vector<SpaceFlightLeg> legs;  ///< one after the other, at least one
    /// World of the flight; nullptr: the nominal one. Must outlive the flight.
    const SpaceWorld* world = nullptr;
    std::int64_t first_tick = 0;  ///< control tick, from the start of the whole flight, with which it begins
    /// The vehicle must meet the pool's goal, slowly, this many ticks before the end of the last leg, every
    /// judging_step_ticks from there on, and at its end. Otherwise the flight is rejected as goal_missed. The last leg
    /// is then a hover. 0: no goal.
    std::int64_t judged_ticks = 0;
    static constexpr std::int64_t judging_step_ticks = 5;
    /// Its first goal is judged in place of the pool's; nullptr: the pool's. Must outlive the flight.
    const SpaceGoalRule* goal = nullptr;
    std::optional<double> margin_m = {};  ///< in place of the pool's

    /// The leg on which the flight ended early; nullptr when it did not.
    [[nodiscard]] const SpaceFlightLeg* rejected_leg() const noexcept {
        const auto rejected = std::find_if(legs.begin(), legs.end(), [](const SpaceFlightLeg& leg) {
            return leg.flight.rejection != Rejection::none;
        });
        return rejected != legs.end() ? &*rejected : nullptr;
    }
    /// Why the flight ended early.
    [[nodiscard]] Rejection rejection() const noexcept {
        return rejected_leg() != nullptr ? rejected_leg()->flight.rejection : Rejection::none;
    }
    /// The vehicle at the end of an accepted flight.
    [[nodiscard]] const AnySpaceState& end() const noexcept { return legs.back().end; }
};

/// Jobs in space that follow one another; see FlightChain.
class DOWNWASH_EXPORT SpaceFlightChain {
 public:
    SpaceFlightChain() = default;
    virtual ~SpaceFlightChain() = default;
    SpaceFlightChain(const SpaceFlightChain&) = delete;
    SpaceFlightChain& operator=(const SpaceFlightChain&) = delete;

    /// The job to fly now; nullptr: the chain has ended. It flies in the nominal world, or in one with a delay that is
    /// no longer. See FlightChain for when and by whom it is asked.
    [[nodiscard]] virtual SpaceFlightJob* next() = 0;
};

}  // namespace downwash

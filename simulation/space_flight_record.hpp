#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "downwash/base/stop_condition.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/flight_sums.hpp"
#include "downwash/simulation/space_goal_rule.hpp"
#include "downwash/simulation/space_loop.hpp"

// What goes into a flight in space, and what comes out: see space_flight.hpp.

namespace downwash {

/// In what and under which rules a plan in space is flown.
struct SpaceFlightSettings {
    SpaceWorld world = {};
    SpaceCarry carry = {};  ///< what the vehicle carries at the first knot
    /// Surfaces that act on the rotors; nullptr: none, and everything is flyable. One flight at a time.
    simulation::SpaceEffect* effect = nullptr;
    simulation::SpaceAero aero = {};
    const SpaceChecker* checker = nullptr;  ///< of collisions, with obstacles in their nominal places; nullptr: none
    std::int64_t first_tick = 0;            ///< of the plan, from the start of the whole flight: for the world's noise
    std::int64_t hold_ticks = 0;            ///< hover after the last knot, >= 0; without goals, which say it themselves
    /// Whether the vehicle has hovered at its start for settling_before_start_s in this world, without noise and gusts.
    /// The start is then at rest.
    bool settles = false;
    /// Whether rows have their clearance; false: it counts as infinite, and takes no time.
    bool measures_clearance = true;
    /// Whether a touch is led by the trim under its force: laws are told of it, and the reference takes the lean into
    /// account (docs/model.md 7.9). false: as in the plane.
    bool leads_touches = true;
    bool is_refined = true;  ///< as many Runge-Kutta steps as a tick needs; false: equal ones, as in planning
    /// The goals that the flight has to meet, slowly and throughout the last second of the plan's hover for each;
    /// nullptr: none. A contact follows its hover: the plan waits until the vehicle is back from the touch.
    const SpaceGoalRule* goals = nullptr;
    /// Whether a motion meets another goal; empty: no such goal. The vehicle meets it slowly and throughout the last
    /// second.
    std::function<bool(const SpaceMotion& motion, const Vector3& end_effector_m)> meets_goal;
    /// Called with the row of every tick; anything but Rejection::none ends the flight.
    std::function<Rejection(const SpaceFlightRow& row)> after_tick;
    StopCondition is_over;
    std::optional<double> energy_budget_j;  ///< a flight that takes more ends `over_budget` where it would end `ok`
};

/// A plan flown from start to the end of the hold.
struct SpaceFlight : FlightSums {
    Outcome outcome = Outcome::ok;
    Rejection rejection = Rejection::none;  ///< why it ended early
    double min_clearance_m = 0;             ///< at ticks; infinity without obstacles; touches do not count
    double clearance_integral = 0;          ///< see SpaceSegmentFlight
    double energy_j = 0;
    double duration_s = 0;
    double max_tracking_error_m = 0;
    double max_saturation = 0;  ///< greatest demand over its limit; above 1 something was clipped
    int joints = 0, rotor_count = 0;
    bool has_rotor_lag = false;
    AnySpaceState end{};                ///< the vehicle at the end
    std::vector<SpaceGoalVisit> goals;  ///< one for each goal of the rule, in their order there
    /// One per control tick, the last one at the end of the flight. Its commands are those that the controller would
    /// give next, or 0 where numbers are beyond max_result.
    std::vector<SpaceFlightRow> rows;
};

}  // namespace downwash

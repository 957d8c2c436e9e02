#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/controllers/reference_segment.hpp"
#include "downwash/simulation/flight.hpp"
#include "downwash/simulation/flight_record.hpp"
#include "downwash/simulation/goal.hpp"

namespace downwash {

/// The outcome's name in files, for example "left_flyable_area".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(Outcome outcome);

/// The rules of a flight that only has to succeed: it may leave bounds and reference, and ask more of rotors and joint
/// than they have. It ends where it touches something, tumbles or leaves the flyable area.
[[nodiscard]] DOWNWASH_EXPORT FlightRules rules_of_execution();

/// How a flight that ended early for this reason counts; `unstable` where no other outcome says why.
[[nodiscard]] DOWNWASH_EXPORT Outcome outcome_of(Rejection rejection);

/// Whether the robot touched a surface on purpose.
[[nodiscard]] DOWNWASH_EXPORT bool has_touch(const Execution& execution) noexcept;

/// Flies a reference from its first knot to its last and holds there, with surface effects evaluated directly. Where a
/// goal asks for a touch, the vehicle touches after its hover, for as long as that takes, and then goes on.
/// @param start vehicle at the first knot   @param knots at least one, ticks rising from 0
/// @param goals at least one, in the order of the visits. The vehicle hovers at the last one after the last knot. It
/// hovers at each other one between two knots that are the same point at rest, meet the goal, and are at least its hold
/// apart. If such a hover is missing, the one after the last knot counts for the first goal without a hover
/// @param aero false flies as if there were no surface effects (and no flyable area)
/// @param in the world of the flight; of its ceiling part only the model is asked
/// @param energy_budget_j a flight that takes more ends `over_budget` where it would end `ok`
/// @throws WorkStopped when it is over before the flight ends
[[nodiscard]] DOWNWASH_EXPORT Execution execute(const FlightModel& model, const FlightState& start,
                                                const std::vector<ReferenceKnot>& knots, std::span<const Goal> goals,
                                                bool aero, const FlightWorld& in = {},
                                                const StopCondition& is_over = {},
                                                std::optional<double> energy_budget_j = {});

/// How a part of a flight goes.
struct FlightPart {
    Rejection rejection = Rejection::none;
    double min_clearance_m = 0;  ///< up to its end; infinity without obstacles
    FlightState end{};           ///< vehicle at its end
};

/// A touch that follows a hover of a plan. The plan leaves the time out that it takes.
struct PlannedTouch {
    std::int64_t tick = 0;  ///< of the plan, at which the hover ends
    std::size_t goal = 0;   ///< number of the goal
    Touch touch;
    ReferencePoint base{};  ///< reference of the hover
};

/// The touches of a plan, in their order.
/// @param goals as of execute()
[[nodiscard]] DOWNWASH_EXPORT std::vector<PlannedTouch> touches_of(const FlightModel& model,
                                                                   const std::vector<ReferenceKnot>& knots,
                                                                   std::span<const Goal> goals);

/// Flies some segments one after the other under the rules of execute(), goals aside.
/// @param start vehicle at the beginning of the first one   @param segments at least one
/// @param touches that follow at ends of segments, their ticks from the beginning of the first one
/// @throws WorkStopped when it is over before the flight ends
[[nodiscard]] DOWNWASH_EXPORT FlightPart execute_part(const FlightModel& model, const FlightState& start,
                                                      std::span<const ReferenceSegment> segments, bool aero,
                                                      const FlightWorld& in, const StopCondition& is_over = {},
                                                      std::span<const PlannedTouch> touches = {});

/// Executes a plan for a single goal.
[[nodiscard]] inline Execution execute(const FlightModel& model, const FlightState& start,
                                       const std::vector<ReferenceKnot>& knots, const Goal& goal, bool aero) {
    return execute(model, start, knots, std::span(&goal, 1), aero);
}

/// How many control ticks a reference point is held as a goal; among alternatives, the hold of the nearest.
[[nodiscard]] DOWNWASH_EXPORT std::int64_t hold_ticks(const Goal& goal, const FlightModel& model,
                                                      const ReferencePoint& at);

/// The knots at which the hovers at the goals end, in their order: all but the last, at which the vehicle hovers after
/// the last knot. Fewer where the reference does not hover at all of them.
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::size_t> hover_ends(const FlightModel& model,
                                                                  const std::vector<ReferenceKnot>& knots,
                                                                  std::span<const Goal> goals);

/// Whether a vehicle meets the goal at this instant: within tolerance and slow enough.
[[nodiscard]] DOWNWASH_EXPORT bool meets_goal(const Goal& goal, const PlantModel& plant, const FlightState& state);

/// How long a vehicle has hovered at its start before a flight in a world begins [s].
inline constexpr double settling_before_start_s = 20;

/// The vehicle that has hovered at its start in a world until its controller has settled, without noise and gusts, with
/// surface effects evaluated directly. Empty if it does not stay stable there.
/// @param start at rest, nominal   @param aero as for execute()
[[nodiscard]] DOWNWASH_EXPORT std::optional<FlightState> hovering_start(const FlightModel& model,
                                                                        const FlightState& start, bool aero,
                                                                        const FlightWorld& in);

}  // namespace downwash

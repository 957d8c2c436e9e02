#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/controllers/reference_segment.hpp"
#include "downwash/simulation/flight.hpp"
#include "downwash/simulation/goal.hpp"

namespace downwash {

/// How an executed plan ended.
enum class Outcome : std::uint8_t {
    ok,
    collision,
    unstable,
    left_flyable_area,
    goal_missed,
    over_budget,  ///< met its goals, but took more energy than it may
};

inline constexpr std::array all_outcomes{Outcome::ok,          Outcome::collision,
                                         Outcome::unstable,    Outcome::left_flyable_area,
                                         Outcome::goal_missed, Outcome::over_budget};

/// The outcome's name in files, for example "left_flyable_area".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(Outcome outcome);

/// The rules of a flight that only has to succeed: it may leave bounds and reference, and ask more of rotors and joint
/// than they have. It ends where it touches something, tumbles or leaves the flyable area.
[[nodiscard]] DOWNWASH_EXPORT FlightRules rules_of_execution();

/// How a flight that ended early for this reason counts; `unstable` where no other outcome says why.
[[nodiscard]] DOWNWASH_EXPORT Outcome outcome_of(Rejection rejection);

/// The largest magnitude of a number of a flight or of a file of results, infinite clearances apart. A flight with a
/// larger one counts as unstable.
inline constexpr double max_result = 1e30;
/// The largest magnitude of a number of a vehicle's state; what follows from it is then within max_result.
inline constexpr double max_state = 1e20;

/// The vehicle at one control tick and the commands it holds until the next; SI units, plane coordinates.
struct FlightRow {
    double t_s = 0;
    ReferencePoint reference;
    double q[4] = {};                         ///< x, z, pitch, arm
    double u[4] = {};                         ///< their rates
    double rotor_command_n[max_rotors] = {};  ///< free-air thrust, after clipping
    double rotor_factor[max_rotors] = {};     ///< surface effect K at t_s
    double rotor_lag_n[max_rotors] = {};      ///< thrust that the lag has reached; meaningful with rotor lag only
    double thrust_command_n = 0;              ///< sum of the rotor commands
    double pitch_torque_command_nm = 0;       ///< -sum x_i T_i of the rotor commands
    double arm_torque_nm = 0;
    double thrust_n = 0;  ///< thrust in aerodynamic effect, at t_s
    double pitch_torque_nm = 0;
    double clearance_m = 0;  ///< infinity without obstacles
    double end_effector_x_m = 0;
    double end_effector_z_m = 0;
    double power_w = 0;
    double energy_j = 0;         ///< spent since the start
    double contact_force_n = 0;  ///< normal force of a surface that the robot touches, mean over the tick before
};

/// The outcome of one goal of a flight.
struct GoalVisit {
    bool is_met = false;  ///< throughout the last second of its hover
    double error_m = 0;   ///< worst over that second, or where the flight ended before
};

/// A plan flown from start to the end of the hold.
struct Execution : FlightSums {
    bool aero = true;  ///< whether surfaces acted on the rotors
    Outcome outcome = Outcome::ok;
    double min_clearance_m = 0;  ///< infinity without obstacles; a touch does not count
    double energy_j = 0;
    double duration_s = 0;
    double clearance_integral = 0;  ///< see SegmentFlight
    double max_tracking_error_m = 0;
    double max_saturation = 0;     ///< greatest demand over its limit; above 1 something was clipped
    double goal_error_m = 0;       ///< the worst of all goals
    double lateral_m = 0;          ///< how far the vehicle was to the left of its plane; see FlownWorld
    std::vector<GoalVisit> goals;  ///< one for each, in their order
    /// Share of the control ticks at which a part of the robot is in space that no sensor saw and that counts as free
    /// (Scene::unseen_space()); empty if the scene has none.
    std::optional<double> unseen_share;
    std::optional<TouchRecord> touch;  ///< touch of the last goal, where it asks for one and the flight came to it
    int rotor_count = 0;
    bool has_rotor_lag = false;
    /// One per control tick, the last one at the end of the flight, or one tick before where its numbers at the end are
    /// beyond max_result. Commands beyond it are 0.
    std::vector<FlightRow> rows;
};

/// Flies a reference from its first knot to its last and holds there, with surface effects evaluated directly. Where
/// the last goal asks for a touch, the vehicle touches after that hover.
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

/// Flies some segments one after the other under the rules of execute(), goals aside.
/// @param start vehicle at the beginning of the first one   @param segments at least one
/// @throws WorkStopped when it is over before the flight ends
[[nodiscard]] DOWNWASH_EXPORT FlightPart execute_part(const FlightModel& model, const FlightState& start,
                                                      std::span<const ReferenceSegment> segments, bool aero,
                                                      const FlightWorld& in, const StopCondition& is_over = {});

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

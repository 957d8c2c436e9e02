#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/comparison/alignment.hpp"
#include "downwash/comparison/compared_plan.hpp"
#include "downwash/comparison/phases.hpp"
#include "downwash/comparison/world_envelope.hpp"
#include "downwash/logs/flight_log.hpp"

namespace downwash {

/// Errors of places [m]: along x, y and z, and as a distance.
struct ErrorFigures {
    std::size_t samples = 0;
    std::array<double, 4> mean_m{};  ///< with its sign; of the distance its mean
    std::array<double, 4> rms_m{};
    std::array<double, 4> max_m{};  ///< of the size
    double max_at_s = 0;            ///< of the distance, time of the plan
};

/// Errors of an angle from its reference, over the whole plan.
struct AngleFigures {
    std::size_t samples = 0;
    double rms_rad = 0, max_rad = 0;
};

/// The errors while a plan is in a phase.
struct PhaseFigures {
    FlightPhase phase = FlightPhase::transit;
    double duration_s = 0;  ///< of the phase in the plan
    ErrorFigures errors;
    double min_clearance_m = 0;  ///< as flown; infinity without obstacles or samples
};

/// The least clearance of a flight.
struct LeastClearance {
    double clearance_m = 0;  ///< infinity without obstacles
    double at_s = 0;         ///< time of the plan
    std::string obstacle;    ///< the nearest one's name, if it has one
};

/// Commands of all rotors together, and what simulation says of them.
struct ThrustFigures {
    double unit_n = 1;  ///< thrust of 1 in the log [N], fitted to the flight with surface effects; 1 if it logs newtons
    double rms_with_effects_n = 0;  ///< root mean square from the planned flight with surface effects
    double rms_in_free_air_n = 0;   ///< the same from one without, with a fit of its own
    double mean_logged_n = 0, mean_planned_n = 0, mean_free_air_n = 0;
    std::size_t samples = 0;
};

/// A time during which the vehicle is outside the envelope of the worlds.
struct OutsideTime {
    double begin_s = 0, end_s = 0;  ///< of the plan
    std::size_t axis = 0;           ///< along which it is farthest outside: 0 x, 1 y, 2 z
    double excess_m = 0;            ///< how far at most
};

struct EnvelopeFigures {
    WorldEnvelope envelope;
    std::vector<OutsideTime> outside;  ///< times apart by less than 0.2 s are one
    double share = 0;                  ///< of the covered time that is outside along some axis
    /// The mean share of time that one more world's flight would be outside along one axis: 2 / (worlds + 1).
    double expected_axis_share = 0;
};

/// A flight at a moment of the plan, for pages and tables.
struct ComparedRow {
    double t_s = 0;
    Vector3 reference_m{}, planned_m{};
    Vector3 flown_m{};  ///< NaN where the log has no position
    double clearance_m = 0, planned_clearance_m = 0;
    double thrust_n = 0, planned_thrust_n = 0, free_air_thrust_n = 0;  ///< the first NaN without commands
};

/// How long a vehicle comes back to its reference after a jump of the log, at most [s].
inline constexpr double after_jump_s = 2;

/// A log, held against a plan.
struct LogComparison {
    LogAlignment alignment;
    std::string planned_outcome;
    double duration_s = 0;      ///< of the planned flight
    ErrorFigures tracking;      ///< from the reference
    ErrorFigures from_planned;  ///< from the flight that simulation plans
    /// Jumps of the log while the plan lasts, with times of the plan and steps in the problem's axes. What they add to
    /// errors is in all figures but `tracking_apart`.
    std::vector<LogJump> jumps;
    ErrorFigures tracking_apart;       ///< from the reference, without the after_jump_s behind each jump
    std::optional<AngleFigures> yaw;   ///< empty without an attitude in the log, and in a plane
    std::vector<AngleFigures> joints;  ///< one for each, if the log has them
    std::vector<PhaseFigures> phases;  ///< those that the plan has, in the order of FlightPhase
    LeastClearance clearance, planned_clearance;
    std::optional<ThrustFigures> thrust;            ///< empty without commands of rotors
    std::optional<EnvelopeFigures> envelope;        ///< empty if no worlds were asked for
    bool has_attitude = false, has_joints = false;  ///< whether the log says them; else the reference stands for them
    double row_step_s = 0;
    std::vector<ComparedRow> rows;
};

struct ComparisonOptions {
    AlignmentOptions alignment;
    EnvelopeWorlds worlds;  ///< count 0: none
};

/// Compares a log with a plan. @throws InputError if the plan cannot be found in it: align()
[[nodiscard]] DOWNWASH_EXPORT LogComparison compare(FlightLog log, const ComparedPlan& plan,
                                                    const ComparisonOptions& options = {});

}  // namespace downwash

#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/comparison/compared_plan.hpp"
#include "downwash/logs/flight_log.hpp"

namespace downwash {

/// Where a log is in time and space, seen from the plan.
struct LogAlignment {
    double offset_s = 0;          ///< time of the log at which the plan begins
    double rate = 1;              ///< seconds of the log in a second of the plan
    double yaw_rad = 0;           ///< by which the log's axes are to be turned about z
    Vector3 shift_m{};            ///< by which its places are to be moved then
    bool is_turned_over = false;  ///< the log's axes were guessed, and the other ones fit: turn_over()

    double correlation = 0;  ///< of the speeds, 1 where they are the same
    double residual_m = 0;   ///< root mean square of what is left between the log and the plan's own flight
    double covered = 0;      ///< share of the plan during which the log has a position
    bool is_time_fitted = false, is_rate_fitted = false, is_frame_fitted = false;
    std::vector<std::string> remarks;  ///< sentences for people

    /// The log's time at a time of the plan.
    [[nodiscard]] double log_time(double plan_s) const noexcept { return offset_s + rate * plan_s; }
    [[nodiscard]] DOWNWASH_EXPORT Vector3 turned(const Vector3& of_log) const noexcept;
    [[nodiscard]] Vector3 placed(const Vector3& of_log_m) const noexcept { return turned(of_log_m) + shift_m; }
};

/// What a user says of the alignment.
struct AlignmentOptions {
    std::optional<double> offset_s;  ///< of the log's t_s; empty: by correlation
    bool is_in_world = false;        ///< the log's places are those of the problem's world: nothing is turned or moved
};

/// Finds a plan in a log. The time comes from the correlation of horizontal and vertical speeds, then from the least
/// residual of places; a clock that runs at another rate is found where it shows. Axes are turned about z and moved by
/// least squares (Umeyama 1991, restricted to yaw).
/// @param planned what the plan's own flight is like; its rows are compared with the log
/// @throws InputError if the log nowhere resembles the plan, or holds too little of it
[[nodiscard]] DOWNWASH_EXPORT LogAlignment align(const FlightLog& log, const PlannedFlight& planned,
                                                 const AlignmentOptions& options = {});

/// A rotation about z and a shift that bring points onto others best.
struct YawFit {
    double yaw_rad = 0;
    Vector3 shift_m{};
    double residual_m = 0;  ///< root mean square
    double spread_m = 0;    ///< root mean square of the horizontal distance of `onto` from its middle
};

/// The least-squares fit of R(yaw) from + shift to `onto`. @param yaw_rad not to be fitted but this
/// @pre as many of both, at least one
[[nodiscard]] DOWNWASH_EXPORT YawFit fit_yaw(std::span<const Vector3> from, std::span<const Vector3> onto,
                                             std::optional<double> yaw_rad = {});

}  // namespace downwash

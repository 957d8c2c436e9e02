#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

#include "downwash/base/bounds.hpp"

namespace downwash {

/// Why a flight was rejected or ended early.
enum class Rejection : std::uint8_t {
    none,
    collision,     ///< nearer to an obstacle than allowed
    flyable_area,  ///< a rotor disc nearer to an obstacle than the aerodynamic map reaches (docs/model.md 4.4)
    saturation,    ///< a rotor or the joint was asked for more than it has
    tracking,      ///< the vehicle or the arm was too far from its reference
    unstable,      ///< tumbling, or numbers that are not finite
    bounds,        ///< the centre of mass left the bounds
    arm_limits,    ///< the arm left its limits
    goal_missed,   ///< hovered at the goal but did not meet it
    over_budget,   ///< a whole flight took more energy than it may
    interrupted,   ///< ended from outside; says nothing about the flight
};

/// Beyond this pitch a multirotor is lost, whatever its controller does next [rad] (80 degrees).
inline constexpr double unstable_pitch_rad = 1.3962634015954636;
/// A flight that is farther than this from its reference has lost its plan [m].
inline constexpr double unstable_error_m = 3.0;

/// How far a robot may move between two collision checks [m]. If it keeps the margin at both, it touches nothing on the
/// way, because each of its points stays within half of that distance from a checked pose. With a margin below 2.5 mm
/// it may cut corners by this distance.
[[nodiscard]] inline double max_unseen_motion_m(double margin_m) noexcept {
    return std::max(2 * margin_m, 0.005);
}

/// By how much a FlightPool may overestimate the least clearance of a flight: a share of it, and a length where that is
/// more.
struct ClearanceError {
    double share = 0.05;
    double length_m = 0.005;

    [[nodiscard]] constexpr double at_m(double clearance_m) const noexcept {
        return std::max(length_m, share * clearance_m);
    }
};

/// The rules of a planned flight.
struct FlightRules {
    double margin_m = 0.05;             ///< least clearance, also between ticks: see max_unseen_motion_m
    Bounds bounds;                      ///< area that the centre of mass may not leave
    double max_tracking_error_m = 0.3;  ///< distance of (x, z) from the reference
    double max_arm_error_rad = 0.35;    ///< arm angle from the reference (20 degrees)
    double max_saturation = 1;          ///< greatest demand on a rotor or the joint over its limit
    double max_pitch_rate_rad_s = std::numeric_limits<double>::infinity();  ///< largest pitch rate of the vehicle
    std::function<bool()> is_over;    ///< polled now and then; true ends the flight as interrupted
    bool measures_clearance = false;  ///< integrates clearance (slow), for the objective of that name
    std::optional<ClearanceError> finds_min_clearance = {};  ///< how well every flight finds its least clearance
};

/// Integrand of the objective `clearance` [1/m].
[[nodiscard]] inline double clearance_density(double clearance_m) noexcept {
    return 1 / ((clearance_m > 0 ? clearance_m : 0) + 0.1);
}

}  // namespace downwash

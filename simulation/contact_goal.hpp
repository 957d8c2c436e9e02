#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// What of the robot touches a surface.
enum class TouchingPart : std::uint8_t {
    frame,         ///< the top of the multirotor, as rotor guards do: from below
    end_effector,  ///< the end of the arm, along the arm: from below, from above or from a side
};

/// A surface that the robot must touch and press on: approach, touch, hold the force, leave (docs/model.md 7.5).
struct ContactGoal {
    std::string obstacle;  ///< name of the obstacle
    double force_n = 5;    ///< normal force that is held, > 0
    TouchingPart part = TouchingPart::frame;
    std::optional<double> x_m, z_m;           ///< where on it, along the plane; empty: anywhere
    double tolerance_m = 0.1;                 ///< of the place from which the robot touches, > 0
    std::optional<double> force_tolerance_n;  ///< of the mean over each second, > 0; empty: a fifth of the force
    double standoff_m = 0.3;                  ///< distance from the surface before and after, > 0
    double speed_m_s = 0.1;                   ///< of approach and leaving, > 0

    /// What the force may be off by [N].
    [[nodiscard]] double tolerance_n() const noexcept { return force_tolerance_n.value_or(0.2 * force_n); }
};

/// A point of the plane of motion [m], or a direction in it.
struct PlaneVector {
    double x = 0, z = 0;
};

/// How a robot that waits at a goal touches the surface in front of it.
struct Touch {
    PlaneVector surface_m;                    ///< point of the surface; of an arm's, its radius in front of it
    PlaneVector normal;                       ///< unit vector out of it, along x or z
    std::vector<PlaneVector> frame_points_m;  ///< of the multirotor, in the body frame; none: the end effector touches
    double force_n = 0;                       ///< normal force that is held
    double force_tolerance_n = 0;             ///< of the mean over each second
    double standoff_m = 0;                    ///< from the surface, before and after
    double speed_m_s = 0;                     ///< of approach and leaving
    double hold_s = 0;                        ///< how long the force is held
};

/// A touch in flight.
struct TouchRecord {
    bool is_met = false;       ///< the force was held within its tolerance, and the robot left the surface
    double touched_s = 0;      ///< first contact, from the start of the flight; 0: never
    double left_s = 0;         ///< last contact; 0: never
    double force_n = 0;        ///< mean over the hold
    double force_error_n = 0;  ///< worst of the mean over a second of the hold; of the whole force without any
    double peak_force_n = 0;   ///< greatest mean over a tick
    double max_depth_m = 0;    ///< by which the part went into the surface
    double power_w = 0;        ///< mean over the hold
};

/// How fast the reference takes up an error of the force: a share of the natural frequency of the position loop, ...
inline constexpr double force_loop_share = 0.4;
/// ... for so many of its time constants before the hold of the force begins.
inline constexpr double touch_settling_constants = 5;
/// The robot hovers for so long where it touched from, ...
inline constexpr double touch_leaving_s = 8;
/// ... after it has pulled until it was free for so long, ...
inline constexpr double touch_free_s = 0.1;
/// ... or gives up pulling with the reference so far in front of that place [m], ...
inline constexpr double touch_pull_m = 2;
/// ... gives up approaching so far behind the place where the surface should be [m], ...
inline constexpr double touch_overshoot_m = 0.5;
/// ... and must not go deeper into it than this [m].
inline constexpr double max_touch_depth_m = 0.002;

}  // namespace downwash

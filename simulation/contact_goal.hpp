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
    std::string obstacle;  ///< Name of the obstacle.
    double force_n = 5;    ///< Normal force that is held, > 0.
    TouchingPart part = TouchingPart::frame;
    std::optional<double> x_m, z_m;  ///< Where on it, along the plane; empty: anywhere.
    double tolerance_m = 0.1;        ///< Tolerance of the place from which the robot touches, > 0.
    std::optional<double>
        force_tolerance_n;    ///< Allowed error of the mean over a second, > 0; empty: a fifth of the force.
    double standoff_m = 0.3;  ///< Distance from the surface before and after, > 0.
    double speed_m_s = 0.1;   ///< Speed of approach and leaving, > 0.

    /// The allowed error of the mean force over a second [N].
    [[nodiscard]] double tolerance_n() const noexcept { return force_tolerance_n.value_or(0.2 * force_n); }
};

/// A point of the plane of motion [m], or a direction in it.
struct PlaneVector {
    double x = 0, z = 0;
};

/// What a touch of a surface is to be.
struct TouchDemand {
    double force_n = 0;            ///< Normal force that is held.
    double force_tolerance_n = 0;  ///< Allowed error of the mean over a second.
    double standoff_m = 0;         ///< Distance from the surface, before and after.
    double speed_m_s = 0;          ///< Speed of approach and leaving.
    double hold_s = 0;             ///< How long the force is held.
};

/// How a robot that waits at a goal touches the surface in front of it.
struct Touch : TouchDemand {
    PlaneVector surface_m;  ///< Point of the surface; for an arm that touches, its radius in front of it.
    PlaneVector normal;     ///< Unit vector out of the surface, along x or z.
    std::vector<PlaneVector>
        frame_points_m;  ///< What of the multirotor touches, in the body frame; none: the end effector.
};

/// A touch in flight.
struct TouchRecord {
    bool is_met = false;   ///< The force was held within its tolerance, and the robot left the surface.
    double touched_s = 0;  ///< First contact, from the start of the flight; 0: never.
    double left_s = 0;     ///< Last contact; 0: never.
    double force_n = 0;    ///< Mean force over the hold.
    /// Greatest error of the mean over a second of the hold; the whole force without a hold.
    double force_error_n = 0;
    double peak_force_n = 0;  ///< Greatest mean over a tick.
    double max_depth_m = 0;   ///< How deep the part went into the surface.
    double power_w = 0;       ///< Mean power over the hold.
};

/// How fast the reference takes up an error of the force: a share of the natural frequency of the position loop.
inline constexpr double force_loop_share = 0.4;
/// How many time constants of that loop the force settles for before its hold begins.
inline constexpr double touch_settling_constants = 5;
/// How long the robot hovers after a touch, in the place from which it touched [s].
inline constexpr double touch_leaving_s = 8;
/// How long the robot has to be free of the surface until it stops pulling [s].
inline constexpr double touch_free_s = 0.1;
/// How long the robot hovers in front of the surface before a touch, within the hold of its goal [s].
inline constexpr double touch_hover_s = 2;
/// How far in front of the hover the reference is when the robot gives up pulling [m].
inline constexpr double touch_pull_m = 2;
/// How far behind the nominal surface the robot gives up approaching [m].
inline constexpr double touch_overshoot_m = 0.5;
/// Greatest depth to which the robot may go into the surface [m].
inline constexpr double max_touch_depth_m = 0.002;

}  // namespace downwash

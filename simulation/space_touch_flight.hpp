#pragma once

#include <optional>

#include "downwash/controllers/space_actuate.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/dynamics/space_contact.hpp"
#include "downwash/scene/space_pose.hpp"
#include "downwash/simulation/space_loop.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/space_touch.hpp"
#include "downwash/simulation/touch_course.hpp"

// A touch in space, tick by tick (docs/model.md 7.9). Private: not installed.

namespace downwash::simulation {

/// Leads a vehicle through a touch, from a hover in front of the surface to the same hover, and writes down what comes
/// of it.
class SpaceTouchFlight {
 public:
    /// @param base reference of the hover, at rest   @param is_led see SpaceFlightSettings::leads_touches
    /// @pre all but base outlive this
    SpaceTouchFlight(const SpaceRobot& robot, const SpaceTouch& touch, const SpaceWorld& world, const SpacePoint& base,
                     bool is_led);

    /// The surface as the world has it.
    [[nodiscard]] const dynamics::SpaceContact& contact() const noexcept { return contact_; }
    /// The reference of the tick that follows.
    [[nodiscard]] SpacePoint reference() const;
    /// What a law is told that the surface does in that tick; empty: nothing, and the reference alone asks for the
    /// force.
    [[nodiscard]] std::optional<controllers::ToldPush> push() const;
    [[nodiscard]] bool is_at_surface() const noexcept { return course_.is_at_surface(); }
    [[nodiscard]] bool is_over() const noexcept { return course_.is_over(); }

    /// Goes on by a tick. @param motion after it   @param end_s of it, from the start of the flight
    /// @param energy_j spent in it
    void saw(const dynamics::SpaceContactRecord& seen, const SpaceMotion& motion, double end_s, double energy_j);
    /// Whether a part is so deep in the surface that the flight ends.
    [[nodiscard]] bool is_too_deep() const noexcept { return depth_m_ > max_touch_depth_m; }

    /// The pose at which to check the obstacles that are not touched: moved out of the surface, and a little farther.
    /// @param pose among obstacles in their nominal places
    [[nodiscard]] SpacePose off_surface(SpacePose pose) const;

    /// @param is_at_end nothing ended the flight before
    [[nodiscard]] SpaceTouchRecord record(bool is_at_end) const;

 private:
    [[nodiscard]] SpaceTouchEnd end_of(const SpaceTouchRecord& record, bool is_at_end) const;
    /// The force that is asked for [N].
    [[nodiscard]] double asked_n() const { return force_per_m_ * course_.beyond_m(); }

    const SpaceRobot& robot_;
    const SpaceTouch& touch_;
    const SpaceWorld& world_;
    SpacePoint base_;
    bool is_led_;
    bool is_told_;        ///< the law hears of the force
    double force_per_m_;  ///< that the law answers to an error of the position along the normal [N/m]
    dynamics::SpaceContact contact_;
    TouchCourse course_;
    TouchForce force_;
    double depth_m_;                 ///< of the deepest point over the last tick
    std::optional<Vector3> held_m_;  ///< middle of the points as the hold began, in the nominal scene
    double slip_m_ = 0;
};

/// The reference of a vehicle that presses with its end effector: in the equilibrium under the force, with the yaw of
/// another reference, the end effector is in the place of that one and points as there, as far as the joints allow.
/// Presses with its top: the other reference itself.
/// @param base at rest   @param force_n >= 0, along the normal
[[nodiscard]] SpacePoint leaning(const SpaceRobot& robot, const SpaceTouch& touch, const SpacePoint& base,
                                 double force_n);

}  // namespace downwash::simulation

#pragma once

#include <optional>
#include <variant>

#include "downwash/judge/space_control.hpp"
#include "downwash/judge/space_touching.hpp"

// What leads a vehicle in space through a touch: its reference, which leans, and the push that its law expects
// (docs/model.md 7.9). Private: not installed.

namespace downwash::judge {

/// What a robot is told in a touch.
class SpaceTouchLead {
 public:
    /// @param from reference of the hover, at rest   @pre all but that outlive this
    SpaceTouchLead(const TouchCourse& course, const SpaceTouch& touch, const SpaceRobot& robot, const SpacePoint& from);

    /// The reference of a tick that follows.
    [[nodiscard]] SpacePoint reference() const;
    /// The push that the law expects in it.
    [[nodiscard]] std::optional<BodyPush> push() const;

 private:
    /// The surface's force that is asked for, world axes.
    [[nodiscard]] Eigen::Vector3d force_n() const;
    /// Leans the reference of the hover so that the end effector stays.
    [[nodiscard]] SpacePoint leant() const;
    /// Whether the law hears of the force.
    [[nodiscard]] bool is_told() const { return std::holds_alternative<SpaceInversion>(robot_.controller.law); }

    const TouchCourse& course_;
    const SpaceTouch& touch_;
    const SpaceRobot& robot_;
    SpacePoint from_;
    SpaceVehicle nominal_;
};

}  // namespace downwash::judge

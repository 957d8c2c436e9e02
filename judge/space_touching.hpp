#pragma once

#include <vector>

#include "downwash/judge/space_bodies.hpp"
#include "downwash/judge/touch_course.hpp"
#include "downwash/simulation/space_touch.hpp"

// A surface that a robot in space touches, and how it is led there (docs/model.md 2.11 and 7.9). Private: not
// installed.

namespace downwash::judge {

/// The surface of a touch in a world.
class SpaceTouchSurface {
 public:
    /// @pre touch outlives it
    DOWNWASH_EXPORT SpaceTouchSurface(const SpaceTouch& touch, const SpaceWorld& world);

    [[nodiscard]] const SpaceTouch& touch() const noexcept { return *touch_; }

    /// How deep the deepest point of what touches is in the surface [m]; negative: its distance.
    [[nodiscard]] DOWNWASH_EXPORT double depth_m(const SpaceVehicle& vehicle, const BodyMotions& bodies) const;

    /// Adds what the surface does to each body. @return the normal force [N]
    DOWNWASH_EXPORT double push(const SpaceVehicle& vehicle, const BodyMotions& bodies,
                                std::vector<BodyLoad>& loads) const;

    /// The middle of what touches, where obstacles are in their nominal places.
    [[nodiscard]] DOWNWASH_EXPORT Eigen::Vector3d middle_m(const SpaceVehicle& vehicle,
                                                           const BodyMotions& bodies) const;

 private:
    const SpaceTouch* touch_;
    SpaceWorld world_;
    Eigen::Vector3d surface_m_, normal_;  ///< in the world
};

/// From the centre of mass of a body to a point of it that may touch, in the axes of the body.
[[nodiscard]] Eigen::Vector3d lever_of(const SpaceVehicle& vehicle, const SpaceTouchPoint& point);

/// What the law of a robot answers to a metre along the normal of a touch [1/s2].
[[nodiscard]] double answer_1_s2(const SpaceTouch& touch, const SpaceRobot& robot);

/// The course of a touch by a robot. @pre touch outlives it
[[nodiscard]] DOWNWASH_EXPORT TouchCourse course_of(const SpaceTouch& touch, const SpaceRobot& robot);

}  // namespace downwash::judge

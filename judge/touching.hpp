#pragma once

#include <vector>

#include "downwash/controllers/reference_point.hpp"
#include "downwash/judge/equations_of_motion.hpp"
#include "downwash/judge/touch_course.hpp"
#include "downwash/simulation/contact_goal.hpp"
#include "downwash/simulation/robot.hpp"
#include "downwash/simulation/world.hpp"

// A surface that the robot touches, and how it does (docs/model.md 2.6 and 7.5). Private: not installed.

namespace downwash::judge {

/// The surface of a touch in a world.
class TouchSurface {
 public:
    /// @pre touch outlives it
    TouchSurface(const Touch& touch, const World& world) : touch_(&touch), shift_{world.scene_x_m, world.scene_z_m} {}

    [[nodiscard]] const Touch& touch() const noexcept { return *touch_; }

    /// How deep the deepest point of what touches is in the surface [m]; negative: its distance.
    /// @param motion of the true centre of mass
    [[nodiscard]] double depth_m(const Vehicle& vehicle, const Motion& motion) const;

    /// Adds what the surface does to the robot. @return the normal force [N]
    double push(const Vehicle& vehicle, const Motion& motion, Loads& loads) const;

 private:
    /// Something of the robot that can touch.
    struct Place {
        Planar position_m, velocity_m_s;
        Planar lever_m;  ///< from the centre of mass of the body that it belongs to
    };
    [[nodiscard]] std::vector<Place> places(const Vehicle& vehicle, const Motion& motion) const;
    [[nodiscard]] double depth_m(const Place& place) const;

    const Touch* touch_;
    Planar shift_;
};

/// The course of a touch by a robot. @pre touch outlives it
[[nodiscard]] TouchCourse course_of(const Touch& touch, const Robot& robot);

/// The reference of a tick that follows. @param from reference of the hover
[[nodiscard]] ReferencePoint reference_of(const TouchCourse& course, const Touch& touch, ReferencePoint from);

}  // namespace downwash::judge

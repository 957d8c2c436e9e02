#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "downwash/controllers/reference_point.hpp"
#include "downwash/judge/equations_of_motion.hpp"
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

/// Leads a vehicle through a touch: to the surface, against it with a force, and back.
class TouchCourse {
 public:
    /// @param from reference of the hover   @pre touch outlives it
    TouchCourse(const Touch& touch, const ReferencePoint& from, const Robot& robot);

    [[nodiscard]] ReferencePoint reference() const;
    [[nodiscard]] bool is_over() const noexcept { return stage_ == Stage::over; }
    /// Between the first contact and the last.
    [[nodiscard]] bool is_at_surface() const noexcept {
        return stage_ == Stage::settling || stage_ == Stage::holding || stage_ == Stage::pulling;
    }
    /// Goes on by a tick. @param force_n mean over it
    void next(double force_n);

    /// The force over the hold: its mean, and the worst mean of a second of it; empty if it was not held for a second.
    struct Hold {
        double mean_n, worst_second_n;
    };
    [[nodiscard]] std::optional<Hold> hold() const;

 private:
    enum class Stage { coming, settling, holding, pulling, going, hovering, over };

    void enter(Stage stage);

    const Touch& touch_;
    ReferencePoint from_;
    double tick_s_;
    double metres_per_newton_;  ///< How far the reference moves in a tick.
    double settling_s_;
    Stage stage_ = Stage::coming;
    std::int64_t since_ = 0;  ///< ticks in this stage
    std::int64_t free_ = 0;   ///< ticks without contact
    double beyond_m_ = 0;     ///< Place of the reference, from the hover towards the surface.
    std::vector<double> held_n_;
};

}  // namespace downwash::judge

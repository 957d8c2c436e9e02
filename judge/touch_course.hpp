#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "downwash/simulation/contact_goal.hpp"

// How a touch goes on, in plane and space (docs/model.md 7.5). Private: not installed.

namespace downwash::judge {

/// Leads a vehicle through a touch: to the surface, against it with a force, and back.
class TouchCourse {
 public:
    /// @param answer_1_s2 of the law to a metre along the way   @pre touch outlives it
    TouchCourse(const TouchDemand& touch, double mass_kg, double answer_1_s2, double tick_s);

    /// Place of the reference, from the hover towards the surface, and its speed.
    [[nodiscard]] double beyond_m() const noexcept { return beyond_m_; }
    [[nodiscard]] double speed_m_s() const;
    /// How much of that way is behind the place of the first contact: what asks for a force.
    [[nodiscard]] double pressed_m() const;
    [[nodiscard]] bool is_holding() const noexcept { return stage_ == Stage::holding; }
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

    const TouchDemand& touch_;
    double tick_s_;
    double metres_per_newton_;  ///< How far the reference moves in a tick.
    double settling_s_;
    Stage stage_ = Stage::coming;
    std::int64_t since_ = 0;  ///< ticks in this stage
    std::int64_t free_ = 0;   ///< ticks without contact
    double beyond_m_ = 0;
    std::optional<double> met_m_;  ///< the way at the first contact
    std::vector<double> held_n_;
};

}  // namespace downwash::judge

#pragma once

#include <cstdint>
#include <vector>

#include "downwash/base/infinity.hpp"
#include "downwash/simulation/contact_goal.hpp"

// How a touch goes on, in plane and space (docs/model.md 7.5). Private: not installed.

namespace downwash::simulation {

/// How far the reference of a touch is in front of the hover, along the way into the surface: in front of the surface,
/// against it, or on the way back.
class TouchCourse {
 public:
    /// @param mass_kg of the robot   @param stiffness_1_s2 what the law answers to a metre along the way
    /// @pre touch outlives it
    TouchCourse(const TouchDemand& touch, double mass_kg, double stiffness_1_s2, double tick_s);

    [[nodiscard]] double ahead_m() const noexcept { return ahead_m_; }
    /// How far it is beyond where it was at the first contact: what asks for a force. 0 without a contact.
    [[nodiscard]] double beyond_m() const noexcept { return ahead_m_ > contact_m_ ? ahead_m_ - contact_m_ : 0; }
    /// How fast the reference goes, into the surface.
    [[nodiscard]] double along_m_s() const noexcept;
    /// Goes on by a tick. @param force_n mean normal force over it
    void next(double force_n);

    /// Whether the tick that follows belongs to the hold of the force.
    [[nodiscard]] bool is_holding() const noexcept { return phase_ == Phase::hold; }
    /// Whether it is between the first contact and the last: in between the vehicle may bounce.
    [[nodiscard]] bool is_at_surface() const noexcept {
        return phase_ == Phase::settle || phase_ == Phase::hold || phase_ == Phase::leave;
    }
    [[nodiscard]] bool is_over() const noexcept { return is_over_; }
    /// Of one that is over: it gave up pulling.
    [[nodiscard]] bool is_stuck() const noexcept { return is_over_ && phase_ == Phase::leave; }

 private:
    enum class Phase { approach, settle, hold, leave, go_back, wait };

    void go_to(Phase phase) {
        phase_ = phase;
        ticks_ = 0;
    }
    /// In this phase.
    [[nodiscard]] double seconds() const noexcept { return static_cast<double>(ticks_) * tick_s_ + 1e-9; }

    const TouchDemand& touch_;
    double tick_s_;
    double gain_m_n_s_ = 0;  ///< how fast the reference goes on for a newton [m / (N s)]
    double settling_s_ = 0;
    Phase phase_ = Phase::approach;
    double ahead_m_ = 0;
    double contact_m_ = infinity;  ///< where it was at the first contact
    std::int64_t ticks_ = 0;
    std::int64_t free_ticks_ = 0;  ///< without contact
    bool is_over_ = false;
};

/// The force of a touch, tick by tick.
class TouchForce {
 public:
    /// @pre touch outlives it
    TouchForce(const TouchDemand& touch, double tick_s) : touch_(touch), tick_s_(tick_s) {}

    /// @param impulse_n_s,depth_m of the tick   @param end_s of the tick, from the start of the flight
    /// @param energy_j spent in the tick
    void saw(double impulse_n_s, double depth_m, double end_s, double energy_j, bool is_holding);
    /// @param is_at_end nothing ended the flight before
    [[nodiscard]] TouchRecord record(bool is_at_end) const;

 private:
    const TouchDemand& touch_;
    double tick_s_;
    TouchRecord record_;
    std::vector<double> forces_n_;
    double energy_j_ = 0;
    double last_depth_m_ = 0;
};

}  // namespace downwash::simulation

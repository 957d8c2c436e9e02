#pragma once

#include <cstdint>
#include <optional>

#include "downwash/base/infinity.hpp"
#include "downwash/simulation/space_flight_record.hpp"
#include "downwash/simulation/space_touch_flight.hpp"

// One vehicle in space, tick by tick, under the rules of fly(). Private: not installed.

namespace downwash::simulation {

/// Whether a vehicle is lost.
class SpaceStability {
 public:
    [[nodiscard]] bool is_lost(const SpaceLoop& loop, const SpaceMotion& motion, const SpacePoint& reference);

 private:
    bool was_upright_ = false;
};

/// Flies a vehicle through ticks and touches, judges every state and writes rows and figures into a flight.
class SpaceFlying {
 public:
    /// @param loop with the vehicle in it   @param reference at which it begins   @pre all but it outlive this
    SpaceFlying(const SpaceRobot& robot, const SpaceFlightSettings& settings, SpaceLoop& loop,
                const SpacePoint& reference, SpaceFlight& flight);

    /// Why the flight is over; Rejection::none: it is not.
    [[nodiscard]] Rejection rejection() const noexcept { return rejection_; }
    [[nodiscard]] std::int64_t ticks() const noexcept { return static_cast<std::int64_t>(flight_.rows.size()); }

    /// Lets the vehicle hover where it starts, without noise, as if it had always been there.
    void settle(const SpaceMotion& start);
    /// Judges the state that the flight begins with.
    void begin();
    /// A tick. @param next reference at its end
    void tick(const SpacePoint& next);
    /// A touch from the hover here to the same hover. The flight is over if it is not met.
    [[nodiscard]] SpaceTouchRecord touch(const SpaceTouch& touch);
    /// Adds the last row, with what the controller commands at the end; nothing is flown with it.
    void end();

 private:
    /// One tick: `move` takes the vehicle on, and says the reference at its end.
    template <class Move>
    void fly_tick(const Move& move);
    [[nodiscard]] Rejection judged(const SpaceMotion& before);
    [[nodiscard]] bool touches_anything(const SpaceMotion& motion);
    [[nodiscard]] bool may_touch(const SpacePose& pose);
    [[nodiscard]] Rejection add(SpaceFlightRow row);

    const SpaceRobot& robot_;
    const SpaceFlightSettings& settings_;
    SpaceLoop& loop_;
    SpacePoint reference_;
    SpaceFlight& flight_;
    double tick_s_;
    Rejection rejection_ = Rejection::none;
    SpaceStability stability_;
    double clearance_m_ = infinity;
    double contact_force_n_ = 0;
    std::optional<SpacePose> before_;          ///< as obstacles saw the last state
    SpacePose looked_at_;                      ///< where collisions were looked for last, and
    SpaceChecker::FreeMotion free_;            ///< how far from there none can be
    int looks_left_ = 0;                       ///< collisions are looked for so often before that is asked again
    const SpaceTouchFlight* touch_ = nullptr;  ///< obstacles see the vehicle a little off its surface
};

}  // namespace downwash::simulation

#pragma once

#include <cstdint>
#include <vector>

#include "downwash/judge/judged_flight.hpp"
#include "downwash/judge/loop.hpp"
#include "downwash/judge/obstacles.hpp"

// The rules of docs/model.md 7. Private: not installed.

namespace downwash::judge {

/// Whether the numbers are finite, and the vehicle neither tumbles nor runs away from its reference.
[[nodiscard]] bool is_stable(const Motion& motion, const ReferencePoint& reference);

/// Writes down a flight and finds out how it ends.
class Umpire {
 public:
    /// @param effects nullptr: free air, where all is flyable   @param flight that is written down, empty
    Umpire(const Problem& problem, const SurfaceEffects* effects, const Obstacles& obstacles, const World& world,
           JudgedFlight& flight);

    /// Looks at the vehicle at a tick; false if the flight ends here.
    bool sees(const Loop& loop, const ReferencePoint& reference);

    /// Looks at a vehicle that may touch a surface with the part that is meant to.
    bool sees_touch(const Loop& loop, const ReferencePoint& reference, const TouchSurface& surface);

    /// Says how a touch ended; the flight, too, where it is not met. @param hold empty: the force was not held
    /// @return mean force [N]
    double sees_hold(const Touch& touch, const std::optional<TouchCourse::Hold>& hold);

    /// A hover at a goal, and the touch that followed.
    struct Stay {
        std::optional<std::size_t> row;        ///< at the end of the hover
        std::optional<std::size_t> row_after;  ///< at the end of the touch, met or not
        std::optional<double> touch_force_n;
        bool is_touch_met = true;
    };
    /// Goes through the goals at the end of a flight. @param stays one for each
    void sees_goals(const std::vector<Goal>& goals, const std::vector<Stay>& stays);

 private:
    /// An instant within a tick.
    struct Instant {
        double since_s;
        Motion motion;
        double clearance_m;
    };

    [[nodiscard]] PlanarPose among_obstacles(const Motion& motion) const;

    /// The flight ends with a contact at a pose among the obstacles, or with one that this is near to.
    void sees_collision(PlanarPose pose);

    void add_row(const Motion& motion, const ReferencePoint& reference, double clearance_m, double energy_j);

    [[nodiscard]] bool touches_within_tick(const Loop& loop, const Motion& motion, double clearance_m) const;

    /// Whether the robot touches something between two instants at which it does not. It cannot where it moves less
    /// than its distances at both ends; other stretches are halved, at poses that the plant gives there.
    [[nodiscard]] bool touches_between(const Loop& loop, const Instant& from, const Instant& to) const;

    /// No point of the robot is faster between two instants of a tick [m/s]: the greater speed of both, and all of the
    /// change, as accelerations hardly change while commands are held.
    [[nodiscard]] double max_speed(const Motion& a, const Motion& b) const;

    /// Whether all rotor discs keep their distance (docs/model.md 4.4).
    [[nodiscard]] bool is_flyable(const Motion& motion) const;

    const Problem& problem_;
    const SurfaceEffects* effects_;
    const Obstacles& obstacles_;
    double body_reach_m_ = 0;
    const World& world_;
    double lateral_m_;
    double tick_s_;
    JudgedFlight& flight_;
    Motion last_;
    bool is_apart_ = false;  ///< from a surface that is touched
};

}  // namespace downwash::judge

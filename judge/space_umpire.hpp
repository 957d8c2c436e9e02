#pragma once

#include "downwash/judge/space_judged_flight.hpp"
#include "downwash/judge/space_loop.hpp"
#include "downwash/judge/space_obstacles.hpp"
#include "downwash/judge/space_touching.hpp"

// How a flight in space ends, by the rules of docs/model.md 7.1. Private: not installed.

namespace downwash::judge {

/// The motion of a row.
[[nodiscard]] SpaceJudgedMotion motion_of(const SpaceCoordinates& at);

/// Whether a vehicle is lost. One that starts tilted may recover; one that has been upright may not tilt too far again.
class SpaceStability {
 public:
    [[nodiscard]] DOWNWASH_EXPORT bool is_stable(const SpaceCoordinates& at, const SpacePoint& reference);

 private:
    bool was_upright_ = false;
};

/// Watches a flight tick by tick and writes down its figures.
class SpaceUmpire {
 public:
    /// @pre all outlive it
    SpaceUmpire(const SpaceObstacles& obstacles, const SpaceSurroundings& surfaces, const SpaceRobot& robot,
                const SpaceWorld& world, double tick_s, SpaceJudgedFlight& flight)
        : obstacles_(obstacles), surfaces_(surfaces), robot_(robot), world_(world), tick_s_(tick_s), flight_(flight) {}

    /// Looks at a vehicle at a tick. @return whether the flight goes on
    [[nodiscard]] bool sees(const SpaceLoop& loop, const SpacePoint& reference);
    /// Looks at a vehicle that may touch a surface with the part that is meant to.
    [[nodiscard]] bool sees_touch(const SpaceLoop& loop, const SpacePoint& reference, const SpaceTouchSurface& surface,
                                  bool is_holding);
    /// Says how the touch ended.
    [[nodiscard]] SpaceJudgedTouch touch(const SpaceTouch& touch, const std::optional<TouchCourse::Hold>& hold);

 private:
    /// The bodies at an instant of a tick, and how far they are from contact.
    struct Instant {
        double since_s = 0;
        BodyMotions bodies;
        double clearance_m = 0;  ///< of obstacles; of the robot to itself counts by half
    };
    [[nodiscard]] Instant instant_at(const SpaceLoop& loop, double since_s, BodyMotions bodies) const;
    [[nodiscard]] bool touches_between(const SpaceLoop& loop, const Instant& from, const Instant& to) const;
    /// A bound on how fast any point of the robot is.
    [[nodiscard]] double max_speed_m_s(const SpaceVehicle& vehicle, const BodyMotions& a, const BodyMotions& b) const;
    [[nodiscard]] bool is_flyable(const SpaceLoop& loop) const;
    void add_row(const SpaceLoop& loop, const SpacePoint& reference, double clearance_m);

    const SpaceObstacles& obstacles_;
    const SpaceSurroundings& surfaces_;
    const SpaceRobot& robot_;
    const SpaceWorld& world_;
    double tick_s_;
    SpaceJudgedFlight& flight_;
    SpaceStability stability_;
    Instant last_;
    bool is_apart_ = true;  ///< from a surface that is touched
    std::optional<Eigen::Vector3d> held_m_;
    double slip_m_ = 0;
};

}  // namespace downwash::judge

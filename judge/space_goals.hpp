#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "downwash/judge/space_judged_flight.hpp"
#include "downwash/judge/space_obstacles.hpp"
#include "downwash/simulation/space_goal.hpp"
#include "downwash/simulation/space_touch.hpp"

// Goals in space and where plans hover for them (docs/model.md 7.4, 7.8 and 7.9). Private: not installed.

namespace downwash::judge {

/// How far a vehicle is from a goal; among alternatives from the one whose tolerances it uses least.
struct SpaceGoalDistance {
    double distance_m = 0;  ///< over what the goal asks for; of a camera, by how much it is too near or too far
    double used_share = 0;  ///< greatest share of a tolerance that is used; the goal is met up to 1; infinity: hidden
};

/// Where a plan stays for a goal.
struct SpaceStay {
    std::size_t goal = 0;
    std::int64_t end = 0;  ///< tick of the plan
    std::optional<SpaceTouch> touch;
};

/// The goals of a flight.
class SpaceGoals {
 public:
    /// @param goals at least one   @pre robot and obstacles outlive this
    DOWNWASH_EXPORT SpaceGoals(const SpaceRobot& robot, const std::vector<Obstacle>& all,
                               const SpaceObstacles& obstacles, const std::vector<SpaceGoal>& goals, bool in_any_order);
    DOWNWASH_EXPORT ~SpaceGoals();
    SpaceGoals(const SpaceGoals&) = delete;
    SpaceGoals& operator=(const SpaceGoals&) = delete;

    [[nodiscard]] std::size_t count() const noexcept { return goals_.size(); }
    /// The stays of a plan in their order, that behind the last knot included.
    [[nodiscard]] DOWNWASH_EXPORT std::vector<SpaceStay> stays(const SpacePlan& plan) const;
    [[nodiscard]] DOWNWASH_EXPORT SpaceGoalDistance distance(const SpaceStay& stay, const SpaceJudgedMotion& motion,
                                                             const SpaceWorld& world) const;

 private:
    struct At;
    struct Kinds;
    struct Candidate;
    [[nodiscard]] At at(const SpaceJudgedMotion& motion, const SpaceWorld& world) const;
    [[nodiscard]] SpaceGoalDistance single(const SpaceGoal& goal, const At& at) const;
    [[nodiscard]] SpaceGoalDistance from_touch(const SpaceTouch& touch, const At& at) const;
    [[nodiscard]] Candidate candidate(std::size_t goal, const SpacePoint& point) const;
    [[nodiscard]] std::optional<SpaceTouch> touch_from(const SpaceContactGoal& goal, double hold_s, const At& at,
                                                       const NamedObstacle& obstacle) const;

    const SpaceRobot& robot_;
    const SpaceObstacles& obstacles_;
    SpaceVehicle nominal_;
    std::vector<SpaceGoal> goals_;
    bool in_any_order_;
    /// Of each alternative of each goal: what a contact names.
    std::vector<std::vector<std::unique_ptr<NamedObstacle>>> named_;
};

}  // namespace downwash::judge

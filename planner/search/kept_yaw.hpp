#pragma once

#include <cstddef>

#include "downwash/controllers/space_reference.hpp"
#include "downwash/controllers/yaw_mode.hpp"
#include "downwash/simulation/space_goal_rule.hpp"
#include "downwash/simulation/space_robot.hpp"

namespace downwash::planning {

/// Keeps the rule of motion.yaw in a search: how every point of a reference looks after the one before. Between points
/// the yaw is a quintic. What a goal asks for comes first: a point at the goal keeps its yaw, unless the goal leaves it
/// open. Then the robot is turned about what it reaches for or looks at.
class KeptYaw {
 public:
    /// @param goals its first goal is that of the search   @pre robot and goals outlive it
    KeptYaw(const YawRule& rule, const SpaceRobot& robot, const SpaceGoalRule& goals)
        : rule_(rule), robot_(robot), goals_(goals) {}

    [[nodiscard]] bool is_free() const noexcept { return rule_.mode == YawMode::free; }
    /// Whether the yaw of a point depends on the points before.
    [[nodiscard]] bool depends_on_way() const noexcept { return rule_.mode == YawMode::along; }

    /// A point as it looks after another one.
    /// @param usable_share of the goal's tolerances, to which a point is at the goal
    [[nodiscard]] SpacePoint looking(const SpacePoint& before, const SpacePoint& point, double usable_share) const;

 private:
    [[nodiscard]] SpacePoint by_rule(const SpacePoint& before, const SpacePoint& point) const;
    [[nodiscard]] SpacePoint at_goal(const SpacePoint& before, const SpacePoint& point, std::size_t alternative,
                                     double usable_share) const;

    YawRule rule_;
    const SpaceRobot& robot_;
    const SpaceGoalRule& goals_;
};

}  // namespace downwash::planning

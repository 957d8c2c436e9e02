#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/simulation/space_configuration.hpp"
#include "downwash/simulation/space_goal.hpp"
#include "downwash/simulation/space_goal_error.hpp"
#include "downwash/simulation/space_loop.hpp"
#include "downwash/simulation/space_touch.hpp"

// Where a plan hovers for its goals, and whether a vehicle meets them there (docs/model.md 7.4 and 7.8).

namespace downwash {

/// A hover of a plan for one of its goals.
struct SpaceGoalHover {
    std::size_t goal = 0;             ///< number of the goal
    std::int64_t end_tick = 0;        ///< of the plan; behind the last knot for the last hover
    std::optional<SpaceTouch> touch;  ///< follows where the goal, or the alternative that is met, is a contact
    std::string reason;               ///< why there is none although the goal is a contact
};

/// The goals of a flight in space. Immutable; safe to share between threads.
class DOWNWASH_EXPORT SpaceGoalRule {
 public:
    /// @param scene obstacles in their nominal places   @param goals at least one
    /// @param in_any_order whether a plan may visit them in another order than the given one
    /// @pre space_robot_errors(robot) is empty
    SpaceGoalRule(const SpaceRobot& robot, std::shared_ptr<const Scene> scene, std::vector<SpaceGoal> goals,
                  bool in_any_order = false);
    ~SpaceGoalRule();
    SpaceGoalRule(const SpaceGoalRule&) = delete;
    SpaceGoalRule& operator=(const SpaceGoalRule&) = delete;

    [[nodiscard]] const std::vector<SpaceGoal>& goals() const noexcept;

    /// The hovers of a plan, in their order. It hovers for its last goal after the last knot, for each other one
    /// between two knots that are the same point at rest, meet the goal, and are at least its hold apart: as goals
    /// follow each other or, in any order, for the first one that is left. There are fewer hovers than goals where the
    /// plan does not hover for all; the one after the last knot then counts for a goal without a hover.
    /// A hover before a touch lasts touch_hover_s; the touch itself has the goal's hold.
    /// @pre the plan has a knot
    [[nodiscard]] std::vector<SpaceGoalHover> hovers(const SpacePlan& plan) const;

    /// The hover of one of the goals at a point of a reference, without its end.
    [[nodiscard]] SpaceGoalHover hover_at(std::size_t goal, const SpacePoint& point) const;

    /// How far the level vehicle is from each alternative of a goal, or from the goal if it has none. A contact is met
    /// where the vehicle waits for a touch. Where there is none, a share without end of its tolerance is used, and
    /// the distance is the least way to where there could be one.
    [[nodiscard]] std::vector<SpaceGoalError> errors_at(std::size_t goal, const SpaceConfiguration& at) const;
    /// The error from the alternative whose tolerances it uses least, or which is nearest.
    [[nodiscard]] SpaceGoalError error_at(std::size_t goal, const SpaceConfiguration& at) const;

    /// How far a vehicle is from the goal of a hover; among alternatives from the one whose tolerances it uses least.
    [[nodiscard]] SpaceGoalError error(const SpaceGoalHover& hover, const SpaceMotion& motion,
                                       const SpaceWorld& world = {}) const;

 private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

/// Whether a vehicle is within the tolerances of a goal and slow enough to hold it.
[[nodiscard]] DOWNWASH_EXPORT bool meets_goal(const SpaceGoalError& error, const SpaceMotion& motion) noexcept;

/// What became of a goal of a flight.
struct SpaceGoalVisit {
    bool is_met = false;      ///< throughout the last second of its hover and, with a touch, of the one after it
    bool is_reached = false;  ///< the flight came to the end of its hover
    double error_m = 0;       ///< worst over that time, or where the flight ended before
    double angle_rad = 0;     ///< the same of angles
    bool is_hidden = false;   ///< something stood between a camera and its target
    std::optional<SpaceTouchRecord> touch;
};

}  // namespace downwash

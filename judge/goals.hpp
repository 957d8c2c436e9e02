#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/dynamics/plant.hpp"
#include "downwash/scene/planar_pose.hpp"
#include "downwash/simulation/goal.hpp"

// Goals and their hovers (docs/model.md 7.4). Private: not installed.

namespace downwash::judge {

/// How far a vehicle is from a goal; among alternatives from the one whose tolerances it uses least.
struct GoalDistance {
    double distance_m = 0;  ///< Distance over the coordinates that the goal gives.
    double used_share = 0;  ///< Greatest share of a tolerance that is used; the goal is met up to 1.
    double hold_s = 0;      ///< How long that alternative is held.
};

[[nodiscard]] DOWNWASH_EXPORT GoalDistance goal_distance(const Goal& goal, const ArmParameters& arm,
                                                         const PlanarPose& pose);

/// The touch that follows a hover for a goal; nullptr where none does. @param pose where the vehicle should hover
[[nodiscard]] const Touch* touch_after(const Goal& goal, const ArmParameters& arm, const PlanarPose& pose);

/// The ticks at which the hovers of the goals of a plan end, in their order; fewer if the plan does not come to all of
/// them. The vehicle hovers at the last of these behind the last knot, at each other one between two knots that are the
/// same point at rest, meet the goal and are at least its hold apart.
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::int64_t> hover_ends(const Plan& plan, std::span<const Goal> goals,
                                                                   const ArmParameters& arm);

}  // namespace downwash::judge

#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/aeromap/aero_settings.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/space_bounds.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/controllers/space_limits.hpp"
#include "downwash/controllers/yaw_mode.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/scene/shapes.hpp"
#include "downwash/simulation/space_carry.hpp"
#include "downwash/simulation/space_goal.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/uncertainty.hpp"

namespace downwash {

/// Where a flight in space begins.
struct SpaceStart {
    Vector3 position_m = {};         ///< of the multirotor's centre of mass, in the world
    double yaw_rad = 0;              ///< from the world's x to its y
    std::vector<double> joints_rad;  ///< one for each joint; empty: all zero
    Vector3 velocity_m_s = {};       ///< in the world
    /// Of the body axes in the world, a quaternion with its scalar first, of any length but zero; empty: level, with
    /// that yaw.
    std::optional<std::array<double, 4>> attitude;
    Vector3 body_rates_rad_s = {};          ///< in the body frame
    std::vector<double> joint_rates_rad_s;  ///< one for each joint; empty: all zero

    /// A reference: one number for each axis, x, y, z [m], yaw and joints [rad], and their derivatives.
    struct Reference {
        std::vector<double> position, velocity, acceleration;
    };
    /// With which the plan begins; empty: where the vehicle is, as it moves.
    std::optional<Reference> reference;
    SpaceCarry carry;  ///< of a vehicle in flight; empty: as after a long hover
};

/// Each once, in their order.
inline constexpr std::array all_yaw_modes{YawMode::free, YawMode::hold, YawMode::along, YawMode::toward};

/// Name as in problem files: "free".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(YawMode mode);

/// How references move and where they look.
struct SpaceMotionSettings : SpaceMotionLimits {
    YawRule yaw;
};

/// A motion planning problem in space, complete in itself.
struct SpaceProblem {
    std::string name = "problem";  ///< [A-Za-z0-9_-]{1,64}
    std::string description;
    SpaceRobot robot;
    SpaceBounds bounds;
    std::vector<Obstacle> obstacles;
    AeroSettings aero;
    std::optional<Uncertainty> uncertainty;  ///< empty: everything is nominal
    SpaceStart start;
    std::vector<SpaceGoal> goals;           ///< to be reached and held one after the other, one at least
    bool in_any_order = false;              ///< whether they are targets, whose order the planner chooses
    std::optional<SpaceGoal> return_to;     ///< a configuration to be reached and held after the targets
    std::optional<double> energy_budget_j;  ///< no flight may take more, > 0; targets beyond it are left out
    SpaceMotionSettings motion;             ///< one limit for all joints
    PlannerSettings planner;
};

/// All goals in their order; targets in any order come as they stand in the file, then the place to return to.
[[nodiscard]] DOWNWASH_EXPORT std::vector<SpaceGoal> goals_of(const SpaceProblem& problem);

/// Whether a plan may visit goals_of(problem) in another order: with a place to return to, which is the last, the order
/// has to be told (in_order()).
[[nodiscard]] inline bool leaves_order_open(const SpaceProblem& problem) noexcept {
    return problem.in_any_order && !problem.return_to;
}

/// Why a start is not one of a robot: lists with too few or too many numbers, or numbers that are not finite. Keys are
/// key paths of a problem file. Empty when it is.
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> start_errors(const SpaceStart& start, const SpaceRobot& robot);

/// Every reason why a problem in space cannot be flown: numbers out of range, a robot that cannot fly, a start outside
/// the flyable area, a goal that says nothing. Keys are key paths of a problem file. Empty when it is sound.
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> space_problem_errors(const SpaceProblem& problem);

/// What can be flown but is likely not meant. @pre space_problem_errors(problem) is empty
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> space_problem_warnings(const SpaceProblem& problem);

}  // namespace downwash

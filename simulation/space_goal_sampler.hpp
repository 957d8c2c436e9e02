#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/base/random.hpp"
#include "downwash/base/space_bounds.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/space_configuration.hpp"
#include "downwash/simulation/space_goal.hpp"
#include "downwash/simulation/space_robot.hpp"

// Configurations of a level robot that meet a goal in space, in closed form (docs/model.md 7.10).

namespace downwash {

/// A configuration that meets a goal.
struct SpaceGoalPlace {
    SpaceConfiguration at{};
    std::size_t alternative = 0;  ///< of the goal, which it meets; 0 of a goal without alternatives
};

/// Why a configuration that meets a goal is none to hover at.
enum class SpaceGoalFlaw : std::uint8_t {
    none,
    outside,         ///< the multirotor's centre of mass is outside the bounds
    touches_itself,  ///< solids of the robot touch each other
    near_obstacle,   ///< the robot is nearer to an obstacle than the margin
    hidden,          ///< an obstacle stands between the camera and its target
};
inline constexpr std::size_t space_goal_flaws = 5;

/// What became of the tries to draw a configuration.
struct SpaceGoalSample {
    std::optional<SpaceGoalPlace> place;
    int tries = 0;        ///< all
    int without_aim = 0;  ///< those without joint angles that aim as the goal asks, or without a surface to touch
    int flaws[space_goal_flaws] = {};  ///< those with each flaw
};

/// How far apart two configurations are: any number that is less for nearer ones.
using SpaceMetric = std::function<double(const SpaceConfiguration& from, const SpaceConfiguration& to)>;

/// Draws and finds configurations for one goal. Immutable; safe to share between threads. Only contacts allocate.
class DOWNWASH_EXPORT SpaceGoalSampler {
 public:
    /// @param scene obstacles in their nominal places   @param checker of the robot in that scene
    /// @param margin_m that the robot keeps from obstacles, >= 0
    /// @pre space_robot_errors(robot) is empty, and the values of the goal are sound
    SpaceGoalSampler(const SpaceRobot& robot, const SpaceBounds& bounds, std::shared_ptr<const Scene> scene,
                     SpaceChecker checker, double margin_m, const SpaceGoal& goal);
    ~SpaceGoalSampler();
    SpaceGoalSampler(const SpaceGoalSampler&) = delete;
    SpaceGoalSampler& operator=(const SpaceGoalSampler&) = delete;

    /// A configuration with joints within their limits that meets the goal, or an alternative drawn at random, and uses
    /// at most this share of its tolerances. Nothing where the joints that were drawn do not allow it. It may have a
    /// flaw.
    /// @param share 0 to 1; 0 meets the goal exactly: of a camera in the middle of its distances
    [[nodiscard]] std::optional<SpaceGoalPlace> drawn(Random& random, double share) const;

    /// The first flaw of a place, in their order; nothing stands between a place and its target if it is the last one.
    [[nodiscard]] SpaceGoalFlaw flaw(const SpaceGoalPlace& place) const;

    /// A place without a flaw: drawn() until there is one, at most so many times.
    [[nodiscard]] SpaceGoalSample sample(Random& random, double share, int max_tries = 50) const;

    /// Among some places that use at most this share of the tolerances the one nearest to a configuration: as its arm
    /// is, if that does; with one joint turned, two, or one after the other; yaw and position follow by the shortest
    /// way. Then the same from arms and yaws beside the best one so far, always the same ones. Nothing where none of
    /// the first meets the goal, though others may. The place may have a flaw. Yaw and joints without limits are those
    /// next to the given ones.
    /// @param refinements how often to look beside the best one; of configurations and contacts never
    [[nodiscard]] std::optional<SpaceGoalPlace> nearest(const SpaceConfiguration& to, const SpaceMetric& metric,
                                                        double share, int refinements = 40) const;

    struct Impl;  ///< private

 private:
    std::unique_ptr<const Impl> impl_;
};

}  // namespace downwash

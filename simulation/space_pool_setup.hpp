#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/flight_rules.hpp"
#include "downwash/simulation/space_goal_rule.hpp"
#include "downwash/simulation/space_loop.hpp"
#include "downwash/simulation/surface_volumes.hpp"

namespace downwash {

/// Rules that planned flights in space keep besides those of fly(). The last three are asked at the end of every leg.
struct SpacePlanningRules {
    Vector3 low_m{}, high_m{};        ///< box that the multirotor's centre of mass may not leave, in the world
    bool keeps_joint_limits = true;   ///< no joint leaves its limits
    double max_tracking_error_m = 0;  ///< distance from the reference
    double max_saturation = 1;        ///< greatest demand on a rotor or a joint over its limit
    /// How fast the multirotor rolls and pitches together.
    double max_tilt_rate_rad_s = std::numeric_limits<double>::infinity();
};

/// What flies in a SpacePool, and under which rules: those of fly() for one flight (space_flight.hpp).
struct SpacePoolSetup {
    const SpaceRobot& robot;
    simulation::SpaceAero aero = {};
    /// Surfaces in their nominal places, in volumes of this robot; nullptr: none, and everything is flyable.
    const SurfaceVolumes* volumes = nullptr;
    /// Instead of volumes: what else says how surfaces act, as DirectSpaceEffect does. Each thread makes one of its own
    /// and asks it vehicle by vehicle. All that are made say the same. Empty: there is none.
    std::function<std::unique_ptr<simulation::SpaceEffect>()> make_effect = {};
    const SpaceChecker* checker = nullptr;  ///< of collisions, with obstacles in their nominal places; nullptr: none
    double margin_m = 0;                    ///< least clearance of obstacles, also between ticks, >= 0
    std::optional<double> energy_budget_j = {};    ///< a job that has spent more at its end is rejected as over_budget
    std::optional<SpacePlanningRules> rules = {};  ///< empty: none
    /// The first goal of this rule is that of jobs with judged_ticks; nullptr: there are none. Outlives the pool.
    const SpaceGoalRule* goal = nullptr;
    bool measures_clearance = false;  ///< integrates clearance (slow), for the objective of that name
    std::optional<ClearanceError> finds_min_clearance = {};  ///< how well every flight finds its least clearance
    std::function<bool()> is_over = {};  ///< all threads ask it now and then; true ends flights as interrupted
};

}  // namespace downwash

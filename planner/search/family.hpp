#pragma once

#include "downwash/base/export.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/controllers/space_configuration.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/search/search_record.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/flight_job.hpp"
#include "downwash/simulation/space_flight_job.hpp"
#include "downwash/simulation/surface_volumes.hpp"

// There is one search, for vehicles in a plane of motion and in space. What it works on are the types of a family.
// Functions that it calls on them (configuration_of(), at_rest(), keeps_limits(), ...) are overloaded for both.

namespace downwash {
class WorldFlights;
}  // namespace downwash

namespace downwash::planning {

class SearchSpace;
class SpaceSearchSpace;
class PassageSampler;
template <class Family>
class LevelWaysOf;
class ProblemWorlds;
class SpaceProblemWorlds;

/// Vehicles in a vertical plane.
struct DOWNWASH_EXPORT Plane {
    using Problem = downwash::Problem;
    using Start = downwash::Start;
    using Goal = downwash::Goal;
    using FlightModel = downwash::FlightModel;
    using Effects = AeroMap;  ///< of surfaces
    using Configuration = downwash::Configuration;
    using ReferencePoint = downwash::ReferencePoint;
    using ReferenceSegment = downwash::ReferenceSegment;
    using Plan = downwash::Plan;
    using MotionLimits = downwash::MotionLimits;
    using Pose = PlanarPose;
    using FlightState = downwash::FlightState;
    using FlownWorld = downwash::FlownWorld;
    using FlightWorld = downwash::FlightWorld;
    using SegmentFlight = downwash::SegmentFlight;
    using FlightLeg = downwash::FlightLeg;
    using FlightJob = downwash::FlightJob;
    using FlightChain = downwash::FlightChain;
    using Obstruction = downwash::Obstruction;
    using TreeNode = downwash::TreeNode;
    using SearchSpace = planning::SearchSpace;
    using NarrowWays = PassageSampler;      ///< through which a tree grows
    using Execution = downwash::Execution;  ///< with direct aerodynamics
    using ProblemWorlds = planning::ProblemWorlds;
    using WorldFlights = downwash::WorldFlights;  ///< of whole plans
    /// Whether a path to a goal before the last is executed without what comes before it, from where the planner's own
    /// model has the vehicle then.
    static constexpr bool executes_parts_alone = false;
};

/// A world in space, and the control tick with which a flight in it begins.
struct SpaceFlightWorld {
    const SpaceWorld* world = nullptr;  ///< nullptr: the nominal one
    std::int64_t first_tick = 0;
};

/// Vehicles in space with any number of joints.
struct DOWNWASH_EXPORT Space {
    using Problem = SpaceProblem;
    using Start = SpaceStart;
    using Goal = SpaceGoal;
    using FlightModel = SpaceProblemModel;
    using Effects = SurfaceVolumes;
    using Configuration = SpaceConfiguration;
    using ReferencePoint = SpacePoint;
    using ReferenceSegment = SpaceSegment;
    using Plan = SpacePlan;
    using MotionLimits = SpaceMotionLimits;
    using Pose = SpacePose;
    using FlightState = AnySpaceState;
    using FlownWorld = SpaceWorld;
    using FlightWorld = SpaceFlightWorld;
    using SegmentFlight = SpaceSegmentFlight;
    using FlightLeg = SpaceFlightLeg;
    using FlightJob = SpaceFlightJob;
    using FlightChain = SpaceFlightChain;
    using Obstruction = SpaceObstruction;
    using TreeNode = SpaceTreeNode;
    using SearchSpace = SpaceSearchSpace;
    using NarrowWays = LevelWaysOf<Space>;
    using Execution = SpaceFlight;
    using ProblemWorlds = SpaceProblemWorlds;
    using WorldFlights = SpaceProblemWorlds;
    static constexpr bool executes_parts_alone = true;  ///< direct flights in space take long
};

/// What limits the references of a problem.
[[nodiscard]] inline const MotionLimits& motion_limits_of(const Problem& problem) noexcept {
    return problem.motion;
}
[[nodiscard]] inline const SpaceMotionLimits& motion_limits_of(const SpaceProblem& problem) noexcept {
    return problem.motion;
}

}  // namespace downwash::planning

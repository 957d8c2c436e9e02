#pragma once

#include <cstddef>
#include <cstdint>

#include "downwash/scene/planar_pose.hpp"
#include "downwash/simulation/map_effect.hpp"
#include "downwash/simulation/motion_reach.hpp"
#include "downwash/simulation/rule_checks.hpp"

// The kernel that flies several edges side by side: plain arrays in, plain arrays out. flight_batch.cpp feeds it.

namespace downwash::simulation {

/// Edges that fly side by side, as many as the widest kernel takes at once.
inline constexpr int lane_count = 8;

/// A struct of numbers for every lane: [number][lane].
template <class Struct>
using LaneRows = double[sizeof(Struct) / sizeof(double)][lane_count];

/// Everything about the edges that changes, as structure of arrays; [..][lane].
struct alignas(64) FlightLanes {
    LaneRows<VehicleState<double>> state;
    // Unused where no flight is in a world.
    LaneRows<WorldMemory<double>> world_memory;
    LaneRows<WorldNumbers<double>> world;
    std::uint64_t tape[lane_count];      ///< tape of the world's noise
    double first_tick[lane_count];       ///< first tick of the segment, from the start of the whole flight
    LaneRows<ReferencePoint> reference;  ///< reference at the current tick

    // The segment that is flown.
    double coefficient[3][6][lane_count];
    LaneRows<ReferencePoint> end;
    double inverse_duration_1_s[lane_count];
    double tick[lane_count], ticks[lane_count];

    // While the robot is this near to a pose, the kernel checks nothing but the rules of flight_rules.hpp.
    LaneRows<PlanarPose> anchor;
    double free_motion_m[lane_count];  ///< negative: check after every tick
    double look_tick[lane_count];      ///< check from this tick of the segment on; infinite: never
    double max_speed_m_s[lane_count];  ///< speed in (x, z) from which on to check; infinite: never

    LaneRows<FlightSums> sums;
    double is_active[lane_count];  ///< 1, or 0 for a lane that only fills the pack

    // What a call found at its last tick.
    LaneRows<PlanarPose> before;   ///< pose at the tick before
    double rejection[lane_count];  ///< number of a Rejection
    /// 1 if a check is due because of the flyable area, free_motion_m, look_tick or max_speed_m_s.
    double is_unclear[lane_count];
};

/// What a lane's flight does not change.
struct FlightKernelModel {
    const TickModel* tick;
    const void* law;  ///< law of the tick, of the type that the kernel was compiled for
    RuleLimits limits;
    MotionReach reach;  ///< how far a motion moves any point of the robot, hubs included
    bool has_map;
    RotorMaps maps;
    bool is_in_worlds;  ///< whether some flight needs tick_in_world()
    bool has_noise;     ///< whether some world has noise
    const float* normal_levels;
};

/// Flies all lanes tick by tick until an active one breaks a rule, is unclear, or is at the end of its segment, or
/// until so many ticks have passed. Every lane's numbers are those of simulation::tick() to the last bit.
using FlightKernel = void (*)(const FlightKernelModel& model, FlightLanes& lanes, int max_ticks);

// For each set of instructions the kernel of a control law, by its number in FlownLaw, and whether it flies Aided.
// Those that are left out of a build are not defined.
[[nodiscard]] FlightKernel baseline_kernel(std::size_t law, bool is_aided);
[[nodiscard]] FlightKernel avx2_kernel(std::size_t law, bool is_aided);
[[nodiscard]] FlightKernel avx512_kernel(std::size_t law, bool is_aided);

}  // namespace downwash::simulation

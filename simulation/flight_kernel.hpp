#pragma once

#include <cstddef>
#include <cstdint>

#include "downwash/simulation/lane_rows.hpp"
#include "downwash/simulation/map_effect.hpp"
#include "downwash/simulation/motion_reach.hpp"
#include "downwash/simulation/rule_checks.hpp"

// The kernel that flies several edges side by side: plain arrays in, plain arrays out. flight_batch.cpp feeds it.

namespace downwash::simulation {

/// Where the vehicles of all lanes were at one tick.
struct alignas(64) TrackRow {
    LaneRows<PastMotion<double>> motion;
};

/// A call of the kernel that follows tracks flies at most so many ticks.
inline constexpr int max_track_ticks = 128;

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
    double anchor[4][lane_count];      ///< x, z, pitch and arm
    double free_motion_m[lane_count];  ///< negative: check after every tick
    double look_tick[lane_count];      ///< check from this tick of the segment on; infinite: never
    double max_speed_m_s[lane_count];  ///< speed in (x, z) from which on to check; infinite: never

    LaneRows<FlightSums> sums;
    double is_active[lane_count];  ///< 1, or 0 for a lane that only fills the pack, which stays as it is

    MapPatches<lane_count> patches[max_rotors + 2];  ///< patches of the map in which the rotors are

    // What a call found at its last tick.
    double before[4][lane_count];  ///< x, z, pitch and arm at the tick before
    double rejection[lane_count];  ///< number of a Rejection
    /// 1 if a check is due because of the flyable area, free_motion_m, look_tick or max_speed_m_s.
    double is_unclear[lane_count];

    void* flights[lane_count];  ///< for LookAround; the same in every lane
    /// Where the vehicles were at the last FlightKernelModel::track_ticks ticks, the oldest first, and room for
    /// max_track_ticks more; the same in every lane.
    TrackRow* track[lane_count];
};

/// Looks around lanes, given as bits, for which a check is due: sets how far each may fly until the next one, or the
/// rejection that it has found. Reads `state` (x, z, pitch and arm), `before` and `tick`; clears is_unclear, unless
/// there is more to check than obstacles and flyable area. Then, and after a rejection, the kernel returns.
using LookAround = void (*)(void* flights, unsigned int lanes);

/// Which tick the flights of a call need. Each kind is compiled for itself.
enum class TickKind : std::uint8_t {
    nominal,   ///< nominal_tick(): all fly in the nominal world, and no arm is in a slipstream
    in_world,  ///< tick_in_world(), and no arm is in a slipstream
    in_wash,   ///< tick_in_world()
};

/// What a lane's flight does not change.
struct FlightKernelModel {
    TickModel tick;   ///< without a map no rotor loses any of its effect as it tilts: there is none
    const void* law;  ///< law of the tick, of the type that the kernel was compiled for
    RuleLimits limits;
    MotionReach reach;   ///< how far a motion moves any point of the robot, hubs included
    RotorMaps maps;      ///< see no_rotor_maps()
    double delay_ticks;  ///< age of what the controller sees in the nominal world
    bool keeps_past;     ///< whether flights in the nominal world remember where they were
    int track_ticks;     ///< ticks that the longest delay reaches back, where that is beyond recent_ticks; else 0
    TickKind kind;
    bool has_noise;  ///< whether some world has noise
    const float* normal_levels;
    LookAround look_around;
};

/// Flies all lanes tick by tick until an active one breaks a rule, stays unclear, or is at the end of its segment, or
/// until so many ticks have passed (see max_track_ticks) or lanes have looked around some times. Every lane's numbers
/// are those of simulation::FlightLoop to the last bit.
using FlightKernel = void (*)(const FlightKernelModel& model, FlightLanes& lanes, int max_ticks);

// For each set of instructions the kernel of a control law, by its number in FlownLaw. Those that are left out of a
// build are not defined.
[[nodiscard]] FlightKernel baseline_kernel(std::size_t law);
[[nodiscard]] FlightKernel avx2_kernel(std::size_t law);
[[nodiscard]] FlightKernel avx512_kernel(std::size_t law);

}  // namespace downwash::simulation

#pragma once

#include <cstddef>
#include <cstdint>

#include "downwash/dynamics/space_integration.hpp"
#include "downwash/scene/space_motion.hpp"
#include "downwash/simulation/lane_rows.hpp"
#include "downwash/simulation/space_vehicle.hpp"
#include "downwash/simulation/volume_field.hpp"

// The kernel that flies several vehicles in space side by side: plain arrays in, plain arrays out. space_pool.cpp feeds
// it; flight_kernel.hpp has that of the plane. Private: not installed.

namespace downwash::simulation {

class SpaceEffect;

/// What a flight adds up tick by tick: numbers of the lane type only.
template <class T>
struct BasicSpaceSums {
    T max_tracking_error_m{};  ///< distance from the reference
    T max_saturation{};        ///< greatest demand over its limit
    T max_tilt_rate_rad_s{};   ///< of the multirotor's roll and pitch together, at ends of ticks
    T length_m{};              ///< see FlightSums
};

/// Where the vehicles of all lanes were at one tick.
template <int n>
struct alignas(64) SpaceTrackRow {
    LaneRows<PastSpaceMotion<double, n>> motion;
};

/// A call of the kernel flies at most so many ticks.
inline constexpr int max_space_ticks = 128;

/// Everything about the flights that changes, as structure of arrays; [..][lane].
template <int n>
struct alignas(64) SpaceLanes {
    LaneRows<SpaceVehicle<double, n>> vehicle;
    double gust[5][lane_count];  ///< see SpaceWorldMemory
    LaneRows<SpaceWorldNumbers<double, n>> world;
    std::uint64_t tape[lane_count];                  ///< of the world's noise
    double has_noise[lane_count];                    ///< 1, or 0 for a world without noise
    double first_tick[lane_count];                   ///< of the segment, from the start of the whole flight
    LaneRows<BasicSpacePoint<double, n>> reference;  ///< at the current tick

    // The segment that is flown.
    double coefficient[space_axes<n>][6][lane_count];
    LaneRows<BasicSpacePoint<double, n>> end;
    double inverse_duration_1_s[lane_count];
    double tick[lane_count], ticks[lane_count];

    // While the robot is this near to coordinates, and every joint within its limits, nothing but stability is checked.
    double anchor[dynamics::space_coordinates<n>][lane_count];
    double free_motion_m[lane_count];        ///< negative: check after every tick; infinite: never
    double free_joint_motion_m[lane_count];  ///< of the robot's points relative to each other

    LaneRows<BasicSpaceSums<double>> sums;
    double is_active[lane_count];  ///< 1, or 0 for a lane that only fills the pack, which stays as it is

    // What a call found at its last tick.
    double before[dynamics::space_coordinates<n>][lane_count];  ///< coordinates at the tick before
    double rejection[lane_count];                               ///< number of a Rejection
    double is_unclear[lane_count];                              ///< 1 if a check is due

    void* flights[lane_count];  ///< for SpaceLookAround; the same in every lane
    /// Where the vehicles were at the last SpaceKernelModel::track_ticks ticks, the oldest first, and room for
    /// max_space_ticks more; the same in every lane.
    SpaceTrackRow<n>* track[lane_count];
    /// SpaceVolumeViews::patches() of SpaceKernelModel::volumes; the same in every lane.
    VolumePatches<lane_count>* patches[lane_count];
    SpaceEffect* effect[lane_count];  ///< what to ask instead of volumes, if any; the same in every lane
};

/// Looks around lanes, given as bits, for which a check is due: sets how far each may fly until the next one, or the
/// rejection that it has found. Reads coordinates, `before` and `tick`; clears is_unclear.
using SpaceLookAround = void (*)(void* flights, unsigned int lanes);

/// What a kernel asks of an effect for one vehicle. By pointers, so that no code of an effect is compiled for wide
/// instructions.
struct AskedSpaceEffect {
    SidedFactor<double> (*at_rotor)(SpaceEffect* effect, int rotor, const dynamics::LaneVector<double>& hub_m,
                                    const dynamics::LaneRotation<double>& attitude);
    SidedFactor<double> (*at_body)(SpaceEffect* effect, const dynamics::LaneVector<double>& center_m,
                                   const dynamics::LaneRotation<double>& attitude);
    dynamics::LaneVector<double> (*wall_nearness)(SpaceEffect* effect, const dynamics::LaneVector<double>& center_m);
};

/// What flights of a pool have in common.
template <int n>
struct SpaceKernelModel {
    SpaceTickModel<n> tick;
    const void* law;  ///< of the tick, of the type that the kernel was compiled for
    dynamics::EqualSpaceSteps step;
    SpaceReach reach;                                                ///< of bodies and hubs
    double joint_low_rad[room_for<n>], joint_high_rad[room_for<n>];  ///< until where checks may be left out
    double least_upright_cosine;                                     ///< of unstable_pitch_rad
    double max_state, max_result;                                    ///< see execution.hpp
    SpaceVolumeViews volumes;
    AskedSpaceEffect ask;
    int track_ticks;  ///< ticks that flights remember: recent_ticks, or as many as the longest delay needs
    const float* normal_levels;
    SpaceLookAround look_around;
};

/// Flies all lanes tick by tick until an active one is lost, rejected or at the end of its segment, or until so many
/// ticks have passed, at most max_space_ticks. Every lane's numbers are those of SpaceLoop with equal steps to the last
/// bit.
template <int n>
using SpaceKernel = void (*)(const SpaceKernelModel<n>& model, SpaceLanes<n>& lanes, int max_ticks);

// For each set of instructions and number of joints the kernel of a law, by its number in SpaceLaw. Sources made of
// space_kernel.cpp.in define them. Those that are left out of a build are not defined.
template <int n>
[[nodiscard]] SpaceKernel<n> baseline_space_kernel(std::size_t law);
template <int n>
[[nodiscard]] SpaceKernel<n> avx2_space_kernel(std::size_t law);
template <int n>
[[nodiscard]] SpaceKernel<n> avx512_space_kernel(std::size_t law);

}  // namespace downwash::simulation

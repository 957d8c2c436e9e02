#pragma once

#include <cstdint>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/simulation/flight_rules.hpp"

// The kernel that flies several edges side by side: plain arrays in, plain arrays out. flight_batch.cpp feeds it.

namespace downwash::simulation {

/// Edges that fly side by side, as many as the widest kernel takes at once.
inline constexpr int lane_count = 8;

/// Everything about the edges that changes, as structure of arrays; [..][lane].
struct alignas(64) FlightLanes {
    double q[4][lane_count], u[4][lane_count], thrust_n[max_rotors][lane_count], energy_j[lane_count];
    double position_integral[2][lane_count], pitch_rate_integral[lane_count], arm_integral[lane_count];
    double pitch_reference_rad[lane_count], pitch_reference_rate[lane_count], rate_reference[lane_count];
    /// The reference at the current tick: position, velocity, acceleration of (x, z, arm).
    double reference[3][3][lane_count];

    // The segment that is flown.
    double coefficient[3][6][lane_count], end[3][3][lane_count];
    double inverse_duration_1_s[lane_count];
    double tick[lane_count], ticks[lane_count];

    // Until the robot has moved so far from a pose nothing but the rules of flight_rules.hpp has to be looked at.
    double anchor[4][lane_count];
    double free_motion_m[lane_count];  ///< negative: look after every tick
    double look_tick[lane_count];      ///< from this tick of the segment on as well; infinite: never
    double max_speed_m_s[lane_count];  ///< in (x, z): from this speed on as well; infinite: never

    double length_m[lane_count];
    double is_active[lane_count];  ///< 1, or 0 for a lane that only fills the pack

    // What a call found at its last tick.
    double before[4][lane_count];  ///< the pose at the tick before
    double rejection[lane_count];  ///< number of a Rejection
    /// 1 where a closer look is due: the flyable area, motion beyond free_motion_m, look_tick or max_speed_m_s ask for
    /// it.
    double is_unclear[lane_count];
};

/// What a lane's flight does not change.
struct FlightKernelModel {
    const TickModel* tick;
    RuleLimits limits;
    double body_reach_m;  ///< no point of a body, of the joint or of a hub is farther from the multirotor's centre
    double joint_reach_m, arm_length_m;
    bool has_map;
    MapView view[max_rotors + 1];  ///< per rotor; then of the body, where there is a fountain
    int same_as[max_rotors];
    /// K beyond the map, evaluated directly.
    double (*factor_outside)(const void* context, int rotor, double x_m, double z_m);
    const void* context;
};

/// Flies all lanes tick by tick until an active one breaks a rule, is unclear, or is at the end of its segment, or
/// until so many ticks have passed. Every lane's numbers are those of simulation::tick() to the last bit.
using FlightKernel = void (*)(const FlightKernelModel& model, FlightLanes& lanes, int most_ticks);

void fly_lanes_baseline(const FlightKernelModel& model, FlightLanes& lanes, int most_ticks);
#ifdef DOWNWASH_HAS_AVX_KERNELS
void fly_lanes_avx2(const FlightKernelModel& model, FlightLanes& lanes, int most_ticks);
void fly_lanes_avx512(const FlightKernelModel& model, FlightLanes& lanes, int most_ticks);
#endif

}  // namespace downwash::simulation

#pragma once

#include "downwash/problems/problem.hpp"

namespace downwash::bench {

/// What a VolumeMap of a block of space costs: times [s] of building, of one look-up and of one direct evaluation, and
/// memory [bytes].
struct VolumeFigures {
    double build_s = 0, bytes = 0, growth_bytes = 0;
    double cold_s = 0, scattered_s = 0, in_flight_order_s = 0, direct_s = 0;
};

/// Of 30 m3 under the deck of the bridge.
VolumeFigures measured_volume(const Problem& bridge, int repetitions);

}  // namespace downwash::bench

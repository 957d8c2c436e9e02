#pragma once

// Numbers of flights side by side, as kernels take them. Private: not installed.

namespace downwash::simulation {

/// Flights that fly side by side, as many as the widest kernel takes at once.
inline constexpr int lane_count = 8;

/// A struct of numbers for every lane: [number][lane].
template <class Struct>
using LaneRows = double[sizeof(Struct) / sizeof(double)][lane_count];

}  // namespace downwash::simulation

#pragma once

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/comparison/compared_plan.hpp"

namespace downwash {

/// Which worlds of a problem's uncertainty an envelope is over: those of a certificate, or others.
struct EnvelopeWorlds {
    std::uint64_t seed = 1, first = 1, count = 0;
    int threads = 1;
    std::stop_token stop;
};

/// Where the vehicle is in many worlds at each tick of a plan: the least and the greatest number of each axis.
struct WorldEnvelope {
    std::uint64_t seed = 1, first = 1;
    std::size_t flown = 0;  ///< worlds, those that ended early included
    double tick_s = 0;
    std::vector<Vector3> low_m, high_m;  ///< at each tick; flights that have ended no longer count
};

/// Flies a plan in worlds. The result does not depend on the number of threads. A stop leaves fewer worlds.
/// @pre plan.has_uncertainty()
[[nodiscard]] DOWNWASH_EXPORT WorldEnvelope world_envelope(const ComparedPlan& plan, double tick_s,
                                                           const EnvelopeWorlds& worlds);

}  // namespace downwash

#pragma once

#include "downwash/base/export.hpp"

namespace downwash::studies {

/// How well the altitude law keeps its promise under a ceiling (claim C3), from 0.5 m below it to 0.2 m below.
struct LyapunovDecay {
    double worst_rate_error =
        0;  ///< error of dV/dt against -k e^2 - k' e'^2, over V(0) [1/s], command of the same moment
    double sampled_excess = 0;  ///< greatest |V - V of continuous command| over V(0), command held for 10 ms
};

[[nodiscard]] DOWNWASH_EXPORT LyapunovDecay lyapunov_decay();

}  // namespace downwash::studies

#pragma once

#include "downwash/studies/study.hpp"

namespace downwash::studies {

/// The experiments of thesis chapter 4 flown again: a quadrotor in six degrees of freedom that touches a ceiling with
/// its frame, holds, and leaves, under the Lyapunov laws and under a PID (claims C3 to C7, figures 4.14 and 4.15), and
/// then at several points in one flight (C8, figures 4.16 and 4.17).
[[nodiscard]] DOWNWASH_EXPORT Study ceiling_contact();

}  // namespace downwash::studies

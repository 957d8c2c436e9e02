#pragma once

#include "downwash/studies/study.hpp"

namespace downwash::studies {

/// The test bench of thesis 3.5: a quadrotor that can only pitch, and a plate that is put under one of its rotors,
/// under three controllers (claim S8, figures 3.18 to 3.20).
[[nodiscard]] DOWNWASH_EXPORT Study disturbance_test_bench();

}  // namespace downwash::studies

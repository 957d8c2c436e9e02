#pragma once

#include <string>

#include "downwash/simulation/loop_margins.hpp"

namespace downwash::cli {

/// Whether a loop has what a robust one should have at least: 6 dB and 45 degrees (Astrom and Murray 2008,
/// section 9.3).
[[nodiscard]] bool has_enough(const LoopMargins& margins);

/// "up", "level", "down", or the angle.
[[nodiscard]] std::string arm_name(double arm_rad);

}  // namespace downwash::cli

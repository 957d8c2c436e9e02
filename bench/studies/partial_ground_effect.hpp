#pragma once

#include "downwash/studies/study.hpp"

namespace downwash::studies {

/// The experiments of thesis chapter 3 flown again: a quadrotor over the edge of a plate under three controllers
/// (figures 3.4 to 3.16), with every ground model and over a range of gains.
[[nodiscard]] DOWNWASH_EXPORT Study partial_ground_effect();

}  // namespace downwash::studies

#pragma once

#include <cstdint>

#include "downwash/controllers/space_reference.hpp"

// Private: not installed.

namespace downwash::judge {

/// The reference at a tick, by the quintic Hermite basis; behind the last knot the last. @pre the plan has a knot
[[nodiscard]] SpacePoint reference_at(const SpacePlan& plan, std::int64_t tick);

}  // namespace downwash::judge

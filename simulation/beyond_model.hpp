#pragma once

// Private to simulation/.

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/base/vector3.hpp"

namespace downwash::simulation {

/// Whether what is above a rotor pulls it in a way that K does not tell: some of it is so near that its part of K is
/// flat, or the sum of both sides is at the cap where it would rise on the way up. The ground is not asked for, and a
/// given map is taken at its word.
[[nodiscard]] bool is_beyond_model(const DirectEffect& effect, const Vector3& hub_m);

}  // namespace downwash::simulation

#pragma once

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash {

/// Whether no obstacle is nearer than `radius_m` (>= 1e-8) to the line between two points, ends included. The line may
/// have no length.
[[nodiscard]] DOWNWASH_EXPORT bool is_line_clear(const Scene& scene, const Vector3& from_m, const Vector3& to_m,
                                                 double radius_m);

}  // namespace downwash

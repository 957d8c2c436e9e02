#pragma once

// Private to the library, for what flies a planar robot in space too.

#include "downwash/base/export.hpp"
#include "downwash/controllers/reference_point.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/scene/plane_of_motion.hpp"
#include "downwash/simulation/space_world_description.hpp"
#include "downwash/simulation/world.hpp"

// What is said in a plane of motion, said in space. The arm is the first joint, and the yaw is the plane's heading.

namespace downwash {

/// A vector of the plane, without its origin, in the world.
[[nodiscard]] inline Vector3 vector_in_space(double x, double z, const PlaneOfMotion& plane) noexcept {
    return {x * plane.cos_heading(), x * plane.sin_heading(), z};
}

/// A world of the plane, but for what it has beside the plane and for its tape: noise is drawn in another order.
[[nodiscard]] DOWNWASH_EXPORT SpaceWorld in_space(const World& world, const PlaneOfMotion& plane);

/// A point of a reference.
[[nodiscard]] DOWNWASH_EXPORT SpacePoint in_space(const ReferencePoint& point, const PlaneOfMotion& plane);

}  // namespace downwash

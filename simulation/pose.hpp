#pragma once

#include "downwash/controllers/configuration.hpp"
#include "downwash/scene/planar_pose.hpp"

namespace downwash {

/// The level vehicle at a configuration.
[[nodiscard]] inline PlanarPose level_at(const Configuration& at) noexcept {
    return {at[plane::x], at[plane::z], 0, at[plane::arm]};
}

/// The pose with coordinates q = (x, z, pitch, arm) [m, m, rad, rad].
[[nodiscard]] inline PlanarPose pose_of(const double (&q)[4]) noexcept {
    return {q[0], q[1], q[2], q[3]};
}

}  // namespace downwash

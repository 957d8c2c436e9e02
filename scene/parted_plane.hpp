#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "downwash/base/bounds.hpp"
#include "downwash/base/export.hpp"
#include "downwash/scene/collision_checker.hpp"
#include "downwash/scene/plane_of_motion.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash {

/// A square of the plane of motion, in plane coordinates.
struct PlaneSquare {
    double x_m = 0, z_m = 0;  ///< its middle
    double half_m = 0;        ///< half a side
};

/// Whether the vehicle's centre of mass may be in a square for some purpose. Never false where it may be.
using MayBeIn = std::function<bool(const PlaneSquare&)>;

/// A region that the vehicle cannot reach, and what closes the way.
struct CutOffRegion {
    std::size_t region = 0;  ///< its number
    /// Obstacles of the scene by their numbers, rising. Without any one of them the others may leave a way; together
    /// with the bounds they leave none.
    std::vector<std::size_t> obstacles;
};

/// The regions that a vehicle cannot reach from a start within the bounds, at any pitch and any arm angle. A region in
/// the result is proven to be out of reach; of the others nothing is known.
///
/// At every pitch the multirotor's bodies contain certain cylinders across the plane around the centre of mass. A
/// square of the plane is blocked if one of these cylinders touches an obstacle wherever in the square the centre is.
/// The function halves the other squares that the start connects to, down to 1/512 of the bounds, until no squares
/// connect the start to a region, or squares that are free as a whole do. (Approximate cell decomposition: Brooks and
/// Lozano-Perez 1985.) It takes some milliseconds, at most about 0.1 s. The safety margin does not count: between two
/// checked poses a flight may come nearer.
/// @param start_x_m,start_z_m centre of mass, plane coordinates
[[nodiscard]] DOWNWASH_EXPORT std::vector<CutOffRegion> cut_off_regions(const Scene& scene, const PlaneOfMotion& plane,
                                                                        const RobotShape& robot, const Bounds& bounds,
                                                                        double start_x_m, double start_z_m,
                                                                        std::span<const MayBeIn> regions);

}  // namespace downwash

#pragma once

#include <memory>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/scene/planar_pose.hpp"
#include "downwash/scene/plane_of_motion.hpp"
#include "downwash/scene/shapes.hpp"

// Distances to obstacles by FCL. Private: not installed.

namespace downwash::judge {

/// The obstacles of a problem and a robot among them, for FCL. Made once, safe to share between threads.
///
/// FCL measures between convex solids by GJK. Each of its two solvers ends far from the minimum now and then, so that a
/// distance counts only if a gap as wide proves it, or both solvers were asked. Meshes are surfaces: a robot that is
/// inside of a closed one without touching it is not noticed, and no flight gets there.
class Obstacles {
 public:
    /// @param robot its bodies and its arm   @param rotor_radius_m of discs
    /// @pre Scene would take the obstacles
    DOWNWASH_EXPORT Obstacles(const std::vector<Obstacle>& obstacles, const PlaneOfMotion& plane,
                              const RobotShape& robot, double rotor_radius_m);
    DOWNWASH_EXPORT ~Obstacles();
    Obstacles(const Obstacles&) = delete;
    Obstacles& operator=(const Obstacles&) = delete;

    /// Least distance from the robot to an obstacle [m]; 0 on contact, infinity without obstacles.
    [[nodiscard]] DOWNWASH_EXPORT double clearance_m(const PlanarPose& pose) const;

    /// Whether a level rotor disc keeps a distance from all obstacles.
    /// @param x_m,lateral_m,z_m its hub in the plane and to the left of it
    [[nodiscard]] DOWNWASH_EXPORT bool disc_keeps(double distance_m, double x_m, double lateral_m, double z_m) const;

 private:
    struct Solids;
    std::unique_ptr<const Solids> solids_;
};

}  // namespace downwash::judge

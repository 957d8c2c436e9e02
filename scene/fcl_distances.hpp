#pragma once

// Private to scene/: collisions and clearances by FCL. Only fcl_distances.cpp sees FCL's headers.

#include <cstdint>
#include <memory>

#include "downwash/base/export.hpp"
#include "downwash/scene/planar_pose.hpp"
#include "downwash/scene/plane_of_motion.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash {

/// Which of FCL's solvers measures between two convex solids.
enum class FclSolver : std::uint8_t {
    both,    ///< libccd, and the other one where libccd's distance is not proven
    libccd,  ///< alone, as it comes
    indep,   ///< alone, as it comes
};

/// A robot among the obstacles of a scene, for FCL: a tree of bounding boxes finds the few pairs in question, and FCL's
/// solvers decide between them. Immutable but for trees over triangles, each of which is made when a robot first comes
/// near to them; every query may run in several threads.
///
/// FCL decides contact to about 1e-6 m. Each of its solvers for distances ends far from the minimum now and then. Hence
/// a distance counts at once only if the gap between both solids along the line between FCL's nearest points, which
/// bounds the distance from below, is as wide. Otherwise the other solver is asked, and the lesser distance counts.
class FclDistances {
 public:
    /// @pre CollisionChecker takes the robot
    DOWNWASH_EXPORT FclDistances(const std::shared_ptr<const Scene>& scene, const PlaneOfMotion& plane,
                                 const RobotShape& robot, FclSolver solver = FclSolver::both);
    DOWNWASH_EXPORT ~FclDistances();
    FclDistances(const FclDistances&) = delete;
    FclDistances& operator=(const FclDistances&) = delete;

    /// As of CollisionChecker, both to what FCL can tell. @pre the pose is finite
    [[nodiscard]] DOWNWASH_EXPORT bool is_nearer_than(const PlanarPose& pose, double margin_m) const;
    [[nodiscard]] DOWNWASH_EXPORT double clearance_m(const PlanarPose& pose) const;

 private:
    struct Solids;
    std::unique_ptr<const Solids> solids_;
};

}  // namespace downwash

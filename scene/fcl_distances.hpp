#pragma once

// Private to scene/: collisions and clearances by FCL, whose headers fcl_*.cpp alone see.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/scene/robot_solids.hpp"
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
    /// @param reach_m no point of the solids is farther from the origin of frame 0 @pre a checker takes the solids
    DOWNWASH_EXPORT FclDistances(const std::shared_ptr<const Scene>& scene, const std::vector<FramedSolid>& solids,
                                 double reach_m, FclSolver solver = FclSolver::both);
    DOWNWASH_EXPORT ~FclDistances();
    FclDistances(const FclDistances&) = delete;
    FclDistances& operator=(const FclDistances&) = delete;

    // As of the checkers, to what FCL can tell. @pre every number is finite

    /// Whether a solid is nearer to an obstacle than the margin of its frame [m].
    [[nodiscard]] DOWNWASH_EXPORT bool is_nearer_than(std::span<const RobotFrame> frames,
                                                      std::span<const double> margins_m) const;
    /// The least distance of a solid to an obstacle if it is below `enough_m`, else `enough_m`; 0 on contact.
    [[nodiscard]] DOWNWASH_EXPORT double clearance_m(std::span<const RobotFrame> frames, double enough_m) const;
    /// Whether two of the robot's solids, by their numbers, are nearer to each other than a margin.
    [[nodiscard]] DOWNWASH_EXPORT bool are_nearer(std::span<const RobotFrame> frames, std::size_t first,
                                                  std::size_t second, double margin_m) const;
    /// The distance of two of the robot's solids [m]; 0 on contact.
    [[nodiscard]] DOWNWASH_EXPORT double distance_m(std::span<const RobotFrame> frames, std::size_t first,
                                                    std::size_t second) const;

 private:
    struct Solids;
    std::unique_ptr<const Solids> solids_;
};

}  // namespace downwash

#pragma once

#include <memory>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/scene/shapes.hpp"

// What vertical rays meet among obstacles. Private: not installed.

namespace downwash::judge {

/// The parts of obstacles in a grid of square columns. A mesh is its triangles, an octree its cubes. Made once; copies
/// share it, and so may threads.
class VerticalRays {
 public:
    /// @param column_m side of the columns of the grid; wider ones are taken where there would be too many
    DOWNWASH_EXPORT VerticalRays(const std::vector<Obstacle>& obstacles, double column_m);

    /// Distances to the first surface straight below and straight above a point [m]; infinite where there is none, 0
    /// inside a solid that is no mesh.
    struct Gaps {
        double below_m, above_m;
    };
    [[nodiscard]] DOWNWASH_EXPORT Gaps gaps(double x_m, double y_m, double z_m) const;

 private:
    struct Parts;
    std::shared_ptr<const Parts> parts_;
};

}  // namespace downwash::judge

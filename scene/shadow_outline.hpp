#pragma once

#include <cstddef>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash {

/// A straight line of a shadow from (ax, ay) to (bx, by), world coordinates [m].
struct OutlineSegment {
    double ax, ay, bx, by;
};

/// A full ellipse of a shadow, world coordinates: semi-axis `along_m` in the unit direction (ux, uy), `across_m` square
/// to it.
struct OutlineEllipse {
    double x, y;
    double ux, uy;
    double along_m, across_m;
};

/// Where an obstacle's vertical extent is not smooth, seen from above: its edges and the rim of its shadow. Whoever
/// integrates over the shadow splits there. A box gives the distinct projections of its edges, a sphere a circle, a
/// cylinder the two straight sides of its shadow and its rims.
struct ShadowOutline {
    std::vector<OutlineSegment> segments;
    std::vector<OutlineEllipse> ellipses;
};

[[nodiscard]] DOWNWASH_EXPORT ShadowOutline shadow_outline(const Scene& scene, std::size_t obstacle);

}  // namespace downwash

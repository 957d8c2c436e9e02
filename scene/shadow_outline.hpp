#pragma once

#include <cstddef>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash {

/// A straight line of a shadow from (ax, ay) to (bx, by), world coordinates [m].
struct OutlineSegment {
    double ax, ay, bx, by;
    bool seen_from_above, seen_from_below;
};

/// A full ellipse of a shadow, world coordinates: semi-axis `along_m` in the unit direction (ux, uy), `across_m` square
/// to it.
struct OutlineEllipse {
    double x, y;
    double ux, uy;
    double along_m, across_m;
    bool seen_from_above, seen_from_below;
};

/// Where a part's vertical extent is not smooth, projected on the ground: its edges and the rim of its shadow. An edge
/// seen from above can crease the upper surface, one seen from below the lower surface. Split integrals over the shadow
/// there. A box gives the distinct projections of its edges, a sphere a circle, a cylinder the two straight sides of
/// its shadow and its rims, a triangle its edges, an upright triangle nothing.
struct ShadowOutline {
    /// Unit horizontal direction in which upper and lower surface fall or bend most; any edge's where both are level.
    double slope_x = 1, slope_y = 0;
    std::vector<OutlineSegment> segments;
    std::vector<OutlineEllipse> ellipses;
};

/// The shadow of one part of a scene, in the world's x and y [m]. @pre part < scene.part_count()
[[nodiscard]] DOWNWASH_EXPORT ShadowOutline shadow_outline(const Scene& scene, std::size_t part);

}  // namespace downwash

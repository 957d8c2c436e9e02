#pragma once

// Private to scene/: what vertical lines and shadows need of an obstacle, prepared once.

#include <array>
#include <variant>

#include "downwash/scene/convex.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

[[nodiscard]] inline double inverse_or_zero(double x) {
    return x == 0 ? 0 : 1 / x;
}

/// The points between two parallel planes or lines: |gx x + gy y + rise z| <= half, from the obstacle's centre.
struct Slab {
    double gx, gy;
    double per_rise;  ///< 1 / rise; 0 when the slab is upright
    double half;
};

struct BoxFromAbove {
    std::array<Slab, 3> faces;   ///< pairs of opposite faces
    std::array<Slab, 3> shadow;  ///< the shadow, a sum of three segments, lies between up to three pairs of lines
};

struct SphereFromAbove {
    double radius_square;
};

struct CylinderFromAbove {
    double along_x, along_y;        ///< horizontal unit direction of the axis; any when it is upright
    double level, upright;          ///< horizontal and vertical part of the unit axis; exactly 0 when negligible
    double per_level, per_upright;  ///< 1 over those; 0 for 0
    double radius, half_length;
};

using SeenFromAbove = std::variant<BoxFromAbove, SphereFromAbove, CylinderFromAbove>;

[[nodiscard]] BoxFromAbove box_from_above(const Box& box, const Placement& placement);

[[nodiscard]] SeenFromAbove seen_from_above(const Primitive& shape, const Placement& placement);

/// Whether upper and lower face are level planes over the whole shadow.
[[nodiscard]] bool has_level_faces(const SeenFromAbove& form);

}  // namespace downwash

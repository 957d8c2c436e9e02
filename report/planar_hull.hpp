#pragma once

// Private: not installed.

#include <vector>

#include "downwash/report/picture.hpp"

namespace downwash {

/// The corners of the convex hull, counter-clockwise; fewer than three when the points lie on a line.
[[nodiscard]] std::vector<PlanePoint> convex_hull(std::vector<PlanePoint> points);

/// Twice the area of the triangle a, b, c; positive when they run counter-clockwise.
[[nodiscard]] inline double turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
    return (b.x_m - a.x_m) * (c.z_m - a.z_m) - (b.z_m - a.z_m) * (c.x_m - a.x_m);
}

}  // namespace downwash

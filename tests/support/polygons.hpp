#pragma once

// Polygons of every shape, in any plane.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "downwash/base/vector3.hpp"
#include "downwash/scene/obstacle_placement.hpp"
#include "random.hpp"

namespace downwash::test {

using Polygon = std::vector<Vector3>;

inline double length(const Vector3& v) {
    return std::sqrt(dot(v, v));
}

/// Twice the area, along the normal.
inline Vector3 twice_area(const Polygon& polygon) {
    Vector3 sum{};
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        sum = sum + cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    }
    return sum;
}

/// Whether a point of its plane is in a polygon that is given in the plane z = 0.
inline bool is_inside(const Polygon& flat, const Vector3& p) {
    bool is_in = false;
    for (std::size_t i = 0; i < flat.size(); ++i) {
        const Vector3& a = flat[i];
        const Vector3& b = flat[(i + 1) % flat.size()];
        if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) {
            is_in = !is_in;
        }
    }
    return is_in;
}

inline bool do_cross(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
    const auto side = [](const Vector3& p, const Vector3& q, const Vector3& r) {
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    };
    return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

/// Points in any order, undone where two edges cross: a simple polygon with deep notches, one way around or the other.
inline Polygon some_polygon(Random& random, int corners) {
    Polygon polygon;
    for (int i = 0; i < corners; ++i) {
        polygon.push_back({random.uniform(-1, 1), random.uniform(-1, 1), 0});
    }
    for (bool is_simple = false; !is_simple;) {
        is_simple = true;
        const std::size_t count = polygon.size();
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = i + 2; k < count; ++k) {
                if ((k + 1) % count != i &&
                    do_cross(polygon[i], polygon[i + 1], polygon[k], polygon[(k + 1) % count])) {
                    std::reverse(polygon.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                 polygon.begin() + static_cast<std::ptrdiff_t>(k) + 1);
                    is_simple = false;
                }
            }
        }
    }
    return polygon;
}

inline Polygon placed(const Polygon& flat, const Vector3& rpy_rad, const Vector3& center, double scale) {
    const Matrix3 rotation = rotation_of(rpy_rad);
    Polygon all;
    for (const Vector3& p : flat) {
        all.push_back(center + rotation * (scale * p));
    }
    return all;
}

inline Polygon started_at(const Polygon& polygon, std::size_t first) {
    Polygon all = polygon;
    std::rotate(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(first), all.end());
    return all;
}

}  // namespace downwash::test

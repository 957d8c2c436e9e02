#include "downwash/report/planar_hull.hpp"

#include <algorithm>

namespace downwash {

// Andrew's monotone chain.
std::vector<PlanePoint> convex_hull(std::vector<PlanePoint> points) {
    const auto is_before = [](const PlanePoint& a, const PlanePoint& b) {
        return a.x_m < b.x_m || (a.x_m == b.x_m && a.z_m < b.z_m);
    };
    std::sort(points.begin(), points.end(), is_before);
    std::vector<PlanePoint> hull;
    for (int pass = 0; pass < 2; ++pass) {
        const std::size_t first = hull.size();
        for (const PlanePoint& point : points) {
            while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0) {
                hull.pop_back();
            }
            hull.push_back(point);
        }
        hull.pop_back();  // it begins the other half
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

}  // namespace downwash

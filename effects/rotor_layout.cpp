#include "downwash/effects/rotor_layout.hpp"

#include <algorithm>
#include <cmath>

namespace downwash {
namespace {

double rounded(double radii) {
    return std::round(radii * 1e9) * 1e-9;
}

double level_distance(const Vector3& a, const Vector3& b) {
    const double dx = a[0] - b[0];
    const double dy = a[1] - b[1];
    return std::sqrt(dx * dx + dy * dy);
}

}  // namespace

RotorNeighbours neighbours_of(const std::vector<Vector3>& hubs_m, std::size_t which, double radius_m) {
    const auto count = static_cast<double>(hubs_m.size());
    Vector3 center_m{};
    for (const Vector3& hub_m : hubs_m) {
        center_m[0] += hub_m[0] / count;
        center_m[1] += hub_m[1] / count;
    }
    RotorNeighbours neighbours;
    for (std::size_t i = 0; i < hubs_m.size(); ++i) {
        neighbours.center_radii += level_distance(hubs_m[i], center_m) / (radius_m * count);
        if (i != which) {
            neighbours.distances_radii.push_back(rounded(level_distance(hubs_m[i], hubs_m[which]) / radius_m));
        }
    }
    neighbours.center_radii = rounded(neighbours.center_radii);
    std::sort(neighbours.distances_radii.begin(), neighbours.distances_radii.end());
    return neighbours;
}

RotorNeighbours square_quadrotor(double spacing_radii) {
    const double half = 0.5 * spacing_radii;
    return neighbours_of({{half, half, 0}, {half, -half, 0}, {-half, half, 0}, {-half, -half, 0}}, 0, 1);
}

}  // namespace downwash

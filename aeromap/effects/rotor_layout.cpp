#include "downwash/effects/rotor_layout.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "downwash/base/lane_math.hpp"

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

RotorNeighbours neighbours_of(const std::vector<Vector3>& hubs_m, std::size_t which, double radius_m,
                              double heading_rad) {
    const auto count = static_cast<double>(hubs_m.size());
    const auto [sine, cosine] = lane::sin_cos(heading_rad);
    Vector3 center_m{};
    for (const Vector3& hub_m : hubs_m) {
        center_m[0] += hub_m[0] / count;
        center_m[1] += hub_m[1] / count;
    }
    struct Neighbour {
        double distance, ahead, left;
    };
    std::vector<Neighbour> others;
    RotorNeighbours neighbours;
    for (std::size_t i = 0; i < hubs_m.size(); ++i) {
        neighbours.center_radii += level_distance(hubs_m[i], center_m) / (radius_m * count);
        if (i != which) {
            others.push_back({rounded(level_distance(hubs_m[i], hubs_m[which]) / radius_m),
                              (hubs_m[i][0] - hubs_m[which][0]) / radius_m,
                              (hubs_m[i][1] - hubs_m[which][1]) / radius_m});
        }
    }
    neighbours.center_radii = rounded(neighbours.center_radii);
    // Rotors that mirror each other across the body's plane of symmetry have theirs in the same order.
    std::sort(others.begin(), others.end(), [](const Neighbour& a, const Neighbour& b) {
        return std::tuple(a.distance, a.ahead, std::abs(a.left)) < std::tuple(b.distance, b.ahead, std::abs(b.left));
    });
    for (const auto& [distance, ahead, left] : others) {
        neighbours.distances_radii.push_back(distance);
        neighbours.offsets_radii.push_back({cosine * ahead - sine * left, sine * ahead + cosine * left});
    }
    return neighbours;
}

RotorNeighbours square_quadrotor(double spacing_radii) {
    const double half = 0.5 * spacing_radii;
    return neighbours_of({{half, half, 0}, {half, -half, 0}, {-half, half, 0}, {-half, -half, 0}}, 0, 1);
}

}  // namespace downwash

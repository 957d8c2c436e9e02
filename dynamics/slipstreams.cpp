#include "downwash/dynamics/slipstreams.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "downwash/dynamics/slipstream_shape.hpp"

namespace downwash {
namespace {

constexpr double air_density_kg_m3 = 1.225;  // at sea level, 15 degrees

/// Whether the arm comes below a rotor as deep as where its slipstream has become wide enough to meet the arm's plane.
bool can_meet(const ArmParameters& arm, double radius_m, const Vector3& hub_m) {
    const double depth_m = std::max(hub_m[2] - arm.joint_z_m + arm.length_m, 0.0);
    return std::abs(hub_m[1]) < dynamics::edge_radii * radius_m + dynamics::edge_spread * depth_m;
}

}  // namespace

Slipstreams slipstreams_of(const ArmParameters& arm, const RotorParameters& rotors) {
    Slipstreams all;
    if (!arm.wash || arm.wash->scale == 0) {
        return all;
    }
    all.radius_m = rotors.radius_m;
    const double disc_m2 = std::numbers::pi * rotors.radius_m * rotors.radius_m;
    all.speed_squared_per_n = arm.wash->scale * arm.wash->scale / (2 * air_density_kg_m3 * disc_m2);
    int number = 0;
    for (const Vector3& hub_m : rotors.positions_m) {
        const double lateral_m = std::abs(hub_m[1]);
        int same = 0;
        while (same < all.count) {
            const Vector3& other_m = rotors.positions_m[static_cast<std::size_t>(all.rotor[same])];
            if (other_m[0] == hub_m[0] && other_m[2] == hub_m[2] && all.lateral_m[same] == lateral_m) {
                break;
            }
            ++same;
        }
        if (same == all.count && can_meet(arm, rotors.radius_m, hub_m)) {
            all.rotor[same] = number;
            all.lateral_m[same] = lateral_m;
            ++all.count;
        } else if (same == all.count) {
            same = -1;
        }
        all.of_rotor[number++] = same;
    }
    for (int& slipstream : all.of_rotor) {
        slipstream = slipstream < 0 ? all.count : slipstream;
    }
    return all;
}

}  // namespace downwash

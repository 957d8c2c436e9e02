#include "downwash/effects/potential_flow.hpp"

#include <cmath>

namespace downwash {

Vector3 potential_flow_velocity(const Vector3& position_radii, double height_radii) {
    constexpr double strength = 0.25;  // s / (R^2 v_i)
    const auto [x, y, z] = position_radii;
    Vector3 velocity{};
    for (const double source_z : {height_radii, -height_radii}) {
        const double dz = z - source_z;
        const double distance = std::sqrt(x * x + y * y + dz * dz);
        const double rate = strength / (distance * distance * distance);
        velocity = {velocity[0] + rate * x, velocity[1] + rate * y, velocity[2] + rate * dz};
    }
    return velocity;
}

}  // namespace downwash

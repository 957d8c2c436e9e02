#include "downwash/identification/surface_weights.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace downwash::identification {
namespace {

/// The third row of the rotation of a quaternion (w, x, y, z) times a vector: how high it points.
double height_of(const std::array<double, 4>& q, const Vector3& v) {
    return 2 * (q[1] * q[3] - q[0] * q[2]) * v[0] + 2 * (q[2] * q[3] + q[0] * q[1]) * v[1] +
           (1 - 2 * (q[1] * q[1] + q[2] * q[2])) * v[2];
}

double closeness(double z_over_r) {
    return 1 / (z_over_r * z_over_r);
}

}  // namespace

SurfaceWeights::SurfaceWeights(const SpaceRobot& robot, const LoggedFlight& flight, const SurfaceNodes& surface)
    : surface_(surface), rotors_(robot.plant.rotors.size()) {
    if (surface.count() == 0) {
        return;
    }
    weights_.assign(flight.ticks.size() * rotors_ * surface.count(), 0.0);
    double* weights = weights_.data();
    for (const LoggedTick& tick : flight.ticks) {
        for (const auto& rotor : robot.plant.rotors) {
            const double hub_m = tick.seen.position_m[2] + height_of(tick.seen.attitude, rotor.position_m);
            double* own = weights;
            if (surface.ground_m) {
                add((hub_m - *surface.ground_m) / robot.rotor_radius_m, own);
                own += surface.of_one();
            }
            if (surface.ceiling_m) {
                add((*surface.ceiling_m - hub_m) / robot.rotor_radius_m, own);
            }
            weights += surface.count();
        }
    }
}

void SurfaceWeights::add(double z_over_r, double* weights) const {
    const std::vector<double>& nodes = surface_.z_over_r;
    const auto above = static_cast<std::size_t>(std::ranges::upper_bound(nodes, z_over_r) - nodes.begin());
    if (above == 0) {
        weights[0] = 1;
    } else if (above < nodes.size()) {
        const double near = closeness(nodes[above - 1]), far = closeness(nodes[above]);
        const double share = (near - closeness(z_over_r)) / (near - far);
        weights[above - 1] = 1 - share;
        if (above < surface_.of_one()) {
            weights[above] = share;
        }
    }
}

void SurfaceWeights::find_ratios(const std::vector<double>& effects, std::size_t tick, double ratio[max_rotors]) const {
    std::fill_n(ratio, max_rotors, 1.0);
    if (weights_.empty()) {
        return;
    }
    const std::size_t nodes = surface_.count();
    for (std::size_t rotor = 0; rotor < rotors_; ++rotor) {
        const double* weights = weights_.data() + (tick * rotors_ + rotor) * nodes;
        for (std::size_t k = 0; k < nodes; ++k) {
            ratio[rotor] += weights[k] * effects[k];
        }
    }
}

}  // namespace downwash::identification

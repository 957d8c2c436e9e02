#include "downwash/judge/slipstream.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace downwash::judge {
namespace {

using Eigen::Vector3d;

constexpr double air_density_kg_m3 = 1.225;

/// The mean of g(e) over [0, 1] under a weight e^n, for g(e) = (1 - e^1.5)^4.
double moment_of_profile(double n) {
    // The binomial series of (1 - e^1.5)^4, term by term.
    constexpr double binomial[] = {1, -4, 6, -4, 1};
    double sum = 0;
    for (int k = 0; k < 5; ++k) {
        sum += binomial[k] / (1.5 * k + n + 1);
    }
    return sum;
}

/// Where the mixing layer of a slipstream begins and ends, over the radius of the slipstream without one.
struct Layer {
    double inner, outer;
};

/// The layer that a core of this radius leaves room for: momentum stays what it was.
/// inner^2 + 2 inner w A + 2 w^2 B = 1 for the width w, with the moments A and B of the profile.
Layer layer_around(double inner) {
    const double a = moment_of_profile(0);
    const double b = 2 * moment_of_profile(1);
    const double rest = 1 - inner * inner;
    return {inner, inner + rest / (inner * a + std::sqrt(inner * inner * a * a + b * rest))};
}

Vector3d in_space(Planar p, double lateral_m) {
    return {p.x, lateral_m, p.z};
}

double drag_per_length(const Vehicle& vehicle, double speed_m_s) {
    return (vehicle.arm_drag.linear_n_s_m * speed_m_s +
            vehicle.arm_drag.quadratic_n_s2_m2 * std::copysign(speed_m_s * speed_m_s, speed_m_s)) /
           vehicle.arm_length_m;
}

}  // namespace

double slipstream_ratio(double radius_m, double depth_m, double away_m) {
    constexpr double core_length = 6;        // in radii of the rotor
    const double half_width_growth = 0.094;  // of a round jet
    const double z = std::max(depth_m / radius_m, 0.0);
    if (depth_m < -0.5 * radius_m || away_m > (1.2 + 0.25 * z) * radius_m) {  // saves time: far outside
        return 0;
    }
    const double hypotenuse = std::hypot(1, z);
    const double gain = 1 + z / hypotenuse;                  // McCormick
    const double contracted_m = radius_m / std::sqrt(gain);  // the same air per second passes everywhere
    const double way = (z + hypotenuse) / 2;
    const double eaten = way / core_length;
    Layer layer = layer_around(std::max(1 - eaten, 0.0));
    double speed = gain;
    if (eaten > 1) {
        // Half the speed is where 1 - (1/2)^(1/2) = e^1.5.
        const double half = std::pow(1 - std::sqrt(0.5), 2.0 / 3.0);
        const double jet = layer.outer;
        layer.outer += (way - core_length) * half_width_growth / half * std::numbers::sqrt2;
        speed *= jet / layer.outer;
    }
    const double e = (away_m / contracted_m - layer.inner) / (layer.outer - layer.inner);
    if (e >= 1) {
        return 0;
    }
    if (e > 0) {
        speed *= std::pow(1 - std::pow(e, 1.5), 2);
    }
    if (depth_m < 0) {
        const double s = std::clamp(1 + 2 * depth_m / radius_m, 0.0, 1.0);
        speed *= s * s * (3 - 2 * s);
    }
    return speed;
}

void add_wash(const Vehicle& vehicle, const Motion& motion, const std::array<double, max_rotors>& thrust_n,
              Planar wind_m_s, Loads& loads) {
    if (vehicle.wash_scale == 0) {
        return;
    }
    const double radius_m = vehicle.rotor_radius_m;
    const double disc_m2 = std::numbers::pi * radius_m * radius_m;
    const Vector3d up = in_space(from_body({0, 1}, motion.pitch_rad), 0);
    const Planar to_joint = from_body(vehicle.joint_m, motion.pitch_rad);
    const Vector3d joint_m = in_space(motion.position_m + to_joint, 0);
    const Vector3d along = in_space(arm_direction(motion.pitch_rad, motion.arm_rad), 0);
    const Vector3d across = in_space(turned(1, arm_direction(motion.pitch_rad, motion.arm_rad)), 0);
    const Vector3d joint_m_s = in_space(motion.velocity_m_s + turned(motion.pitch_rate_rad_s, to_joint) - wind_m_s, 0);
    const double rate_rad_s = motion.pitch_rate_rad_s + motion.arm_rate_rad_s;
    const auto rotors = static_cast<std::size_t>(vehicle.rotor_count);
    std::array<bool, max_rotors> is_done{};
    double force_n = 0;
    double moment_nm = 0;  // about the joint
    for (std::size_t i = 0; i < rotors; ++i) {
        if (is_done[i]) {
            continue;
        }
        double momentum_n = 0;
        for (std::size_t k = i; k < rotors; ++k) {
            if (vehicle.hub_m[k].x == vehicle.hub_m[i].x && vehicle.hub_m[k].z == vehicle.hub_m[i].z &&
                std::abs(vehicle.hub_lateral_m[k]) == std::abs(vehicle.hub_lateral_m[i])) {
                is_done[k] = true;
                momentum_n += std::max(thrust_n[k], 0.0);
            }
        }
        const double disc_m_s = vehicle.wash_scale * std::sqrt(momentum_n / (2 * air_density_kg_m3 * disc_m2));
        const Vector3d hub_m =
            in_space(motion.position_m + from_body(vehicle.hub_m[i], motion.pitch_rad), vehicle.hub_lateral_m[i]);
        constexpr int pieces = 240;
        const double piece_m = vehicle.arm_length_m / pieces;
        for (int n = 0; n <= pieces; ++n) {
            const double s = n * piece_m;
            const Vector3d from_hub_m = joint_m + s * along - hub_m;
            const double depth_m = -from_hub_m.dot(up);
            const double away_m = (from_hub_m + depth_m * up).norm();
            const double ratio = slipstream_ratio(radius_m, depth_m, away_m);
            if (ratio == 0) {
                continue;
            }
            const double still_m_s = joint_m_s.dot(across) + rate_rad_s * s;
            const double washed_m_s = still_m_s + disc_m_s * ratio * up.dot(across);
            const double simpson = (n == 0 || n == pieces ? 1 : n % 2 == 1 ? 4 : 2) * piece_m / 3;
            const double push_n =
                simpson * (drag_per_length(vehicle, still_m_s) - drag_per_length(vehicle, washed_m_s));
            force_n += push_n;
            moment_nm += s * push_n;
        }
    }
    const Planar n{across.x(), across.z()};
    loads.arm_force_n = loads.arm_force_n + force_n * n;
    loads.arm_moment_nm += moment_nm - force_n * vehicle.arm_center_of_mass_m;
}

}  // namespace downwash::judge

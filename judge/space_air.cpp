#include "downwash/judge/space_air.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "downwash/judge/slipstream.hpp"

namespace downwash::judge {
namespace {

using Eigen::Vector3d;

constexpr double air_density_kg_m3 = 1.225;

Vector3d drag_of(const DragParameters& drag, const Vector3d& through_air_m_s) {
    return -(drag.linear_n_s_m + drag.quadratic_n_s2_m2 * through_air_m_s.norm()) * through_air_m_s;
}

/// A link in the air.
struct LinkInAir {
    Vector3d joint_m, along;  ///< where it begins, and where it leads, of length 1 or 0
    double length_m;
    const BodyMotion& body;
    const DragParameters& drag;
    Vector3d wind_m_s;

    LinkInAir(const SpaceVehicle& vehicle, const BodyMotions& bodies, std::size_t joint, const Vector3d& wind)
        : length_m(vehicle.joints[joint].link_m.norm()),
          body(bodies[joint + 1]),
          drag(vehicle.joints[joint].drag),
          wind_m_s(wind) {
        joint_m = body.position_m + body.attitude * vehicle.joints[joint].in_outer_m;
        along = length_m > 0 ? Vector3d(body.attitude * vehicle.joints[joint].link_m / length_m) : Vector3d::Zero();
    }
    [[nodiscard]] Vector3d lever(double s_m) const { return joint_m + s_m * along - body.position_m; }
    /// What a piece moves through air that blows at `air` besides the wind, across the link.
    [[nodiscard]] Vector3d across(double s_m, const Vector3d& air_m_s) const {
        const Vector3d through = body.velocity_m_s + body.rate_rad_s.cross(lever(s_m)) - wind_m_s - air_m_s;
        return through - through.dot(along) * along;
    }
};

/// Simpson's rule for pieces of a link: its weights sum to 1.
double simpson(int piece, int pieces) {
    return (piece == 0 || piece == pieces ? 1 : piece % 2 == 1 ? 4 : 2) / (3.0 * pieces);
}

}  // namespace

void add_drag(const SpaceVehicle& vehicle, const BodyMotions& bodies, const Vector3d& wind_m_s,
              std::vector<BodyLoad>& loads) {
    loads.front().force_n += drag_of(vehicle.body_drag, bodies.front().velocity_m_s - wind_m_s);
    for (std::size_t i = 0; i < vehicle.joints.size(); ++i) {
        if (!vehicle.joints[i].drag.is_any()) {
            continue;
        }
        const LinkInAir link(vehicle, bodies, i, wind_m_s);
        constexpr int pieces = 16;
        for (int k = 0; k <= pieces; ++k) {
            const double s_m = link.length_m * k / pieces;
            loads[i + 1].push(link.lever(s_m),
                              simpson(k, pieces) * drag_of(link.drag, link.across(s_m, Vector3d::Zero())));
        }
    }
}

void add_wash(const SpaceVehicle& vehicle, const BodyMotions& bodies, const std::vector<double>& thrust_n,
              const Vector3d& wind_m_s, std::vector<BodyLoad>& loads) {
    if (vehicle.wash_scale == 0) {
        return;
    }
    const BodyMotion& body = bodies.front();
    const double disc_m2 = std::numbers::pi * vehicle.rotor_radius_m * vehicle.rotor_radius_m;
    struct Stream {
        Vector3d hub_m, axis;
        double disc_m_s;
    };
    // Rotors that mirror each other blow as one.
    std::vector<std::vector<Stream>> groups;
    std::vector<bool> is_done(vehicle.rotors.size());
    for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
        if (is_done[i]) {
            continue;
        }
        std::vector<Stream> group;
        const FlyingRotor& own = vehicle.rotors[i];
        // The plane of the robot file: a shifted centre of mass moves all hubs alike.
        const auto lateral_m = [&](const FlyingRotor& rotor) { return rotor.hub_m.y() + vehicle.center_of_mass_m.y(); };
        for (std::size_t k = i; k < vehicle.rotors.size() && group.size() < 2; ++k) {
            const FlyingRotor& other = vehicle.rotors[k];
            const bool is_mirror =
                lateral_m(own) != 0 && other.hub_m.x() == own.hub_m.x() && other.hub_m.z() == own.hub_m.z() &&
                std::abs(lateral_m(other) + lateral_m(own)) < 1e-12 && other.axis.x() == own.axis.x() &&
                other.axis.y() == -own.axis.y() && other.axis.z() == own.axis.z();
            if (k == i || (!is_done[k] && is_mirror)) {
                is_done[k] = true;
                group.push_back(
                    {body.position_m + body.attitude * other.hub_m, body.attitude * other.axis,
                     vehicle.wash_scale * std::sqrt(std::max(thrust_n[k], 0.0) / (2 * air_density_kg_m3 * disc_m2))});
            }
        }
        groups.push_back(group);
    }
    for (std::size_t i = 0; i < vehicle.joints.size(); ++i) {
        const LinkInAir link(vehicle, bodies, i, wind_m_s);
        if (link.length_m == 0 || !link.drag.is_any()) {
            continue;
        }
        constexpr int pieces = 120;
        for (int k = 0; k <= pieces; ++k) {
            const double s_m = link.length_m * k / pieces;
            const Vector3d at_m = link.joint_m + s_m * link.along;
            for (const auto& group : groups) {
                Vector3d momentum = Vector3d::Zero();  // of the air, over its density and a cross section
                double squares = 0;
                for (const Stream& stream : group) {
                    const Vector3d from_hub = at_m - stream.hub_m;
                    const double depth_m = -from_hub.dot(stream.axis);
                    const double away_m = (from_hub + depth_m * stream.axis).norm();
                    const double speed = stream.disc_m_s * slipstream_ratio(vehicle.rotor_radius_m, depth_m, away_m);
                    squares += speed * speed;
                    momentum -= speed * speed * stream.axis;
                }
                if (squares == 0) {
                    continue;
                }
                const Vector3d blown = drag_of(link.drag, link.across(s_m, momentum / std::sqrt(squares)));
                loads[i + 1].push(
                    link.lever(s_m),
                    simpson(k, pieces) * (blown - drag_of(link.drag, link.across(s_m, Vector3d::Zero()))));
            }
        }
    }
}

}  // namespace downwash::judge

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "downwash/base/vector3.hpp"
#include "downwash/dynamics/space_step.hpp"
#include "downwash/identification/gust_model.hpp"
#include "downwash/identification/trial.hpp"

// Private to identification/: what a filter believes of a vehicle with n joints, and differences of that.

namespace downwash::identification {

inline Eigen::Vector3d vector_of(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

/// Numbers that a log has of every tick: position, turn about body axes, joints, velocity, body rates, joint rates.
template <int n>
inline constexpr Eigen::Index measured_numbers = 12 + 2 * n;

/// Of which kind a measured number is.
template <int n>
Channel channel_of(Eigen::Index number) {
    return number < 3        ? Channel::position
           : number < 6      ? Channel::attitude
           : number < 6 + n  ? Channel::joints
           : number < 9 + n  ? Channel::velocity
           : number < 12 + n ? Channel::body_rates
                             : Channel::joint_rates;
}

/// The turn by a vector, as a quaternion.
inline Eigen::Quaterniond turn_by(const Eigen::Vector3d& by_rad) {
    const double angle_rad = by_rad.norm();
    const double scale = angle_rad > 1e-12 ? std::sin(0.5 * angle_rad) / angle_rad : 0.5;
    return {std::cos(0.5 * angle_rad), scale * by_rad.x(), scale * by_rad.y(), scale * by_rad.z()};
}

/// The vector of a turn of less than pi.
inline Eigen::Vector3d vector_of_turn(Eigen::Quaterniond turn) {
    if (turn.w() < 0) {
        turn.coeffs() = -turn.coeffs();
    }
    const double sine = turn.vec().norm();
    return (sine > 1e-12 ? 2 * std::atan2(sine, turn.w()) / sine : 2.0) * turn.vec();
}

inline Eigen::Quaterniond attitude_of(const double q[7]) {
    return {q[3], q[4], q[5], q[6]};
}
inline void put_attitude(const Eigen::Quaterniond& attitude, double q[7]) {
    q[3] = attitude.w();
    q[4] = attitude.x();
    q[5] = attitude.y();
    q[6] = attitude.z();
}

/// An estimate of the vehicle, of the point that the robot file calls its centre of mass, and of the gust.
template <int n>
struct VehicleEstimate {
    dynamics::SpaceState<double, n> vehicle;
    GustModel::State gust;
    /// What is seen of the vehicle less the vehicle: controllers see it linear between two ticks (docs/model.md 9).
    Eigen::Matrix<double, measured_numbers<n>, 1> seen;
};

/// Moves a vehicle from the point of the robot file to the true centre of mass (sign 1), or back (sign -1).
template <int n>
void shift(const Eigen::Vector3d& center_of_mass_m, double sign, dynamics::SpaceState<double, n>& vehicle) {
    const Eigen::Quaterniond attitude = attitude_of(vehicle.q);
    const Eigen::Vector3d place = attitude * center_of_mass_m;
    const Eigen::Vector3d velocity =
        attitude * Eigen::Map<const Eigen::Vector3d>(vehicle.u + 3).cross(center_of_mass_m);
    for (int i = 0; i < 3; ++i) {
        vehicle.q[i] += sign * place[i];
        vehicle.u[i] += sign * velocity[i];
    }
}

/// By what the motion of one vehicle differs from that of another.
template <int n>
Eigen::Matrix<double, measured_numbers<n>, 1> motion_between(const dynamics::SpaceState<double, n>& to,
                                                             const dynamics::SpaceState<double, n>& from) {
    Eigen::Matrix<double, measured_numbers<n>, 1> by;
    for (int i = 0; i < 3; ++i) {
        by[i] = to.q[i] - from.q[i];
        by[6 + n + i] = to.u[i] - from.u[i];
        by[9 + n + i] = to.u[3 + i] - from.u[3 + i];
    }
    by.template segment<3>(3) = vector_of_turn(attitude_of(from.q).conjugate() * attitude_of(to.q));
    for (int i = 0; i < n; ++i) {
        by[6 + i] = to.q[7 + i] - from.q[7 + i];
        by[12 + n + i] = to.u[6 + i] - from.u[6 + i];
    }
    return by;
}

/// By what one estimate differs from another: motion, then lagged thrusts, then the gust.
/// @param lags lagged thrusts
template <int n>
Eigen::VectorXd difference(const VehicleEstimate<n>& to, const VehicleEstimate<n>& from, Eigen::Index lags) {
    constexpr Eigen::Index measured = measured_numbers<n>;
    Eigen::VectorXd by(measured + lags + GustModel::size);
    by.head(measured) = motion_between<n>(to.vehicle, from.vehicle);
    for (Eigen::Index i = 0; i < lags; ++i) {
        by[measured + i] = to.vehicle.thrust_n[i] - from.vehicle.thrust_n[i];
    }
    by.tail<GustModel::size>() = to.gust - from.gust;
    return by;
}

/// An estimate with such a difference added.
template <int n>
VehicleEstimate<n> corrected(const VehicleEstimate<n>& from, const Eigen::VectorXd& by, Eigen::Index lags) {
    VehicleEstimate<n> at = from;
    dynamics::SpaceState<double, n>& vehicle = at.vehicle;
    for (int i = 0; i < 3; ++i) {
        vehicle.q[i] += by[i];
        vehicle.u[i] += by[6 + n + i];
        vehicle.u[3 + i] += by[9 + n + i];
    }
    put_attitude((attitude_of(vehicle.q) * turn_by(by.template segment<3>(3))).normalized(), vehicle.q);
    for (int i = 0; i < n; ++i) {
        vehicle.q[7 + i] += by[6 + i];
        vehicle.u[6 + i] += by[12 + n + i];
    }
    for (Eigen::Index i = 0; i < lags; ++i) {
        vehicle.thrust_n[i] += by[measured_numbers<n> + i];
    }
    at.gust += by.tail<GustModel::size>();
    return at;
}

/// What is seen between two ticks, less where the vehicle is then.
template <int n>
Eigen::Matrix<double, measured_numbers<n>, 1> seen_between(const dynamics::SpaceState<double, n>& before,
                                                           const dynamics::SpaceState<double, n>& after,
                                                           double share_before,
                                                           const dynamics::SpaceState<double, n>& now) {
    dynamics::SpaceState<double, n> seen = before;
    const auto mix = [&](double& a, double b) { a = share_before * a + (1 - share_before) * b; };
    for (int i = 0; i < dynamics::space_coordinates<n>; ++i) {
        mix(seen.q[i], after.q[i]);
    }
    for (int i = 0; i < dynamics::space_speeds<n>; ++i) {
        mix(seen.u[i], after.u[i]);
    }
    put_attitude(attitude_of(seen.q).normalized(), seen.q);
    return motion_between<n>(seen, now);
}

}  // namespace downwash::identification

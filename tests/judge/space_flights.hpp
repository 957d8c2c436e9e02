#pragma once

#include "../dynamics/random_space_plant.hpp"
#include "downwash/judge/space_plant.hpp"
#include "downwash/simulation/space_world.hpp"

// Vehicles in space as both the judge and the planner know them.

namespace downwash::test {

/// A robot with a plant.
inline SpaceRobot robot_of(const ::downwash::SpacePlant& plant) {
    SpaceRobot robot;
    robot.plant = plant;
    robot.rotor_radius_m = 0.12;
    robot.links.resize(plant.links.size());
    for (SpaceLinkLimits& link : robot.links) {
        link.max_torque_nm = 3;
    }
    robot.min_thrust_n.assign(plant.rotors.size(), 0.2);
    robot.max_thrust_n.assign(plant.rotors.size(), 12);
    return robot;
}

/// The judge's coordinates of a planner's state.
template <int n>
judge::SpaceCoordinates coordinates_of(const dynamics::SpaceState<double, n>& state) {
    const double* q = state.q;
    const double* u = state.u;
    return {
        {q[0], q[1], q[2]}, Eigen::Quaterniond(q[3], q[4], q[5], q[6]),  {u[0], u[1], u[2]},
        {u[3], u[4], u[5]}, Eigen::Map<const Eigen::VectorXd>(q + 7, n), Eigen::Map<const Eigen::VectorXd>(u + 6, n)};
}

/// The greatest difference of both [m, m/s, rad, rad/s, or of a quaternion]. @tparam n number of joints
template <int n>
double difference(const judge::SpaceCoordinates& at, const dynamics::SpaceState<double, n>& state) {
    const judge::SpaceCoordinates other = coordinates_of(state);
    const double side = at.attitude.dot(other.attitude) < 0 ? -1 : 1;
    double worst = std::max({(at.position_m - other.position_m).cwiseAbs().maxCoeff(),
                             (at.velocity_m_s - other.velocity_m_s).cwiseAbs().maxCoeff(),
                             (at.body_rate_rad_s - other.body_rate_rad_s).cwiseAbs().maxCoeff(),
                             (at.attitude.coeffs() - side * other.attitude.coeffs()).cwiseAbs().maxCoeff()});
    for (int i = 0; i < n; ++i) {
        worst = std::max({worst, std::abs(at.joints_rad[i] - other.joints_rad[i]),
                          std::abs(at.joint_rates_rad_s[i] - other.joint_rates_rad_s[i])});
    }
    return worst;
}

/// K = 1 and wind.
struct WindInSpace : dynamics::CalmSpace {
    explicit WindInSpace(const Eigen::Vector3d& wind) : air{wind.x(), wind.y(), wind.z()} {}
    dynamics::LaneVector<double> air;
    static constexpr bool has_wind = true;
    [[nodiscard]] dynamics::LaneVector<double> wind() const { return air; }
};

}  // namespace downwash::test

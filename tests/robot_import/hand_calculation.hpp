#pragma once

#include <Eigen/Dense>
#include <vector>

#include "downwash/base/vector3.hpp"

namespace downwash::test {

/// A body of a model, as a hand writes it down: its centre and its own axes in the frame of the base.
struct HandBody {
    double mass_kg;
    Eigen::Vector3d center_m;
    Eigen::Matrix3d inertia_kg_m2;
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

inline Eigen::Matrix3d diagonal(double x, double y, double z) {
    return Eigen::Vector3d(x, y, z).asDiagonal();
}

/// Several bodies as one, by second moments of mass about the origin instead of the parallel-axis rule.
inline HandBody joined(const std::vector<HandBody>& bodies) {
    double mass = 0;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    for (const HandBody& body : bodies) {
        const Eigen::Matrix3d turned = body.axes * body.inertia_kg_m2 * body.axes.transpose();
        second += 0.5 * turned.trace() * Eigen::Matrix3d::Identity() - turned +
                  body.mass_kg * body.center_m * body.center_m.transpose();
        first += body.mass_kg * body.center_m;
        mass += body.mass_kg;
    }
    const Eigen::Vector3d center = first / mass;
    second -= mass * center * center.transpose();
    return {mass, center, second.trace() * Eigen::Matrix3d::Identity() - second};
}

inline Eigen::Vector3d eigen(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

inline Eigen::Matrix3d eigen(const Matrix3& m) {
    Eigen::Matrix3d out;
    out << m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1], m[2][2];
    return out;
}

/// Thrusts of least norm that carry a weight at a place without torques [N].
/// @param spin_torque_m spin times drag torque per newton of each rotor
inline Eigen::VectorXd hover_thrusts_n(const std::vector<Eigen::Vector3d>& hubs_m,
                                       const std::vector<double>& spin_torque_m, double weight_n,
                                       const Eigen::Vector3d& at_m) {
    Eigen::MatrixXd effect(4, hubs_m.size());
    for (Eigen::Index k = 0; k < effect.cols(); ++k) {
        const Eigen::Vector3d& hub = hubs_m[static_cast<std::size_t>(k)];
        effect.col(k) << 1, hub.y() - at_m.y(), at_m.x() - hub.x(), -spin_torque_m[static_cast<std::size_t>(k)];
    }
    return effect.completeOrthogonalDecomposition().solve(Eigen::Vector4d(weight_n, 0, 0, 0));
}

/// Whether two matrices or vectors are the same but for rounding.
template <class A, class B>
bool are_close(const A& a, const B& b, double tolerance = 1e-9) {
    return (a - b).cwiseAbs().maxCoeff() < tolerance;
}

}  // namespace downwash::test

#include "space_newton_euler.hpp"

namespace downwash::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d vector_of(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

Matrix3d matrix_of(const Matrix3& m) {
    Matrix3d matrix;
    matrix << m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1], m[2][2];
    return matrix;
}

/// What a body needs, and where.
struct Need {
    Vector3d force, moment;  ///< about its centre of mass
    Vector3d center;
    Vector3d joint, axis;  ///< world
};

}  // namespace

SpaceForces space_newton_euler_forces(const SpacePlant& plant, const double* q, const double* u, const double* du) {
    const Vector3d gravity(0, 0, 9.80665);
    Matrix3d axes = Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized().toRotationMatrix();
    Vector3d rate = axes * Vector3d(u[3], u[4], u[5]);
    Vector3d rate_change = axes * Vector3d(du[3], du[4], du[5]);
    Vector3d origin(q[0], q[1], q[2]);
    Vector3d acceleration = Vector3d(du[0], du[1], du[2]) + gravity;
    std::vector<Need> needs;
    const auto need = [&](const SpaceBody& body, const Vector3d& to_center, const Vector3d& axis) {
        const Matrix3d inertia = axes * matrix_of(body.inertia_kg_m2) * axes.transpose();
        const Vector3d center_acceleration =
            acceleration + rate_change.cross(to_center) + rate.cross(rate.cross(to_center));
        needs.push_back({body.mass_kg * center_acceleration, inertia * rate_change + rate.cross(inertia * rate),
                         origin + to_center, origin, axis});
    };
    need(plant.multirotor, Vector3d::Zero(), Vector3d::Zero());
    for (std::size_t i = 0; i < plant.links.size(); ++i) {
        const SpaceLink& link = plant.links[i];
        const Vector3d along = axes * vector_of(link.joint_m);
        acceleration += rate_change.cross(along) + rate.cross(rate.cross(along));
        origin += along;
        const Vector3d unit = vector_of(link.axis).normalized();
        const Vector3d axis = axes * unit;
        rate_change += du[6 + i] * axis + u[6 + i] * rate.cross(axis);
        rate += u[6 + i] * axis;
        axes = axes * Eigen::AngleAxisd(q[7 + i], unit).toRotationMatrix();
        need(link.body, axes * vector_of(link.center_of_mass_m), axis);
    }
    SpaceForces forces;
    forces.joint_torques_nm.resize(plant.links.size());
    Vector3d force = Vector3d::Zero();
    Vector3d moment_at_origin = Vector3d::Zero();  // about the world's origin
    for (std::size_t i = needs.size(); i-- > 0;) {
        force += needs[i].force;
        moment_at_origin += needs[i].moment + needs[i].center.cross(needs[i].force);
        const Vector3d at_joint = moment_at_origin - needs[i].joint.cross(force);
        if (i == 0) {
            forces.torque_nm = at_joint;
        } else {
            forces.joint_torques_nm[i - 1] = needs[i].axis.dot(at_joint);
        }
    }
    forces.force_n = force;
    return forces;
}

}  // namespace downwash::test

#include "downwash/judge/space_bodies.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "downwash/dynamics/plant_model.hpp"

namespace downwash::judge {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Matrix3d crossing(const Vector3d& v) {
    Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

/// Two unit vectors across an axis and across each other.
struct Across {
    Vector3d first, second;

    explicit Across(const Vector3d& axis) : first(axis.unitOrthogonal()), second(axis.cross(first)) {}
};

/// The turn by a small or large rotation vector.
Eigen::Quaterniond turn_by(const Vector3d& turn) {
    const double angle = turn.norm();
    return angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) : Eigen::Quaterniond::Identity();
}

}  // namespace

BodyMotions bodies_at(const SpaceVehicle& vehicle, const SpaceCoordinates& at) {
    BodyMotions bodies;
    const Eigen::Quaterniond attitude = at.attitude.normalized();
    bodies.push_back({at.position_m, attitude, at.velocity_m_s, attitude * at.body_rate_rad_s});
    for (int i = 0; i < vehicle.joint_count(); ++i) {
        const FlyingJoint& joint = vehicle.joints[static_cast<std::size_t>(i)];
        const BodyMotion& inner = bodies.back();
        BodyMotion outer;
        outer.attitude = (inner.attitude * Eigen::AngleAxisd(at.joints_rad[i], joint.axis)).normalized();
        outer.rate_rad_s = inner.rate_rad_s + at.joint_rates_rad_s[i] * (inner.attitude * joint.axis);
        const Vector3d to_joint = inner.attitude * joint.in_inner_m;
        const Vector3d from_joint = -(outer.attitude * joint.in_outer_m);
        outer.position_m = inner.position_m + to_joint + from_joint;
        outer.velocity_m_s = inner.velocity_m_s + inner.rate_rad_s.cross(to_joint) + outer.rate_rad_s.cross(from_joint);
        bodies.push_back(outer);
    }
    return bodies;
}

SpaceCoordinates coordinates_of(const SpaceVehicle& vehicle, const BodyMotions& bodies, const VectorXd& near_rad) {
    SpaceCoordinates at;
    const BodyMotion& body = bodies.front();
    at.position_m = body.position_m;
    at.attitude = body.attitude;
    at.velocity_m_s = body.velocity_m_s;
    at.body_rate_rad_s = body.attitude.conjugate() * body.rate_rad_s;
    const int n = vehicle.joint_count();
    at.joints_rad.resize(n);
    at.joint_rates_rad_s.resize(n);
    for (int i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Vector3d& axis = vehicle.joints[k].axis;
        const Eigen::Quaterniond turn = bodies[k].attitude.conjugate() * bodies[k + 1].attitude;
        const double angle = 2 * std::atan2(turn.vec().dot(axis), turn.w());
        constexpr double whole = 2 * std::numbers::pi;
        at.joints_rad[i] = angle + whole * std::round((near_rad[i] - angle) / whole);
        at.joint_rates_rad_s[i] = (bodies[k].attitude * axis).dot(bodies[k + 1].rate_rad_s - bodies[k].rate_rad_s);
    }
    return at;
}

Linkage::Linkage(const SpaceVehicle& vehicle, std::optional<HeldPlane> plane)
    : vehicle_(vehicle), plane_(std::move(plane)) {
    for (const FlyingBody& body : vehicle.bodies) {
        inverse_inertia_.emplace_back(body.inertia_kg_m2.inverse());
    }
}

Linkage::Rows Linkage::rows_at(const BodyMotions& bodies) const {
    const auto joints = static_cast<Eigen::Index>(vehicle_.joints.size());
    const Eigen::Index count = 5 * joints + (plane_ ? 3 : 0);
    Rows rows{MatrixXd::Zero(count, 6 * (joints + 1)), VectorXd::Zero(count), VectorXd::Zero(count)};
    for (Eigen::Index i = 0; i < joints; ++i) {
        const FlyingJoint& joint = vehicle_.joints[static_cast<std::size_t>(i)];
        const BodyMotion& inner = bodies[static_cast<std::size_t>(i)];
        const BodyMotion& outer = bodies[static_cast<std::size_t>(i) + 1];
        const Eigen::Index a = 6 * i;
        const Eigen::Index b = a + 6;
        const Vector3d& w = inner.rate_rad_s;
        const Vector3d& v = outer.rate_rad_s;
        // Both bodies have the joint at the same place.
        const Vector3d at_inner = inner.attitude * joint.in_inner_m;
        const Vector3d at_outer = outer.attitude * joint.in_outer_m;
        rows.error.segment<3>(5 * i) = inner.position_m + at_inner - outer.position_m - at_outer;
        rows.jacobian.block<3, 3>(5 * i, a).setIdentity();
        rows.jacobian.block<3, 3>(5 * i, a + 3) = -crossing(at_inner);
        rows.jacobian.block<3, 3>(5 * i, b) = -Matrix3d::Identity();
        rows.jacobian.block<3, 3>(5 * i, b + 3) = crossing(at_outer);
        rows.drift.segment<3>(5 * i) = w.cross(w.cross(at_inner)) - v.cross(v.cross(at_outer));
        // The axis on the outer body stays across two vectors of the inner one.
        const Across across(joint.axis);
        const Vector3d axis = outer.attitude * joint.axis;
        int row = 3;
        for (const Vector3d& own : {across.first, across.second}) {
            const Vector3d side = inner.attitude * own;
            const Vector3d c = side.cross(axis);
            rows.error[5 * i + row] = side.dot(axis);
            rows.jacobian.block<1, 3>(5 * i + row, a + 3) = c.transpose();
            rows.jacobian.block<1, 3>(5 * i + row, b + 3) = -c.transpose();
            // d/dt of (w - v) . (side x axis) at constant rates.
            rows.drift[5 * i + row] = (w - v).dot(w.cross(side).cross(axis) + side.cross(v.cross(axis)));
            ++row;
        }
    }
    if (plane_) {
        const BodyMotion& body = bodies.front();
        const Eigen::Index at = 5 * joints;
        rows.error[at] = plane_->normal.dot(body.position_m - plane_->point_m);
        rows.jacobian.block<1, 3>(at, 0) = plane_->normal.transpose();
        const Vector3d lateral = body.attitude * Vector3d::UnitY();
        const Across across(plane_->normal);
        int row = 1;
        for (const Vector3d& side : {across.first, across.second}) {
            // d(side . lateral)/dt = side . (w x lateral) = w . (lateral x side)
            rows.error[at + row] = side.dot(lateral);
            rows.jacobian.block<1, 3>(at + row, 3) = lateral.cross(side).transpose();
            rows.drift[at + row] = body.rate_rad_s.dot(body.rate_rad_s.cross(lateral).cross(side));
            ++row;
        }
    }
    return rows;
}

MatrixXd Linkage::without_mass(const BodyMotions& bodies, const MatrixXd& columns) const {
    MatrixXd out(columns.rows(), columns.cols());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(6 * i);
        const Matrix3d r = bodies[i].attitude.toRotationMatrix();
        out.middleRows<3>(at) = columns.middleRows<3>(at) / vehicle_.bodies[i].mass_kg;
        out.middleRows<3>(at + 3) = r * (inverse_inertia_[i] * (r.transpose() * columns.middleRows<3>(at + 3)));
    }
    return out;
}

VectorXd Linkage::accelerations(const BodyMotions& bodies, const std::vector<BodyLoad>& loads) const {
    VectorXd acting(static_cast<Eigen::Index>(6 * bodies.size()));
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(6 * i);
        const Matrix3d r = bodies[i].attitude.toRotationMatrix();
        const Vector3d& w = bodies[i].rate_rad_s;
        acting.segment<3>(at) =
            loads[i].force_n - vehicle_.bodies[i].mass_kg * standard_gravity_m_s2 * Vector3d::UnitZ();
        acting.segment<3>(at + 3) =
            loads[i].torque_nm - w.cross(r * (vehicle_.bodies[i].inertia_kg_m2 * (r.transpose() * w)));
    }
    VectorXd free = without_mass(bodies, acting);
    const Rows rows = rows_at(bodies);
    if (rows.error.size() == 0) {
        return free;
    }
    const MatrixXd inverse_mass = without_mass(bodies, rows.jacobian.transpose());
    const VectorXd forces = (rows.jacobian * inverse_mass).ldlt().solve(VectorXd(-rows.drift - rows.jacobian * free));
    return free + inverse_mass * forces;
}

void Linkage::project(BodyMotions& bodies) const {
    for (BodyMotion& body : bodies) {
        body.attitude.normalize();
    }
    // Errors are those of an integrator: Newton's method squares them.
    constexpr int rounds = 2;
    for (int round = 0; round < rounds; ++round) {
        const Rows rows = rows_at(bodies);
        if (rows.error.size() == 0) {
            return;
        }
        const MatrixXd inverse_mass = without_mass(bodies, rows.jacobian.transpose());
        const VectorXd move = inverse_mass * (rows.jacobian * inverse_mass).ldlt().solve(VectorXd(-rows.error));
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            const auto at = static_cast<Eigen::Index>(6 * i);
            bodies[i].position_m += move.segment<3>(at);
            bodies[i].attitude = (turn_by(move.segment<3>(at + 3)) * bodies[i].attitude).normalized();
        }
    }
    const Rows rows = rows_at(bodies);
    VectorXd speeds(static_cast<Eigen::Index>(6 * bodies.size()));
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(6 * i);
        speeds.segment<3>(at) = bodies[i].velocity_m_s;
        speeds.segment<3>(at + 3) = bodies[i].rate_rad_s;
    }
    const MatrixXd inverse_mass = without_mass(bodies, rows.jacobian.transpose());
    speeds -= inverse_mass * (rows.jacobian * inverse_mass).ldlt().solve(VectorXd(rows.jacobian * speeds));
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(6 * i);
        bodies[i].velocity_m_s = speeds.segment<3>(at);
        bodies[i].rate_rad_s = speeds.segment<3>(at + 3);
    }
}

Linkage::Errors Linkage::errors(const BodyMotions& bodies) const {
    const Rows rows = rows_at(bodies);
    if (rows.error.size() == 0) {
        return {0, 0};
    }
    VectorXd speeds(static_cast<Eigen::Index>(6 * bodies.size()));
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        speeds.segment<3>(static_cast<Eigen::Index>(6 * i)) = bodies[i].velocity_m_s;
        speeds.segment<3>(static_cast<Eigen::Index>(6 * i + 3)) = bodies[i].rate_rad_s;
    }
    return {rows.error.cwiseAbs().maxCoeff(), (rows.jacobian * speeds).cwiseAbs().maxCoeff()};
}

Needed needed_for(const SpaceVehicle& vehicle, const BodyMotions& bodies, const Vector3d& acceleration_m_s2,
                  const Vector3d& turn_rad_s2, const VectorXd& joints_rad_s2, double gravity_m_s2) {
    const int n = vehicle.joint_count();
    Needed needed{Vector3d::Zero(), Vector3d::Zero(), VectorXd::Zero(n)};
    Vector3d a = acceleration_m_s2;
    Vector3d turn = turn_rad_s2;
    for (int i = 0; i <= n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const BodyMotion& body = bodies[k];
        const Vector3d& w = body.rate_rad_s;
        if (i > 0) {
            const FlyingJoint& joint = vehicle.joints[k - 1];
            const BodyMotion& inner = bodies[k - 1];
            const Vector3d axis = inner.attitude * joint.axis;
            const Vector3d to_joint = inner.attitude * joint.in_inner_m;
            const Vector3d from_joint = -(body.attitude * joint.in_outer_m);
            const Vector3d& v = inner.rate_rad_s;
            a += turn.cross(to_joint) + v.cross(v.cross(to_joint));
            turn += joints_rad_s2[i - 1] * axis + v.cross(w - v);
            a += turn.cross(from_joint) + w.cross(w.cross(from_joint));
        }
        const Matrix3d r = body.attitude.toRotationMatrix();
        const Matrix3d inertia = r * vehicle.bodies[k].inertia_kg_m2 * r.transpose();
        const Vector3d force = vehicle.bodies[k].mass_kg * (a + gravity_m_s2 * Vector3d::UnitZ());
        const Vector3d torque = inertia * turn + w.cross(inertia * w);
        needed.force_n += force;
        needed.torque_nm += torque + (body.position_m - bodies.front().position_m).cross(force);
        for (int j = 0; j < i; ++j) {
            const auto at = static_cast<std::size_t>(j);
            const Vector3d joint_m = bodies[at].position_m + bodies[at].attitude * vehicle.joints[at].in_inner_m;
            needed.joints_nm[j] +=
                (bodies[at].attitude * vehicle.joints[at].axis).dot(torque + (body.position_m - joint_m).cross(force));
        }
    }
    return needed;
}

Needed push_on(const SpaceVehicle& vehicle, const BodyMotions& bodies, const BodyPush& push) {
    const Vector3d at_m = bodies[push.body].position_m + bodies[push.body].attitude * push.lever_m;
    Needed moments{push.force_n, (at_m - bodies.front().position_m).cross(push.force_n),
                   VectorXd::Zero(vehicle.joint_count())};
    for (std::size_t i = 0; i < push.body; ++i) {  // the joints between the multirotor and the body
        const BodyMotion& inner = bodies[i];
        const Vector3d from_joint_m = at_m - inner.position_m - inner.attitude * vehicle.joints[i].in_inner_m;
        moments.joints_nm[static_cast<Eigen::Index>(i)] =
            from_joint_m.cross(push.force_n).dot(inner.attitude * vehicle.joints[i].axis);
    }
    return moments;
}

}  // namespace downwash::judge

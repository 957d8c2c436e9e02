#include "downwash/judge/space_observer.hpp"

#include <cstddef>

#include "downwash/dynamics/plant_model.hpp"

namespace downwash::judge {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// e^x as docs/model.md 5.6 sums it up.
double growth_of(double x) {
    return 1 + x * (1 + x / 2 * (1 + x / 3 * (1 + x / 4)));
}

/// Sums over the bodies from one on, world axes.
struct Sums {
    Vector3d push = Vector3d::Zero();           ///< linear momentum
    Vector3d spin = Vector3d::Zero();           ///< angular momentum about a point
    Vector3d weight_moment = Vector3d::Zero();  ///< about the same point
    double mass_kg = 0;
};

Sums sums_from(const SpaceVehicle& vehicle, const BodyMotions& bodies, std::size_t first, const Vector3d& about_m) {
    Sums sums;
    for (std::size_t i = first; i < bodies.size(); ++i) {
        const BodyMotion& b = bodies[i];
        const double mass_kg = vehicle.bodies[i].mass_kg;
        const Vector3d push = mass_kg * b.velocity_m_s;
        const Vector3d lever = b.position_m - about_m;
        sums.mass_kg += mass_kg;
        sums.push += push;
        sums.spin += lever.cross(push) +
                     b.attitude * (vehicle.bodies[i].inertia_kg_m2 * (b.attitude.conjugate() * b.rate_rad_s));
        sums.weight_moment += lever.cross(Vector3d(0, 0, -standard_gravity_m_s2 * mass_kg));
    }
    return sums;
}

/// Place, velocity and axis of a joint.
struct JointMotion {
    Vector3d at_m, velocity_m_s, axis;

    JointMotion(const SpaceVehicle& vehicle, const BodyMotions& bodies, std::size_t joint) {
        const BodyMotion& inner = bodies[joint];
        const Vector3d lever = inner.attitude * vehicle.joints[joint].in_inner_m;
        at_m = inner.position_m + lever;
        velocity_m_s = inner.velocity_m_s + inner.rate_rad_s.cross(lever);
        axis = inner.attitude * vehicle.joints[joint].axis;
    }
};

}  // namespace

VectorXd momentum_of(const SpaceVehicle& vehicle, const BodyMotions& bodies) {
    VectorXd p(6 + vehicle.joint_count());
    const Sums all = sums_from(vehicle, bodies, 0, bodies.front().position_m);
    p.segment<3>(0) = all.push;
    p.segment<3>(3) = bodies.front().attitude.conjugate() * all.spin;
    for (std::size_t i = 0; i < vehicle.joints.size(); ++i) {
        const JointMotion joint(vehicle, bodies, i);
        p[static_cast<Eigen::Index>(6 + i)] = joint.axis.dot(sums_from(vehicle, bodies, i + 1, joint.at_m).spin);
    }
    return p;
}

VectorXd free_momentum_rate(const SpaceVehicle& vehicle, const BodyMotions& bodies) {
    VectorXd rate(6 + vehicle.joint_count());
    const BodyMotion& body = bodies.front();
    const Sums all = sums_from(vehicle, bodies, 0, body.position_m);
    rate.segment<3>(0) = Vector3d(0, 0, -standard_gravity_m_s2 * all.mass_kg);
    // About a point that moves at v the angular momentum L changes by the moment less v x P; in axes that turn by
    // -w x L besides.
    rate.segment<3>(3) = body.attitude.conjugate() *
                         (all.weight_moment - body.velocity_m_s.cross(all.push) - body.rate_rad_s.cross(all.spin));
    for (std::size_t i = 0; i < vehicle.joints.size(); ++i) {
        const JointMotion joint(vehicle, bodies, i);
        const Sums outer = sums_from(vehicle, bodies, i + 1, joint.at_m);
        rate[static_cast<Eigen::Index>(6 + i)] =
            joint.axis.dot(outer.weight_moment - joint.velocity_m_s.cross(outer.push)) +
            bodies[i].rate_rad_s.cross(joint.axis).dot(outer.spin);
    }
    return rate;
}

SpaceObserver::SpaceObserver(const SpaceVehicle& nominal, double gain_1_s, double tick_s)
    : nominal_(nominal), tick_s_(tick_s), share_(1 - 1 / growth_of(gain_1_s * tick_s)) {}

SpaceObserverMemory SpaceObserver::at_start(const SpaceCoordinates& seen) const {
    return {VectorXd::Zero(6 + nominal_.joint_count()), momentum_of(nominal_, bodies_at(nominal_, seen))};
}

void SpaceObserver::look(const SpaceCoordinates& seen, SpaceObserverMemory& memory) const {
    memory.estimate += share_ / tick_s_ * (momentum_of(nominal_, bodies_at(nominal_, seen)) - memory.expected_momentum);
}

void SpaceObserver::expect(const SpaceCoordinates& seen, const Vector3d& force_n, const Vector3d& torque_nm,
                           const VectorXd& joints_nm, SpaceObserverMemory& memory) const {
    SpaceCoordinates middle = seen;
    const double half_s = 0.5 * tick_s_;
    const double turn_rad = half_s * seen.body_rate_rad_s.norm();
    middle.position_m += half_s * seen.velocity_m_s;
    middle.attitude.normalize();
    if (turn_rad > 0) {
        middle.attitude = middle.attitude * Eigen::AngleAxisd(turn_rad, seen.body_rate_rad_s.normalized());
    }
    middle.joints_rad += half_s * seen.joint_rates_rad_s;
    VectorXd acting(6 + nominal_.joint_count());
    acting << middle.attitude * force_n, torque_nm, joints_nm;
    memory.expected_momentum =
        momentum_of(nominal_, bodies_at(nominal_, seen)) +
        tick_s_ * (acting + free_momentum_rate(nominal_, bodies_at(nominal_, middle)) + memory.estimate);
}

SpaceObserverMemory SpaceObserver::held(SpaceObserverMemory memory, const SpaceCoordinates& from,
                                        const SpaceCoordinates& to) const {
    memory.expected_momentum +=
        momentum_of(nominal_, bodies_at(nominal_, to)) - momentum_of(nominal_, bodies_at(nominal_, from));
    return memory;
}

}  // namespace downwash::judge

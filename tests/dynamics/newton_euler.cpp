#include "newton_euler.hpp"

#include <cmath>
#include <vector>

namespace downwash::test {
namespace {

using Vector = std::array<double, 3>;

Vector operator+(const Vector& a, const Vector& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vector operator*(double s, const Vector& a) {
    return {s * a[0], s * a[1], s * a[2]};
}
double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A body-fixed vector (x, 0, z) of a frame turned by `angle` about +y, in world axes.
Vector turned(double angle, double x, double z) {
    const Vector first{std::cos(angle), 0, -std::sin(angle)};
    const Vector third{std::sin(angle), 0, std::cos(angle)};
    return x * first + z * third;
}

/// One joint of the chain and the link behind it; the first joints move links without mass.
struct Link {
    bool turns;
    Vector axis;            ///< in world axes
    Vector from_parent;     ///< parent's frame -> this frame, in world axes
    Vector center_of_mass;  ///< from this frame
    double mass;
    double inertia_y;  ///< about the centre of mass
};

}  // namespace

Four newton_euler_forces(const MultirotorParameters& multirotor, const ArmParameters& arm, const Four& q, const Four& u,
                         const Four& du) {
    constexpr double gravity = 9.80665;
    const Vector none{0, 0, 0};
    const Vector along_x{1, 0, 0};
    const Vector along_y{0, 1, 0};
    const Vector along_z{0, 0, 1};
    const std::vector<Link> chain = {
        {false, along_x, q[0] * along_x, none, 0, 0},
        {false, along_z, q[1] * along_z, none, 0, 0},
        {true, along_y, none, none, multirotor.mass_kg, multirotor.pitch_inertia_kg_m2},
        {true, along_y, turned(q[2], arm.joint_x_m, arm.joint_z_m), turned(q[2] + q[3], arm.center_of_mass_m, 0),
         arm.mass_kg, arm.inertia_kg_m2},
    };

    // Outward: rates and accelerations of each frame; gravity as an acceleration of the world (A.7).
    Vector rate = none;
    Vector rate_change = none;
    Vector acceleration = gravity * along_z;
    std::vector<Vector> force;
    std::vector<Vector> moment;  // about the centre of mass
    for (std::size_t i = 0; i < chain.size(); ++i) {
        const Link& link = chain[i];
        acceleration = acceleration + cross(rate_change, link.from_parent) + cross(rate, cross(rate, link.from_parent));
        if (link.turns) {
            rate_change = rate_change + du[i] * link.axis + u[i] * cross(rate, link.axis);
            rate = rate + u[i] * link.axis;
        } else {
            acceleration = acceleration + du[i] * link.axis + 2 * u[i] * cross(rate, link.axis);
        }
        const Vector& to_center = link.center_of_mass;
        const Vector center_acceleration =
            acceleration + cross(rate_change, to_center) + cross(rate, cross(rate, to_center));
        const Vector spin = link.inertia_y * rate;  // all rotation is about y
        force.push_back(link.mass * center_acceleration);
        moment.push_back(link.inertia_y * rate_change + cross(rate, spin));
    }

    // Inward: what each joint must carry of the links behind it (A.8, A.9).
    Four generalised{};
    Vector carried_force = none;
    Vector carried_moment = none;  // about the origin of the frame behind
    Vector behind = none;          // this frame -> the frame behind
    for (std::size_t i = chain.size(); i-- > 0;) {
        const Link& link = chain[i];
        carried_moment =
            carried_moment + cross(behind, carried_force) + moment[i] + cross(link.center_of_mass, force[i]);
        carried_force = carried_force + force[i];
        generalised[i] = dot(link.axis, link.turns ? carried_moment : carried_force);
        behind = link.from_parent;
    }
    return generalised;
}

}  // namespace downwash::test

#include "downwash/judge/equations_of_motion.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "downwash/dynamics/plant_model.hpp"

namespace downwash::judge {
namespace {

/// From the joint, and from it to the centre of mass of the arm.
struct Levers {
    Planar to_joint;        ///< From the multirotor's centre of mass.
    Planar arm_from_joint;  ///< From the joint to the arm's centre of mass.
    double arm_rate_rad_s;  ///< Rate of the arm against the world.
};

Levers levers_of(const Vehicle& vehicle, const Motion& motion) {
    return {from_body(vehicle.joint_m, motion.pitch_rad),
            vehicle.arm_center_of_mass_m * arm_direction(motion.pitch_rad, motion.arm_rad),
            motion.pitch_rate_rad_s + motion.arm_rate_rad_s};
}

double squared(Planar v) {
    return v.x * v.x + v.z * v.z;
}

/// Force and first moment of a stream across the stretch from s0 to s1 [m from the joint], on which it has one sign.
/// With v(s) = v0 + w s the integrand -(c1 + c2 sign v) v is linear and quadratic in s: its integrals are exact.
void add_stretch(const DragParameters& drag, double length_m, double v0, double w, double s0, double s1, double& force,
                 double& moment) {
    const double sign = v0 + 0.5 * w * (s0 + s1) < 0 ? -1 : 1;
    // -(c1 v + c2 sign v^2) / L = a + b s + c s^2
    const double c2 = drag.quadratic_n_s2_m2 * sign;
    const double a = -(drag.linear_n_s_m * v0 + c2 * v0 * v0) / length_m;
    const double b = -(drag.linear_n_s_m * w + 2 * c2 * v0 * w) / length_m;
    const double c = -c2 * w * w / length_m;
    const auto power = [&](int n) { return (std::pow(s1, n) - std::pow(s0, n)) / n; };
    force += a * power(1) + b * power(2) + c * power(3);
    moment += a * power(2) + b * power(3) + c * power(4);
}

}  // namespace

Acceleration acceleration_of(const Vehicle& vehicle, const Motion& motion, const Loads& loads) {
    constexpr double g = standard_gravity_m_s2;
    const Levers levers = levers_of(vehicle, motion);
    const Planar a = levers.to_joint;               // in the multirotor, from its centre of mass to the joint
    const Planar b = -1.0 * levers.arm_from_joint;  // in the arm, from its centre of mass to the joint
    const double wa = motion.pitch_rate_rad_s;
    const double wb = levers.arm_rate_rad_s;
    const double ma = vehicle.body_mass_kg;
    const double mb = vehicle.arm_mass_kg;

    // Unknown: accelerations of A (x, z, pitch) and B (x, z, pitch + arm), force f of B on A in the joint.
    Eigen::Matrix<double, 8, 8> m = Eigen::Matrix<double, 8, 8>::Zero();
    Eigen::Matrix<double, 8, 1> r;
    m(0, 0) = ma;
    m(0, 6) = -1;
    m(1, 1) = ma;
    m(1, 7) = -1;
    m(2, 2) = vehicle.body_inertia_kg_m2;
    m(2, 6) = -a.z;
    m(2, 7) = a.x;
    m(3, 3) = mb;
    m(3, 6) = 1;
    m(4, 4) = mb;
    m(4, 7) = 1;
    m(5, 5) = vehicle.arm_inertia_kg_m2;
    m(5, 6) = b.z;
    m(5, 7) = -b.x;
    // Acceleration of the joint in A less that in B: a_A + alpha_A x a - wa^2 a = a_B + alpha_B x b - wb^2 b.
    m(6, 0) = 1;
    m(6, 2) = a.z;
    m(6, 3) = -1;
    m(6, 5) = -b.z;
    m(7, 1) = 1;
    m(7, 2) = -a.x;
    m(7, 4) = -1;
    m(7, 5) = b.x;
    r << loads.body_force_n.x, loads.body_force_n.z - ma * g, loads.body_moment_nm - loads.joint_torque_nm,
        loads.arm_force_n.x, loads.arm_force_n.z - mb * g, loads.arm_moment_nm + loads.joint_torque_nm,
        wa * wa * a.x - wb * wb * b.x, wa * wa * a.z - wb * wb * b.z;
    const Eigen::Matrix<double, 8, 1> x = m.partialPivLu().solve(r);
    return {{x(0), x(1)}, x(2), x(5) - x(2)};
}

void add_drag(const Vehicle& vehicle, const Motion& motion, Planar wind_m_s, Loads& loads) {
    const Planar stream = motion.velocity_m_s - wind_m_s;
    const double speed = std::sqrt(squared(stream));
    loads.body_force_n =
        loads.body_force_n - (vehicle.body_drag.linear_n_s_m + vehicle.body_drag.quadratic_n_s2_m2 * speed) * stream;
    if (!vehicle.arm_drag.is_any()) {
        return;
    }
    const Levers levers = levers_of(vehicle, motion);
    const Planar e = arm_direction(motion.pitch_rad, motion.arm_rad);
    const Planar n = turned(1, e);  // the direction in which the arm's points move as it turns
    const Planar joint = stream + turned(motion.pitch_rate_rad_s, levers.to_joint);
    const double v0 = joint.x * n.x + joint.z * n.z;
    const double w = levers.arm_rate_rad_s;
    const double length_m = vehicle.arm_length_m;
    double force_n = 0;
    double moment_nm = 0;                          // about the joint
    const double still_m = w != 0 ? -v0 / w : -1;  // where the stream changes its side
    if (still_m > 0 && still_m < length_m) {
        add_stretch(vehicle.arm_drag, length_m, v0, w, 0, still_m, force_n, moment_nm);
        add_stretch(vehicle.arm_drag, length_m, v0, w, still_m, length_m, force_n, moment_nm);
    } else {
        add_stretch(vehicle.arm_drag, length_m, v0, w, 0, length_m, force_n, moment_nm);
    }
    // The moment of a force f n at s e about the joint is f s, as e x n = 1.
    loads.arm_force_n = loads.arm_force_n + force_n * n;
    loads.arm_moment_nm += moment_nm - force_n * vehicle.arm_center_of_mass_m;
}

double mechanical_energy_j(const Vehicle& vehicle, const Motion& motion) {
    const Levers levers = levers_of(vehicle, motion);
    const Planar arm_velocity = motion.velocity_m_s + turned(motion.pitch_rate_rad_s, levers.to_joint) +
                                turned(levers.arm_rate_rad_s, levers.arm_from_joint);
    const double arm_z_m = motion.position_m.z + levers.to_joint.z + levers.arm_from_joint.z;
    return 0.5 * (vehicle.body_mass_kg * squared(motion.velocity_m_s) + vehicle.arm_mass_kg * squared(arm_velocity) +
                  vehicle.body_inertia_kg_m2 * motion.pitch_rate_rad_s * motion.pitch_rate_rad_s +
                  vehicle.arm_inertia_kg_m2 * levers.arm_rate_rad_s * levers.arm_rate_rad_s) +
           standard_gravity_m_s2 * (vehicle.body_mass_kg * motion.position_m.z + vehicle.arm_mass_kg * arm_z_m);
}

}  // namespace downwash::judge

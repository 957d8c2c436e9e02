#include "downwash/judge/space_plant.hpp"

#include <algorithm>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation/generation_controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation/generation_runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/stepper/generation/make_controlled.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "downwash/judge/space_air.hpp"
#include "downwash/judge/space_touching.hpp"

namespace downwash::judge {
namespace {

using Eigen::Vector3d;

constexpr double tolerance = 1e-9;
constexpr std::size_t per_body = 13;

/// Position, quaternion (w, x, y, z), velocity and rate of each body; energy; thrusts; beside a surface its impulse.
using Numbers = std::vector<double>;

Numbers numbers_of(const SpacePlantState& state) {
    Numbers y;
    for (const BodyMotion& b : state.bodies) {
        const Eigen::Quaterniond& q = b.attitude;
        const double all[] = {b.position_m.x(),
                              b.position_m.y(),
                              b.position_m.z(),
                              q.w(),
                              q.x(),
                              q.y(),
                              q.z(),
                              b.velocity_m_s.x(),
                              b.velocity_m_s.y(),
                              b.velocity_m_s.z(),
                              b.rate_rad_s.x(),
                              b.rate_rad_s.y(),
                              b.rate_rad_s.z()};
        y.insert(y.end(), std::begin(all), std::end(all));
    }
    y.push_back(state.energy_j);
    y.insert(y.end(), state.thrust_n.begin(), state.thrust_n.end());
    return y;
}

BodyMotions bodies_of(const Numbers& y, std::size_t count) {
    BodyMotions bodies;
    for (std::size_t i = 0; i < count; ++i) {
        const double* at = y.data() + per_body * i;
        bodies.push_back({{at[0], at[1], at[2]},
                          Eigen::Quaterniond(at[3], at[4], at[5], at[6]).normalized(),
                          {at[7], at[8], at[9]},
                          {at[10], at[11], at[12]}});
    }
    return bodies;
}

/// Friction and stops of a joint (docs/model.md 2.10).
double passive_torque_nm(const FlyingJoint& joint, double angle_rad, double rate_rad_s) {
    constexpr double slip_rad_s = 0.05;
    double torque_nm = -joint.viscous_friction_nm_s * rate_rad_s -
                       joint.coulomb_friction_nm * rate_rad_s / std::hypot(rate_rad_s, slip_rad_s);
    if (joint.stop) {
        const JointStop& stop = *joint.stop;
        const double over = angle_rad - stop.upper_rad;
        const double under = stop.lower_rad - angle_rad;
        if (over > 0) {
            torque_nm -= stop.stiffness_nm_rad * over * std::max(0.0, 1 + stop.dissipation_s_rad * rate_rad_s);
        }
        if (under > 0) {
            torque_nm += stop.stiffness_nm_rad * under * std::max(0.0, 1 - stop.dissipation_s_rad * rate_rad_s);
        }
    }
    return torque_nm;
}

}  // namespace

double SpacePlant::rotor_power_w(const std::vector<double>& thrust_n) const {
    double sum = 0;
    for (const double thrust : thrust_n) {
        sum += std::pow(std::max(thrust, 0.0), 1.5);
    }
    return vehicle_.power_coefficient_w_n1p5 * sum;
}

Eigen::VectorXd SpacePlant::accelerations(const BodyMotions& bodies, const std::vector<double>& thrust_n,
                                          const Eigen::VectorXd& joints_nm, const Vector3d& wind_m_s,
                                          double* contact_n) const {
    std::vector<BodyLoad> loads(bodies.size());
    const BodyMotion& body = bodies.front();
    std::vector<double> acting_n;
    std::vector<Vector3d> hubs_m, axes;
    Vector3d center = Vector3d::Zero();  // between the rotors
    Vector3d mean_axis = Vector3d::Zero();
    Vector3d spin = Vector3d::Zero();
    for (std::size_t i = 0; i < vehicle_.rotors.size(); ++i) {
        const FlyingRotor& rotor = vehicle_.rotors[i];
        const Vector3d lever = body.attitude * rotor.hub_m;
        acting_n.push_back(rotor.thrust_of * thrust_n[i]);
        hubs_m.push_back(body.position_m + lever);
        axes.push_back(body.attitude * rotor.axis);
        center += lever / static_cast<double>(vehicle_.rotors.size());
        mean_axis += axes.back();
        loads.front().torque_nm += rotor.reaction_m * thrust_n[i] * axes.back();
        spin += rotor.spin * vehicle_.spin_kg_m2_s_n0p5 * std::sqrt(std::max(thrust_n[i], 0.0)) * axes.back();
    }
    const std::vector<double> ratios = surroundings_.thrust_ratios(hubs_m, axes);
    for (std::size_t i = 0; i < ratios.size(); ++i) {
        loads.front().push(hubs_m[i] - body.position_m, ratios[i] * acting_n[i] * axes[i]);
    }
    const double free_air_n = std::accumulate(acting_n.begin(), acting_n.end(), 0.0);
    mean_axis.normalize();
    loads.front().push(center, surroundings_.fountain(hubs_m, mean_axis) * free_air_n * mean_axis);
    const auto wall = surroundings_.walls(body.position_m + center, free_air_n);
    loads.front().force_n += wall.force_n;
    loads.front().torque_nm += wall.torque_nm;
    loads.front().torque_nm -= body.rate_rad_s.cross(spin);
    add_drag(vehicle_, bodies, wind_m_s, loads);
    add_wash(vehicle_, bodies, acting_n, wind_m_s, loads);
    // Only stops need angles: those within half a turn of the middle between them.
    Eigen::VectorXd middle_rad = Eigen::VectorXd::Zero(joints_nm.size());
    bool has_stops = false;
    for (std::size_t i = 0; i < vehicle_.joints.size(); ++i) {
        if (const auto& stop = vehicle_.joints[i].stop) {
            has_stops = true;
            middle_rad[static_cast<Eigen::Index>(i)] = 0.5 * (stop->lower_rad + stop->upper_rad);
        }
    }
    const SpaceCoordinates at = has_stops ? coordinates_of(vehicle_, bodies, middle_rad) : SpaceCoordinates{};
    for (std::size_t i = 0; i < vehicle_.joints.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        const Vector3d axis = bodies[i].attitude * vehicle_.joints[i].axis;
        const double rate = axis.dot(bodies[i + 1].rate_rad_s - bodies[i].rate_rad_s);
        const double torque_nm =
            joints_nm[k] + passive_torque_nm(vehicle_.joints[i], has_stops ? at.joints_rad[k] : 0, rate);
        loads[i + 1].torque_nm += torque_nm * axis;
        loads[i].torque_nm -= torque_nm * axis;
    }
    const double pushed_n = surface_ != nullptr ? surface_->push(vehicle_, bodies, loads) : 0;
    if (contact_n != nullptr) {
        *contact_n = pushed_n;
    }
    return linkage_.accelerations(bodies, loads);
}

SpacePlantState SpacePlant::after(const SpacePlantState& state, const SpaceCommands& commands, const Vector3d& wind_m_s,
                                  double duration_s) const {
    namespace odeint = boost::numeric::odeint;
    const bool has_lag = vehicle_.rotor_time_constant_s > 0;
    const std::size_t count = state.bodies.size();
    const std::size_t energy_at = per_body * count;
    const auto rate = [&](const Numbers& y, Numbers& dy, double) {
        const BodyMotions bodies = bodies_of(y, count);
        std::vector<double> thrust_n = commands.thrust_n;
        for (std::size_t i = 0; i < thrust_n.size(); ++i) {
            double& change = dy[energy_at + 1 + i];
            change = 0;
            if (has_lag) {
                thrust_n[i] = y[energy_at + 1 + i];
                change = (commands.thrust_n[i] - thrust_n[i]) / vehicle_.rotor_time_constant_s;
            }
        }
        double contact_n = 0;
        const Eigen::VectorXd a = accelerations(bodies, thrust_n, commands.joints_nm, wind_m_s, &contact_n);
        if (surface_ != nullptr) {
            dy.back() = contact_n;
        }
        double power_w = rotor_power_w(thrust_n);
        for (std::size_t i = 0; i < count; ++i) {
            const BodyMotion& b = bodies[i];
            double* out = dy.data() + per_body * i;
            const double* own = y.data() + per_body * i;
            // dq/dt = (0, w) q / 2 with the rate in world axes, for a quaternion of any length.
            const Eigen::Quaterniond turning =
                Eigen::Quaterniond(0, b.rate_rad_s.x(), b.rate_rad_s.y(), b.rate_rad_s.z()) *
                Eigen::Quaterniond(own[3], own[4], own[5], own[6]);
            const double quaternion[] = {turning.w(), turning.x(), turning.y(), turning.z()};
            for (Eigen::Index k = 0; k < 3; ++k) {
                out[k] = b.velocity_m_s[k];
                out[7 + k] = a[static_cast<Eigen::Index>(6 * i) + k];
                out[10 + k] = a[static_cast<Eigen::Index>(6 * i) + 3 + k];
            }
            for (std::size_t k = 0; k < 4; ++k) {
                out[3 + k] = 0.5 * quaternion[k];
            }
            if (i > 0) {
                const Vector3d axis = bodies[i - 1].attitude * vehicle_.joints[i - 1].axis;
                power_w += std::abs(commands.joints_nm[static_cast<Eigen::Index>(i) - 1] *
                                    axis.dot(b.rate_rad_s - bodies[i - 1].rate_rad_s));
            }
        }
        dy[energy_at] = power_w;
    };
    Numbers y = numbers_of(state);
    if (surface_ != nullptr) {
        y.push_back(0);
    }
    const auto stepper = odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_dopri5<Numbers>());
    odeint::integrate_adaptive(stepper, rate, y, 0.0, duration_s, duration_s);
    SpacePlantState next;
    next.bodies = bodies_of(y, count);
    linkage_.project(next.bodies);
    next.energy_j = y[energy_at];
    next.thrust_n = commands.thrust_n;
    if (has_lag) {
        std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(energy_at) + 1, next.thrust_n.size(),
                    next.thrust_n.begin());
    }
    next.contact_n = surface_ != nullptr && duration_s > 0 ? y.back() / duration_s : 0;
    return next;
}

}  // namespace downwash::judge

#include "downwash/judge/plant.hpp"

#include <algorithm>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation/generation_controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation/generation_runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/stepper/generation/make_controlled.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <cstddef>

#include "downwash/judge/slipstream.hpp"

namespace downwash::judge {
namespace {

constexpr double tolerance = 1e-8;
constexpr std::size_t first_thrust = 10;

/// x, z, pitch, arm; their rates; energy; normal impulse of a surface; thrusts.
using Numbers = std::array<double, first_thrust + max_rotors>;

Motion motion_of(const Numbers& y) {
    return {{y[0], y[1]}, {y[4], y[5]}, y[2], y[6], y[3], y[7]};
}

Numbers numbers_of(const PlantState& state) {
    const Motion& m = state.motion;
    Numbers y{m.position_m.x,   m.position_m.z,     m.pitch_rad,      m.arm_rad,      m.velocity_m_s.x,
              m.velocity_m_s.z, m.pitch_rate_rad_s, m.arm_rate_rad_s, state.energy_j, 0};
    std::copy(state.thrust_n.begin(), state.thrust_n.end(), y.begin() + first_thrust);
    return y;
}

}  // namespace

double rotor_power_w(const Vehicle& vehicle, const std::array<double, max_rotors>& thrust_n) {
    double sum = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(vehicle.rotor_count); ++i) {
        const double thrust = std::max(thrust_n[i], 0.0);
        sum += thrust * std::sqrt(thrust);
    }
    return vehicle.power_coefficient_w_n1p5 * sum;
}

Acceleration Plant::acceleration(const Motion& motion, const std::array<double, max_rotors>& thrust_n,
                                 double joint_torque_nm, Planar wind_m_s, double* contact_n,
                                 const Surroundings::Tangents& near) const {
    const Planar up = from_body({0, 1}, motion.pitch_rad);  // b3
    Loads loads;
    loads.joint_torque_nm = joint_torque_nm;
    double free_air_n = 0;
    std::array<double, max_rotors> acting_n{};
    const auto push = [&](Planar lever, double force_n) {
        loads.body_force_n = loads.body_force_n + force_n * up;
        loads.body_moment_nm += moment_of(lever, force_n * up);
    };
    for (int i = 0; i < vehicle_.rotor_count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Planar lever = from_body(vehicle_.hub_m[k], motion.pitch_rad);
        const double thrust = vehicle_.thrust_of[k] * thrust_n[k];
        free_air_n += thrust;
        acting_n[k] = thrust;
        push(lever, surroundings_.thrust_ratio(i, motion.position_m + lever, motion.pitch_rad, near) * thrust);
    }
    const Planar center = from_body(vehicle_.hub_center_m, motion.pitch_rad);
    push(center, surroundings_.fountain(motion.position_m + center, motion.pitch_rad) * free_air_n);
    const auto wall = surroundings_.walls(motion.position_m + center, free_air_n);
    loads.body_force_n = loads.body_force_n + Planar{wall.force_x_n, 0};
    loads.body_moment_nm += wall.moment_nm;
    add_drag(vehicle_, motion, wind_m_s, loads);
    add_wash(vehicle_, motion, acting_n, wind_m_s, loads);
    const double normal_n = touched_ != nullptr ? touched_->push(vehicle_, motion, loads) : 0;
    if (contact_n != nullptr) {
        *contact_n = normal_n;
    }
    return acceleration_of(vehicle_, motion, loads);
}

PlantState Plant::after(const PlantState& state, const Command& command, Planar wind_m_s, double duration_s) const {
    namespace odeint = boost::numeric::odeint;
    const bool has_lag = vehicle_.rotor_time_constant_s > 0;
    const auto near = surroundings_.tangents(vehicle_, state.motion.position_m, state.motion.pitch_rad);
    const auto rate = [&](const Numbers& y, Numbers& dy, double) {
        const Motion motion = motion_of(y);
        std::array<double, max_rotors> thrust_n = command.thrust_n;
        std::fill(dy.begin() + first_thrust, dy.end(), 0.0);
        if (has_lag) {
            std::copy(y.begin() + first_thrust, y.end(), thrust_n.begin());
            for (std::size_t i = 0; i < static_cast<std::size_t>(vehicle_.rotor_count); ++i) {
                dy[first_thrust + i] = (command.thrust_n[i] - thrust_n[i]) / vehicle_.rotor_time_constant_s;
            }
        }
        const Acceleration a = acceleration(motion, thrust_n, command.joint_torque_nm, wind_m_s, &dy[9], near);
        std::copy_n(y.begin() + 4, 4, dy.begin());
        dy[4] = a.position_m_s2.x;
        dy[5] = a.position_m_s2.z;
        dy[6] = a.pitch_rad_s2;
        dy[7] = a.arm_rad_s2;
        dy[8] = rotor_power_w(vehicle_, thrust_n) + std::abs(command.joint_torque_nm * motion.arm_rate_rad_s);
    };
    Numbers y = numbers_of(state);
    const auto stepper = odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_dopri5<Numbers>());
    odeint::integrate_adaptive(stepper, rate, y, 0.0, duration_s, duration_s);
    PlantState next;
    next.motion = motion_of(y);
    next.energy_j = y[8];
    next.contact_n = y[9] / duration_s;
    if (has_lag) {
        std::copy(y.begin() + first_thrust, y.end(), next.thrust_n.begin());
    } else {
        next.thrust_n = command.thrust_n;
    }
    return next;
}

}  // namespace downwash::judge

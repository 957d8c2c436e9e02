#include "closed_loop_ode.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace downwash::bench {
namespace {

struct Bodies {
    Eigen::Matrix4d mass;
    Eigen::Vector4d bias;
};

/// Mass matrix and bias of the two bodies (docs/model.md 2).
Bodies bodies(const PlantNumbers<double>& p, const double q[4], const double u[4]) {
    const Eigen::Vector2d r(std::cos(q[2]) * p.joint_x_m + std::sin(q[2]) * p.joint_z_m,
                            -std::sin(q[2]) * p.joint_x_m + std::cos(q[2]) * p.joint_z_m);
    const double a = q[2] + q[3];
    const Eigen::Vector2d e(std::cos(a), -std::sin(a));
    const Eigen::Vector2d by_arm = p.arm_center_of_mass_m * Eigen::Vector2d(-std::sin(a), -std::cos(a));
    const Eigen::Vector2d by_pitch = Eigen::Vector2d(r.y(), -r.x()) + by_arm;

    Bodies b;
    b.mass.setZero();
    b.mass(0, 0) = b.mass(1, 1) = p.total_mass_kg;
    b.mass.block<2, 1>(0, 2) = p.arm_mass_kg * by_pitch;
    b.mass.block<2, 1>(0, 3) = p.arm_mass_kg * by_arm;
    b.mass(2, 2) = p.pitch_inertia_kg_m2 + p.arm_inertia_kg_m2 + p.arm_mass_kg * by_pitch.squaredNorm();
    b.mass(2, 3) = p.arm_inertia_kg_m2 + p.arm_mass_kg * by_arm.dot(by_pitch);
    b.mass(3, 3) = p.arm_inertia_kg_m2 + p.arm_mass_kg * by_arm.squaredNorm();
    b.mass.triangularView<Eigen::StrictlyLower>() = b.mass.transpose();

    const double turn = u[2] + u[3];
    const Eigen::Vector2d acceleration = -r * u[2] * u[2] - p.arm_center_of_mass_m * e * turn * turn;
    const Eigen::Vector2d k = p.arm_mass_kg * (acceleration + Eigen::Vector2d(0, standard_gravity_m_s2));
    b.bias << p.arm_mass_kg * acceleration.x(),
        p.arm_mass_kg * acceleration.y() + p.total_mass_kg * standard_gravity_m_s2, by_pitch.dot(k), by_arm.dot(k);
    return b;
}

double limited(double value, double limit) {
    return std::clamp(value, -limit, limit);
}

}  // namespace

void ClosedLoopOde::operator()(const double* s, const double velocity[3], double* rates) const {
    const PlantModel& p = model_.tick().plant;
    const auto& g = std::get<ModelInversion>(model_.tick().law);
    const double* q = &s[x];
    const double* u = &s[vx];
    const Bodies b = bodies(p, q, u);
    const PlantNumbers<double>& real = world_ != nullptr ? world_->numbers.plant : p;

    // Position and arm (docs/model.md 5.1, 5.2): the accelerations to impose.
    const double error[3] = {s[reference_x] - q[0], s[reference_z] - q[1], s[reference_arm] - q[3]};
    Eigen::Vector4d wanted = Eigen::Vector4d::Zero();
    for (int i = 0; i < 2; ++i) {
        const ModelInversion::AxisGains gains = g.axis_gains(i);
        wanted[i] = gains.kd * (velocity[i] - u[i]) + gains.kp * error[i] +
                    limited(gains.ki * s[integral_x + static_cast<std::size_t>(i)], g.position_integral_limit_m_s2);
    }
    wanted[3] = g.arm_kd * (velocity[2] - u[3]) + g.arm_kp * error[2] +
                limited(g.arm_ki * s[integral_arm], g.arm_integral_limit_rad_s2);

    // Their force, its direction as pitch reference, the rate to get there.
    const Eigen::Vector2d force = (b.mass * wanted + b.bias).head<2>();
    const double least_z = g.min_vertical_force_ratio * p.total_mass_kg * standard_gravity_m_s2;
    const double pitch_reference = limited(std::atan2(force.x(), std::max(force.y(), least_z)), g.max_tilt_rad);
    const double reference_rate = (pitch_reference - s[filtered_pitch_reference]) / g.pitch_rate_filter_s;
    const double rate_error = reference_rate + g.attitude_kp * (pitch_reference - q[2]) - u[2];
    const double thrust = force.dot(Eigen::Vector2d(std::sin(q[2]), std::cos(q[2])));
    wanted[2] = g.attitude_rate_kp * rate_error +
                limited(g.attitude_rate_ki * s[integral_pitch_rate], g.attitude_integral_limit_rad_s2);

    // The torques for it, with the accelerations that this thrust will really give.
    const Eigen::Vector2d given = thrust * Eigen::Vector2d(std::sin(q[2]), std::cos(q[2])) - b.bias.head<2>() -
                                  b.mass.block<2, 2>(0, 2) * wanted.tail<2>();
    wanted.head<2>() = given / p.total_mass_kg;
    const Eigen::Vector4d demand = b.mass * wanted + b.bias;

    // Rotors, their limits, and surfaces near them (docs/model.md 3).
    double acting_thrust = 0;
    double acting_torque = 0;
    double power = 0;
    for (int i = 0; i < p.rotor_count; ++i) {
        const double command =
            std::clamp(p.force_share[i] * thrust + p.torque_share_1_m[i] * demand[2], p.min_thrust_n, p.max_thrust_n);
        const double given_n = command * (world_ != nullptr ? world_->numbers.rotor_thrust_scale[i] : 1);
        const double hub_x = q[0] + std::cos(q[2]) * real.rotor_x_m[i] + std::sin(q[2]) * real.rotor_z_m[i];
        const double hub_z = q[1] - std::sin(q[2]) * real.rotor_x_m[i] + std::cos(q[2]) * real.rotor_z_m[i];
        const double factor = factor_at(i, hub_x, hub_z, q[2]);
        acting_thrust += factor * given_n;
        acting_torque -= real.rotor_x_m[i] * factor * given_n;
        power += p.power_coefficient_w_n1p5 * std::pow(command, 1.5);
    }
    const double joint_torque = limited(demand[3], p.max_joint_torque_nm);
    const Eigen::Vector4d acting(acting_thrust * std::sin(q[2]), acting_thrust * std::cos(q[2]), acting_torque,
                                 joint_torque);
    const Bodies flying = world_ != nullptr ? bodies(real, q, u) : b;
    const Eigen::Vector4d acceleration = flying.mass.ldlt().solve(acting - flying.bias);

    for (std::size_t i = 0; i < 4; ++i) {
        rates[x + i] = u[i];
        rates[vx + i] = acceleration[static_cast<Eigen::Index>(i)];
    }
    rates[integral_x] = error[0];
    rates[integral_z] = error[1];
    rates[integral_pitch_rate] = rate_error;
    rates[integral_arm] = error[2];
    rates[filtered_pitch_reference] = reference_rate;
    for (std::size_t i = 0; i < 3; ++i) {
        rates[reference_x + i] = velocity[i];
    }
    rates[energy] = power + std::abs(joint_torque * u[3]);
}

double ClosedLoopOde::factor_at(int rotor, double x_m, double z_m, double pitch_rad) const {
    if (map_ == nullptr) {
        return 1;
    }
    const World as_believed;
    const World& world = world_ != nullptr ? world_->world : as_believed;
    const auto level = map_->sided_factor(model_.rotor_layer(rotor), x_m - world.scene_x_m, z_m - world.scene_z_m);
    const auto fading = [&](double change, double loss) {
        const double half = loss * std::sin(pitch_rad) * std::sin(pitch_rad);
        return half > 0 ? change * std::abs(change) / (std::abs(change) + half) : change;
    };
    const TiltLoss& loss = model_.tick().tilt_loss;
    return 1 + (1 + world.ground_scale) * fading(level.all - level.above, loss.ground) +
           (1 + world.ceiling_scale) * fading(level.above - 1, loss.ceiling);
}

std::vector<double> ClosedLoopOde::hovered(std::vector<double> state, double seconds) const {
    constexpr double step_s = 0.01;
    const double still[3] = {};
    std::vector<double> k[4];
    std::vector<double> at;
    for (double time_s = 0; time_s < seconds; time_s += step_s) {
        at = state;
        for (int stage = 0; stage < 4; ++stage) {
            (*this)(at, still, k[stage]);
            const double way_s = stage < 2 ? 0.5 * step_s : step_s;
            for (std::size_t i = 0; i < size; ++i) {
                at[i] = state[i] + way_s * k[stage][i];
            }
        }
        for (std::size_t i = 0; i < size; ++i) {
            state[i] += step_s / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
        }
    }
    state[energy] = 0;
    return state;
}

std::vector<double> ClosedLoopOde::resting_at(double x_m, double z_m, double arm_rad) {
    std::vector<double> state(size, 0.0);
    state[x] = state[reference_x] = x_m;
    state[z] = state[reference_z] = z_m;
    state[arm] = state[reference_arm] = arm_rad;
    return state;
}

}  // namespace downwash::bench

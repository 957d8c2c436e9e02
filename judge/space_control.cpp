#include "downwash/judge/space_control.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <variant>

#include "downwash/dynamics/plant_model.hpp"
#include "downwash/judge/placement.hpp"
#include "downwash/judge/space_attitude.hpp"

namespace downwash::judge {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double g = standard_gravity_m_s2;

double rotor_lead_of(const SpaceLaw& law) {
    return std::visit([](const auto& each) { return each.rotor_lead; }, law);
}

std::optional<SpaceObserver> observer_of(const SpaceLaw& law, const SpaceVehicle& nominal, double tick_s) {
    const auto* inversion = std::get_if<SpaceInversion>(&law);
    return inversion != nullptr && inversion->observer_gain_1_s > 0
               ? std::optional<SpaceObserver>(std::in_place, nominal, inversion->observer_gain_1_s, tick_s)
               : std::nullopt;
}

double action_of(double ki, double limit, double integral) {
    return std::clamp(ki * integral, -limit, limit);
}

/// An integral a tick later. No integral grows beyond what its limit can use.
double grown(double ki, double limit, double integral, double error, double tick_s) {
    return ki > 0 ? std::clamp(integral + error * tick_s, -limit / ki, limit / ki) : integral;
}

Vector3d limited(const Vector3d& v, double most) {
    return v.norm() > most ? Vector3d(most / v.norm() * v) : v;
}

/// Accelerations that the loops of the joints ask for, and their errors.
struct JointLoops {
    VectorXd wanted, error;

    JointLoops(const SpaceLoopGains& gains, const SpaceCoordinates& seen, const SpacePoint& reference,
               const VectorXd& integral)
        : wanted(seen.joints_rad.size()), error(seen.joints_rad.size()) {
        for (Eigen::Index i = 0; i < wanted.size(); ++i) {
            const Eigen::Index at = space::first_joint + i;
            error[i] = reference.position[at] - seen.joints_rad[i];
            wanted[i] = reference.acceleration[at] +
                        gains.kd_1_s * (reference.velocity[at] - seen.joint_rates_rad_s[i]) + gains.kp_1_s2 * error[i] +
                        action_of(gains.ki_1_s3, gains.integral_limit, integral[i]);
        }
    }
    void grow(const SpaceLoopGains& gains, double tick_s, VectorXd& integral) const {
        for (Eigen::Index i = 0; i < error.size(); ++i) {
            integral[i] = grown(gains.ki_1_s3, gains.integral_limit, integral[i], error[i], tick_s);
        }
    }
};

}  // namespace

/// What a law is given in a tick.
struct SpaceControl::Tick {
    SpaceCoordinates seen;  ///< its quaternion of length 1
    BodyMotions bodies;
    Matrix3d attitude;
    const std::vector<double>& thrust_n;
    const SpacePoint& reference;
    const SpaceSurroundings& surfaces;
    const std::optional<BodyPush>& push;
};

SpaceControl::SpaceControl(const SpaceRobot& robot)
    : nominal_(vehicle_in(SpaceWorld{}, robot)),
      law_(robot.controller.law),
      tick_s_(1 / robot.controller.rate_hz),
      shares_(nominal_, tick_s_, rotor_lead_of(law_)),
      observer_(observer_of(law_, nominal_, tick_s_)) {}

std::vector<double> SpaceControl::resting_thrust_n() const {
    return shares_.thrusts_of(nominal_.mass_kg() * g);
}

SpaceControlMemory SpaceControl::at_start(const SpaceCoordinates& seen) const {
    const int n = nominal_.joint_count();
    SpaceControlMemory memory;
    memory.position_integral = memory.velocity_integral = memory.rate_integral = Vector3d::Zero();
    memory.joint_integral = VectorXd::Zero(n);
    memory.direction_rate = memory.rate_reference = Vector3d::Zero();
    memory.velocity_before = seen.velocity_m_s;
    memory.rate_before = seen.body_rate_rad_s;
    const Vector3d at = seen.attitude.normalized() * shares_.lift_axis();
    memory.direction = at;
    if (const auto* law = std::get_if<SpaceInversion>(&law_)) {
        memory.direction = direction_of(at, law->max_tilt_rad, std::cos(law->max_tilt_rad)).direction;
        if (observer_) {
            memory.observer = observer_->at_start(seen);
        }
    } else {
        // The integrals carry what the arm weighs, as after a long hover.
        const auto& cascade = std::get<Px4Cascade>(law_);
        SpaceCoordinates still = seen;
        still.velocity_m_s = still.body_rate_rad_s = Vector3d::Zero();
        still.joint_rates_rad_s.setZero();
        const BodyMotions bodies = bodies_at(nominal_, still);
        const Needed weight = needed_for(nominal_, bodies, Vector3d::Zero(), Vector3d::Zero(), VectorXd::Zero(n), g);
        const auto carried = [](double ki, double limit, double action) {
            return ki > 0 ? std::clamp(action, -limit, limit) / ki : 0;
        };
        const Vector3d turn = nominal_.bodies.front().inertia_kg_m2.inverse() *
                              (seen.attitude.normalized().conjugate() * weight.torque_nm);
        for (int i = 0; i < 3; ++i) {
            const SpaceRateGains& gains = i < 2 ? cascade.rate : cascade.yaw_rate;
            memory.rate_integral[i] = carried(gains.ki_1_s2, gains.integral_limit, turn[i]);
        }
        if (n > 0) {
            Eigen::MatrixXd inertia(n, n);
            for (int i = 0; i < n; ++i) {
                inertia.col(i) =
                    needed_for(nominal_, bodies, Vector3d::Zero(), Vector3d::Zero(), VectorXd::Unit(n, i), 0).joints_nm;
            }
            const VectorXd needed = inertia.ldlt().solve(weight.joints_nm);
            for (int i = 0; i < n; ++i) {
                memory.joint_integral[i] = carried(cascade.joint.ki_1_s3, cascade.joint.integral_limit, needed[i]);
            }
        }
    }
    return memory;
}

SpaceControlMemory SpaceControl::memory_of(const std::vector<double>& numbers) const {
    const int n = nominal_.joint_count();
    SpaceControlMemory memory;
    auto next = numbers.begin();
    const auto take = [&next](auto& into) {
        std::copy_n(next, into.size(), into.data());
        next += into.size();
    };
    const bool is_inversion = std::holds_alternative<SpaceInversion>(law_);
    take(is_inversion ? memory.position_integral : memory.velocity_integral);
    take(memory.rate_integral);
    memory.joint_integral.resize(n);
    take(memory.joint_integral);
    next += n == 0 ? 1 : 0;  // without joints there is one number that means nothing
    if (!is_inversion) {
        take(memory.velocity_before);
        take(memory.rate_before);
        return memory;
    }
    take(memory.direction);
    take(memory.direction_rate);
    take(memory.rate_reference);
    if (observer_) {  // the numbers are the estimate less what a momentum of zero would add to it
        memory.observer = {VectorXd(6 + n), VectorXd::Zero(6 + n)};
        take(memory.observer.estimate);
    }
    return memory;
}

SpaceCommands SpaceControl::command(const SpaceCoordinates& seen, const std::vector<double>& thrust_n,
                                    const SpacePoint& reference, const SpaceSurroundings& surfaces,
                                    SpaceControlMemory& memory, const std::optional<BodyPush>& push) const {
    SpaceCoordinates usable = seen;
    usable.attitude.normalize();
    const Tick tick{
        usable, bodies_at(nominal_, usable), usable.attitude.toRotationMatrix(), thrust_n, reference, surfaces, push};
    return std::visit([&](const auto& law) { return command_by(law, tick, memory); }, law_);
}

std::vector<double> SpaceControl::ratios(const SpaceInversion& law, const Tick& tick) const {
    if (!law.feed_forward) {
        return std::vector<double>(nominal_.rotors.size(), 1);
    }
    std::vector<Vector3d> hubs_m, axes;
    for (const FlyingRotor& rotor : nominal_.rotors) {
        hubs_m.push_back(tick.seen.position_m - vector_of(law.feed_forward_offset_m) + tick.attitude * rotor.hub_m);
        axes.push_back(tick.attitude * rotor.axis);
    }
    constexpr double least_ratio = 0.1;
    std::vector<double> ratios = tick.surfaces.thrust_ratios(hubs_m, axes);
    for (double& ratio : ratios) {
        ratio = std::max(ratio, least_ratio);
    }
    return ratios;
}

VectorXd SpaceControl::within_limits(const VectorXd& joints_nm, double& saturation) const {
    VectorXd clipped = joints_nm;
    for (std::size_t i = 0; i < nominal_.joints.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        const double most = nominal_.joints[i].max_torque_nm;
        saturation = std::max(saturation, std::abs(joints_nm[k]) / most);
        clipped[k] = std::clamp(joints_nm[k], -most, most);
    }
    return clipped;
}

SpaceCommands SpaceControl::command_by(const SpaceInversion& law, const Tick& tick, SpaceControlMemory& memory) const {
    const SpaceCoordinates& seen = tick.seen;
    const SpacePoint& reference = tick.reference;
    const Matrix3d& r = tick.attitude;
    const double mass_kg = nominal_.mass_kg();
    const int n = nominal_.joint_count();
    Vector3d unknown_n = Vector3d::Zero();  // what the observer sees and a surface does, world axes
    Vector3d unknown_nm = Vector3d::Zero();
    VectorXd unknown_joints_nm = VectorXd::Zero(n);
    if (observer_) {
        observer_->look(seen, memory.observer);
        unknown_n = memory.observer.estimate.segment<3>(0);
        unknown_nm = r * memory.observer.estimate.segment<3>(3);
        unknown_joints_nm = memory.observer.estimate.tail(n);
    }
    if (tick.push) {
        const Needed push = push_on(nominal_, tick.bodies, *tick.push);
        unknown_n += push.force_n;
        unknown_nm += push.torque_nm;
        unknown_joints_nm += push.joints_nm;
    }
    Vector3d spin = Vector3d::Zero();
    for (std::size_t i = 0; i < nominal_.rotors.size(); ++i) {
        const FlyingRotor& rotor = nominal_.rotors[i];
        spin += rotor.spin * nominal_.spin_kg_m2_s_n0p5 * std::sqrt(std::max(tick.thrust_n[i], 0.0)) * rotor.axis;
    }
    const Vector3d gyroscopic = spin.cross(seen.body_rate_rad_s);

    // The accelerations to impose.
    Vector3d error, wanted;
    for (int i = 0; i < 3; ++i) {
        const SpaceLoopGains& gains = i == space::z ? law.height : law.horizontal;
        error[i] = reference.position[i] - seen.position_m[i];
        wanted[i] = reference.acceleration[i] + gains.kd_1_s * (reference.velocity[i] - seen.velocity_m_s[i]) +
                    gains.kp_1_s2 * error[i] +
                    action_of(gains.ki_1_s3, gains.integral_limit, memory.position_integral[i]);
    }
    const JointLoops joints(law.joint, seen, reference, memory.joint_integral);

    // The force for them, and what of it acts along the thrust axis.
    const Vector3d force_n =
        needed_for(nominal_, tick.bodies, wanted, Vector3d::Zero(), joints.wanted, g).force_n - unknown_n;
    const WantedDirection to = direction_of(force_n, law.max_tilt_rad, law.min_vertical_force_ratio * g * mass_kg);
    const Vector3d& axis = shares_.lift_axis();
    const double asked_n = force_n.dot(r * axis);
    const double thrust_n = std::max(asked_n, shares_.min_lift_n());

    // Tilt first, then yaw.
    const Vector3d turned = shortest_turn(memory.direction, to.direction, Vector3d::UnitY());
    const Vector3d direction_rate =
        (law.direction_rate_filter_s * memory.direction_rate + turned) / (law.direction_rate_filter_s + tick_s_);
    Vector3d along = r.transpose() * direction_rate;
    along -= along.dot(axis) * axis;
    const Vector3d tilt_error = shortest_turn(axis, r.transpose() * to.direction, Vector3d::UnitY());
    const Vector3d tilt_rate = limited(along + law.attitude_kp_1_s * tilt_error, law.max_rate_rad_s);
    const double yaw_rad = reference.position[space::yaw];
    const YawLeft yaw = yaw_left(r, axis, to.direction, yaw_rad);
    const double yaw_rate =
        std::clamp(law.yaw_kp_1_s * yaw.weight * yaw.angle_rad +
                       wanted_yaw_rate(to.direction, direction_rate, yaw_rad, reference.velocity[space::yaw]),
                   -law.max_yaw_rate_rad_s, law.max_yaw_rate_rad_s);
    const Vector3d rate_reference = tilt_rate + yaw_rate * axis;
    const Vector3d rate_error = rate_reference - seen.body_rate_rad_s;
    Vector3d turn;
    for (int i = 0; i < 3; ++i) {
        turn[i] = (i < 2 ? law.rate_kp_1_s : law.yaw_rate_kp_1_s) * rate_error[i] +
                  action_of(i < 2 ? law.rate_ki_1_s2 : law.yaw_rate_ki_1_s2, law.rate_integral_limit_rad_s2,
                            memory.rate_integral[i]);
    }
    if (law.rate_feed_forward) {
        turn += (rate_reference - memory.rate_reference) / tick_s_;
    }

    // The torque, with the acceleration that the thrust will give while the vehicle turns so.
    const auto needed_at = [&](const Vector3d& acceleration, const Vector3d& turning) {
        Needed needed = needed_for(nominal_, tick.bodies, acceleration, turning, joints.wanted, g);
        needed.force_n -= unknown_n;
        needed.torque_nm -= unknown_nm + r * gyroscopic;
        needed.joints_nm -= unknown_joints_nm;
        return needed;
    };
    const double given_n = std::min(thrust_n, shares_.max_lift_n());
    const Vector3d lacking_n = given_n * (r * axis) - needed_at(Vector3d::Zero(), r * turn).force_n;
    const Vector3d torque_nm = needed_at(lacking_n / mass_kg, r * turn).torque_nm;
    const ExpectedRotors rotors =
        shares_.command({thrust_n * axis.z(), r.transpose() * torque_nm}, ratios(law, tick), tick.thrust_n);

    // The joints under what the rotors will give: six accelerations of the multirotor follow from it.
    const Needed still = needed_at(Vector3d::Zero(), Vector3d::Zero());
    Eigen::Matrix<double, 6, 6> columns;
    Eigen::Matrix<double, 6, 1> given;
    given << r * rotors.force_n - still.force_n, r * rotors.torque_nm - still.torque_nm;
    for (int i = 0; i < 6; ++i) {
        const Vector3d unit = Vector3d::Unit(i % 3);
        const Needed more = needed_at(i < 3 ? unit : Vector3d::Zero(), i < 3 ? Vector3d::Zero() : unit);
        columns.col(i) << more.force_n - still.force_n, more.torque_nm - still.torque_nm;
    }
    const Eigen::Matrix<double, 6, 1> moves = columns.fullPivLu().solve(given);
    double saturation = rotors.saturation;
    const VectorXd joints_nm = within_limits(needed_at(moves.head<3>(), moves.tail<3>()).joints_nm, saturation);

    const bool is_clipped = saturation > 1 || thrust_n > asked_n;
    for (int i = 0; i < 3; ++i) {
        const SpaceLoopGains& gains = i == space::z ? law.height : law.horizontal;
        if (!is_clipped && !to.is_limited) {
            memory.position_integral[i] =
                grown(gains.ki_1_s3, gains.integral_limit, memory.position_integral[i], error[i], tick_s_);
        }
        if (!is_clipped) {
            memory.rate_integral[i] =
                grown(i < 2 ? law.rate_ki_1_s2 : law.yaw_rate_ki_1_s2, law.rate_integral_limit_rad_s2,
                      memory.rate_integral[i], rate_error[i], tick_s_);
        }
    }
    if (!is_clipped) {
        joints.grow(law.joint, tick_s_, memory.joint_integral);
    }
    memory.direction = to.direction;
    memory.direction_rate = direction_rate;
    memory.rate_reference = rate_reference;
    if (observer_) {
        observer_->expect(seen, rotors.force_n, rotors.torque_nm + gyroscopic, joints_nm, memory.observer);
    }
    return {rotors.command_n, joints_nm};
}

SpaceCommands SpaceControl::command_by(const Px4Cascade& law, const Tick& tick, SpaceControlMemory& memory) const {
    const SpaceCoordinates& seen = tick.seen;
    const SpacePoint& reference = tick.reference;
    const Matrix3d& r = tick.attitude;
    const double mass_kg = nominal_.mass_kg();
    const int n = nominal_.joint_count();

    // Position to velocity to acceleration.
    Vector3d velocity;
    for (int i = 0; i < 3; ++i) {
        velocity[i] = reference.velocity[i] + (i == space::z ? law.height_p_1_s : law.position_p_1_s) *
                                                  (reference.position[i] - seen.position_m[i]);
    }
    velocity.head<2>() *= std::min(1.0, law.max_speed_m_s / std::max(velocity.head<2>().norm(), 1e-300));
    velocity.z() = std::clamp(velocity.z(), -law.max_descent_m_s, law.max_climb_m_s);
    const Vector3d velocity_error = velocity - seen.velocity_m_s;
    Vector3d wanted;
    for (int i = 0; i < 3; ++i) {
        const SpaceRateGains& gains = i == space::z ? law.vertical_velocity : law.velocity;
        wanted[i] = reference.acceleration[i] + gains.kp_1_s * velocity_error[i] +
                    action_of(gains.ki_1_s2, gains.integral_limit, memory.velocity_integral[i]) -
                    gains.kd * (seen.velocity_m_s[i] - memory.velocity_before[i]) / tick_s_;
    }
    const WantedDirection to = direction_of({wanted.x(), wanted.y(), g}, law.max_tilt_rad, g);
    const double asked_n = mass_kg * (g + wanted.z()) / to.direction.z();
    const double thrust_n = std::max(asked_n, law.min_thrust_ratio * mass_kg * g);

    // Attitude to rate: the turn to the wanted direction, then a share of the yaw that is left.
    const Vector3d& axis = shares_.lift_axis();
    const YawLeft yaw = yaw_left(r, axis, to.direction, reference.position[space::yaw]);
    const Matrix3d tilt = rotation_by(shortest_turn(axis, r.transpose() * to.direction, Vector3d::UnitY()));
    const Matrix3d error_turn = tilt * rotation_by(law.yaw_weight * yaw.angle_rad * axis);
    Eigen::Quaterniond q(error_turn);
    const Vector3d e = (q.w() < 0 ? -2 : 2) * q.vec();
    const Vector3d yaw_rate = reference.velocity[space::yaw] * r.row(2).transpose();
    Vector3d rate;
    for (int i = 0; i < 3; ++i) {
        const double most = i < 2 ? law.max_rate_rad_s : law.max_yaw_rate_rad_s;
        const double gain = i < 2 ? law.attitude_p_1_s : law.yaw_p_1_s / law.yaw_weight;
        rate[i] = std::clamp(gain * e[i] + yaw_rate[i], -most, most);
    }
    const Vector3d rate_error = rate - seen.body_rate_rad_s;
    Vector3d turn;
    for (int i = 0; i < 3; ++i) {
        const SpaceRateGains& gains = i < 2 ? law.rate : law.yaw_rate;
        turn[i] = gains.kp_1_s * rate_error[i] +
                  action_of(gains.ki_1_s2, gains.integral_limit, memory.rate_integral[i]) -
                  gains.kd * (seen.body_rate_rad_s[i] - memory.rate_before[i]) / tick_s_;
    }
    const std::vector<double> ones(nominal_.rotors.size(), 1);
    const ExpectedRotors rotors =
        shares_.command({thrust_n * axis.z(), nominal_.bodies.front().inertia_kg_m2 * turn}, ones, tick.thrust_n);

    // The arm's own inertia: what its joints need where nothing else moves and nothing weighs.
    SpaceCoordinates still = seen;
    still.velocity_m_s = still.body_rate_rad_s = Vector3d::Zero();
    still.joint_rates_rad_s.setZero();
    const JointLoops joints(law.joint, seen, reference, memory.joint_integral);
    double saturation = rotors.saturation;
    const VectorXd joints_nm = within_limits(needed_for(nominal_, bodies_at(nominal_, still), Vector3d::Zero(),
                                                        Vector3d::Zero(), n > 0 ? joints.wanted : VectorXd(0), 0)
                                                 .joints_nm,
                                             saturation);

    const bool is_clipped = saturation > 1;
    for (int i = 0; i < 3; ++i) {
        const SpaceRateGains& gains = i == space::z ? law.vertical_velocity : law.velocity;
        if (!is_clipped && !to.is_limited && !(thrust_n > asked_n)) {
            memory.velocity_integral[i] =
                grown(gains.ki_1_s2, gains.integral_limit, memory.velocity_integral[i], velocity_error[i], tick_s_);
        }
        if (!is_clipped) {
            const SpaceRateGains& turning = i < 2 ? law.rate : law.yaw_rate;
            memory.rate_integral[i] =
                grown(turning.ki_1_s2, turning.integral_limit, memory.rate_integral[i], rate_error[i], tick_s_);
        }
    }
    if (!is_clipped) {
        joints.grow(law.joint, tick_s_, memory.joint_integral);
    }
    memory.velocity_before = seen.velocity_m_s;
    memory.rate_before = seen.body_rate_rad_s;
    return {rotors.command_n, joints_nm};
}

void SpaceControl::stand_still(const SpaceControlMemory& before, const SpaceCoordinates& from,
                               const SpaceCoordinates& to, SpaceControlMemory& memory) const {
    memory.position_integral = before.position_integral;
    memory.velocity_integral = before.velocity_integral;
    memory.rate_integral = before.rate_integral;
    memory.joint_integral = before.joint_integral;
    if (observer_) {
        memory.observer = observer_->held(before.observer, from, to);
    }
}

}  // namespace downwash::judge

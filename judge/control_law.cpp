#include "downwash/judge/control_law.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <variant>

#include "downwash/dynamics/plant_model.hpp"

namespace downwash::judge {
namespace {

using Matrix4 = Eigen::Matrix4d;
using Vector4 = Eigen::Vector4d;

/// ki times an integral, within its limit.
double action(double ki, double limit, double integral) {
    return std::clamp(ki * integral, -limit, limit);
}

/// The integral a tick later; it never grows beyond what its limit can use. Without a gain it stays.
double integrated_by(double ki, double limit, double integral, double error, double tick_s) {
    return ki > 0 ? std::clamp(integral + error * tick_s, -limit / ki, limit / ki) : integral;
}

/// 0 without an observer.
double observer_gain_1_s(const Robot& robot) {
    const auto observer = controllers::aids_of(robot.controller.law).observer;
    return observer ? observer->gain_1_s : 0;
}

/// A law that commands thrusts ahead of the rotors' lag.
template <class Law>
concept LeadsRotors = requires(const Law& law) {
    law.rotor_lead;
};

double rotor_lead_of(const Robot& robot) {
    return std::visit(
        []<class Law>(const Law& law) {
            if constexpr (LeadsRotors<Law>) {
                return law.rotor_lead;
            } else {
                return 0.0;
            }
        },
        robot.controller.law);
}

}  // namespace

/// The equations of motion of docs/model.md 2 at one instant: M du/dt + c = Q.
struct ControlLaw::Inversion {
    Matrix4 mass;
    Vector4 bias;
    double sine, cosine;  ///< Sine and cosine of the pitch.

    Inversion(const Vehicle& v, const Motion& seen) : sine(std::sin(seen.pitch_rad)), cosine(std::cos(seen.pitch_rad)) {
        const Planar r = from_body(v.joint_m, seen.pitch_rad);
        const Planar e = arm_direction(seen.pitch_rad, seen.arm_rad);
        const Planar ea = turned(v.arm_center_of_mass_m, e);
        const Planar both = turned(1, r) + ea;
        const double mb = v.arm_mass_kg;
        const double w = seen.pitch_rate_rad_s + seen.arm_rate_rad_s;
        const auto dot = [](Planar a, Planar b) { return a.x * b.x + a.z * b.z; };
        mass << v.mass_kg(), 0, mb * both.x, mb * ea.x,  //
            0, v.mass_kg(), mb * both.z, mb * ea.z,      //
            mb * both.x, mb * both.z, v.body_inertia_kg_m2 + v.arm_inertia_kg_m2 + mb * dot(both, both),
            v.arm_inertia_kg_m2 + mb * dot(ea, both),  //
            mb * ea.x, mb * ea.z, v.arm_inertia_kg_m2 + mb * dot(ea, both),
            v.arm_inertia_kg_m2 + mb * v.arm_center_of_mass_m * v.arm_center_of_mass_m;
        const Planar ac = -(seen.pitch_rate_rad_s * seen.pitch_rate_rad_s) * r - v.arm_center_of_mass_m * w * w * e;
        const Planar k = mb * (ac + Planar{0, standard_gravity_m_s2});
        bias << mb * ac.x, mb * ac.z + v.mass_kg() * standard_gravity_m_s2, dot(both, k), dot(ea, k);
    }

    /// Row 3, with du1 and du3 from rows 1 and 2 under this thrust.
    [[nodiscard]] double pitch_torque_nm(double thrust_n, double v5, double v7) const {
        const Eigen::Vector2d pull(thrust_n * sine, thrust_n * cosine);
        const Eigen::Vector2d translation = mass.topLeftCorner<2, 2>().diagonal().cwiseInverse().cwiseProduct(
            pull - bias.head<2>() - mass.topRightCorner<2, 2>() * Eigen::Vector2d(v5, v7));
        return mass.row(2) * Vector4(translation(0), translation(1), v5, v7) + bias(2);
    }
};

/// Accelerations of x, z and the arm.
struct ControlLaw::Wanted {
    double v1, v3, v7;
};

/// Where a law wants the thrust to point, and what acts along b3 of it.
struct ControlLaw::Tilt {
    double reference_rad, rate_rad_s, thrust_n;  ///< the rate is filtered
    bool is_clipped;
};

/// What a law demands of the joint: an acceleration, or a torque.
struct ControlLaw::Demand {
    double thrust_n, pitch_torque_nm;
    std::optional<double> arm_acceleration, joint_torque_nm;
};

/// What the controller's map says: K of every rotor, K_body - 1 of the fountain.
struct ControlLaw::Read {
    std::array<double, max_rotors> ratio;
    double fountain = 0;
};

/// What the controller expects of its rotors in mid-tick.
struct ControlLaw::Rotors {
    double thrust_n = 0, pitch_torque_nm = 0;
    bool are_clipped = false;
};

ControlLaw::ControlLaw(const Robot& robot)
    : robot_(robot),
      nominal_vehicle_(vehicle_in({}, robot)),
      tick_s_(1 / robot.controller.rate_hz),
      rotor_lead_(rotor_lead_of(robot)),
      feed_forward_(controllers::aids_of(robot.controller.law).feed_forward),
      has_observer_(observer_gain_1_s(robot) > 0),
      observer_(nominal_vehicle_, observer_gain_1_s(robot), tick_s_) {
    Eigen::MatrixXd rows(2, nominal_vehicle_.rotor_count);
    for (int i = 0; i < nominal_vehicle_.rotor_count; ++i) {
        rows(0, i) = 1;
        rows(1, i) = -nominal_vehicle_.hub_m[static_cast<std::size_t>(i)].x;
    }
    const Eigen::MatrixXd inverse = rows.completeOrthogonalDecomposition().pseudoInverse();
    for (int i = 0; i < nominal_vehicle_.rotor_count; ++i) {
        share_[static_cast<std::size_t>(i)] = {inverse(i, 0), inverse(i, 1)};
    }
}

std::array<double, max_rotors> ControlLaw::resting_thrust_n() const noexcept {
    std::array<double, max_rotors> thrust_n{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(nominal_vehicle_.rotor_count); ++i) {
        thrust_n[i] = share_[i][0] * nominal_vehicle_.mass_kg() * standard_gravity_m_s2;
    }
    return thrust_n;
}

ControlMemory ControlLaw::memory_at_start(const Motion& motion) const {
    ControlMemory memory;
    memory.pitch_reference_rad = motion.pitch_rad;
    memory.observed = observer_.at_start(motion);
    if (const auto* gain = std::get_if<CascadedPid>(&robot_.controller.law)) {
        // As after a long hover with the arm at this angle: both integrals carry its weight.
        Motion still = motion;
        still.velocity_m_s = {};
        still.pitch_rate_rad_s = 0;
        still.arm_rate_rad_s = 0;
        const Four weight = free_momentum_rate(nominal_vehicle_, still);
        const auto carrying = [](double ki, double limit, double torque) {
            return ki > 0 ? std::clamp(torque, -limit, limit) / ki : 0;
        };
        memory.pitch_rate_integral = carrying(gain->pitch_rate_ki, gain->pitch_integral_limit_nm, -weight[2]);
        memory.joint_integral = carrying(gain->joint_ki, gain->joint_integral_limit_nm, -weight[3]);
        memory.velocity_before = motion.velocity_m_s;
        memory.rate_before = motion.pitch_rate_rad_s;
    }
    return memory;
}

/// docs/model.md 5.5.
ControlLaw::Demand ControlLaw::cascaded(const CascadedPid& gain, const Motion& seen, const ReferencePoint& reference,
                                        ControlMemory& kept, ControlMemory& integrated) const {
    const double dt = tick_s_;
    const Four& other = kept.observed.estimate;  // zero without an observer
    const double m = nominal_vehicle_.mass_kg();
    const auto velocity_error = [&](int axis, double kp, double place, double speed) {
        return reference.velocity[axis] + kp * (reference.position[axis] - place) - speed;
    };
    const Planar error{velocity_error(0, gain.horizontal_position_kp, seen.position_m.x, seen.velocity_m_s.x),
                       velocity_error(1, gain.vertical_position_kp, seen.position_m.z, seen.velocity_m_s.z)};
    const Planar change = (1 / dt) * (seen.velocity_m_s - kept.velocity_before);
    const double ax =
        reference.acceleration[0] + gain.horizontal_velocity_kp * error.x +
        action(gain.horizontal_velocity_ki, gain.horizontal_integral_limit_m_s2, kept.velocity_integral.x) -
        gain.horizontal_velocity_kd * change.x;
    const double az = reference.acceleration[1] + gain.vertical_velocity_kp * error.z +
                      action(gain.vertical_velocity_ki, gain.vertical_integral_limit_m_s2, kept.velocity_integral.z) -
                      gain.vertical_velocity_kd * change.z;
    const Planar force{m * ax - other[0], m * (az + standard_gravity_m_s2) - other[1]};
    const double min_force_z = gain.min_vertical_force_ratio * m * standard_gravity_m_s2;
    const double tilt = std::atan2(force.x, std::max(force.z, min_force_z));
    const double pitch_reference = std::clamp(tilt, -gain.max_tilt_rad, gain.max_tilt_rad);
    const bool is_tilt_clipped = std::abs(tilt) > gain.max_tilt_rad || force.z < min_force_z;
    const Planar up = from_body({0, 1}, seen.pitch_rad);

    const double rate_error = gain.pitch_angle_kp * (pitch_reference - seen.pitch_rad) - seen.pitch_rate_rad_s;
    const double torque = gain.pitch_rate_kp * rate_error +
                          action(gain.pitch_rate_ki, gain.pitch_integral_limit_nm, kept.pitch_rate_integral) -
                          gain.pitch_rate_kd * (seen.pitch_rate_rad_s - kept.rate_before) / dt - other[2];
    const double arm_error = reference.position[2] - seen.arm_rad;
    const double joint = gain.joint_kp * arm_error + gain.joint_kd * (reference.velocity[2] - seen.arm_rate_rad_s) +
                         action(gain.joint_ki, gain.joint_integral_limit_nm, kept.joint_integral) - other[3];

    kept.velocity_before = seen.velocity_m_s;
    kept.rate_before = seen.pitch_rate_rad_s;
    integrated = kept;
    if (!is_tilt_clipped) {
        integrated.velocity_integral = {integrated_by(gain.horizontal_velocity_ki, gain.horizontal_integral_limit_m_s2,
                                                      kept.velocity_integral.x, error.x, dt),
                                        integrated_by(gain.vertical_velocity_ki, gain.vertical_integral_limit_m_s2,
                                                      kept.velocity_integral.z, error.z, dt)};
    }
    integrated.pitch_rate_integral =
        integrated_by(gain.pitch_rate_ki, gain.pitch_integral_limit_nm, kept.pitch_rate_integral, rate_error, dt);
    integrated.joint_integral =
        integrated_by(gain.joint_ki, gain.joint_integral_limit_nm, kept.joint_integral, arm_error, dt);
    return {force.x * up.x + force.z * up.z, torque, std::nullopt, joint};
}

template <class Gain>
ControlLaw::Tilt ControlLaw::tilt(const Gain& gain, const Inversion& inversion, const Wanted& wanted,
                                  const ControlMemory& kept) const {
    // Rows 1 and 2 with (v1, v3, 0, v7).
    const Vector4 force = inversion.mass * Vector4(wanted.v1, wanted.v3, 0, wanted.v7) + inversion.bias;
    const double min_force_z = gain.min_vertical_force_ratio * nominal_vehicle_.mass_kg() * standard_gravity_m_s2;
    const double whole = std::atan2(force(0), std::max(force(1), min_force_z));
    const double reference = std::clamp(whole, -gain.max_tilt_rad, gain.max_tilt_rad);
    const double raw_rate = (reference - kept.pitch_reference_rad) / tick_s_;
    const double share = tick_s_ / (gain.pitch_rate_filter_s + tick_s_);
    return {reference, kept.pitch_reference_rate + share * (raw_rate - kept.pitch_reference_rate),
            force(0) * inversion.sine + force(1) * inversion.cosine,
            std::abs(whole) > gain.max_tilt_rad || force(1) < min_force_z};
}

/// docs/model.md 5.8: nothing is integrated.
ControlLaw::Demand ControlLaw::falling(const PlanarLyapunov& gain, const Inversion& inversion, const Motion& seen,
                                       const ReferencePoint& reference, ControlMemory& kept,
                                       ControlMemory& integrated) const {
    const auto fall = [](double k, double k_rate, double e, double de, double acceleration) {
        const double e_rate = de + k * e;
        return acceleration + (k * k - 1) * e - (k + k_rate) * e_rate;
    };
    const auto& r = reference;
    const double v1 = fall(gain.horizontal_k, gain.horizontal_k_rate, seen.position_m.x - r.position[0],
                           seen.velocity_m_s.x - r.velocity[0], r.acceleration[0]);
    const double v3 = fall(gain.vertical_k, gain.vertical_k_rate, seen.position_m.z - r.position[1],
                           seen.velocity_m_s.z - r.velocity[1], r.acceleration[1]);
    const double v7 = fall(gain.joint_k, gain.joint_k_rate, seen.arm_rad - r.position[2],
                           seen.arm_rate_rad_s - r.velocity[2], r.acceleration[2]);
    const Tilt tilted = tilt(gain, inversion, {v1, v3, v7}, kept);
    const double v5 = fall(gain.pitch_k, gain.pitch_k_rate, seen.pitch_rad - tilted.reference_rad,
                           seen.pitch_rate_rad_s - tilted.rate_rad_s, 0);
    kept.pitch_reference_rad = tilted.reference_rad;
    kept.pitch_reference_rate = tilted.rate_rad_s;
    integrated = kept;
    return {tilted.thrust_n, inversion.pitch_torque_nm(tilted.thrust_n, v5, v7), v7, std::nullopt};
}

ControlLaw::Demand ControlLaw::inverted(const ModelInversion& gain, const Inversion& inversion, const Motion& seen,
                                        const ReferencePoint& reference, ControlMemory& kept,
                                        ControlMemory& integrated) const {
    const double dt = tick_s_;
    // 5.1: acceleration of x and z, and 5.2: of the arm.
    const Planar error{reference.position[0] - seen.position_m.x, reference.position[1] - seen.position_m.z};
    const double kp[] = {gain.position_kp, gain.height_kp.value_or(gain.position_kp)};
    const double kd[] = {gain.position_kd, gain.height_kd.value_or(gain.position_kd)};
    const double ki[] = {gain.position_ki, gain.height_ki.value_or(gain.position_ki)};
    const auto wanted = [&](int axis, double speed, double off, double integral) {
        return reference.acceleration[axis] + kd[axis] * (reference.velocity[axis] - speed) + kp[axis] * off +
               action(ki[axis], gain.position_integral_limit_m_s2, integral);
    };
    const double v1 = wanted(0, seen.velocity_m_s.x, error.x, kept.position_integral.x);
    const double v3 = wanted(1, seen.velocity_m_s.z, error.z, kept.position_integral.z);
    const double arm_error = reference.position[2] - seen.arm_rad;
    const double v7 = reference.acceleration[2] + gain.arm_kd * (reference.velocity[2] - seen.arm_rate_rad_s) +
                      gain.arm_kp * arm_error + action(gain.arm_ki, gain.arm_integral_limit_rad_s2, kept.arm_integral);

    const Tilt tilted = tilt(gain, inversion, {v1, v3, v7}, kept);

    // K5^-1 and D5^-1.
    const double rate_reference = tilted.rate_rad_s + gain.attitude_kp * (tilted.reference_rad - seen.pitch_rad);
    const double rate_error = rate_reference - seen.pitch_rate_rad_s;
    double v5 = gain.attitude_rate_kp * rate_error +
                action(gain.attitude_rate_ki, gain.attitude_integral_limit_rad_s2, kept.pitch_rate_integral);
    if (gain.rate_feed_forward) {
        v5 += (rate_reference - kept.rate_reference) / dt;
    }
    kept.pitch_reference_rad = tilted.reference_rad;
    kept.pitch_reference_rate = tilted.rate_rad_s;
    kept.rate_reference = rate_reference;
    integrated = kept;
    if (!tilted.is_clipped) {
        const double most = gain.position_integral_limit_m_s2;
        integrated.position_integral = {integrated_by(ki[0], most, kept.position_integral.x, error.x, dt),
                                        integrated_by(ki[1], most, kept.position_integral.z, error.z, dt)};
    }
    integrated.pitch_rate_integral = integrated_by(gain.attitude_rate_ki, gain.attitude_integral_limit_rad_s2,
                                                   kept.pitch_rate_integral, rate_error, dt);
    integrated.arm_integral =
        integrated_by(gain.arm_ki, gain.arm_integral_limit_rad_s2, kept.arm_integral, arm_error, dt);
    return {tilted.thrust_n, inversion.pitch_torque_nm(tilted.thrust_n, v5, v7), v7, std::nullopt};
}

ControlLaw::Demand ControlLaw::demand(const Motion& seen, const ReferencePoint& reference, const Inversion& inversion,
                                      ControlMemory& kept, ControlMemory& integrated) const {
    if (const auto* cascade = std::get_if<CascadedPid>(&robot_.controller.law)) {
        return cascaded(*cascade, seen, reference, kept, integrated);
    }
    if (const auto* lyapunov = std::get_if<PlanarLyapunov>(&robot_.controller.law)) {
        return falling(*lyapunov, inversion, seen, reference, kept, integrated);
    }
    return inverted(std::get<ModelInversion>(robot_.controller.law), inversion, seen, reference, kept, integrated);
}

/// docs/model.md 5.7: in free air, and without a feed-forward, K = 1.
ControlLaw::Read ControlLaw::read(const Motion& seen, const Surroundings& nominal) const {
    Read read;
    read.ratio.fill(1);
    if (feed_forward_) {
        const Planar from = seen.position_m - Planar{feed_forward_->offset_x_m, feed_forward_->offset_z_m};
        for (int i = 0; i < nominal_vehicle_.rotor_count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const Planar hub = from + from_body(nominal_vehicle_.hub_m[k], seen.pitch_rad);
            read.ratio[k] = std::max(nominal.thrust_ratio(i, hub, seen.pitch_rad), 0.1);
        }
        const Planar center = from + from_body(nominal_vehicle_.hub_center_m, seen.pitch_rad);
        read.fountain = nominal.fountain(center, seen.pitch_rad);
    }
    return read;
}

/// Allocates and clips.
ControlLaw::Rotors ControlLaw::limit(const Demand& demand, const Read& read,
                                     const std::array<double, max_rotors>& rotor_n, Command& command) const {
    const auto count = static_cast<std::size_t>(nominal_vehicle_.rotor_count);
    // What a thrust and a torque, shared out and divided by K, would act as: their multiples have to act as demanded.
    const auto acting = [&](const auto& free_air_n) {
        Eigen::Vector2d sum(0, 0);
        for (std::size_t i = 0; i < count; ++i) {
            const double at_rotor_n = read.ratio[i] * free_air_n(i);
            const double at_body_n = read.fountain * free_air_n(i);
            sum += Eigen::Vector2d(at_rotor_n + at_body_n, -(nominal_vehicle_.hub_m[i].x * at_rotor_n +
                                                             nominal_vehicle_.hub_center_m.x * at_body_n));
        }
        return sum;
    };
    Eigen::Matrix2d per_share;
    per_share.col(0) = acting([&](std::size_t i) { return share_[i][0] / read.ratio[i]; });
    per_share.col(1) = acting([&](std::size_t i) { return share_[i][1] / read.ratio[i]; });
    const Eigen::Vector2d shares =
        per_share.partialPivLu().solve(Eigen::Vector2d(demand.thrust_n, demand.pitch_torque_nm));

    const double low_n = robot_.rotors.min_thrust_n;
    const double high_n = robot_.rotors.max_thrust_n;
    const double lag_s = nominal_vehicle_.rotor_time_constant_s;
    const double reached = 0.5 * tick_s_ / (0.5 * tick_s_ + lag_s);  // of the way, in mid-tick
    const double lead = lag_s > 0 ? rotor_lead_ : 0;
    Rotors rotors;
    std::array<double, max_rotors> expected_n{};
    for (std::size_t i = 0; i < count; ++i) {
        const double wanted_n = (share_[i][0] * shares(0) + share_[i][1] * shares(1)) / read.ratio[i];
        rotors.are_clipped = rotors.are_clipped || wanted_n > high_n || wanted_n < low_n;
        command.thrust_n[i] = std::clamp(wanted_n + lead * (wanted_n - rotor_n[i]), low_n, high_n);
        const double now_n = lag_s > 0 ? rotor_n[i] : command.thrust_n[i];
        expected_n[i] = now_n + reached * (command.thrust_n[i] - now_n);
    }
    const Eigen::Vector2d expected = acting([&](std::size_t i) { return expected_n[i]; });
    rotors.thrust_n = expected(0);
    rotors.pitch_torque_nm = expected(1);
    return rotors;
}

ControlMemory ControlLaw::memory_of(const std::vector<double>& numbers) const {
    ControlMemory memory;
    const std::vector<double>& n = numbers;
    if (std::holds_alternative<CascadedPid>(robot_.controller.law)) {
        memory.velocity_integral = {n[0], n[1]};
        memory.pitch_rate_integral = n[2];
        memory.joint_integral = n[3];
        memory.velocity_before = {n[4], n[5]};
        memory.rate_before = n[6];
    } else {
        memory.position_integral = {n[0], n[1]};
        memory.pitch_rate_integral = n[2];
        memory.arm_integral = n[3];
        memory.pitch_reference_rad = n[4];
        memory.pitch_reference_rate = n[5];
        memory.rate_reference = n[6];
    }
    if (has_observer_) {
        memory.observed = observer_.of_kept({n[7], n[8], n[9], n[10]});
    }
    return memory;
}

void ControlLaw::stand_still(const ControlMemory& before, const Motion& from, const Motion& to,
                             ControlMemory& memory) const {
    memory.position_integral = before.position_integral;
    memory.pitch_rate_integral = before.pitch_rate_integral;
    memory.arm_integral = before.arm_integral;
    memory.velocity_integral = before.velocity_integral;
    memory.joint_integral = before.joint_integral;
    memory.observed = observer_.held(before.observed, from, to);
}

Command ControlLaw::command(const Motion& seen, const std::array<double, max_rotors>& rotor_n,
                            const ReferencePoint& reference, const Surroundings& nominal, ControlMemory& memory) const {
    Inversion inversion(nominal_vehicle_, seen);
    ControlMemory kept = memory;
    if (has_observer_) {
        observer_.look(seen, kept.observed);
        const Four& other = kept.observed.estimate;
        inversion.bias -= Vector4(other[0], other[1], other[2], other[3]);
    }
    ControlMemory integrated;
    const Demand demand = this->demand(seen, reference, inversion, kept, integrated);
    Command command;
    const Rotors rotors = limit(demand, read(seen, nominal), rotor_n, command);
    double joint_nm = 0;
    if (demand.joint_torque_nm) {
        joint_nm = *demand.joint_torque_nm;
    } else {
        // The four rows for du1, du3, du5 and the joint torque, with du7 given.
        Matrix4 m = inversion.mass;
        m.col(3) << 0, 0, 0, -1;
        const Vector4 load(rotors.thrust_n * inversion.sine, rotors.thrust_n * inversion.cosine, rotors.pitch_torque_nm,
                           0);
        joint_nm = m.partialPivLu().solve(load - inversion.bias - *demand.arm_acceleration * inversion.mass.col(3))(3);
    }
    const double most_nm = robot_.arm.max_torque_nm;
    command.joint_torque_nm = std::clamp(joint_nm, -most_nm, most_nm);
    memory = rotors.are_clipped || std::abs(joint_nm) > most_nm ? kept : integrated;
    observer_.expect(seen, rotors.thrust_n, rotors.pitch_torque_nm, command.joint_torque_nm, memory.observed);
    return command;
}

}  // namespace downwash::judge

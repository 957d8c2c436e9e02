#include "downwash/simulation/hover_trim.hpp"

#include <cmath>

namespace downwash::simulation {
namespace {

using dynamics::Attitude;
using dynamics::EquationsOfMotion;
using dynamics::RotorWrench;

/// The wrench to command so that the wrench in effect is `wanted`: the effect is linear in the commands.
RotorWrench<double> command_for(const PlantModel& plant, const FlightState& at, const LinearEffect& effect,
                                const RotorWrench<double>& wanted) {
    const auto attitude = dynamics::attitude(plant, at.plant.q[2], at.plant.q[3]);
    const auto acting = [&](double thrust_n, double pitch_torque_nm) {
        double command_n[max_rotors];
        dynamics::allocate(plant, thrust_n, pitch_torque_nm, command_n);
        return dynamics::rotor_wrench(plant, attitude, at.plant.q[0], at.plant.q[1], command_n, effect);
    };
    const RotorWrench<double> a = acting(1, 0);
    const RotorWrench<double> b = acting(0, 1);
    const double determinant = a.thrust_n * b.pitch_torque_nm - b.thrust_n * a.pitch_torque_nm;
    return {(wanted.thrust_n * b.pitch_torque_nm - b.thrust_n * wanted.pitch_torque_nm) / determinant,
            (a.thrust_n * wanted.pitch_torque_nm - wanted.thrust_n * a.pitch_torque_nm) / determinant};
}

/// The error that makes a gain give an action; infinite where there is no gain.
double error_for(double action, double gain) {
    return action == 0 ? 0 : action / gain;
}

/// What a PID settles at when it has to give `action` for ever.
struct SettledPid {
    double error, integral;
    bool is_at_limit;
};

SettledPid settled_pid(double action, double kp, double ki, double limit) {
    if (!(ki > 0)) {
        return {error_for(action, kp), 0, false};
    }
    if (std::abs(action) < limit) {
        return {0, action / ki, false};
    }
    const double most = action > 0 ? limit : -limit;
    return {error_for(action - most, kp), most / ki, true};
}

}  // namespace

HoverTrim hover_trim(const Robot& robot, const TickModel& model, const LinearEffect& effect,
                     const FlightState& resting) {
    const PlantModel& plant = model.plant;
    const ControllerGains& gains = model.gains;
    HoverTrim trim;
    trim.state = resting;
    const double arm_rad = resting.plant.q[3];
    const Attitude<double> a = dynamics::attitude(plant, resting.plant.q[2], arm_rad);
    const EquationsOfMotion<double> e = dynamics::equations_of_motion(plant, a, resting.plant.u);

    // The plant's side. Row 1 leaves no other pitch than level; rows 2 to 4 with du = 0 give thrust, torque, joint.
    const RotorWrench<double> command = command_for(plant, resting, effect, {e.bias[1], e.bias[2]});
    dynamics::allocate(plant, command.thrust_n, command.pitch_torque_nm, trim.rotor_command_n);
    trim.joint_torque_nm = e.bias[3];

    // The controller's side, from the last block of figure C.2 to the first. It knows nothing of surfaces, and asks
    // for accelerations that never come.
    const double force[3] = {0, command.thrust_n, command.pitch_torque_nm};
    const double torque_at_rest_nm = dynamics::joint_torque_for(plant, e, force, 0.0);
    const double torque_per_v7 = dynamics::joint_torque_for(plant, e, force, 1.0) - torque_at_rest_nm;
    const double v7 = (trim.joint_torque_nm - torque_at_rest_nm) / torque_per_v7;
    const dynamics::RotationalSystem<double> s = dynamics::rotational_system(plant, e, force);
    const double v5 = (s.g5 - s.s57 * v7) / s.s55;
    const SettledPid rate =
        settled_pid(v5, gains.attitude_ku5, gains.attitude_kiu5, gains.attitude_integral_limit_rad_s2);
    trim.pitch_reference_rad = error_for(rate.error, gains.attitude_k5);
    double sine = 0;
    double cosine = 1;
    lane::sin_cos(trim.pitch_reference_rad, sine, cosine);
    const double vx = (sine / cosine * command.thrust_n - plant.arm_mass_kg * e.arm_x * v7) / plant.total_mass_kg;
    const double vz = (command.thrust_n - e.bias[1] - plant.arm_mass_kg * e.arm_z * v7) / plant.total_mass_kg;
    const double position_limit = gains.position_integral_limit_m_s2;
    const SettledPid x = settled_pid(vx, gains.position_kp, gains.position_ki, position_limit);
    const SettledPid z = settled_pid(vz, gains.position_kp, gains.position_ki, position_limit);
    const SettledPid arm = settled_pid(v7, gains.arm_kp, gains.arm_ki, gains.arm_integral_limit_rad_s2);

    trim.reference.position[0] = resting.plant.q[0] + x.error;
    trim.reference.position[1] = resting.plant.q[1] + z.error;
    trim.reference.position[2] = arm_rad + arm.error;
    trim.is_integral_at_limit[0] = x.is_at_limit;
    trim.is_integral_at_limit[1] = z.is_at_limit;
    trim.is_integral_at_limit[2] = rate.is_at_limit;
    trim.is_integral_at_limit[3] = arm.is_at_limit;
    for (int i = 0; i < plant.rotor_count; ++i) {
        trim.state.plant.thrust_n[i] = trim.rotor_command_n[i];
    }
    trim.state.controller.position_integral[0] = x.integral;
    trim.state.controller.position_integral[1] = z.integral;
    trim.state.controller.pitch_rate_integral = rate.integral;
    trim.state.controller.arm_integral = arm.integral;
    trim.state.controller.pitch_reference_rad = trim.pitch_reference_rad;
    trim.state.controller.pitch_reference_rate = 0;
    trim.state.controller.rate_reference = rate.error;

    // Its limits.
    const double joint_saturation = std::abs(trim.joint_torque_nm) / plant.max_joint_torque_nm;
    const double rotor_saturation = thrust_saturation(plant, trim.rotor_command_n);
    trim.saturation = lane::max(joint_saturation, rotor_saturation);
    const double least_force_n = gains.min_vertical_force_ratio * e.bias[1];
    if (robot.arm.is_limited && (arm_rad < robot.arm.lower_limit_rad || arm_rad > robot.arm.upper_limit_rad)) {
        trim.limit = HoldLimit::arm_angle;
    } else if (!(rotor_saturation < 1) || !std::isfinite(command.thrust_n + command.pitch_torque_nm)) {
        trim.limit = HoldLimit::rotor_thrust;
    } else if (!(joint_saturation < 1)) {
        trim.limit = HoldLimit::joint_torque;
    } else if (!(std::abs(trim.pitch_reference_rad) < gains.max_tilt_rad)) {
        trim.limit = HoldLimit::tilt;
    } else if (!(command.thrust_n > least_force_n)) {
        trim.limit = HoldLimit::vertical;
    } else if (!std::isfinite(x.error + z.error + arm.error)) {
        trim.limit = HoldLimit::gain;
    }
    return trim;
}

}  // namespace downwash::simulation

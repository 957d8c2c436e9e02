#pragma once

#include <cmath>

#include "downwash/controllers/px4_cascade_control.hpp"
#include "downwash/controllers/rest.hpp"
#include "downwash/controllers/space_inversion_control.hpp"

// A vehicle at rest in space in closed loop: what its law has to remember and to be given to hold it there, worked out
// from the last block of the law to the first.

namespace downwash::controllers {

/// The commands that balance a vehicle at rest.
template <int n>
struct SpaceRestingCommand {
    double q[dynamics::space_coordinates<n>];  ///< where it is; the quaternion of length 1
    dynamics::SpaceWrench<double> wrench;      ///< that acts by what the law knows: wrench_of() the commands
    double joint_torque_nm[room_for<n>];
};

/// The equilibrium of a law: what it remembers and is given when it asks for these commands for ever.
template <class Law, int n>
struct SpaceRest {
    using Numbers = typename Law::template Memory<double, n>;
    using Flags = typename Law::template Memory<bool, n>;
    HoldLimit limit = HoldLimit::none;  ///< why the law cannot; then the rest of this is of no use
    Numbers memory{};
    Flags feeds_back{};             ///< whether the next ticks depend on that number of the memory
    double error[space_axes<n>]{};  ///< where the reference has to be, from the vehicle [m, rad]
    double height_gain_1_s2 = 0;    ///< vertical acceleration per metre of error
    double tilt_gain_1_s2 = 0;      ///< roll and pitch acceleration per radian of error
};

namespace detail {

/// A unit vector turned by a small or large turn across it, all in the same axes.
inline dynamics::LaneVector<double> turned_by(const dynamics::LaneVector<double>& turn,
                                              const dynamics::LaneVector<double>& v) {
    const double angle = std::sqrt(dot(turn, turn));
    if (!(angle > 0)) {
        return v;
    }
    return dynamics::rotation_about((1 / angle) * turn, angle) * v;
}

/// How far the heading has to be from the vehicle's yaw for a yaw error [rad]. Where the thrust shall point elsewhere
/// both differ a little.
inline double heading_error(const dynamics::LaneRotation<double>& attitude, const ThrustDirections<double>& thrust,
                            double yaw_error_rad) {
    const double yaw_rad = lane::atan2(attitude.first.y, attitude.first.x);
    double error_rad = yaw_error_rad;
    for (int i = 0; i < 20 && std::isfinite(error_rad); ++i) {  // each round leaves the square of the tilt error of it
        error_rad += yaw_error_rad - yaw_error(attitude, thrust, heading_at(yaw_rad + error_rad)).angle_rad;
    }
    return error_rad;
}

/// Whether a wanted thrust direction is beyond the limits of a law.
inline HoldLimit limit_of(const dynamics::LaneVector<double>& direction, double max_tilt_rad, double vertical_n,
                          double least_vertical_n, double errors) {
    if (!(std::hypot(direction.x, direction.y) < std::tan(max_tilt_rad) * direction.z)) {
        return HoldLimit::tilt;
    }
    if (!(vertical_n > least_vertical_n)) {
        return HoldLimit::vertical;
    }
    return std::isfinite(errors) ? HoldLimit::none : HoldLimit::gain;
}

}  // namespace detail

/// The equilibrium of a model inversion. An observer settles at what is missing in the balance; without one, the law
/// asks for accelerations that never come.
/// @pre the vehicle is upright: its thrust axis points upward
template <int n>
[[nodiscard]] SpaceRest<SpaceInversion, n> space_rest(const SpaceInversion& law, const SpaceLawModel<n>& nominal,
                                                      const SpaceRestingCommand<n>& command) {
    using dynamics::LaneVector;
    const SpaceModel<n>& plant = nominal.plant;
    const dynamics::SpacePlaces<double, n> places = dynamics::places_at(plant, command.q);
    const double still[dynamics::space_speeds<n>]{};
    dynamics::SpaceEquations<double, n> e = dynamics::equations_of_motion(plant, places, still);
    SpaceRest<SpaceInversion, n> rest;
    if (law.observer_gain_1_s > 0) {
        const LaneVector<double> up = turned_back(places.attitude, LaneVector<double>{0, 0, standard_gravity_m_s2});
        const LaneVector<double> force = plant.total_mass_kg * up - command.wrench.force_n;
        const LaneVector<double> torque = cross(e.first_moment_kg_m, up) - command.wrench.torque_nm;
        const LaneVector<double> in_world = places.attitude * force;
        const double missing[6] = {in_world.x, in_world.y, in_world.z, torque.x, torque.y, torque.z};
        for (int i = 0; i < 6 + n; ++i) {
            rest.memory.observed[i] =
                i < 6 ? missing[i] : dot(e.joint_push_kg_m[i - 6], up) - command.joint_torque_nm[i - 6];
            rest.feeds_back.observed[i] = true;
        }
        e.bias_force_n = -1.0 * force;
        e.bias_torque_nm = -1.0 * torque;
        for (int i = 0; i < n; ++i) {
            e.bias_joint_nm[i] = -rest.memory.observed[6 + i];
        }
    }
    // What the law believes that these commands do.
    double du[dynamics::space_speeds<n>];
    dynamics::forward_dynamics(plant, places, e, command.wrench, command.joint_torque_nm, du);

    double rate_error[3];
    for (int i = 0; i < 3; ++i) {
        const SettledPid rate =
            settled_pid(du[3 + i], i < 2 ? law.rate_kp_1_s : law.yaw_rate_kp_1_s,
                        i < 2 ? law.rate_ki_1_s2 : law.yaw_rate_ki_1_s2, law.rate_integral_limit_rad_s2);
        rate_error[i] = rate.error;
        rest.memory.rate_integral[i] = rate.integral;
        rest.feeds_back.rate_integral[i] = rate.feeds_back;
        rest.memory.rate_reference[i] = rate.error;
        rest.feeds_back.rate_reference[i] = law.rate_feed_forward;
    }
    const LaneVector<double> axis = nominal.allocation.lift_axis;
    const LaneVector<double> demanded{rate_error[0], rate_error[1], rate_error[2]};
    const double yaw_rate = dot(demanded, axis);
    const LaneVector<double> across = demanded - yaw_rate * axis;
    const LaneVector<double> tilt{error_for(across.x, law.attitude_kp_1_s), error_for(across.y, law.attitude_kp_1_s),
                                  error_for(across.z, law.attitude_kp_1_s)};
    const LaneVector<double> direction = places.attitude * detail::turned_by(tilt, axis);
    rest.memory.direction[0] = direction.x;
    rest.memory.direction[1] = direction.y;
    rest.memory.direction[2] = direction.z;
    for (int i = 0; i < 3; ++i) {
        rest.feeds_back.direction[i] = rest.feeds_back.direction_rate[i] = true;
    }

    // The force that points there and of which the thrust is the part along the thrust axis.
    const LaneVector<double> at = places.attitude * axis;
    const double thrust_n = command.wrench.force_n.z / axis.z;
    const LaneVector<double> force = (thrust_n / dot(direction, at)) * direction;
    LaneVector<double> push = e.bias_force_n;
    double errors = 0;
    for (int i = 0; i < n; ++i) {
        push = push + du[6 + i] * e.joint_push_kg_m[i];
        const SettledPid joint = settled_pid(du[6 + i], law.joint.kp_1_s2, law.joint.ki_1_s3, law.joint.integral_limit);
        rest.memory.joint_integral[i] = joint.integral;
        rest.feeds_back.joint_integral[i] = joint.feeds_back;
        rest.error[space::first_joint + i] = joint.error;
        errors += joint.error;
    }
    const LaneVector<double> wanted = plant.inverse_mass_1_kg * (force - places.attitude * push);
    const double acceleration[3] = {wanted.x, wanted.y, wanted.z - standard_gravity_m_s2};
    for (int i = 0; i < 3; ++i) {
        const SpaceLoopGains& gains = i == space::z ? law.height : law.horizontal;
        const SettledPid position = settled_pid(acceleration[i], gains.kp_1_s2, gains.ki_1_s3, gains.integral_limit);
        rest.memory.position_integral[i] = position.integral;
        rest.feeds_back.position_integral[i] = position.feeds_back;
        rest.error[i] = position.error;
        errors += position.error;
    }
    const ThrustDirections<double> thrust{axis, direction};
    const double yaw_gain = law.yaw_kp_1_s * 0.5 * (1 + dot(at, direction));
    rest.error[space::yaw] = detail::heading_error(places.attitude, thrust, error_for(yaw_rate, yaw_gain));
    errors += rest.error[space::yaw];
    rest.height_gain_1_s2 = law.height.kp_1_s2;
    rest.tilt_gain_1_s2 = law.attitude_kp_1_s * law.rate_kp_1_s;
    rest.limit = detail::limit_of(direction, law.max_tilt_rad, force.z,
                                  law.min_vertical_force_ratio * plant.total_mass_kg * standard_gravity_m_s2, errors);
    return rest;
}

/// The equilibrium of PX4's cascade. Where the yaw rate has no integral, the yaw error is right to first order.
/// @pre the vehicle is upright: its thrust axis points upward
template <int n>
[[nodiscard]] SpaceRest<Px4Cascade, n> space_rest(const Px4Cascade& law, const SpaceLawModel<n>& nominal,
                                                  const SpaceRestingCommand<n>& command) {
    using dynamics::LaneVector;
    const SpaceModel<n>& plant = nominal.plant;
    const dynamics::SpacePlaces<double, n> places = dynamics::places_at(plant, command.q);
    const double still[dynamics::space_speeds<n>]{};
    const dynamics::SpaceEquations<double, n> e = dynamics::equations_of_motion(plant, places, still);
    SpaceRest<Px4Cascade, n> rest;
    double errors = 0;
    double joint_acceleration[room_for<n>]{};
    accelerations_of_arm(e, command.joint_torque_nm, joint_acceleration);
    for (int i = 0; i < n; ++i) {
        const SettledPid joint =
            settled_pid(joint_acceleration[i], law.joint.kp_1_s2, law.joint.ki_1_s3, law.joint.integral_limit);
        rest.memory.joint_integral[i] = joint.integral;
        rest.feeds_back.joint_integral[i] = joint.feeds_back;
        rest.error[space::first_joint + i] = joint.error;
        errors += joint.error;
    }
    const LaneVector<double> turn = plant.inverse_inertia_1_kg_m2 * command.wrench.torque_nm;
    const double turns[3] = {turn.x, turn.y, turn.z};
    double rate_error[3];
    for (int i = 0; i < 3; ++i) {
        const SpaceRateGains& gains = i < 2 ? law.rate : law.yaw_rate;
        const SettledPid rate = settled_pid(turns[i], gains.kp_1_s, gains.ki_1_s2, gains.integral_limit);
        rate_error[i] = rate.error;
        rest.memory.rate_integral[i] = rate.integral;
        rest.feeds_back.rate_integral[i] = rate.feeds_back;
        rest.feeds_back.previous_rate[i] = gains.kd > 0;
    }
    // Twice the sine of half the tilt error.
    const LaneVector<double> axis = nominal.allocation.lift_axis;
    const double x = error_for(rate_error[0], law.attitude_p_1_s);
    const double y = error_for(rate_error[1], law.attitude_p_1_s);
    const double chord = std::hypot(x, y);
    const double scale = chord > 0 ? 2 * std::asin(0.5 * chord) / chord : 1;
    const LaneVector<double> direction = places.attitude * detail::turned_by({scale * x, scale * y, 0}, axis);
    const ThrustDirections<double> thrust{axis, direction};
    const double half_cosine = std::sqrt(0.5 * (1 + dot(places.attitude * axis, direction)));
    const double half_sine = 0.5 * error_for(rate_error[2], law.yaw_p_1_s / law.yaw_weight) / half_cosine;
    rest.error[space::yaw] = detail::heading_error(places.attitude, thrust, 2 * std::asin(half_sine) / law.yaw_weight);
    errors += rest.error[space::yaw];

    const double thrust_n = command.wrench.force_n.z / axis.z;
    const double acceleration[3] = {standard_gravity_m_s2 * direction.x / direction.z,
                                    standard_gravity_m_s2 * direction.y / direction.z,
                                    thrust_n * direction.z / plant.total_mass_kg - standard_gravity_m_s2};
    for (int i = 0; i < 3; ++i) {
        const bool is_height = i == space::z;
        const SpaceRateGains& gains = is_height ? law.vertical_velocity : law.velocity;
        const SettledPid velocity = settled_pid(acceleration[i], gains.kp_1_s, gains.ki_1_s2, gains.integral_limit);
        rest.memory.velocity_integral[i] = velocity.integral;
        rest.feeds_back.velocity_integral[i] = velocity.feeds_back;
        rest.feeds_back.previous_velocity[i] = gains.kd > 0;
        rest.error[i] = error_for(velocity.error, is_height ? law.height_p_1_s : law.position_p_1_s);
        errors += rest.error[i];
    }
    rest.height_gain_1_s2 = law.position_stiffness_1_s2(space::z);
    rest.tilt_gain_1_s2 = law.attitude_p_1_s * law.rate.kp_1_s;
    rest.limit = detail::limit_of(direction, law.max_tilt_rad, thrust_n,
                                  law.min_thrust_ratio * plant.total_mass_kg * standard_gravity_m_s2, errors);
    return rest;
}

}  // namespace downwash::controllers

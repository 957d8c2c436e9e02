#pragma once

#include "downwash/controllers/pid.hpp"
#include "downwash/controllers/space_actuate.hpp"
#include "downwash/controllers/space_attitude.hpp"
#include "downwash/controllers/space_law.hpp"

// The law of Px4Cascade (docs/model.md 5.10).

namespace downwash {
namespace controllers {

/// PX4's attitude error: twice the vector part of the quaternion that turns the vehicle first as the reduced attitude
/// asks, then about the thrust axis by a share of what is left. Body axes [rad] where small.
template <class T>
dynamics::LaneVector<T> weighted_attitude_error(const dynamics::LaneRotation<T>& attitude,
                                                const ThrustDirections<T>& thrust, const T& yaw_error_rad,
                                                double yaw_weight) {
    using dynamics::LaneVector;
    const LaneVector<T> wanted = turned_back(attitude, thrust.wanted);
    const T one_and_cosine = T(1) + dot(thrust.axis, wanted);
    const auto has_axis = one_and_cosine > T(1e-10);
    const T half_cosine = lane::sqrt(T(0.5) * lane::max(one_and_cosine, T(0)));  // of half the tilt error
    const LaneVector<T> c = cross(thrust.axis, wanted);
    const T share = lane::select(has_axis, T(0.5) / lane::select(has_axis, half_cosine, T(1)), T(0));
    const LaneVector<T> tilt{share * c.x, lane::select(has_axis, share * c.y, T(1)), share * c.z};
    T sine, cosine;
    lane::sin_cos(T(0.5 * yaw_weight) * yaw_error_rad, sine, cosine);
    const LaneVector<T> turn = sine * thrust.axis;
    return T(2) * (half_cosine * turn + cosine * tilt + cross(tilt, turn));
}

/// The acceleration that a loop of rates asks for.
template <class T>
T rate_action(const SpaceRateGains& gains, const T& error, const T& integral, const T& change_per_s) {
    return T(gains.kp_1_s) * error + integral_action(gains.ki_1_s2, gains.integral_limit, integral) -
           T(gains.kd) * change_per_s;
}

/// Position to velocity to acceleration: what the outer loops ask for.
/// @param[out] velocity_error [m/s]   @param[out] acceleration world axes [m/s2]
template <class T, int n>
[[gnu::always_inline]] inline void ask_accelerations(const Px4Cascade& law, const dynamics::SpaceState<T, n>& seen,
                                                     const Px4Cascade::Memory<T, n>& memory,
                                                     const BasicSpacePoint<T, n>& reference, double tick_s,
                                                     T velocity_error[3], T acceleration[3]) {
    const T per_tick(1 / tick_s);
    T velocity_wanted[3];
    for (int i = 0; i < 3; ++i) {
        velocity_wanted[i] = reference.velocity[i] + T(i == space::z ? law.height_p_1_s : law.position_p_1_s) *
                                                         (reference.position[i] - seen.q[i]);
    }
    const dynamics::LaneVector<T> level =
        limited_length(dynamics::LaneVector<T>{velocity_wanted[0], velocity_wanted[1], T(0)}, law.max_speed_m_s);
    velocity_wanted[0] = level.x;
    velocity_wanted[1] = level.y;
    velocity_wanted[2] = lane::clamp(velocity_wanted[2], T(-law.max_descent_m_s), T(law.max_climb_m_s));
    for (int i = 0; i < 3; ++i) {
        velocity_error[i] = velocity_wanted[i] - seen.u[i];
        acceleration[i] = reference.acceleration[i] + rate_action(i == space::z ? law.vertical_velocity : law.velocity,
                                                                  velocity_error[i], memory.velocity_integral[i],
                                                                  per_tick * (seen.u[i] - memory.previous_velocity[i]));
    }
}

/// The joint accelerations that torques give while the multirotor stands still: the arm's own inertia, eliminated from
/// the last joint to the first.
template <class T, int n>
void accelerations_of_arm(const dynamics::SpaceEquations<T, n>& e, const T torque_nm[room_for<n>], T y[room_for<n>]) {
    if constexpr (n > 0) {
        T m[n][n];  // its upper triangle
        for (int i = 0; i < n; ++i) {
            y[i] = torque_nm[i];
            for (int k = 0; k <= i; ++k) {
                m[k][i] = e.joint_inertia_kg_m2[k][i];
            }
        }
        for (int i = n - 1; i > 0; --i) {
            for (int k = 0; k < i; ++k) {
                const T factor = m[k][i] / m[i][i];
                for (int j = 0; j <= k; ++j) {
                    m[j][k] = m[j][k] - factor * m[j][i];
                }
                y[k] = y[k] - factor * y[i];
            }
        }
        for (int i = 0; i < n; ++i) {
            for (int k = 0; k < i; ++k) {
                y[i] = y[i] - m[k][i] * y[k];
            }
            y[i] = y[i] / m[i][i];
        }
    }
}

}  // namespace controllers

template <class T, int n>
Px4Cascade::Memory<T, n> Px4Cascade::rested(const SpaceLawModel<n>& nominal, const dynamics::SpaceState<T, n>& state,
                                            double /*tick_s*/) const {
    using dynamics::LaneVector;
    const SpaceModel<n>& plant = nominal.plant;
    const auto places = dynamics::places_at(plant, state.q);
    const T still[dynamics::space_speeds<n>]{};
    const auto e = dynamics::equations_of_motion(plant, places, still);
    const LaneVector<T> up = turned_back(places.attitude, LaneVector<T>{T(0), T(0), T(standard_gravity_m_s2)});
    const LaneVector<T> turn = dynamics::spread<T>(plant.inverse_inertia_1_kg_m2) * cross(e.first_moment_kg_m, up);
    const auto carries = [](double ki, double limit, const T& action) {
        return ki > 0 ? lane::clamp(action, T(-limit), T(limit)) / T(ki) : T(0);
    };
    Memory<T, n> memory{};
    const T turns[3] = {turn.x, turn.y, turn.z};
    for (int i = 0; i < 3; ++i) {
        const SpaceRateGains& gains = i < 2 ? rate : yaw_rate;
        memory.rate_integral[i] = carries(gains.ki_1_s2, gains.integral_limit, turns[i]);
        memory.previous_velocity[i] = state.u[i];
        memory.previous_rate[i] = state.u[3 + i];
    }
    T weight_nm[room_for<n>]{}, needed[room_for<n>]{};
    for (int i = 0; i < n; ++i) {
        weight_nm[i] = dot(e.joint_push_kg_m[i], up);
    }
    controllers::accelerations_of_arm(e, weight_nm, needed);
    for (int i = 0; i < n; ++i) {
        memory.joint_integral[i] = carries(joint.ki_1_s3, joint.integral_limit, needed[i]);
    }
    return memory;
}

template <class T, int n, class Map>
T Px4Cascade::control(const SpaceLawModel<n>& nominal, const dynamics::SpaceState<T, n>& seen,
                      const Memory<T, n>& memory, const BasicSpacePoint<T, n>& reference, double tick_s,
                      const Map& /*map*/, dynamics::SpaceCommand<T, n>& given, Memory<T, n>& next) const {
    using dynamics::LaneVector;
    const SpaceModel<n>& plant = nominal.plant;
    const T* q = seen.q;
    const T* u = seen.u;
    const T dt_s(tick_s);
    const T per_tick(1 / tick_s);
    const dynamics::LaneRotation<T> attitude = dynamics::rotation_of(q + 3);

    T velocity_error[3], acceleration[3];
    controllers::ask_accelerations(*this, seen, memory, reference, tick_s, velocity_error, acceleration);

    // Acceleration to thrust: the direction counts with the weight alone, its length makes up for the tilt.
    const T gravity(standard_gravity_m_s2);
    const auto to =
        controllers::limited_direction(LaneVector<T>{acceleration[0], acceleration[1], gravity}, max_tilt_rad, gravity);
    const T asked_n = T(plant.total_mass_kg) * (gravity + acceleration[2]) / to.direction.z;
    const T thrust_n = lane::max(asked_n, T(min_thrust_ratio * standard_gravity_m_s2 * plant.total_mass_kg));

    // Attitude to body rate.
    const LaneVector<T> axis = dynamics::spread<T>(nominal.allocation.lift_axis);
    const controllers::ThrustDirections<T> thrust{axis, to.direction};
    const auto yaw = controllers::yaw_error(attitude, thrust, controllers::heading_at(reference.position[space::yaw]));
    const LaneVector<T> error = controllers::weighted_attitude_error(attitude, thrust, yaw.angle_rad, yaw_weight);
    const T yaw_rate_wanted = reference.velocity[space::yaw];
    const T rate_wanted[3] = {lane::clamp(T(attitude_p_1_s) * error.x + yaw_rate_wanted * attitude.first.z,
                                          T(-max_rate_rad_s), T(max_rate_rad_s)),
                              lane::clamp(T(attitude_p_1_s) * error.y + yaw_rate_wanted * attitude.second.z,
                                          T(-max_rate_rad_s), T(max_rate_rad_s)),
                              lane::clamp(T(yaw_p_1_s / yaw_weight) * error.z + yaw_rate_wanted * attitude.third.z,
                                          T(-max_yaw_rate_rad_s), T(max_yaw_rate_rad_s))};

    // Body rate to torque: that of the multirotor alone.
    T rate_error[3], turn[3];
    for (int i = 0; i < 3; ++i) {
        rate_error[i] = rate_wanted[i] - u[3 + i];
        turn[i] = controllers::rate_action(i < 2 ? rate : yaw_rate, rate_error[i], memory.rate_integral[i],
                                           per_tick * (u[3 + i] - memory.previous_rate[i]));
    }
    const controllers::SpaceDemand<T> demand{
        thrust_n * axis.z, dynamics::spread<T>(plant.inertia_kg_m2) * LaneVector<T>{turn[0], turn[1], turn[2]}};
    const T* no_ratio = nullptr;
    T saturation = controllers::command_rotors(nominal, seen, no_ratio, demand, tick_s, rotor_lead, given).saturation;

    // Joints: the torques that accelerate the arm as wanted while the multirotor stands still.
    T joint_error[room_for<n>]{}, joint_torque_nm[room_for<n>]{};
    if constexpr (n > 0) {
        const auto places = dynamics::places_at(plant, q, attitude);
        const auto e = dynamics::equations_of_motion(plant, places, u);
        T wanted[n];
        for (int i = 0; i < n; ++i) {
            constexpr int first = space::first_joint;
            joint_error[i] = reference.position[first + i] - q[7 + i];
            wanted[i] = reference.acceleration[first + i] +
                        T(joint.kd_1_s) * (reference.velocity[first + i] - u[6 + i]) +
                        T(joint.kp_1_s2) * joint_error[i] +
                        controllers::integral_action(joint.ki_1_s3, joint.integral_limit, memory.joint_integral[i]);
        }
        for (int i = 0; i < n; ++i) {
            joint_torque_nm[i] = T(0);
            for (int k = 0; k < n; ++k) {
                joint_torque_nm[i] = joint_torque_nm[i] +
                                     (k < i ? e.joint_inertia_kg_m2[k][i] : e.joint_inertia_kg_m2[i][k]) * wanted[k];
            }
        }
    }
    saturation = controllers::command_joints(nominal, joint_torque_nm, saturation, given);

    // Integrals stand still where something was clipped (anti-windup), those of the velocity where the thrust was, too.
    const auto is_clipped = saturation > T(1);
    const auto is_force_clipped =
        lane::max(lane::max(to.excess, thrust_n - asked_n), lane::select(is_clipped, T(1), T(-1))) > T(0);
    for (int i = 0; i < 3; ++i) {
        const SpaceRateGains& loop = i == space::z ? vertical_velocity : velocity;
        next.velocity_integral[i] = controllers::integral_unless(is_force_clipped, loop.ki_1_s2, loop.integral_limit,
                                                                 memory.velocity_integral[i], velocity_error[i], dt_s);
        const SpaceRateGains& turning = i < 2 ? rate : yaw_rate;
        next.rate_integral[i] = controllers::integral_unless(is_clipped, turning.ki_1_s2, turning.integral_limit,
                                                             memory.rate_integral[i], rate_error[i], dt_s);
        next.previous_velocity[i] = u[i];
        next.previous_rate[i] = u[3 + i];
    }
    next.joint_integral[0] = T(0);
    for (int i = 0; i < n; ++i) {
        next.joint_integral[i] = controllers::integral_unless(is_clipped, joint.ki_1_s3, joint.integral_limit,
                                                              memory.joint_integral[i], joint_error[i], dt_s);
    }
    return saturation;
}

}  // namespace downwash

#pragma once

#include <concepts>
#include <optional>

#include "downwash/controllers/pid.hpp"
#include "downwash/controllers/space_actuate.hpp"
#include "downwash/controllers/space_attitude.hpp"
#include "downwash/controllers/space_law.hpp"
#include "downwash/controllers/space_observer.hpp"

// The law of SpaceInversion (docs/model.md 5.9).

namespace downwash {
namespace controllers {

/// What the position loops of a law ask for.
/// @param[out] error of the position [m]   @param[out] wanted accelerations, world axes [m/s2]
template <class T, int n>
[[gnu::always_inline]] inline void ask_accelerations(const SpaceInversion& law, const dynamics::SpaceState<T, n>& seen,
                                                     const SpaceInversion::Memory<T, n>& memory,
                                                     const BasicSpacePoint<T, n>& reference, double /*tick_s*/,
                                                     T error[3], T wanted[3]) {
    for (int i = 0; i < 3; ++i) {
        const SpaceLoopGains& gains = i == space::z ? law.height : law.horizontal;
        error[i] = reference.position[i] - seen.q[i];
        wanted[i] = reference.acceleration[i] + T(gains.kd_1_s) * (reference.velocity[i] - seen.u[i]) +
                    T(gains.kp_1_s2) * error[i] +
                    integral_action(gains.ki_1_s3, gains.integral_limit, memory.position_integral[i]);
    }
}

}  // namespace controllers

template <class T, int n>
SpaceInversion::Memory<T, n> SpaceInversion::rested(const SpaceLawModel<n>& nominal,
                                                    const dynamics::SpaceState<T, n>& state, double tick_s) const {
    Memory<T, n> memory{};
    const auto axis = dynamics::rotation_of(state.q + 3) * dynamics::spread<T>(nominal.allocation.lift_axis);
    const auto direction =
        controllers::limited_direction(axis, max_tilt_rad, T(lane::sin_cos(max_tilt_rad).cosine)).direction;
    memory.direction[0] = direction.x;
    memory.direction[1] = direction.y;
    memory.direction[2] = direction.z;
    if (observer_gain_1_s > 0) {
        controllers::start_observing(observer_gain_1_s, tick_s, nominal.plant, state, memory.observed);
    }
    return memory;
}

template <class T, int n, class Map>
T SpaceInversion::control(const SpaceLawModel<n>& nominal, const dynamics::SpaceState<T, n>& seen,
                          const Memory<T, n>& memory, const BasicSpacePoint<T, n>& reference, double tick_s,
                          const Map& map, dynamics::SpaceCommand<T, n>& given, Memory<T, n>& next) const {
    using dynamics::LaneVector;
    const SpaceModel<n>& plant = nominal.plant;
    const T* q = seen.q;
    const T* u = seen.u;
    const T dt_s(tick_s);
    const dynamics::LaneRotation<T> attitude = dynamics::rotation_of(q + 3);
    const dynamics::SpacePlaces<T, n> places = dynamics::places_at(plant, q, attitude);
    dynamics::SpaceEquations<T, n> e = dynamics::equations_of_motion(plant, places, u);
    std::optional<controllers::SpaceObservation<T, n>> observation;
    if (observer_gain_1_s > 0) {
        observation.emplace(observer_gain_1_s, tick_s, plant, seen, places, e, memory.observed);
        observation->explain(attitude, e);
    }
    if constexpr (std::derived_from<Map, controllers::ToldPush>) {
        controllers::stand_up_to(map, places, e);
    }
    const LaneVector<T> body_rate{u[3], u[4], u[5]};
    LaneVector<T> gyroscopic{T(0), T(0), T(0)};  // torque of the spinning rotors
    if (plant.has_gyroscopic_term) {
        gyroscopic = cross(dynamics::rotor_spin_of(plant, seen.thrust_n), body_rate);
        e.bias_torque_nm = e.bias_torque_nm - gyroscopic;
    }

    // Position and joint PID: the accelerations to impose.
    T wanted[3], error[3];
    controllers::ask_accelerations(*this, seen, memory, reference, tick_s, error, wanted);
    T joint_error[room_for<n>]{}, joint_acceleration[room_for<n>]{};
    LaneVector<T> push = e.bias_force_n;  // what arm and velocity products need, body axes
    LaneVector<T> spin = e.bias_torque_nm;
    for (int i = 0; i < n; ++i) {
        constexpr int first = space::first_joint;
        joint_error[i] = reference.position[first + i] - q[7 + i];
        joint_acceleration[i] =
            reference.acceleration[first + i] + T(joint.kd_1_s) * (reference.velocity[first + i] - u[6 + i]) +
            T(joint.kp_1_s2) * joint_error[i] +
            controllers::integral_action(joint.ki_1_s3, joint.integral_limit, memory.joint_integral[i]);
        push = push + joint_acceleration[i] * e.joint_push_kg_m[i];
        spin = spin + joint_acceleration[i] * e.joint_spin_kg_m2[i];
    }

    // The force that gives these accelerations, where it points, and what of it acts along the thrust axis.
    const T mass(plant.total_mass_kg);
    const LaneVector<T> force =
        mass * LaneVector<T>{wanted[0], wanted[1], wanted[2] + T(standard_gravity_m_s2)} + attitude * push;
    const auto to =
        controllers::limited_direction(force, max_tilt_rad, T(min_vertical_force_ratio * standard_gravity_m_s2) * mass);
    const LaneVector<T> axis = dynamics::spread<T>(nominal.allocation.lift_axis);
    const T asked_n = dot(force, attitude * axis);
    const T thrust_n = lane::max(asked_n, T(nominal.min_lift_n));

    // Tilt first, then yaw: the body rate that takes the thrust there, with how fast the direction itself turns.
    const controllers::ThrustDirections<T> thrust{axis, to.direction};
    const LaneVector<T> before{memory.direction[0], memory.direction[1], memory.direction[2]};
    const LaneVector<T> turned = controllers::shortest_turn(cross(before, to.direction), dot(before, to.direction),
                                                            LaneVector<T>{T(0), T(1), T(0)});
    const LaneVector<T> old_rate{memory.direction_rate[0], memory.direction_rate[1], memory.direction_rate[2]};
    const T blend = dt_s / (T(direction_rate_filter_s) + dt_s);
    const LaneVector<T> direction_rate = old_rate + blend * ((T(1) / dt_s) * turned - old_rate);
    LaneVector<T> along = turned_back(attitude, direction_rate);
    along = along - dot(along, axis) * axis;
    const LaneVector<T> tilt_rate = controllers::limited_length(
        along + T(attitude_kp_1_s) * controllers::tilt_error(attitude, thrust), max_rate_rad_s);
    const controllers::Heading<T> heading = controllers::heading_at(reference.position[space::yaw]);
    const controllers::YawError<T> yaw = controllers::yaw_error(attitude, thrust, heading);
    const T yaw_rate = lane::clamp(
        T(yaw_kp_1_s) * yaw.weight * yaw.angle_rad +
            controllers::yaw_feed_forward(yaw, thrust, heading, direction_rate, reference.velocity[space::yaw]),
        T(-max_yaw_rate_rad_s), T(max_yaw_rate_rad_s));
    const LaneVector<T> demanded = tilt_rate + yaw_rate * axis;
    const T rate_reference[3] = {demanded.x, demanded.y, demanded.z};

    // The torque for the angular acceleration, with the acceleration that this thrust will really give: more than all
    // rotors have does not push a centre of mass that is beside the rotors' own.
    const T given_n = lane::min(thrust_n, T(nominal.max_lift_n));
    T rate_error[3], turn[3];
    for (int i = 0; i < 3; ++i) {
        rate_error[i] = rate_reference[i] - u[3 + i];
        turn[i] = T(i < 2 ? rate_kp_1_s : yaw_rate_kp_1_s) * rate_error[i] +
                  controllers::integral_action(i < 2 ? rate_ki_1_s2 : yaw_rate_ki_1_s2, rate_integral_limit_rad_s2,
                                               memory.rate_integral[i]);
        if (rate_feed_forward) {
            turn[i] = turn[i] + (rate_reference[i] - memory.rate_reference[i]) / dt_s;
        }
    }
    const LaneVector<T> turning{turn[0], turn[1], turn[2]};
    const LaneVector<T> acceleration =
        T(plant.inverse_mass_1_kg) * (given_n * axis - cross(turning, e.first_moment_kg_m) - push);
    const controllers::SpaceDemand<T> demand{
        thrust_n * axis.z, cross(e.first_moment_kg_m, acceleration) + e.inertia_kg_m2 * turning + spin};

    // Rotors, then joints under what the rotors will give.
    T ratio[max_rotors]{};
    if (feed_forward) {
        controllers::read_ratios(nominal, seen, attitude, feed_forward_offset_m, map, ratio);
    }
    const controllers::CommandedRotors<T> rotors =
        controllers::command_rotors(nominal, seen, feed_forward ? ratio : nullptr, demand, tick_s, rotor_lead, given);
    T joint_torque_nm[room_for<n>]{};
    controllers::joint_torques_for(plant, e, rotors.wrench, joint_acceleration, joint_torque_nm);
    const T saturation = controllers::command_joints(nominal, joint_torque_nm, rotors.saturation, given);

    // Integrals stand still where something was clipped (anti-windup), those of the position where the force was, too.
    const auto is_clipped = lane::max(saturation - T(1), thrust_n - asked_n) > T(0);
    const auto is_force_clipped = lane::max(to.excess, lane::select(is_clipped, T(1), T(-1))) > T(0);
    next.direction[0] = to.direction.x;
    next.direction[1] = to.direction.y;
    next.direction[2] = to.direction.z;
    next.direction_rate[0] = direction_rate.x;
    next.direction_rate[1] = direction_rate.y;
    next.direction_rate[2] = direction_rate.z;
    for (int i = 0; i < 3; ++i) {
        const SpaceLoopGains& gains = i == space::z ? height : horizontal;
        next.position_integral[i] = controllers::integral_unless(is_force_clipped, gains.ki_1_s3, gains.integral_limit,
                                                                 memory.position_integral[i], error[i], dt_s);
        next.rate_integral[i] =
            controllers::integral_unless(is_clipped, i < 2 ? rate_ki_1_s2 : yaw_rate_ki_1_s2,
                                         rate_integral_limit_rad_s2, memory.rate_integral[i], rate_error[i], dt_s);
        next.rate_reference[i] = rate_reference[i];
    }
    next.joint_integral[0] = T(0);
    for (int i = 0; i < n; ++i) {
        next.joint_integral[i] = controllers::integral_unless(is_clipped, joint.ki_1_s3, joint.integral_limit,
                                                              memory.joint_integral[i], joint_error[i], dt_s);
    }
    if (observation) {
        const dynamics::SpaceWrench<T> acting{rotors.wrench.force_n, rotors.wrench.torque_nm + gyroscopic};
        observation->keep(acting, given.joint_torque_nm, next.observed);
    } else {
        for (T& number : next.observed) {
            number = T(0);
        }
    }
    return saturation;
}

}  // namespace downwash

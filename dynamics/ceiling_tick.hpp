#pragma once

#include <cmath>

#include "downwash/dynamics/ceiling_contact.hpp"
#include "downwash/dynamics/space_step.hpp"

// A tick under a ceiling that the vehicle may touch.

namespace downwash::dynamics {

/// What the ceiling does to the multirotor.
template <class T>
struct CeilingLoad {
    SpaceWrench<T> wrench;  ///< wrench of the contact, in body axes
    T normal_n;             ///< sum of the normal forces, downward
    T depth_m;              ///< depth of the deepest point, 0 without contact
    T highest_m;            ///< height of the highest point in the world
};

/// The load at coordinates and speeds of a plant in space (space_body.hpp).
template <class T>
CeilingLoad<T> ceiling_load(const CeilingContact& contact, const T* q, const T* u, const LaneRotation<T>& attitude) {
    const T zero(0);
    CeilingLoad<T> load{{{zero, zero, zero}, {zero, zero, zero}}, zero, zero, T(-1e300)};
    const LaneVector<T> rate{u[3], u[4], u[5]};
    const T slip_squared(contact.slip_speed_m_s * contact.slip_speed_m_s);
    for (int i = 0; i < contact.point_count; ++i) {
        const LaneVector<T> arm = spread<T>(contact.point_m[i]);
        const T height = q[2] + (attitude * arm).z;
        const LaneVector<T> velocity = LaneVector<T>{u[0], u[1], u[2]} + attitude * cross(rate, arm);
        const T depth = lane::max(height - T(contact.ceiling_m), zero);
        const T normal =
            T(contact.stiffness_n_m) * depth * lane::max(T(1) + T(contact.dissipation_s_m) * velocity.z, zero);
        const T slip = lane::sqrt(velocity.x * velocity.x + velocity.y * velocity.y + slip_squared);
        const T drag = T(contact.friction) * normal / slip;
        const LaneVector<T> force =
            turned_back(attitude, LaneVector<T>{-(drag * velocity.x), -(drag * velocity.y), -normal});
        load.wrench.force_n = load.wrench.force_n + force;
        load.wrench.torque_nm = load.wrench.torque_nm + cross(arm, force);
        load.normal_n = load.normal_n + normal;
        load.depth_m = lane::max(load.depth_m, depth);
        load.highest_m = lane::max(load.highest_m, height);
    }
    return load;
}

/// Surroundings with a ceiling to touch: what they are without it, and the load.
template <SpaceSurroundings<double> Around>
struct UnderCeiling : Around {
    UnderCeiling(const Around& around, const CeilingContact& ceiling) : Around(around), contact(ceiling) {}
    const CeilingContact& contact;

    template <int n>
    void add_load(const double* q, const double* u, const SpacePlaces<double, n>& places,
                  SpaceLoad<double, n>& load) const {
        Around::add_load(q, u, places, load);
        const SpaceWrench<double> wrench = ceiling_load(contact, q, u, places.attitude).wrench;
        load.wrench.force_n = load.wrench.force_n + wrench.force_n;
        load.wrench.torque_nm = load.wrench.torque_nm + wrench.torque_nm;
    }
};

/// A tick under a ceiling.
template <int n>
struct ContactTick {
    SpaceState<double, n> state;  ///< after it
    int steps;                    ///< steps of the integrator
    double normal_impulse_n_s;    ///< impulse of the ceiling on the vehicle
    double max_depth_m;           ///< largest depth of any point
};

/// The state after `dt_s` under a ceiling, in as many Runge-Kutta steps as contact needs: one where nothing can touch.
/// @param dt_s a tick, at most 0.02 s   @param step_share share of the step that is taken otherwise; for tests
template <int n, SpaceSurroundings<double> Around>
ContactTick<n> contact_tick(const SpaceModel<n>& model, const CeilingContact& contact,
                            const SpaceState<double, n>& state, const SpaceCommand<double, n>& command, double dt_s,
                            const Around& around, double step_share = 1) {
    // Contact and friction are stiff.
    constexpr double phase_rad = 0.1;     // of the fastest vibration against the ceiling per step
    constexpr double friction_decay = 1;  // by which friction may slow slip per step, as an exponent

    const auto load_at = [&](const SpaceState<double, n>& at) {
        return ceiling_load(contact, at.q, at.u, rotation_of(at.q + 3));
    };
    // What a newton at a point does to its velocity: of a vehicle that is nearly level, without its arm, which only
    // holds it back.
    const double inverse_mass = 1 / model.multirotor_mass_kg;
    double normal_mobility = 0;  // sum
    double slip_mobility = 0;    // greatest
    double max_arm_m = 0;
    for (int k = 0; k < contact.point_count; ++k) {
        const LaneVector<double>& arm = contact.point_m[k];
        const auto by_turning = [&](const LaneVector<double>& direction) {
            const LaneVector<double> lever = cross(arm, direction);
            return dot(lever, model.inverse_inertia_1_kg_m2 * lever);
        };
        normal_mobility += inverse_mass + by_turning({0, 0, 1});
        slip_mobility = lane::max(slip_mobility, inverse_mass + by_turning({1, 0, 0}) + by_turning({0, 1, 0}));
        max_arm_m = lane::max(max_arm_m, lane::sqrt(dot(arm, arm)));
    }
    const double fastest_rad_s = lane::sqrt(contact.stiffness_n_m * normal_mobility);

    ContactTick<n> tick{state, 0, 0, 0};
    CeilingLoad<double> load = load_at(state);
    const double* u = state.u;
    const double speed_m_s = lane::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) +
                             max_arm_m * lane::sqrt(u[3] * u[3] + u[4] * u[4] + u[5] * u[5]);
    constexpr double max_acceleration_m_s2 = 100;
    if (load.highest_m + (speed_m_s + 0.5 * max_acceleration_m_s2 * dt_s) * dt_s < contact.ceiling_m) {
        tick.state = space_step(model, state, command, dt_s, around);
        tick.steps = 1;
        return tick;
    }
    const UnderCeiling<Around> surroundings(around, contact);
    for (double rest_s = dt_s; rest_s > 0;) {
        // Friction decays slip at mu N / v_slip times the mobility.
        const double slip_decay_1_s = contact.friction * load.normal_n * slip_mobility / contact.slip_speed_m_s;
        const double longest_s = step_share * lane::min(phase_rad / fastest_rad_s,
                                                        slip_decay_1_s > 0 ? friction_decay / slip_decay_1_s : dt_s);
        const double parts = std::ceil(rest_s / longest_s);
        const bool is_last = parts <= 1;
        const double step_s = is_last ? rest_s : rest_s / parts;
        tick.state = space_step(model, tick.state, command, step_s, surroundings);
        const CeilingLoad<double> next = load_at(tick.state);
        tick.normal_impulse_n_s += 0.5 * step_s * (load.normal_n + next.normal_n);
        tick.max_depth_m = lane::max(tick.max_depth_m, next.depth_m);
        ++tick.steps;
        load = next;
        rest_s = is_last ? 0 : rest_s - step_s;
    }
    return tick;
}

}  // namespace downwash::dynamics

#pragma once

#include "downwash/dynamics/space_body.hpp"

// How easily a plant in space gives way: what a newton or a newton metre does to the velocity where it acts. It says
// how long a step of the integrator may be where forces are stiff.

namespace downwash::dynamics {

/// What a load does to the speeds of a plant at rest, gravity apart.
template <int n>
void response_to(const SpaceModel<n>& model, const SpacePlaces<double, n>& p, const SpaceLoad<double, n>& load,
                 double du[space_speeds<n>]) {
    const double at_rest[space_speeds<n>] = {};
    forward_dynamics(model, p, equations_of_motion(model, p, at_rest), load.wrench, load.joint_torque_nm, du);
    du[2] += standard_gravity_m_s2;
}

/// Acceleration of a point along a unit vector in body axes by a force of 1 N along it [1/kg].
/// @param link,at_m as of add_force_at()
template <int n>
double mobility_at(const SpaceModel<n>& model, const SpacePlaces<double, n>& p, int link,
                   const LaneVector<double>& at_m, const LaneVector<double>& direction) {
    SpaceLoad<double, n> load{};
    add_force_at(p, link, at_m, direction, load);
    double du[space_speeds<n>];
    response_to(model, p, load, du);
    return dot(velocity_at(p, link, at_m, du), direction);
}

/// Greatest acceleration of each joint by a torque of 1 N m on it [1/(kg m2)], over its way and that of the others: of
/// places spread evenly over all angles, which come within some percent of the greatest.
template <int n>
void joint_mobility(const SpaceModel<n>& model, double mobility_1_kg_m2[room_for<n>]) {
    constexpr int samples = 256;
    // Additive recurrence with the roots of x^(n+1) = x + 1 (M. Roberts 2018): even in n dimensions.
    double root = 2;
    for (int i = 0; i < 60 && n > 0; ++i) {
        double power = root;
        for (int k = 0; k < n; ++k) {
            power *= root;
        }
        const double slope = (n + 1) * power / root - 1;
        root -= (power - root - 1) / slope;
    }
    for (int i = 0; i < n; ++i) {
        mobility_1_kg_m2[i] = 0;
    }
    for (int sample = 0; sample < samples; ++sample) {
        double q[space_coordinates<n>] = {0, 0, 0, 1};
        double share = 1;
        for (int i = 0; i < n; ++i) {
            share /= root;
            const double turns = sample * share;
            q[7 + i] = 6.28318530717958647692 * (turns - static_cast<double>(static_cast<int>(turns)));
        }
        const SpacePlaces<double, n> p = places_at(model, q);
        for (int i = 0; i < n; ++i) {
            SpaceLoad<double, n> load{};
            load.joint_torque_nm[i] = 1;
            double du[space_speeds<n>];
            response_to(model, p, load, du);
            mobility_1_kg_m2[i] = lane::max(mobility_1_kg_m2[i], du[6 + i]);
        }
    }
}

}  // namespace downwash::dynamics

#pragma once

#include <cmath>

#include "downwash/dynamics/space_mobility.hpp"
#include "downwash/dynamics/space_step.hpp"

// How the plant in space moves over one control tick. space_contact_step.hpp has one more way, beside a surface.

namespace downwash::dynamics {

/// Equal Runge-Kutta steps, the same number in every tick, place and lane; for planning. One unless the joints have
/// friction or stops: joint_steps().
struct EqualSpaceSteps {
    int count = 1;  ///< >= 1

    /// The state after `dt_s`; see space_step().
    template <class T, int n, class P, SpaceSurroundings<T> Around>
    SpaceState<T, n> operator()(const BasicSpaceModel<P, n>& model, const SpaceState<T, n>& state,
                                const SpaceCommand<T, n>& command, T dt_s, const Around& around) const {
        const T step_s = count == 1 ? dt_s : dt_s * T(1.0 / count);
        SpaceState<T, n> next = state;
        for (int i = 0; i < count; ++i) {  // one call, and so one copy of the step in a kernel
            next = space_step(model, next, command, step_s, around);
        }
        return next;
    }
};

/// One Runge-Kutta step; for planning with joints that have neither friction nor stops.
struct OneSpaceStep {
    /// The state after `dt_s`; see space_step().
    template <class T, int n, class P, SpaceSurroundings<T> Around>
    SpaceState<T, n> operator()(const BasicSpaceModel<P, n>& model, const SpaceState<T, n>& state,
                                const SpaceCommand<T, n>& command, T dt_s, const Around& around) const {
        return space_step(model, state, command, dt_s, around);
    }
};

/// One Runge-Kutta step under a command to which something is added between controller and plant.
template <int n>
struct DisturbedSpaceStep {
    SpaceCommand<double, n> added;

    /// The state after `dt_s`; see space_step().
    template <SpaceSurroundings<double> Around>
    SpaceState<double, n> operator()(const SpaceModel<n>& model, const SpaceState<double, n>& state,
                                     const SpaceCommand<double, n>& command, double dt_s, const Around& around) const {
        SpaceCommand<double, n> acting = command;
        for (int i = 0; i < model.rotor_count; ++i) {
            acting.thrust_n[i] += added.thrust_n[i];
        }
        for (int i = 0; i < n; ++i) {
            acting.joint_torque_nm[i] += added.joint_torque_nm[i];
        }
        return space_step(model, state, acting, dt_s, around);
    }
};

/// As many steps as the tick needs; for flights that are reported. A step is halved until both halves agree with the
/// whole: RefinedStep in integration.hpp says why.
struct RefinedSpaceStep {
    double tolerance = 1e-7;  ///< allowed error of every coordinate and speed, SI units
    int max_halvings = 8;

    /// The state after `dt_s`; see space_step().
    template <int n, SpaceSurroundings<double> Around>
    SpaceState<double, n> operator()(const SpaceModel<n>& model, const SpaceState<double, n>& state,
                                     const SpaceCommand<double, n>& command, double dt_s, const Around& around) const {
        return refined(model, state, command, dt_s, around, space_step(model, state, command, dt_s, around),
                       max_halvings);
    }

 private:
    template <int n, SpaceSurroundings<double> Around>
    SpaceState<double, n> refined(const SpaceModel<n>& model, const SpaceState<double, n>& state,
                                  const SpaceCommand<double, n>& command, double dt_s, const Around& around,
                                  const SpaceState<double, n>& whole, int halvings) const {
        const double half_s = 0.5 * dt_s;
        const SpaceState<double, n> middle = space_step(model, state, command, half_s, around);
        const SpaceState<double, n> end = space_step(model, middle, command, half_s, around);
        if (halvings == 0 || agree(whole, end)) {
            return end;
        }
        const SpaceState<double, n> reached = refined(model, state, command, half_s, around, middle, halvings - 1);
        return refined(model, reached, command, half_s, around, space_step(model, reached, command, half_s, around),
                       halvings - 1);
    }
    template <int n>
    [[nodiscard]] bool agree(const SpaceState<double, n>& a, const SpaceState<double, n>& b) const {
        double worst = 0;
        for (int i = 0; i < space_coordinates<n>; ++i) {
            worst = lane::max(worst, lane::abs(a.q[i] - b.q[i]));
        }
        for (int i = 0; i < space_speeds<n>; ++i) {
            worst = lane::max(worst, lane::abs(a.u[i] - b.u[i]));
        }
        return worst <= tolerance;
    }
};

/// How many equal steps a tick needs so that the joints' friction slows no joint by more than a factor of e in one, and
/// so that no joint vibrates against its stop by more than a quarter of a radian in one. 1 without friction and stops.
/// @param dt_s a tick, > 0
template <int n>
int joint_steps(const SpaceModel<n>& model, double dt_s) {
    if (!model.has_friction && !model.has_stops) {
        return 1;
    }
    double mobility_1_kg_m2[room_for<n>];
    joint_mobility(model, mobility_1_kg_m2);
    double per_second = 0;
    for (int i = 0; i < n; ++i) {
        const auto& link = model.link[i];
        const double resistance_nm_s = link.viscous_friction_nm_s + link.coulomb_friction_nm / joint_slip_rad_s;
        per_second = lane::max(per_second, resistance_nm_s * mobility_1_kg_m2[i]);
        per_second = lane::max(per_second, 4 * lane::sqrt(link.stop_stiffness_nm_rad * mobility_1_kg_m2[i]));
    }
    return static_cast<int>(lane::max(1.0, std::ceil(per_second * dt_s)));
}

}  // namespace downwash::dynamics

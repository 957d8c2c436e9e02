#pragma once

#include <algorithm>
#include <cmath>

#include "../support/random.hpp"
#include "../support/surroundings.hpp"
#include "downwash/controllers/lyapunov.hpp"
#include "downwash/dynamics/quadrotor.hpp"

namespace downwash::test {

using SpaceVehicle = dynamics::SpaceState<double, 0>;
using SpaceThrusts = dynamics::SpaceCommand<double, 0>;

/// A quadrotor with spinning rotors, which follow commands at once.
inline SpaceModel<0> sample() {
    QuadrotorParameters quadrotor;
    quadrotor.mass_kg = 1.5;
    quadrotor.inertia_kg_m2 = {0.02, 0.024, 0.041};
    quadrotor.arm_m = 0.24;
    quadrotor.drag_torque_m = 0.016;
    quadrotor.thrust_coefficient_n_s2 = 1.1e-5;
    quadrotor.rotor_inertia_kg_m2 = 6e-5;
    return make_space_model<0>(make_quadrotor(quadrotor));
}

/// The same K everywhere.
struct Even : dynamics::CalmSpace {
    explicit Even(double everywhere) : factor(everywhere) {}
    double factor;
    [[nodiscard]] double thrust_ratio(int /*rotor*/, const dynamics::LaneVector<double>& /*hub_m*/,
                                      const dynamics::LaneVector<double>& /*axis*/) const {
        return factor;
    }
};

/// Yaw about z, pitch about y, roll about x: the product of three quaternions of half the angles.
inline void set_attitude(SpaceVehicle& state, const controllers::EulerAngles<double>& a) {
    const double cr = std::cos(a.roll / 2);
    const double sr = std::sin(a.roll / 2);
    const double cp = std::cos(a.pitch / 2);
    const double sp = std::sin(a.pitch / 2);
    const double cy = std::cos(a.yaw / 2);
    const double sy = std::sin(a.yaw / 2);
    const double q[4] = {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                         cr * cp * sy - sr * sp * cy};
    std::copy(q, q + 4, state.q + 3);
}

inline controllers::EulerAngles<double> angles_of(const SpaceVehicle& state) {
    return controllers::euler_angles(dynamics::rotation_of(state.q + 3));
}

inline controllers::EulerAngles<double> rates_of(const SpaceVehicle& state) {
    return controllers::euler_rates(controllers::euler_tilt(angles_of(state)),
                                    dynamics::LaneVector<double>{state.u[3], state.u[4], state.u[5]});
}

inline SpaceVehicle random_state(Random& random) {
    SpaceVehicle state{};
    for (int i = 0; i < 3; ++i) {
        state.q[i] = random.uniform(-1, 1);
        state.u[i] = random.uniform(-1, 1);
        state.u[3 + i] = random.uniform(-2, 2);
    }
    set_attitude(state, {random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), random.uniform(-3, 3)});
    return state;
}

}  // namespace downwash::test

#pragma once

#include <algorithm>
#include <cmath>

#include "../support/random.hpp"
#include "../support/surroundings.hpp"
#include "downwash/controllers/px4_cascade_control.hpp"
#include "downwash/controllers/space_gains.hpp"
#include "downwash/controllers/space_inversion_control.hpp"

// Robots in space with arms of 0 to 3 joints, and their closed loop.

namespace downwash::test {

inline constexpr double space_tick_s = 0.01;

/// A hexarotor of some 2 kg with an arm below that hangs at zero angles: numbers near those of eagle-mpc's hexacopter
/// 370. Its joints turn about -y, but the second about x where there are three.
inline SpacePlant hexarotor(int joints, double lag_s = 0.02) {
    SpacePlant plant;
    plant.multirotor = {2.2, {{{0.0145, 0, 0}, {0, 0.0150, 0}, {0, 0, 0.0237}}}};
    for (int i = 0; i < 6; ++i) {
        const double angle = (30 + 60 * i) * 3.14159265358979323846 / 180;
        plant.rotors.push_back(
            {{0.185 * std::cos(angle), 0.185 * std::sin(angle), 0.05}, {0, 0, 1}, i % 2 == 0 ? -1 : 1, 0.01689});
    }
    const double length_m[] = {0.132, 0.12, 0.08};
    const double mass_kg[] = {0.12, 0.1, 0.05};
    for (int i = 0; i < joints; ++i) {
        const double inertia = mass_kg[i] * length_m[i] * length_m[i] / 10;
        plant.links.push_back({{mass_kg[i], {{{inertia, 0, 0}, {0, inertia, 0}, {0, 0, 0.1 * inertia}}}},
                               i == 0 ? Vector3{0.01, 0, -0.1} : Vector3{0, 0, -length_m[i - 1]},
                               joints == 3 && i == 1 ? Vector3{1, 0, 0} : Vector3{0, -1, 0},
                               {0, 0.002, -0.5 * length_m[i]}});
    }
    plant.time_constant_s = lag_s;
    plant.thrust_coefficient_n_s2 = 4.138395e-6;
    plant.rotor_inertia_kg_m2 = 1.5e-5;
    plant.power_coefficient_w_n1p5 = 3;
    return plant;
}

template <int n>
SpaceLawModel<n> law_model_of(const SpacePlant& plant, double min_thrust_n = 0, double max_thrust_n = 12,
                              double max_torque_nm = 1) {
    return make_space_law_model<n>(plant, std::vector<double>(plant.rotors.size(), min_thrust_n),
                                   std::vector<double>(plant.rotors.size(), max_thrust_n),
                                   std::vector<double>(n, max_torque_nm));
}

/// At rest, level, with the thrust of hover.
template <int n>
dynamics::SpaceState<double, n> hovering(const SpaceModel<n>& model) {
    dynamics::SpaceState<double, n> state{};
    state.q[3] = 1;
    for (int i = 0; i < model.rotor_count; ++i) {
        state.thrust_n[i] = model.total_mass_kg * standard_gravity_m_s2 / model.rotor_count;
    }
    return state;
}

/// What a closed loop went through.
template <class Law, int n>
struct SpaceFlight {
    dynamics::SpaceState<double, n> state;
    typename Law::template Memory<double, n> memory;
    dynamics::SpaceCommand<double, n> given{};
    double max_saturation = 0;
};

/// Flies a law with the state that it sees at once. @param reference of a tick: `BasicSpacePoint<double, n>(int)`
template <class Law, int n, class Reference, class Around = FreeSpace, class Map = controllers::NoRatios>
SpaceFlight<Law, n> fly(const Law& law, const SpaceLawModel<n>& nominal, const SpaceModel<n>& plant,
                        const dynamics::SpaceState<double, n>& start, const Reference& reference, int ticks,
                        const Around& around = {}, const Map& map = {}) {
    SpaceFlight<Law, n> flight{start, law.rested(nominal, start, space_tick_s), {}, 0};
    for (int tick = 0; tick < ticks; ++tick) {
        typename Law::template Memory<double, n> next;
        const double saturation =
            law.control(nominal, flight.state, flight.memory, reference(tick), space_tick_s, map, flight.given, next);
        flight.max_saturation = std::max(flight.max_saturation, saturation);
        flight.memory = next;
        flight.state = dynamics::space_step(plant, flight.state, flight.given, space_tick_s, around);
    }
    return flight;
}

/// Distance of the place from that of a reference [m].
template <int n>
double off_m(const dynamics::SpaceState<double, n>& state, const BasicSpacePoint<double, n>& point) {
    return std::hypot(state.q[0] - point.position[0], state.q[1] - point.position[1], state.q[2] - point.position[2]);
}

/// The yaw of the first body axis.
template <int n>
double yaw_of(const dynamics::SpaceState<double, n>& state) {
    const auto r = dynamics::rotation_of(state.q + 3);
    return std::atan2(r.first.y, r.first.x);
}

}  // namespace downwash::test

#pragma once

#include <Eigen/Dense>
#include <algorithm>

#include "../support/random.hpp"
#include "../support/surroundings.hpp"
#include "downwash/dynamics/space_plant.hpp"
#include "downwash/dynamics/space_step.hpp"

namespace downwash::test {

inline Vector3 random_vector(Random& random, double most) {
    Vector3 v{};
    for (double& number : v) {
        number = random.uniform(-most, most);
    }
    return v;
}

/// The inertia of a few random points: the moments of a body that can exist, in axes that are not its own.
inline Matrix3 random_inertia(Random& random, double scale) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 4; ++i) {
        const Eigen::Vector3d at(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        sum += scale * (at.squaredNorm() * Eigen::Matrix3d::Identity() - at * at.transpose());
    }
    Matrix3 inertia{};
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            inertia[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] = sum(i, k);
        }
    }
    return inertia;
}

/// A multirotor of some kilograms with `joints` links of a fifth of it, axes and places askew, and tilted rotors.
inline SpacePlant random_space_plant(Random& random, int joints) {
    SpacePlant plant;
    plant.multirotor = {random.uniform(1, 6), random_inertia(random, 0.03)};
    for (int i = 0; i < joints; ++i) {
        plant.links.push_back({{random.uniform(0.1, 1), random_inertia(random, 0.01)},
                               random_vector(random, 0.3),
                               random_vector(random, 1),
                               random_vector(random, 0.3)});
    }
    const int rotors = random.integer(5, max_rotors);
    for (int i = 0; i < rotors; ++i) {
        plant.rotors.push_back({random_vector(random, 0.4),
                                {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 1},
                                i % 2 == 0 ? 1 : -1,
                                random.uniform(0.01, 0.03)});
    }
    plant.thrust_coefficient_n_s2 = random.uniform(1e-5, 1e-4);
    plant.rotor_inertia_kg_m2 = random.uniform(1e-5, 1e-3);
    plant.power_coefficient_w_n1p5 = random.uniform(1, 5);
    return plant;
}

/// Anywhere, with any attitude, turning.
template <int n>
dynamics::SpaceState<double, n> random_space_state(Random& random, double rate_rad_s) {
    dynamics::SpaceState<double, n> state{};
    for (double& number : state.q) {
        number = random.uniform(-1, 1);
    }
    dynamics::normalise_attitude(state.q);
    for (int i = 0; i < 6 + n; ++i) {
        state.u[i] = random.uniform(-1, 1) * (i < 3 ? 2 : rate_rad_s);
    }
    return state;
}

/// Several steps.
template <int n, class Surroundings = FreeSpace>
dynamics::SpaceState<double, n> flown(const SpaceModel<n>& model, dynamics::SpaceState<double, n> state,
                                      const dynamics::SpaceCommand<double, n>& command, double dt_s, int steps,
                                      const Surroundings& surroundings = {}) {
    for (int i = 0; i < steps; ++i) {
        state = dynamics::space_step(model, state, command, dt_s, surroundings);
    }
    return state;
}

}  // namespace downwash::test

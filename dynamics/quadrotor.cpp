#include "downwash/dynamics/quadrotor.hpp"

#include <cmath>

namespace downwash {

SpacePlant make_quadrotor(const QuadrotorParameters& quadrotor) {
    SpacePlant plant;
    plant.multirotor.mass_kg = quadrotor.mass_kg;
    for (std::size_t i = 0; i < 3; ++i) {
        plant.multirotor.inertia_kg_m2[i][i] = quadrotor.inertia_kg_m2[i];
    }
    const double d = quadrotor.arm_m;
    const double half = d * std::sqrt(0.5);
    const double z = quadrotor.rotor_height_m;
    // Thesis (4.13): roll has the signs - + + -, which are those of y; pitch has + - + -, which are those of -x.
    const bool is_plus = quadrotor.layout == QuadrotorLayout::plus;
    const Vector3 places[] = {
        is_plus ? Vector3{-d, 0, z} : Vector3{-half, -half, z}, is_plus ? Vector3{d, 0, z} : Vector3{half, half, z},
        is_plus ? Vector3{0, d, z} : Vector3{-half, half, z}, is_plus ? Vector3{0, -d, z} : Vector3{half, -half, z}};
    int number = 0;
    for (const Vector3& place : places) {
        const int spin = number++ < 2 ? -1 : 1;
        plant.rotors.push_back({place, {0, 0, 1}, spin, quadrotor.drag_torque_m});
    }
    plant.time_constant_s = quadrotor.time_constant_s;
    plant.thrust_coefficient_n_s2 = quadrotor.thrust_coefficient_n_s2;
    plant.rotor_inertia_kg_m2 = quadrotor.rotor_inertia_kg_m2;
    plant.power_coefficient_w_n1p5 = quadrotor.power_coefficient_w_n1p5;
    return plant;
}

}  // namespace downwash

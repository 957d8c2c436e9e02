#pragma once

#include "../support/random.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "newton_euler.hpp"

namespace downwash::test {

/// Parameters of an arbitrary aerial manipulator, joint offset included.
struct RandomPlant {
    MultirotorParameters multirotor;
    ArmParameters arm;
    RotorParameters rotors;
    PlantModel model;

    explicit RandomPlant(Random& random) {
        multirotor.mass_kg = random.uniform(0.3, 20);
        multirotor.pitch_inertia_kg_m2 = random.uniform(0.01, 2);
        arm.joint_x_m = random.uniform(-0.3, 0.3);
        arm.joint_z_m = random.uniform(-0.3, 0.3);
        arm.length_m = random.uniform(0.2, 2);
        arm.center_of_mass_m = random.uniform(0, 1) * arm.length_m;
        arm.mass_kg = random.uniform(0.05, 5);
        arm.inertia_kg_m2 = random.uniform(0.002, 0.5);
        arm.max_torque_nm = random.uniform(1, 50);
        rotors.radius_m = 0.2;
        const int count = random.integer(2, max_rotors);
        for (int i = 0; i < count; ++i) {
            rotors.positions_m.push_back(
                {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.1, 0.1)});
        }
        rotors.max_thrust_n = 100;
        rotors.power_coefficient_w_n1p5 = random.uniform(1, 5);
        model = make_plant_model(multirotor, arm, rotors);
    }
};

/// Four numbers in [-most, most].
inline Four random_four(Random& random, double most) {
    Four four{};
    for (double& value : four) {
        value = random.uniform(-most, most);
    }
    return four;
}

}  // namespace downwash::test

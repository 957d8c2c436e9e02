#pragma once

#include <cassert>
#include <vector>

#include "downwash/dynamics/space_allocation.hpp"

namespace downwash {

/// What a control law knows of its vehicle: the nominal plant, how its rotors share a demand, and limits. Immutable
/// once made.
template <int n>
struct SpaceLawModel {
    SpaceModel<n> plant;
    SpaceAllocation allocation;
    double min_thrust_n[max_rotors], max_thrust_n[max_rotors];  ///< of each rotor's command
    double min_lift_n;                                          ///< least thrust along the lift axis, all rotors at min
    double max_lift_n;                                          ///< greatest one, all rotors at max
    double max_joint_torque_nm[room_for<n>];
};

/// What a law knows of a plant.
/// @param min_thrust_n,max_thrust_n one for each rotor, 0 <= min < max   @param max_joint_torque_nm one for each joint,
/// > 0
/// @pre lift and torques can be commanded apart: SpaceAllocation::has_full_rank
template <int n>
[[nodiscard]] SpaceLawModel<n> make_space_law_model(const SpacePlant& plant, const std::vector<double>& min_thrust_n,
                                                    const std::vector<double>& max_thrust_n,
                                                    const std::vector<double>& max_joint_torque_nm) {
    assert(min_thrust_n.size() == plant.rotors.size() && max_thrust_n.size() == plant.rotors.size());
    assert(max_joint_torque_nm.size() == static_cast<std::size_t>(n));
    SpaceLawModel<n> model{};
    model.plant = make_space_model<n>(plant);
    model.allocation = make_space_allocation(model.plant);
    for (int i = 0; i < model.plant.rotor_count; ++i) {
        model.min_thrust_n[i] = min_thrust_n[static_cast<std::size_t>(i)];
        model.max_thrust_n[i] = max_thrust_n[static_cast<std::size_t>(i)];
        const double along = dot(model.plant.rotor[i].axis, model.allocation.lift_axis);
        model.min_lift_n += model.min_thrust_n[i] * along;
        model.max_lift_n += model.max_thrust_n[i] * along;
    }
    for (int i = 0; i < n; ++i) {
        model.max_joint_torque_nm[i] = max_joint_torque_nm[static_cast<std::size_t>(i)];
    }
    return model;
}

}  // namespace downwash

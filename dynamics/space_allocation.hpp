#pragma once

#include "downwash/base/export.hpp"
#include "downwash/dynamics/space_model.hpp"

// Which rotor takes what part of a demanded lift and torque in space.

namespace downwash {

/// Thrust of each rotor per unit of lift along b3 [N], roll, pitch and yaw torque [N m]: the least thrusts of all that
/// give them together.
struct SpaceAllocation {
    bool has_full_rank;  ///< whether lift and the three torques can be commanded apart; else the shares are 0
    int rotor_count;
    double share[max_rotors][4];
    /// Where the force of a lift without torque points, body axes, of length 1: b3, exactly so where tilts cancel.
    /// Without full rank b3.
    dynamics::LaneVector<double> lift_axis;
};

/// The allocation of a plant in free air (thesis (4.15), inverted for any layout).
/// @param rotors `rotor_count` of them
[[nodiscard]] DOWNWASH_EXPORT SpaceAllocation make_space_allocation(int rotor_count,
                                                                    const SpaceRotorNumbers<double>* rotors);

/// The allocation of a plant with any arm.
template <int n>
[[nodiscard]] SpaceAllocation make_space_allocation(const SpaceModel<n>& model) {
    return make_space_allocation(model.rotor_count, model.rotor);
}

namespace dynamics {

/// Free-air thrusts [N], not clipped. @param demand lift [N], roll, pitch and yaw torque [N m]
template <class T>
void allocate(const SpaceAllocation& allocation, const T demand[4], T thrust_n[max_rotors]) {
    for (int i = 0; i < allocation.rotor_count; ++i) {
        const double* share = allocation.share[i];
        thrust_n[i] =
            T(share[0]) * demand[0] + T(share[1]) * demand[1] + T(share[2]) * demand[2] + T(share[3]) * demand[3];
    }
}

}  // namespace dynamics
}  // namespace downwash

#pragma once

#include "downwash/base/export.hpp"
#include "downwash/dynamics/plant.hpp"

namespace downwash {

/// Standard gravity [m/s2].
inline constexpr double standard_gravity_m_s2 = 9.80665;

/// The plant as plain numbers, ready for the tick. Immutable once made.
struct PlantModel {
    double multirotor_mass_kg, arm_mass_kg, total_mass_kg;
    double inverse_mass_1_kg;    ///< 1 / (mA + mB)
    double reduced_mass_kg;      ///< mA mB / (mA + mB)
    double arm_mass_ratio;       ///< mB / (mA + mB)
    double pitch_inertia_kg_m2;  ///< IA
    double arm_inertia_kg_m2;    ///< IB
    double joint_x_m, joint_z_m;
    double arm_center_of_mass_m;  ///< lB
    double arm_length_m;          ///< L
    double max_joint_torque_nm;

    int rotor_count;
    /// The number under which the body stands behind the rotors: its hub is the centre between all of theirs.
    [[nodiscard, gnu::always_inline]] constexpr int body() const noexcept { return rotor_count; }
    /// Hubs in the body frame, body() included.
    double rotor_x_m[max_rotors + 1], rotor_z_m[max_rotors + 1];
    /// Near the ground the air that rises between the rotors pushes the body at that centre (thesis (2.17)).
    bool has_fountain;
    double force_share[max_rotors];       ///< thrust of rotor i per newton of F3
    double torque_share_1_m[max_rotors];  ///< thrust of rotor i per newton metre of T2
    double min_thrust_n, max_thrust_n;
    double rotor_time_constant_s;  ///< 0: thrust follows the command at once
    double power_coefficient_w_n1p5;
};

/// Prepares a plant.
/// @pre the parameters are sound (robot_errors() finds nothing) and no more than max_rotors rotors are given
[[nodiscard]] DOWNWASH_EXPORT PlantModel make_plant_model(const MultirotorParameters& multirotor,
                                                          const ArmParameters& arm, const RotorParameters& rotors,
                                                          bool has_fountain = false);

/// Whether the rotor positions let total thrust and pitch torque be commanded apart (rank 2 of the allocation of
/// docs/model.md 3).
[[nodiscard]] DOWNWASH_EXPORT bool allocation_has_full_rank(const RotorParameters& rotors);

}  // namespace downwash

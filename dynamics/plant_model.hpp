#pragma once

#include "downwash/base/export.hpp"
#include "downwash/dynamics/plant.hpp"

namespace downwash {

/// Standard gravity [m/s2].
inline constexpr double standard_gravity_m_s2 = 9.80665;

/// What all lanes of a plant have in common.
struct PlantStructure {
    int rotor_count;
    /// Near the ground the air that rises between the rotors pushes the body at their centre (thesis (2.17)).
    bool has_fountain;
    bool has_walls;      ///< walls beside the vehicle push it and turn it
    bool has_rotor_lag;  ///< without it thrust follows the command at once
    bool has_drag;       ///< whether the multirotor or the arm has drag
    /// Effect of a wall that a rotor touches, per newton of free-air thrust: a force away from it, and a moment [m]
    /// that lowers the side towards it.
    double wall_force, wall_moment_m;
};

/// The numbers that may differ from lane to lane. Nothing but T: see base/numbers.hpp.
template <class T>
struct PlantNumbers {
    T multirotor_mass_kg, arm_mass_kg, total_mass_kg;
    T weight_n;             ///< total mass times gravity
    T inverse_mass_1_kg;    ///< 1 / (mA + mB)
    T reduced_mass_kg;      ///< mA mB / (mA + mB)
    T arm_mass_ratio;       ///< mB / (mA + mB)
    T pitch_inertia_kg_m2;  ///< IA
    T arm_inertia_kg_m2;    ///< IB
    T joint_x_m, joint_z_m;
    T arm_center_of_mass_m;  ///< lB
    T arm_length_m;          ///< L
    T max_joint_torque_nm;
    T rotor_x_m[max_rotors], rotor_z_m[max_rotors];  ///< hubs in the body frame
    T center_x_m, center_z_m;                        ///< the centre between all hubs, where air pushes the body
    T force_share[max_rotors];                       ///< thrust of rotor i per newton of F3
    T torque_share_1_m[max_rotors];                  ///< thrust of rotor i per newton metre of T2
    T min_thrust_n, max_thrust_n;
    T rotor_time_constant_s;  ///< > 0 in every lane where the plant has a lag
    T power_coefficient_w_n1p5;
    T body_drag_n_s_m, body_drag_n_s2_m2;  ///< linear and quadratic in the speed through the air
    T arm_drag_n_s_m, arm_drag_n_s2_m2;    ///< drag of the whole arm, in the speed across it
};

/// The plant as plain numbers, ready for the tick. With T = double one model serves all lanes of a tick; with a pack
/// every lane flies a vehicle of its own.
template <class T>
struct BasicPlantModel : PlantStructure, PlantNumbers<T> {};

/// The plant that all lanes share, and that controllers know. Immutable once made.
using PlantModel = BasicPlantModel<double>;

/// Prepares a plant.
/// @pre the parameters are sound (robot_errors() finds nothing) and no more than max_rotors rotors are given
[[nodiscard]] DOWNWASH_EXPORT PlantModel make_plant_model(const MultirotorParameters& multirotor,
                                                          const ArmParameters& arm, const RotorParameters& rotors,
                                                          bool has_fountain = false);

}  // namespace downwash

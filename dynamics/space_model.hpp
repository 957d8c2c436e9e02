#pragma once

#include "downwash/base/export.hpp"
#include "downwash/dynamics/lane_vector.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/dynamics/space_plant.hpp"

namespace downwash {

/// Room for n numbers: no array of C++ is empty.
template <int n>
inline constexpr int room_for = n > 0 ? n : 1;

/// What all lanes of a plant in space have in common.
struct SpaceStructure {
    int rotor_count;
    bool has_rotor_lag;        ///< without it thrust follows the command at once
    bool has_gyroscopic_term;  ///< whether spinning rotors add a gyroscopic torque
    bool has_drag;             ///< whether the multirotor or a link has drag
    bool has_friction;         ///< whether a joint has friction
    bool has_stops;            ///< whether a joint has stops
    /// Near the ground the air that rises between the rotors pushes the body at their centre (thesis (2.17)).
    bool has_fountain;
    bool has_walls;  ///< walls beside the vehicle push it and turn it
    /// Effect of a wall that a rotor touches, per newton of free-air thrust: a force away from it, and a moment [m]
    /// that lowers the side towards it.
    double wall_force, wall_moment_m;
};

/// A link as plain numbers; see SpaceLink.
template <class T>
struct SpaceLinkNumbers {
    T mass_kg;
    dynamics::LaneVector<T> joint_m, axis, center_of_mass_m;
    dynamics::LaneSymmetric<T> inertia_kg_m2;
    T length_m, inverse_length_1_m;  ///< of its way to the next joint or the end effector; the inverse of 0 is 0
    T drag_n_s_m, drag_n_s2_m2;      ///< drag of the whole link, in the speed across it
    T viscous_friction_nm_s, coulomb_friction_nm;
    T stop_lower_rad, stop_upper_rad, stop_stiffness_nm_rad, stop_dissipation_s_rad;  ///< far away: no stop
};

/// A rotor as plain numbers; see SpaceRotor.
template <class T>
struct SpaceRotorNumbers {
    dynamics::LaneVector<T> position_m, axis;
    T reaction_m;         ///< torque about its axis per newton of free-air thrust: -spin * drag_torque_m
    T spin_kg_m2_s_n0p5;  ///< angular momentum about its axis per square root of free-air thrust
};

/// The numbers that may differ from lane to lane. Nothing but T: see base/numbers.hpp.
template <class T, int n>
struct SpaceNumbers {
    T multirotor_mass_kg, total_mass_kg, inverse_mass_1_kg;
    dynamics::LaneSymmetric<T> inertia_kg_m2, inverse_inertia_1_kg_m2;  ///< inertia of the multirotor alone
    SpaceLinkNumbers<T> link[room_for<n>];
    SpaceRotorNumbers<T> rotor[max_rotors];
    T rotor_time_constant_s;  ///< > 0 in every lane where the plant has a lag
    T power_coefficient_w_n1p5;
    T body_drag_n_s_m, body_drag_n_s2_m2;    ///< linear and quadratic in the speed through the air
    dynamics::LaneVector<T> end_effector_m;  ///< from the last joint, in the last link's axes
    dynamics::LaneVector<T> center_m;        ///< the centre between all hubs, where air pushes the body
    dynamics::LaneVector<T> center_axis;     ///< mean axis of the rotors, of length 1: the push acts along it
};

/// A plant in space with an arm of n joints as plain numbers, ready for the tick. As with BasicPlantModel, one model of
/// T = double serves all lanes.
template <class T, int n>
struct BasicSpaceModel : SpaceStructure, SpaceNumbers<T, n> {};

/// The plant in space that all lanes share.
template <int n>
using SpaceModel = BasicSpaceModel<double, n>;

/// Parts of make_space_model().
namespace detail {

/// Everything but the links.
DOWNWASH_EXPORT void set_multirotor(const SpacePlant& plant, SpaceStructure& structure, SpaceNumbers<double, 0>& out);
/// A link in plain numbers.
[[nodiscard]] DOWNWASH_EXPORT SpaceLinkNumbers<double> link_numbers(const SpacePlant& plant, int link);

}  // namespace detail

/// Prepares a plant in space.
/// @pre it has n links and at most max_rotors rotors; masses and inertias are positive, axes are not zero
/// @param has_fountain whether the air below pushes the body (docs/model.md 4.3). Walls are switched on in the model
template <int n>
[[nodiscard]] SpaceModel<n> make_space_model(const SpacePlant& plant, bool has_fountain = false) {
    SpaceModel<n> model{};
    SpaceNumbers<double, 0> alone{};
    detail::set_multirotor(plant, model, alone);
    model.multirotor_mass_kg = alone.multirotor_mass_kg;
    model.total_mass_kg = alone.multirotor_mass_kg;
    model.inertia_kg_m2 = alone.inertia_kg_m2;
    model.inverse_inertia_1_kg_m2 = alone.inverse_inertia_1_kg_m2;
    model.rotor_time_constant_s = alone.rotor_time_constant_s;
    model.power_coefficient_w_n1p5 = alone.power_coefficient_w_n1p5;
    model.body_drag_n_s_m = alone.body_drag_n_s_m;
    model.body_drag_n_s2_m2 = alone.body_drag_n_s2_m2;
    model.end_effector_m = alone.end_effector_m;
    model.center_m = alone.center_m;
    model.center_axis = alone.center_axis;
    model.has_fountain = has_fountain;
    for (int i = 0; i < model.rotor_count; ++i) {
        model.rotor[i] = alone.rotor[i];
    }
    for (int i = 0; i < n; ++i) {
        model.link[i] = detail::link_numbers(plant, i);
        model.total_mass_kg += model.link[i].mass_kg;
    }
    model.inverse_mass_1_kg = 1 / model.total_mass_kg;
    return model;
}

}  // namespace downwash

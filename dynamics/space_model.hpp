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
};

/// A link as plain numbers; see SpaceLink.
template <class T>
struct SpaceLinkNumbers {
    T mass_kg;
    dynamics::LaneVector<T> joint_m, axis, center_of_mass_m;
    dynamics::LaneSymmetric<T> inertia_kg_m2;
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
[[nodiscard]] DOWNWASH_EXPORT SpaceLinkNumbers<double> link_numbers(const SpaceLink& link);

}  // namespace detail

/// Prepares a plant in space.
/// @pre it has n links and at most max_rotors rotors; masses and inertias are positive, axes are not zero
template <int n>
[[nodiscard]] SpaceModel<n> make_space_model(const SpacePlant& plant) {
    SpaceModel<n> model{};
    SpaceNumbers<double, 0> alone{};
    detail::set_multirotor(plant, model, alone);
    model.multirotor_mass_kg = alone.multirotor_mass_kg;
    model.total_mass_kg = alone.multirotor_mass_kg;
    model.inertia_kg_m2 = alone.inertia_kg_m2;
    model.inverse_inertia_1_kg_m2 = alone.inverse_inertia_1_kg_m2;
    model.rotor_time_constant_s = alone.rotor_time_constant_s;
    model.power_coefficient_w_n1p5 = alone.power_coefficient_w_n1p5;
    for (int i = 0; i < model.rotor_count; ++i) {
        model.rotor[i] = alone.rotor[i];
    }
    for (int i = 0; i < n; ++i) {
        model.link[i] = detail::link_numbers(plant.links[static_cast<std::size_t>(i)]);
        model.total_mass_kg += model.link[i].mass_kg;
    }
    model.inverse_mass_1_kg = 1 / model.total_mass_kg;
    return model;
}

}  // namespace downwash

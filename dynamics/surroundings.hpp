#pragma once

#include <concepts>

#include "downwash/dynamics/plant_state.hpp"
#include "downwash/dynamics/slipstreams.hpp"

// What surrounds a vehicle in the plane: surfaces that change the thrust of its rotors, air that moves, things that it
// touches. One template over the lane type.

namespace downwash::dynamics {

/// Thrust ratios K = T / T_free around a vehicle: those that its rotors feel, or those that a control law reads.
/// - `thrust_ratio(rotor, hub_m, sin_pitch)`: K of a rotor with its hub there
/// - `same_as(rotor)`: the earliest rotor that is known to have the same K, perhaps that rotor itself
/// - `body_ratio(center_m, sin_pitch)`: K of the body with the centre between its rotors there; asked for where there
///   is a fountain
template <class S, class T>
concept ThrustRatios = requires(const S& around, int rotor, const PlanePoint<T>& at_m, const T& sin_pitch) {
    { around.thrust_ratio(rotor, at_m, sin_pitch) } -> std::same_as<T>;
    { around.same_as(rotor) } -> std::same_as<int>;
    { around.body_ratio(at_m, sin_pitch) } -> std::same_as<T>;
};

/// All that acts on a plant beside its own rotors and weight.
/// - `wall_nearness(center_m)`: from -1 (the vehicle touches a wall behind it) to 1 (ahead); asked for where there are
///   walls
/// - `thrust_scale(rotor)`: the thrust that a rotor really gives in free air over the nominal one
/// - `has_wind`: false where no drag acts; `wind()`: velocity of the air [m/s]
/// - `has_wash`: false where no slipstream meets the arm; `slipstreams()`: those of the rotors that may;
///   `wash_scale()`: their speed over that of the model. Asked for where drag acts
/// - `add_load(q, u, attitude, force)`: adds other generalised forces [N, N, N m, N m]
template <class S, class T>
concept Surroundings = ThrustRatios<S, T> &&
    requires(const S& around, int rotor, const PlanePoint<T>& at_m, const T* q, const Attitude<T>& attitude, T* force) {
    { around.wall_nearness(at_m) } -> std::same_as<T>;
    { around.thrust_scale(rotor) } -> std::same_as<T>;
    { S::has_wind } -> std::convertible_to<bool>;
    { around.wind() } -> std::same_as<PlanePoint<T>>;
    { S::has_wash } -> std::convertible_to<bool>;
    { around.slipstreams() } -> std::same_as<const Slipstreams&>;
    { around.wash_scale() } -> std::same_as<T>;
    around.add_load(q, q, attitude, force);
};

/// No air and nothing near. Other surroundings derive from this and hide the members that they change.
template <class T>
struct CalmSurroundings {
    T thrust_ratio(int /*rotor*/, const PlanePoint<T>& /*hub_m*/, const T& /*sin_pitch*/) const { return T(1); }
    [[nodiscard]] int same_as(int rotor) const { return rotor; }
    T body_ratio(const PlanePoint<T>& /*center_m*/, const T& /*sin_pitch*/) const { return T(1); }
    T wall_nearness(const PlanePoint<T>& /*center_m*/) const { return T(0); }
    T thrust_scale(int /*rotor*/) const { return T(1); }
    static constexpr bool has_wind = false;
    PlanePoint<T> wind() const { return {T(0), T(0)}; }
    static constexpr bool has_wash = false;
    [[nodiscard]] const Slipstreams& slipstreams() const { return no_slipstreams; }
    T wash_scale() const { return T(1); }
    void add_load(const T* /*q*/, const T* /*u*/, const Attitude<T>& /*attitude*/, T* /*force*/) const {}
};

}  // namespace downwash::dynamics

#pragma once

#include <concepts>

#include "downwash/dynamics/space_body.hpp"
#include "downwash/dynamics/space_slipstreams.hpp"

// What surrounds a vehicle in space: surfaces that change the thrust of its rotors, air that moves, things that it
// touches. One template over the lane type.

namespace downwash::dynamics {

/// All that acts on a plant in space beside its own rotors and weight. Places and directions are in the world. What
/// does not depend on a place may be of type double, if all lanes share it.
/// - `thrust_ratio(rotor, hub_m, axis)`: K = T / T_free of a rotor with its hub there, which pushes along that unit
///   vector
/// - `thrust_scale(rotor)`: the thrust that a rotor really gives in free air over the nominal one
/// - `body_ratio(center_m, axis)`: K of the body with the centre between its rotors there, and their mean axis; asked
///   for where there is a fountain
/// - `wall_nearness(center_m)`: level vector towards the nearest wall, of length 1 where a rotor touches it and less
///   with distance; asked for where there are walls
/// - `has_wind`: false where no drag acts; `wind()`: velocity of the air [m/s]
/// - `has_wash`: false where no slipstream meets a link; `slipstreams()`: those of the rotors that may;
///   `wash_scale()`: their speed over that of the model. Asked for where drag acts
/// - `drag_pieces`: see link_drag()
/// - `add_load(q, u, places, load)`: adds other loads
template <class S, class T>
concept SpaceSurroundings = requires(const S& around, int rotor, const LaneVector<T>& at_m, const T* q,
                                     const SpacePlaces<T, 1>& places, SpaceLoad<T, 1>& load) {
    { around.thrust_ratio(rotor, at_m, at_m) } -> std::same_as<T>;
    { T(around.thrust_scale(rotor)) } -> std::same_as<T>;
    { around.body_ratio(at_m, at_m) } -> std::same_as<T>;
    { around.wall_nearness(at_m) } -> std::same_as<LaneVector<T>>;
    { S::has_wind } -> std::convertible_to<bool>;
    { spread<T>(around.wind()) } -> std::same_as<LaneVector<T>>;
    { S::has_wash } -> std::convertible_to<bool>;
    { S::drag_pieces } -> std::convertible_to<int>;
    { around.slipstreams() } -> std::same_as<const SpaceSlipstreams&>;
    { T(around.wash_scale()) } -> std::same_as<T>;
    around.add_load(q, q, places, load);
};

/// Surroundings in which thrust ratios depend on the attitude of the whole vehicle, as among the images of several
/// rotors. `at_attitude(attitude)` has `thrust_ratio()` and `body_ratio()` of that attitude; those of the surroundings
/// themselves are of a level vehicle that heads along x.
template <class S, class T>
concept TurningSurroundings = requires(const S& around, int rotor, const LaneVector<T>& at_m,
                                       const LaneRotation<T>& attitude) {
    { around.at_attitude(attitude).thrust_ratio(rotor, at_m, at_m) } -> std::same_as<T>;
    { around.at_attitude(attitude).body_ratio(at_m, at_m) } -> std::same_as<T>;
};

/// Surroundings as a vehicle with an attitude meets them: ask these for thrust_ratio() and body_ratio().
template <class T, SpaceSurroundings<T> Around>
[[gnu::always_inline]] inline decltype(auto) at_attitude(const Around& around,
                                                         [[maybe_unused]] const LaneRotation<T>& attitude) {
    if constexpr (TurningSurroundings<Around, T>) {
        return around.at_attitude(attitude);
    } else {
        return static_cast<const Around&>(around);
    }
}

/// Sine of the angle between an axis and the vertical: what tilted() in effects/sided_factor.hpp takes.
/// @param axis of length 1, in the world
template <class T>
T sine_of_tilt(const LaneVector<T>& axis) {
    return lane::sqrt(axis.x * axis.x + axis.y * axis.y);
}

/// Nothing near, and air without drag. Other surroundings derive from this and hide the members that they change.
struct CalmSpace {
    template <class T>
    T thrust_ratio(int /*rotor*/, const LaneVector<T>& /*hub_m*/, const LaneVector<T>& /*axis*/) const {
        return T(1);
    }
    [[nodiscard]] double thrust_scale(int /*rotor*/) const { return 1; }
    template <class T>
    T body_ratio(const LaneVector<T>& /*center_m*/, const LaneVector<T>& /*axis*/) const {
        return T(1);
    }
    template <class T>
    LaneVector<T> wall_nearness(const LaneVector<T>& /*center_m*/) const {
        return {T(0), T(0), T(0)};
    }
    static constexpr bool has_wind = false;
    [[nodiscard]] LaneVector<double> wind() const { return {0, 0, 0}; }
    static constexpr bool has_wash = false;
    static constexpr int drag_pieces = 1;
    [[nodiscard]] const SpaceSlipstreams& slipstreams() const { return no_space_slipstreams; }
    [[nodiscard]] double wash_scale() const { return 1; }
    template <class T, int n>
    void add_load(const T* /*q*/, const T* /*u*/, const SpacePlaces<T, n>& /*places*/,
                  SpaceLoad<T, n>& /*load*/) const {}
};

}  // namespace downwash::dynamics

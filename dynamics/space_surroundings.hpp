#pragma once

#include <concepts>

#include "downwash/dynamics/space_body.hpp"

// What surrounds a vehicle in space. One template over the lane type.

namespace downwash::dynamics {

/// All that acts on a plant in space beside its own rotors and weight.
/// - `thrust_ratio(rotor, hub_m)`: K = T / T_free of a rotor with its hub there in the world
/// - `add_load(q, u, attitude, wrench)`: adds what touches the multirotor
template <class S, class T>
concept SpaceSurroundings = requires(const S& around, const LaneVector<T>& hub_m, const T* q,
                                     const LaneRotation<T>& attitude, SpaceWrench<T>& wrench) {
    { around.thrust_ratio(0, hub_m) } -> std::same_as<T>;
    around.add_load(q, q, attitude, wrench);
};

/// Nothing but air. Other surroundings derive from this and hide the members that they change.
struct CalmSpace {
    template <class T>
    T thrust_ratio(int /*rotor*/, const LaneVector<T>& /*hub_m*/) const {
        return T(1);
    }
    template <class T>
    void add_load(const T* /*q*/, const T* /*u*/, const LaneRotation<T>& /*attitude*/,
                  SpaceWrench<T>& /*wrench*/) const {}
};

}  // namespace downwash::dynamics

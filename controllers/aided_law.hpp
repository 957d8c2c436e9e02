#pragma once

#include <concepts>

#include "downwash/controllers/actuation.hpp"
#include "downwash/controllers/aids.hpp"
#include "downwash/controllers/reference_point.hpp"
#include "downwash/controllers/rest.hpp"
#include "downwash/dynamics/plant_model.hpp"

// A control law with an observer, a feed-forward, or both. A type of its own: laws without them are compiled as if
// there were none. aided_control.hpp has its arithmetic, one template over the lane type.

namespace downwash::controllers {

/// A law that can have aids.
template <class Law>
concept CanBeAided = requires(const Law& law) {
    { law.aids } -> std::convertible_to<const Aids&>;
};

/// A law that has `aids`, flown with them.
template <CanBeAided Law>
struct Aided {
    const Law& law;

    /// What the law remembers, and its observer.
    template <class T>
    struct Memory {
        typename Law::template Memory<T> loops;
        T observed[4];  ///< see Observation
    };

    /// The memory with which a flight starts in a state of the nominal plant.
    template <class T>
    [[nodiscard]] Memory<T> rested(const PlantModel& nominal, const dynamics::PlantState<T>& state,
                                   double tick_s) const;

    /// A memory whose integrals stand still. The observer goes on: see hold_estimate().
    template <class T>
    [[nodiscard]] static Memory<T> with_integrals_of(const Memory<T>& before, Memory<T> now) {
        now.loops = Law::with_integrals_of(before.loops, now.loops);
        return now;
    }

    /// Lets the observer estimate at the next tick what it estimated at this one, whatever pushes in between.
    /// @param before memory of this tick   @param change of the nominal momentum over the tick
    template <class T>
    void hold_estimate(const Memory<T>& before, const T change[4], double tick_s, Memory<T>& now) const;

    /// One control step: that of the law. @param map what its feed-forward reads, dynamics::ThrustRatios
    template <class T, class Map>
    Memory<T> control(const PlantModel& nominal, const dynamics::PlantState<T>& seen, const dynamics::Motion<T>& motion,
                      const Memory<T>& memory, const BasicReferencePoint<T>& reference, double tick_s,
                      Actuation<T>& given, const Map& map) const;

    /// The equilibrium of the law. An observer settles at what is missing in the balance c = Q + D.
    [[nodiscard]] Rest<Memory> rest(const PlantModel& nominal, const dynamics::EquationsOfMotion<double>& equations,
                                    RestingCommand command) const;
};

/// Whether this type is that of a law with its aids.
template <class Flown>
inline constexpr bool is_aided = false;
template <class Law>
inline constexpr bool is_aided<Aided<Law>> = true;

}  // namespace downwash::controllers

#pragma once

#include <algorithm>
#include <type_traits>
#include <variant>

#include "downwash/base/numbers.hpp"
#include "downwash/controllers/space_law.hpp"
#include "downwash/controllers/space_law_model.hpp"
#include "downwash/dynamics/space_slipstreams.hpp"
#include "downwash/dynamics/space_step.hpp"
#include "downwash/effects/sided_factor.hpp"
#include "downwash/simulation/space_world.hpp"

// What a control tick in space does not change, and what it does. tick_model.hpp and vehicle_state.hpp have that of the
// plane.

namespace downwash::simulation {

/// The numbers of the largest memory among laws.
template <int n, class... Laws>
constexpr int max_space_memory(const std::variant<Laws...>* /*laws*/) {
    return std::max({number_count<double, typename Laws::template Memory<double, n>>...});
}

/// What the law of a flight remembers, whichever it is: the numbers of its memory, then zeros.
template <class T, int n>
struct SpaceLawMemory {
    T number[max_space_memory<n>(static_cast<const SpaceLaw*>(nullptr))];
};

/// Reads the memory of one law.
template <class Law, class T, int n>
[[nodiscard, gnu::always_inline]] inline typename Law::template Memory<T, n> recalled(const SpaceLawMemory<T, n>& all) {
    using Memory = typename Law::template Memory<T, n>;
    Memory own;
    for (int i = 0; i < number_count<T, Memory>; ++i) {
        set_number_at(own, i, all.number[i]);
    }
    return own;
}

/// Writes the memory of one law.
template <class T, int n, class Memory>
[[gnu::always_inline]] inline void remember(const Memory& memory, SpaceLawMemory<T, n>& all) {
    constexpr int own = number_count<T, Memory>;
    for (int i = 0; i < own; ++i) {
        all.number[i] = number_at<T>(memory, i);
    }
    for (int i = own; i < number_count<T, SpaceLawMemory<T, n>>; ++i) {
        all.number[i] = T(0);
    }
}

/// What the plain tick changes: bodies, rotor lag, energy, and what the law remembers. Nothing but T: see
/// base/numbers.hpp.
template <class T, int n>
struct SpaceVehicle {
    dynamics::SpaceState<T, n> plant;
    SpaceLawMemory<T, n> memory;
};

/// Everything about the vehicle that changes in flight, with what its world remembers. Nothing but T; of a flight one
/// lane wide also the older motions of SpaceFlightMemory.
template <class T, int n>
struct SpaceFlightState : SpaceVehicle<T, n> {
    std::conditional_t<std::is_same_v<T, double>, SpaceFlightMemory<n>, SpaceWorldMemory<T, n>> world;
};

/// What the controller gives in a tick.
template <class T, int n>
struct SpaceActuation {
    dynamics::SpaceCommand<T, n> command;
    T saturation;  ///< greatest demand over its limit; more than 1 when something had to be clipped
};

/// Everything about the vehicle that does not change in flight.
template <int n>
struct SpaceTickModel {
    SpaceLawModel<n> nominal;  ///< plant and limits: the controller knows them, and they fly in the nominal world
    SpaceLaw law;
    double tick_s;  ///< control period, 1 / rate_hz
    TiltLoss tilt_loss = {};
    SpaceSlipstreams slipstreams = {};  ///< on the links, in the nominal world and in others
};

}  // namespace downwash::simulation

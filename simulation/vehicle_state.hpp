#pragma once

#include <cstddef>
#include <type_traits>

#include "downwash/base/export.hpp"
#include "downwash/base/numbers.hpp"
#include "downwash/controllers/control_law.hpp"
#include "downwash/dynamics/plant_state.hpp"
#include "downwash/simulation/flight_memory.hpp"
#include "downwash/simulation/world_numbers.hpp"

namespace downwash {
namespace simulation {

/// What the plain tick changes: bodies, rotor lag, energy, and every integrator. Nothing but T: see base/numbers.hpp.
template <class T>
struct VehicleState {
    dynamics::PlantState<T> plant;
    controllers::LawMemory<T> memory;
};

/// Everything about the vehicle that changes in flight, with what its world remembers. Nothing but T; of a flight one
/// lane wide also the older motions of FlightMemory.
template <class T>
struct State : VehicleState<T> {
    /// The plain tick leaves it as it is.
    std::conditional_t<std::is_same_v<T, double>, FlightMemory, WorldMemory<T>> world;
};

/// How many numbers a state has without older motions.
inline constexpr int state_numbers = number_count<bool, State<bool>>;

static_assert(sizeof(State<double>) == state_numbers * sizeof(double) + sizeof(decltype(FlightMemory::older)));

}  // namespace simulation

/// The state of a flight, one lane wide.
using FlightState = simulation::State<double>;

/// Whether two states are the same to the last bit; a state that remembers no older motions is no other than one whose
/// older motions are all its oldest.
[[nodiscard]] DOWNWASH_EXPORT bool is_same(const FlightState& a, const FlightState& b) noexcept;

namespace simulation {

/// How many numbers a state has with its older motions.
[[nodiscard]] inline int number_count_of(const FlightState& state) noexcept {
    return state_numbers + static_cast<int>(state.world.older.size()) * number_count<double, PastMotion<double>>;
}

/// One of them: those of the older motions come last.
[[nodiscard]] inline double number_of(const FlightState& state, int i) noexcept {
    constexpr int each = number_count<double, PastMotion<double>>;
    const int beyond = i - state_numbers;
    return beyond < 0 ? number_at<double>(state, i)
                      : number_at<double>(state.world.older[static_cast<std::size_t>(beyond / each)], beyond % each);
}

/// Replaces one of them.
inline void set_number_of(FlightState& state, int i, double number) noexcept {
    constexpr int each = number_count<double, PastMotion<double>>;
    const int beyond = i - state_numbers;
    if (beyond < 0) {
        set_number_at(state, i, number);
    } else {
        set_number_at(state.world.older[static_cast<std::size_t>(beyond / each)], beyond % each, number);
    }
}

}  // namespace simulation

}  // namespace downwash

#pragma once

namespace downwash {

/// What a flight adds up tick by tick, for objectives: numbers of the lane type only.
template <class T>
struct BasicFlightSums {
    T length_m{};  ///< integral of sqrt(dx^2 + dz^2 + (w darm)^2), w = half the arm's length
};

/// The sums of one flight.
using FlightSums = BasicFlightSums<double>;

}  // namespace downwash

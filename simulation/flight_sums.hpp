#pragma once

namespace downwash {

/// What a flight adds up tick by tick, for objectives: numbers of the lane type only.
template <class T>
struct BasicFlightSums {
    /// Integral of sqrt(dx^2 + dz^2 + (w darm)^2), w = half the arm's length; in space, where arms move in every way,
    /// that of the multirotor's centre of mass alone.
    T length_m{};
};

/// The sums of one flight.
using FlightSums = BasicFlightSums<double>;

}  // namespace downwash

#pragma once

// The step of the plants in space. That of the plant in the plane stands in flight_step.hpp: it takes from one stage to
// the next what it knows of the motion, and its energy is a sum of its own.

namespace downwash::dynamics {

/// Moves the first `count` numbers of y on by one classical Runge-Kutta step of fourth order.
/// @param rates (const T* y, T* rate): the derivatives of these numbers at y   @param dt_s > 0
template <class T, int size, class Rates>
void runge_kutta_step(T (&y)[size], int count, T dt_s, const Rates& rates) {
    constexpr double share_of_step[] = {0, 0.5, 0.5, 1};
    constexpr double weight[] = {1, 2, 2, 1};
    T at[size], rate[size] = {}, sum[size];
    for (int i = 0; i < size; ++i) {
        at[i] = y[i];
        sum[i] = T(0);
    }
    for (int stage = 0; stage < 4; ++stage) {
        for (int i = 0; i < count && stage > 0; ++i) {
            at[i] = y[i] + T(share_of_step[stage]) * dt_s * rate[i];
        }
        rates(at, rate);
        for (int i = 0; i < count; ++i) {
            sum[i] = sum[i] + T(weight[stage]) * rate[i];
        }
    }
    for (int i = 0; i < count; ++i) {
        y[i] = y[i] + dt_s * T(1.0 / 6.0) * sum[i];
    }
}

}  // namespace downwash::dynamics

#pragma once

#include <utility>

#include "downwash/dynamics/space_surroundings.hpp"
#include "downwash/dynamics/surroundings.hpp"

namespace downwash::test {

/// Still air far from everything.
using FreeAir = dynamics::CalmSurroundings<double>;
using FreeSpace = dynamics::CalmSpace;

/// Surroundings of nothing but thrust ratios. @tparam Ratio callable (rotor, x_m, z_m) -> K at a hub
template <class Ratio>
struct Ratios : dynamics::CalmSurroundings<double> {
    explicit Ratios(Ratio of_hub) : ratio(std::move(of_hub)) {}
    Ratio ratio;
    double thrust_ratio(int rotor, const dynamics::PlanePoint<double>& hub_m, double /*sin_pitch*/) const {
        return ratio(rotor, hub_m.x, hub_m.z);
    }
};

/// Surroundings of nothing but thrust ratios, in space. @tparam Ratio callable (rotor, x_m, y_m, z_m) -> K at a hub
template <class Ratio>
struct RatiosInSpace : dynamics::CalmSpace {
    explicit RatiosInSpace(Ratio of_hub) : ratio(std::move(of_hub)) {}
    Ratio ratio;
    template <class T>
    T thrust_ratio(int rotor, const dynamics::LaneVector<T>& hub_m, const dynamics::LaneVector<T>& /*axis*/) const {
        return ratio(rotor, hub_m.x, hub_m.y, hub_m.z);
    }
};

}  // namespace downwash::test

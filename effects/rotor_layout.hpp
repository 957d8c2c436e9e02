#pragma once

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"

namespace downwash {

/// The distances from one rotor of a vehicle to the others, in rotor radii in the rotor plane. Empty: a single rotor.
struct RotorNeighbours {
    std::vector<double> distances_radii;  ///< to every other rotor's axis, ascending
    double center_radii = 0;              ///< mean distance of all rotors' axes from their centre

    [[nodiscard]] std::size_t rotors() const noexcept { return distances_radii.size() + 1; }
    friend bool operator==(const RotorNeighbours&, const RotorNeighbours&) = default;
};

/// The neighbours of rotor `which` at these hubs (body frame, metres; z does not count). Distances are rounded to 1e-9
/// of a radius, so that the rotors of a symmetric vehicle agree. @pre radius_m > 0
[[nodiscard]] DOWNWASH_EXPORT RotorNeighbours neighbours_of(const std::vector<Vector3>& hubs_m, std::size_t which,
                                                            double radius_m);

/// Of any rotor of a square quadrotor with adjacent axes `spacing_radii` apart.
[[nodiscard]] DOWNWASH_EXPORT RotorNeighbours square_quadrotor(double spacing_radii);

}  // namespace downwash

#pragma once

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"

namespace downwash {

/// Where the other rotors of a level vehicle are as seen from one of them, in rotor radii. Empty: a single rotor.
struct RotorNeighbours {
    /// A horizontal vector in world axes.
    struct Offset {
        double x, y;
        friend bool operator==(const Offset&, const Offset&) = default;
    };

    std::vector<double> distances_radii;  ///< distances to the other rotors, ascending
    std::vector<Offset> offsets_radii;    ///< offsets of the same rotors, in the same order
    double center_radii = 0;              ///< mean distance of all rotors from their centre

    [[nodiscard]] std::size_t rotors() const noexcept { return distances_radii.size() + 1; }
    friend bool operator==(const RotorNeighbours&, const RotorNeighbours&) = default;
};

/// The neighbours of rotor `which` at these hubs (body frame, metres; z does not count). Distances are rounded to 1e-9
/// of a radius, so that all rotors of a symmetric vehicle get equal values.
/// @param heading_rad of the vehicle: the angle from the world's x axis to the body's   @pre radius_m > 0
[[nodiscard]] DOWNWASH_EXPORT RotorNeighbours neighbours_of(const std::vector<Vector3>& hubs_m, std::size_t which,
                                                            double radius_m, double heading_rad = 0);

/// The neighbours of any rotor of a square quadrotor with adjacent axes `spacing_radii` apart.
[[nodiscard]] DOWNWASH_EXPORT RotorNeighbours square_quadrotor(double spacing_radii);

}  // namespace downwash

#pragma once

// Private to simulation/: what of an obstacle's surface a contact may touch.

#include <vector>

#include "downwash/base/vector3.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/simulation/space_goal.hpp"

namespace downwash::simulation {

/// A triangle of an obstacle's surface, seen from the side that n points to.
struct Facet {
    Vector3 corner_m, first_m, second_m;  ///< a corner, and the way from it to both others
    Vector3 n;
    double area_until_m2;  ///< of this one and all before
    bool has_two_sides;

    [[nodiscard]] Vector3 middle_m() const { return corner_m + (1.0 / 3) * (first_m + second_m); }
    /// A point of it about as near to another point as any.
    [[nodiscard]] Vector3 nearest_m(const Vector3& to_m) const;
};

/// The triangles of some obstacles that a contact may touch: near enough to its place, and facing down where the frame
/// touches.
[[nodiscard]] std::vector<Facet> facets_of(const SpaceContactGoal& goal, const std::vector<Obstacle>& obstacles);

}  // namespace downwash::simulation

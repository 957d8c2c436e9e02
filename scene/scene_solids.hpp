#pragma once

// What scene/ knows about the placed obstacles beyond the public header. Private: not installed.

#include <string>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/scene/parts.hpp"
#include "downwash/scene/surface_facts.hpp"

namespace downwash {

/// Everything in the world frame N.
struct SceneSolids {
    /// The pieces of a mesh without a rim, which are solid: `first` to `last` - 1 of Parts::triangles.
    struct ClosedSurface {
        std::size_t first, last;
        BoundingBox bounds;
    };

    std::vector<Obstacle> obstacles;
    std::vector<BoundingBox> bounds;  ///< tight boxes of the obstacles
    std::vector<SurfaceFacts> facts;  ///< of the obstacles
    Parts parts;
    std::vector<ClosedSurface> closed_surfaces;

    /// Whether a solid is nearer than `distance_m` to an obstacle, is in contact with one or lies inside a closed mesh.
    [[nodiscard]] bool are_near(const Convex& solid, double distance_m) const;

    /// Distance from a solid to the nearest obstacle [m] if it is below `enough_m`, else `enough_m`; <= 0 on contact
    /// and inside a closed mesh.
    [[nodiscard]] double clearance_m(const Convex& solid, double enough_m) const;

    /// Whether a point lies inside a closed mesh. Points on its surface may count as either.
    [[nodiscard]] bool is_inside_mesh(const Vector3& p_m) const noexcept {
        return !closed_surfaces.empty() && is_inside_closed_surface(p_m);
    }

 private:
    [[nodiscard]] bool is_inside_closed_surface(const Vector3& p_m) const noexcept;
};

/// Adds what is wrong with the sizes of a shape, under keys such as `key`.box.size_m.
void inspect(const Primitive& shape, const std::string& key, std::vector<KeyError>& errors);

}  // namespace downwash

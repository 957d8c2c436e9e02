#pragma once

// Private to aeromap.

#include <cstddef>
#include <vector>

#include "downwash/scene/scene.hpp"
#include "downwash/scene/shadow_outline.hpp"

namespace downwash {

/// One part of an obstacle as rotors see it from above or below. World coordinates, metres.
struct Footprint {
    Footprint(const Scene& scene, std::size_t which);

    /// Whether the part's bounding box reaches into the vertical column through the level disc around (x, y).
    [[nodiscard]] bool meets_column(double x, double y, double radius) const noexcept;

    /// Whether the shadow holds the whole disc. Only asked of level parts, false for others.
    [[nodiscard]] bool covers_disc(double x, double y, double radius) const noexcept;

    std::size_t part;
    Scene::Bounds bounds;
    bool is_level;                 ///< see Scene::is_level
    bool has_plane_faces = false;  ///< a box or a triangle
    ShadowOutline outline;
    /// A plane face as heights over the ground: z = z_m + gx x + gy y.
    struct Plane {
        double z_m, gx, gy;
    };
    std::vector<Plane> upper_planes, lower_planes;  ///< seen from above and from below; of parts with plane faces

 private:
    /// The points with nx x + ny y <= reach.
    struct HalfPlane {
        double nx, ny, reach;
    };
    std::vector<HalfPlane> sides_;  ///< of a level box' or triangle's shadow
    double disc_radius_ = 0;        ///< of an upright cylinder's shadow; 0 for others
};

}  // namespace downwash

#pragma once

// Private to aeromap.

#include <atomic>
#include <cstddef>
#include <list>
#include <optional>
#include <span>
#include <vector>

#include "downwash/aeromap/part_columns.hpp"
#include "downwash/aeromap/row_columns.hpp"
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

    /// Whether the shadow is a polygon under a level face.
    [[nodiscard]] bool is_level_polygon() const noexcept { return !sides_.empty(); }

    /// The area of the shadow inside the disc [m^2], in closed form. @pre is_level_polygon()
    [[nodiscard]] double area_in_disc_m2(double x, double y, double radius) const noexcept;

    /// Scene::shadow_on_line, sooner. @pre is_level_polygon()
    [[nodiscard]] Interval shadow_on_line(double px, double py, double dx, double dy) const noexcept;

    /// Whether an edge of one of the two shadows has both on different sides; the edge itself may be shared.
    /// @pre both are level polygons
    [[nodiscard]] bool lies_beside(const Footprint& other) const noexcept;

    /// Whether discs among hubs in a box see the same of the part wherever they are along a level direction: it is a
    /// level polygon whose edges over those discs lead that way, or over none of them. False where that is not seen.
    /// @param dx,dy of length 1
    [[nodiscard]] bool is_same_along(double dx, double dy, const BoundingBox& hubs, double radius) const noexcept;

    std::size_t part;
    BoundingBox bounds;
    bool is_level;                 ///< see Scene::is_level
    bool has_plane_faces = false;  ///< a box or a triangle
    ShadowOutline outline;
    /// A plane face as heights over the ground: z = z_m + gx x + gy y.
    struct Plane {
        double z_m, gx, gy;
    };
    std::vector<Plane> upper_planes, lower_planes;  ///< seen from above and from below; of parts with plane faces

 private:
    /// A side of a convex polygon, from a to b with the inside on the left: nx x + ny y <= reach.
    struct Edge {
        double ax, ay, bx, by;
        double nx, ny, reach;
    };
    [[nodiscard]] bool has_side_before(const Footprint& other) const noexcept;

    std::vector<Edge> sides_;  ///< edges of the shadow of a level box or triangle
    double disc_radius_ = 0;   ///< radius of the shadow of an upright cylinder; 0 for others
};

/// The footprints of a scene's parts: those of primitives are made at once, those of triangles and boxes of octrees
/// when they are first asked for; in a scene of many parts all when they are first asked for. Safe to share between
/// threads.
class Footprints {
 public:
    /// A scene of more parts is one of many, in which discs are averaged over rows.
    static constexpr std::size_t few_parts = 2048;

    /// @param scene must live as long as this   @param radius_m of the discs
    Footprints(const Scene& scene, double radius_m);
    ~Footprints();
    Footprints(const Footprints&) = delete;
    Footprints& operator=(const Footprints&) = delete;

    /// The columns of a scene of many parts; nullptr in a scene of few.
    [[nodiscard]] const RowColumns* columns() const noexcept { return columns_ ? &*columns_ : nullptr; }

    /// The parts near discs, in any scene.
    [[nodiscard]] const PartColumns& part_columns() const noexcept { return part_columns_; }

    /// The footprints of the scene's first parts: Scene::primitive_count() of them, in a scene of many parts none.
    [[nodiscard]] std::span<const Footprint> of_primitives() const noexcept { return primitives_; }

    /// Whether these are all parts, and so few that each is asked sooner than those near a place are found.
    [[nodiscard]] bool are_few_primitives() const noexcept {
        constexpr std::size_t few = 16;
        return primitives_.size() <= few && others_.empty();
    }

    /// The footprint of a part that is not among the first ones. Kept for later while there is room, else put into
    /// `spare`.
    [[nodiscard]] const Footprint& of_other(std::size_t part, std::list<Footprint>& spare) const;

 private:
    using Kept = std::atomic<const Footprint*>;

    const Scene& scene_;
    PartColumns part_columns_;
    std::optional<RowColumns> columns_;
    std::vector<Footprint> primitives_;
    mutable std::vector<Kept> others_;  ///< null: not yet made
    mutable std::atomic<std::size_t> kept_{0};
};

}  // namespace downwash

#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <memory_resource>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/scene/bounding_box.hpp"
#include "downwash/scene/shapes.hpp"
#include "downwash/scene/surface_facts.hpp"

namespace downwash {

struct SceneSolids;

/// The obstacles of the world, placed once and never changed; safe to share between threads, and copies share them.
class DOWNWASH_EXPORT Scene {
 public:
    /// @throws InputError when a shape has a size that is not finite and positive, or an axis of no length; when a mesh
    /// or an octree has nothing in it, is not finite, refers to vertices it has not got, or the scene has more than
    /// 2,000,000 triangles and boxes. Triangles without area are left out.
    explicit Scene(std::vector<Obstacle> obstacles);

    [[nodiscard]] const std::vector<Obstacle>& obstacles() const noexcept;

    /// The bounding box of the obstacle of that number in obstacles().
    [[nodiscard]] const BoundingBox& bounds(std::size_t obstacle) const noexcept;

    /// What the scene made of that obstacle if it is a mesh; any other one counts as one solid piece.
    [[nodiscard]] const SurfaceFacts& facts(std::size_t obstacle) const noexcept;

    /// Obstacles consist of convex parts: a mesh of its triangles, an octree of boxes that fill what its cubes fill,
    /// any other is its own only part. Parts are numbered through; those of primitives come first, in the obstacles'
    /// order.
    [[nodiscard]] std::size_t part_count() const noexcept;

    /// The number in obstacles() of the obstacle that a part belongs to.
    [[nodiscard]] std::size_t obstacle_of(std::size_t part) const noexcept;

    /// What counts as free of octrees although no sensor saw it (Octomap::unknown), as a scene of its own; nullptr if
    /// there is none. Octrees without a free leaf do not tell. Made at the first call.
    [[nodiscard]] std::shared_ptr<const Scene> unseen_space() const;

    /// How many parts are primitives.
    [[nodiscard]] std::size_t primitive_count() const noexcept;

    /// Appends the parts whose bounding boxes meet a box, in no order.
    void add_parts_meeting(const BoundingBox& box, std::pmr::vector<std::size_t>& parts) const;

    /// Whether a part is a triangle, which has no inside.
    [[nodiscard]] bool is_triangle(std::size_t part) const noexcept;

    /// A plane face: three or four corners in order around it, in the world [m].
    struct Face {
        std::array<Vector3, 4> corners_m;
        std::size_t corner_count;
    };
    /// Appends the faces of a part with plane faces that are seen from above or from below, and returns true; false of
    /// cylinders and spheres. A triangle is seen from both.
    bool add_faces(std::size_t part, bool is_from_above, std::pmr::vector<Face>& faces) const;

    /// World-aligned bounding box of one part [m].
    [[nodiscard]] BoundingBox part_bounds(std::size_t part) const noexcept;

    /// Whether a part is seen from above: upright triangles are not.
    [[nodiscard]] bool has_shadow(std::size_t part) const noexcept;

    /// The stretch of the vertical line through world (x, y) that lies inside one part, as heights z [m]: a single
    /// height in a triangle. Upright triangles are not met.
    [[nodiscard]] Interval vertical_extent(std::size_t part, double x_m, double y_m) const noexcept;

    /// The stretch of the horizontal line p + s (dx, dy), |(dx, dy)| = 1, that lies in one part's vertical shadow (its
    /// projection onto the ground), in metres s. Upright triangles have none.
    [[nodiscard]] Interval shadow_on_line(std::size_t part, double px_m, double py_m, double dx,
                                          double dy) const noexcept;

    /// Whether one part's upper and lower faces are level planes over its whole shadow (a box without roll or pitch, an
    /// upright cylinder, a level triangle), so that its vertical extent is the same wherever it is above or below.
    [[nodiscard]] bool is_level(std::size_t part) const noexcept;

    /// The placed obstacles for the collision library; only scene/ looks inside.
    [[nodiscard]] const SceneSolids& solids() const noexcept;

 private:
    std::shared_ptr<const SceneSolids> solids_;
};

}  // namespace downwash

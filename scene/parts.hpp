#pragma once

// The convex parts that obstacles consist of, placed in the world. Private to scene/.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "downwash/scene/bounds_tree.hpp"
#include "downwash/scene/convex.hpp"
#include "downwash/scene/seen_from_above.hpp"
#include "downwash/scene/triangle.hpp"

namespace downwash {

/// A box of an octree.
struct OctreeBox {
    Vector3 center_m;      ///< centre in the world
    Vector3 size_m;        ///< along the axes of its octree
    std::uint32_t turned;  ///< which of Parts::octree_placements
};

/// Lists of parts, numbered through: first primitives, then boxes of octrees, then triangles. Primitives
/// keep what queries need; what the others need is worked out from the little that is kept of them.
struct Parts {
    std::vector<Primitive> primitives;
    std::vector<Vector3> primitive_centers_m;
    std::vector<Placement> primitive_placements;
    std::vector<Convex> primitive_convexes;
    std::vector<SeenFromAbove> primitives_from_above;
    std::vector<BoundingBox> primitive_bounds;  ///< tight

    std::vector<OctreeBox> octree_boxes;
    std::vector<Placement> octree_placements;

    std::vector<Triangle> triangles;

    void add(const Primitive& primitive, const Vector3& center_m, const Placement& placement);

    /// Makes the trees that `any` and `any_other` ask, when all parts are there.
    void index();

    /// BoundsTree::any over all parts, primitives first.
    template <class Gap, class Visit>
    bool any(const Gap& gap, const double& limit, const Visit& visit) const {
        return primitive_tree_.any(gap, limit, visit) || any_other(gap, limit, visit);
    }
    /// Visits the near parts that are no primitives. Their tree is one of its own: a ground or a deck would spoil its
    /// upper boxes.
    template <class Gap, class Visit>
    bool any_other(const Gap& gap, const double& limit, const Visit& visit) const {
        return other_tree_.any(gap, limit, [&](std::size_t other) { return visit(primitives.size() + other); });
    }

    [[nodiscard]] std::size_t first_octree_box() const noexcept { return primitives.size(); }
    [[nodiscard]] std::size_t first_triangle() const noexcept { return primitives.size() + octree_boxes.size(); }
    [[nodiscard]] std::size_t count() const noexcept { return first_triangle() + triangles.size(); }

    [[nodiscard]] BoundingBox bounds(std::size_t part) const noexcept {
        return part < primitive_bounds.size() ? primitive_bounds[part] : bounds_of_other(part);
    }
    /// Calls `use(convex)` with the part as a solid.
    template <class Use>
    auto with_convex(std::size_t part, const Use& use) const {
        return part < primitive_convexes.size() ? use(primitive_convexes[part]) : use(convex_of_other(part));
    }

    /// Calls one of `of_primitive(index)`, `of_box(box, its placement)` and `of_triangle(triangle)`.
    template <class OfPrimitive, class OfBox, class OfTriangle>
    auto visit(std::size_t part, const OfPrimitive& of_primitive, const OfBox& of_box,
               const OfTriangle& of_triangle) const {
        if (part < first_octree_box()) {
            return of_primitive(part);
        }
        if (part < first_triangle()) {
            const OctreeBox& box = octree_boxes[part - first_octree_box()];
            return of_box(box, octree_placements[box.turned]);
        }
        return of_triangle(triangles[part - first_triangle()]);
    }

 private:
    [[nodiscard]] Convex convex_of_other(std::size_t part) const noexcept;
    [[nodiscard]] BoundingBox bounds_of_other(std::size_t part) const noexcept;

    BoundsTree primitive_tree_;
    BoundsTree other_tree_;
};

}  // namespace downwash

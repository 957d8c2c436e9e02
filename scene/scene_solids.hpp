#pragma once

// What scene/ knows about the placed obstacles beyond the public header. Private: not installed.

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/scene/parts.hpp"
#include "downwash/scene/surface_facts.hpp"

namespace downwash {

class Scene;

/// An obstacle, by its number, and how near it is.
struct NearObstacle {
    std::size_t obstacle = 0;
    double distance_m = 0;  ///< <= 0 on contact and inside a closed mesh
};

/// Everything in the world frame N.
struct SceneSolids {
    /// The pieces of a mesh without a rim, which are solid: `first` to `last` - 1 of Parts::triangles.
    struct ClosedSurface {
        std::size_t first, last;
        BoundingBox bounds;
        std::size_t obstacle;
    };
    /// Triangles from `first` on belong to a mesh, up to those of the next.
    struct FirstTriangle {
        std::size_t first, obstacle;
    };

    std::vector<Obstacle> obstacles;
    std::vector<BoundingBox> bounds;  ///< tight boxes of the obstacles
    std::vector<SurfaceFacts> facts;  ///< of the obstacles
    Parts parts;
    std::vector<ClosedSurface> closed_surfaces;
    // Numbers of the obstacles that parts belong to.
    std::vector<std::size_t> obstacle_of_primitive;  ///< of Parts::primitives
    std::vector<std::size_t> obstacle_of_octree;     ///< of Parts::octree_placements
    std::vector<FirstTriangle> meshes;
    /// See Scene::unseen_space(); made when first asked for.
    mutable std::once_flag is_unseen_made;
    mutable std::shared_ptr<const Scene> unseen;

    /// Whether a solid is nearer than `distance_m` to an obstacle, is in contact with one or lies inside a closed mesh.
    [[nodiscard]] bool are_near(const Convex& solid, double distance_m) const;

    /// Distance from a solid to the nearest obstacle [m] if it is below `enough_m`, else `enough_m`; <= 0 on contact
    /// and inside a closed mesh.
    [[nodiscard]] double clearance_m(const Convex& solid, double enough_m) const;

    /// The obstacle nearest to a solid, if it is nearer than `within_m` or contains the solid's centre. Of several in
    /// contact, any.
    [[nodiscard]] std::optional<NearObstacle> nearest(const Convex& solid, double within_m) const;

    /// Whether a point lies inside a closed mesh. Points on its surface may count as either.
    [[nodiscard]] bool is_inside_mesh(const Vector3& p_m) const noexcept {
        return !closed_surfaces.empty() && surface_around(p_m) != nullptr;
    }

    /// The number of the obstacle that a part belongs to.
    [[nodiscard]] std::size_t obstacle_of(std::size_t part) const noexcept;

 private:
    /// A closed surface with the point inside; nullptr if there is none.
    [[nodiscard]] const ClosedSurface* surface_around(const Vector3& p_m) const noexcept;
};

/// Adds what is wrong with the sizes of a shape, under keys such as `key`.box.size_m.
void inspect(const Primitive& shape, const std::string& key, std::vector<KeyError>& errors);

}  // namespace downwash

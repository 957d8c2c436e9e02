#pragma once

// Meshes and octrees of shapes that are known otherwise.

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "downwash/scene/shapes.hpp"

namespace downwash::test {

inline Mesh mesh_of(std::vector<Vector3> vertices_m, std::vector<std::array<std::uint32_t, 3>> triangles) {
    return {"", 1, std::make_shared<const TriangleMesh>(TriangleMesh{std::move(vertices_m), std::move(triangles)})};
}

/// Twelve triangles. Vertex i has its coordinates at the high end where i has bits 1 (x), 2 (y) and 4 (z).
inline Mesh box_mesh(const Vector3& size_m) {
    std::vector<Vector3> vertices;
    for (unsigned i = 0; i < 8; ++i) {
        const auto end = [&](unsigned bit, std::size_t k) { return ((i & bit) != 0 ? 0.5 : -0.5) * size_m[k]; };
        vertices.push_back({end(1, 0), end(2, 1), end(4, 2)});
    }
    return mesh_of(std::move(vertices), {{0, 2, 1},
                                         {1, 2, 3},
                                         {4, 5, 6},
                                         {5, 7, 6},
                                         {0, 1, 4},
                                         {1, 5, 4},
                                         {2, 6, 3},
                                         {3, 6, 7},
                                         {0, 4, 2},
                                         {2, 4, 6},
                                         {1, 3, 5},
                                         {3, 7, 5}});
}

/// The mesh with its surface changed by `edit`.
template <class Edit>
Mesh edited(const Mesh& mesh, const Edit& edit) {
    TriangleMesh surface = *mesh.surface;
    edit(surface);
    return {"", mesh.scale, std::make_shared<const TriangleMesh>(std::move(surface))};
}

/// The same surface with the inside out.
inline Mesh reversed(const Mesh& mesh) {
    return edited(mesh, [](TriangleMesh& surface) {
        for (auto& triangle : surface.triangles) {
            std::swap(triangle[1], triangle[2]);
        }
    });
}

/// Every vertex elsewhere.
inline Mesh moved(const Mesh& mesh, const Vector3& by_m) {
    return edited(mesh, [&by_m](TriangleMesh& surface) {
        for (Vector3& vertex : surface.vertices_m) {
            vertex = {vertex[0] + by_m[0], vertex[1] + by_m[1], vertex[2] + by_m[2]};
        }
    });
}

/// Every vertex with its coordinates times those of `by`: flattened or mirrored.
inline Mesh stretched(const Mesh& mesh, const Vector3& by) {
    return edited(mesh, [&by](TriangleMesh& surface) {
        for (Vector3& vertex : surface.vertices_m) {
            vertex = {vertex[0] * by[0], vertex[1] * by[1], vertex[2] * by[2]};
        }
    });
}

/// Both surfaces as one mesh.
inline Mesh joined(const Mesh& a, const Mesh& b) {
    return edited(a, [&b](TriangleMesh& surface) {
        const auto offset = static_cast<std::uint32_t>(surface.vertices_m.size());
        surface.vertices_m.insert(surface.vertices_m.end(), b.surface->vertices_m.begin(), b.surface->vertices_m.end());
        for (const auto& [i, j, k] : b.surface->triangles) {
            surface.triangles.push_back({i + offset, j + offset, k + offset});
        }
    });
}

/// Without the triangles from `count` on.
inline Mesh first_triangles(const Mesh& mesh, std::size_t count) {
    return edited(mesh, [count](TriangleMesh& surface) { surface.triangles.resize(count); });
}

/// Triangles that share no corner.
inline Mesh soup_of(const std::vector<std::array<Vector3, 3>>& all) {
    TriangleMesh surface;
    for (const auto& corners : all) {
        const auto first = static_cast<std::uint32_t>(surface.vertices_m.size());
        surface.vertices_m.insert(surface.vertices_m.end(), corners.begin(), corners.end());
        surface.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh_of(std::move(surface.vertices_m), std::move(surface.triangles));
}

/// A closed cylinder along y; vertices lie on it: 2 around (along + 1) triangles.
inline Mesh pipe_mesh(double radius_m, double length_m, std::uint32_t around, std::uint32_t along) {
    std::vector<Vector3> vertices;
    for (std::uint32_t j = 0; j <= along; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const double angle = 2 * 3.14159265358979323846 * i / around;
            vertices.push_back({radius_m * std::sin(angle), length_m * (static_cast<double>(j) / along - 0.5),
                                radius_m * std::cos(angle)});
        }
    }
    const auto low_end = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back({0, -0.5 * length_m, 0});
    vertices.push_back({0, 0.5 * length_m, 0});
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i < around; ++i) {
        const std::uint32_t next = (i + 1) % around;
        for (std::uint32_t j = 0; j < along; ++j) {
            const std::uint32_t row = j * around;
            triangles.push_back({row + i, row + around + i, row + next});
            triangles.push_back({row + next, row + around + i, row + around + next});
        }
        triangles.push_back({low_end, i, next});
        triangles.push_back({low_end + 1, along * around + next, along * around + i});
    }
    return mesh_of(std::move(vertices), std::move(triangles));
}

/// The cubes of a grid between `low_m` and `high_m` (multiples of the side) whose centres are occupied.
inline Octomap octree_of(const std::function<bool(const Vector3&)>& is_occupied, const Vector3& low_m,
                         const Vector3& high_m, double side_m) {
    OccupancyTree tree{side_m, {}};
    const auto count = [&](std::size_t k) { return std::lround((high_m[k] - low_m[k]) / side_m); };
    for (long i = 0; i < count(0); ++i) {
        for (long j = 0; j < count(1); ++j) {
            for (long k = 0; k < count(2); ++k) {
                const auto at = [&](std::size_t axis, long n) {
                    return low_m[axis] + (static_cast<double>(n) + 0.5) * side_m;
                };
                const Vector3 center{at(0, i), at(1, j), at(2, k)};
                if (is_occupied(center)) {
                    tree.cubes.push_back({center, side_m});
                }
            }
        }
    }
    return {"", std::make_shared<const OccupancyTree>(std::move(tree))};
}

}  // namespace downwash::test

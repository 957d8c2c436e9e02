#include "downwash/scene/mesh_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "downwash/scene/scene_solids.hpp"

namespace downwash {
namespace {

/// Farther from its own origin no corner is of use, and squares stay finite.
constexpr double farthest_m = 1e6;

Triangle corners_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    const auto corner = [&](std::size_t i) { return mesh.scale * mesh.surface->vertices_m[triangle[i]]; };
    return {corner(0), corner(1), corner(2)};
}

bool has_area(const Triangle& triangle) {
    return normal_of(triangle) != Vector3{};
}

}  // namespace

void inspect(const Mesh& mesh, const std::string& key, std::vector<KeyError>& errors) {
    const auto require = [&](bool holds, const std::string& name, const std::string& message) {
        if (!holds) {
            errors.push_back({key + name, message});
        }
        return holds;
    };
    const bool has_scale =
        require(std::isfinite(mesh.scale) && mesh.scale > 0, ".mesh.scale", "must be a finite number above 0");
    if (!has_scale || !require(mesh.surface != nullptr, ".mesh.file", "must have been read: there is no surface")) {
        return;
    }
    const TriangleMesh& surface = *mesh.surface;
    const auto is_near = [&](const Vector3& v) {
        return std::all_of(v.begin(), v.end(), [&](double x) { return std::abs(mesh.scale * x) <= farthest_m; });
    };
    const auto is_known = [&](const std::array<std::uint32_t, 3>& triangle) {
        return std::all_of(triangle.begin(), triangle.end(),
                           [&](std::uint32_t corner) { return corner < surface.vertices_m.size(); });
    };
    const auto has_extent = [&](const std::array<std::uint32_t, 3>& triangle) {
        return has_area(corners_of(mesh, triangle));
    };
    const auto& triangles = surface.triangles;
    if (require(triangles.size() <= max_pieces, ".mesh.file",
                "has " + std::to_string(triangles.size()) + " triangles: at most " + std::to_string(max_pieces) +
                    " are allowed") &&
        require(std::all_of(surface.vertices_m.begin(), surface.vertices_m.end(), is_near), ".mesh.file",
                "has a vertex that is not finite or, once scaled, farther than 1e6 m from its origin") &&
        require(std::all_of(triangles.begin(), triangles.end(), is_known), ".mesh.file",
                "has a triangle with a corner that is not among its vertices")) {
        require(std::any_of(triangles.begin(), triangles.end(), has_extent), ".mesh.file",
                "has no triangle with an area");
    }
}

std::vector<Triangle> scaled_triangles(const Mesh& mesh, const std::vector<bool>& is_turned) {
    const auto& triangles = mesh.surface->triangles;
    std::vector<Triangle> all;
    all.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        Triangle corners = corners_of(mesh, triangles[i]);
        if (has_area(corners)) {
            if (!is_turned.empty() && is_turned[i]) {
                std::swap(corners[1], corners[2]);
            }
            all.push_back(corners);
        }
    }
    return all;
}

}  // namespace downwash

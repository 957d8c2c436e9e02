#include "downwash/scene/solid_surface.hpp"

#include <cmath>
#include <variant>

#include "downwash/base/lane_math.hpp"
#include "downwash/scene/obstacle_placement.hpp"

namespace downwash {
namespace {

constexpr double whole_turn_rad = 6.283185307179586;

Vector3 on_circle(std::uint32_t i, std::uint32_t sides) {
    const auto [sine, cosine] = lane::sin_cos(whole_turn_rad * i / sides);
    return {cosine, sine, 0};
}

/// Builds surfaces in a shape's own frame.
class SurfaceBuilder {
 public:
    void add_box(const Vector3& center_m, const Vector3& size_m) {
        const auto first = static_cast<std::uint32_t>(surface.vertices_m.size());
        for (std::uint32_t corner = 0; corner < 8; ++corner) {
            Vector3 vertex_m = center_m;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                vertex_m[axis] += ((corner >> axis) & 1U) != 0 ? size_m[axis] / 2 : -size_m[axis] / 2;
            }
            surface.vertices_m.push_back(vertex_m);
        }
        constexpr std::uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                               {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
        for (const auto& face : faces) {
            surface.triangles.push_back({first + face[0], first + face[1], first + face[2]});
            surface.triangles.push_back({first + face[0], first + face[2], first + face[3]});
        }
    }

    /// From `low_m` to `high_m` along z.
    void add_upright_cylinder(double radius_m, double low_m, double high_m, std::uint32_t sides) {
        surface.vertices_m = {{0, 0, low_m}, {0, 0, high_m}};
        for (std::uint32_t i = 0; i < sides; ++i) {
            const Vector3 rim = on_circle(i, sides);
            surface.vertices_m.push_back({radius_m * rim[0], radius_m * rim[1], low_m});
            surface.vertices_m.push_back({radius_m * rim[0], radius_m * rim[1], high_m});
        }
        for (std::uint32_t i = 0; i < sides; ++i) {
            const std::uint32_t here = 2 + 2 * i, next = 2 + 2 * ((i + 1) % sides);
            surface.triangles.insert(
                surface.triangles.end(),
                {{0, next, here}, {1, here + 1, next + 1}, {here, next, next + 1}, {here, next + 1, here + 1}});
        }
    }

    void add_sphere(double radius_m) {
        constexpr std::uint32_t rings = 24, sides = 48;
        surface.vertices_m = {{0, 0, -radius_m}, {0, 0, radius_m}};
        for (std::uint32_t ring = 1; ring < rings; ++ring) {
            const auto [sine, cosine] = lane::sin_cos(whole_turn_rad / 2 * ring / rings);
            for (std::uint32_t i = 0; i < sides; ++i) {
                const Vector3 rim = on_circle(i, sides);
                surface.vertices_m.push_back({radius_m * sine * rim[0], radius_m * sine * rim[1], -radius_m * cosine});
            }
        }
        const auto vertex = [](std::uint32_t ring, std::uint32_t i) { return 2 + (ring - 1) * sides + i % sides; };
        for (std::uint32_t i = 0; i < sides; ++i) {
            surface.triangles.push_back({0, vertex(1, i + 1), vertex(1, i)});
            for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
                surface.triangles.push_back({vertex(ring, i), vertex(ring, i + 1), vertex(ring + 1, i + 1)});
                surface.triangles.push_back({vertex(ring, i), vertex(ring + 1, i + 1), vertex(ring + 1, i)});
            }
            surface.triangles.push_back({1, vertex(rings - 1, i), vertex(rings - 1, i + 1)});
        }
    }

    void operator()(const Box& box) { add_box({0, 0, 0}, box.size_m); }
    void operator()(const Sphere& sphere) { add_sphere(sphere.radius_m); }
    void operator()(const Cylinder& cylinder) {
        constexpr std::uint32_t sides = 48;
        add_upright_cylinder(cylinder.radius_m, -cylinder.length_m / 2, cylinder.length_m / 2, sides);
        for (Vector3& vertex_m : surface.vertices_m) {
            vertex_m = along(cylinder.axis, vertex_m);
        }
    }
    void operator()(const Capsule& capsule) {
        const Vector3 way_m = capsule.to_m - capsule.from_m;
        const double length_m = std::hypot(way_m[0], way_m[1], way_m[2]);
        add_sphere(capsule.radius_m);
        for (Vector3& vertex_m : surface.vertices_m) {
            vertex_m[2] += vertex_m[2] < 0 ? -length_m / 2 : length_m / 2;
            vertex_m = 0.5 * (capsule.from_m + capsule.to_m) + (length_m > 0 ? along(way_m, vertex_m) : vertex_m);
        }
    }
    void operator()(const Mesh& mesh) {
        for (const Vector3& vertex : mesh.surface->vertices_m) {
            surface.vertices_m.push_back(local_m(mesh, vertex));
        }
        surface.triangles = mesh.surface->triangles;
    }
    void operator()(const Octomap& octomap) {
        for_each_solid_box(octomap, [this](const LocalBox& box) { add_box(box.center_m, box.size_m); });
    }

    TriangleMesh surface;

 private:
    /// A point of a frame whose z axis is turned into a direction, the shortest way.
    static Vector3 along(const Vector3& direction, const Vector3& own) {
        const double length = std::hypot(direction[0], direction[1], direction[2]);
        const Vector3 d{direction[0] / length, direction[1] / length, direction[2] / length};
        if (d[2] < 0) {  // the same solid the other way up, which keeps the division below sound
            return along({-direction[0], -direction[1], -direction[2]}, own);
        }
        const double k = 1 / (1 + d[2]);
        return {(1 - k * d[0] * d[0]) * own[0] - k * d[0] * d[1] * own[1] + d[0] * own[2],
                -k * d[0] * d[1] * own[0] + (1 - k * d[1] * d[1]) * own[1] + d[1] * own[2],
                -d[0] * own[0] - d[1] * own[1] + d[2] * own[2]};
    }
};

}  // namespace

TriangleMesh surface_of(const Obstacle& obstacle) {
    SurfaceBuilder builder;
    std::visit(builder, obstacle.shape);
    const Matrix3 rotation = rotation_of(obstacle.rpy_rad);
    for (Vector3& vertex_m : builder.surface.vertices_m) {
        vertex_m = obstacle.center_world_m + rotation * vertex_m;
    }
    return builder.surface;
}

TriangleMesh surface_of(const SpaceBodyShape& body) {
    SurfaceBuilder builder;
    std::visit(builder, body.shape);
    for (Vector3& vertex_m : builder.surface.vertices_m) {
        vertex_m = body.center_m + vertex_m;
    }
    return builder.surface;
}

TriangleMesh rod_surface(double length_m, double radius_m) {
    constexpr std::uint32_t sides = 24;
    SurfaceBuilder builder;
    builder.add_upright_cylinder(radius_m, 0, length_m, sides);
    for (Vector3& vertex_m : builder.surface.vertices_m) {
        vertex_m = {vertex_m[2], vertex_m[1], -vertex_m[0]};
    }
    return builder.surface;
}

}  // namespace downwash

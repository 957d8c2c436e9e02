#include "downwash/report/obstacle_outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <type_traits>
#include <utility>
#include <variant>

#include "downwash/base/lane_math.hpp"
#include "downwash/report/obstacle_frame.hpp"
#include "downwash/report/planar_geometry.hpp"

namespace downwash {
namespace {

constexpr std::size_t sides = 96;  // of a circle
constexpr double beside_everything_m = 1e7;

/// Sine and cosine of the corners of a circle.
const std::array<lane::SinCos, sides>& unit_circle() {
    static const auto corners = [] {
        constexpr double whole_turn_rad = 6.283185307179586;
        std::array<lane::SinCos, sides> made;
        for (std::size_t i = 0; i < sides; ++i) {
            made[i] = lane::sin_cos(whole_turn_rad * static_cast<double>(i) / sides);
        }
        return made;
    }();
    return corners;
}

/// A convex solid with flat faces; points are (x, lateral, z) in the plane's own coordinates.
struct Polyhedron {
    std::vector<Vector3> corners_m;
    std::vector<std::pair<std::size_t, std::size_t>> edges;
};

PlanePoint projected(const Vector3& point_m) {
    return {point_m[0], point_m[2]};
}

Ring projection(const std::vector<Vector3>& points_m) {
    std::vector<PlanePoint> points;
    points.reserve(points_m.size());
    for (const Vector3& point_m : points_m) {
        points.push_back(projected(point_m));
    }
    return convex_hull(std::move(points));
}

/// Empty when the plane lateral = 0 does not cut the solid.
Ring section(const Polyhedron& solid) {
    std::vector<PlanePoint> points;
    for (const auto& [from, to] : solid.edges) {
        const Vector3& a = solid.corners_m[from];
        const Vector3& b = solid.corners_m[to];
        if ((a[1] < 0) != (b[1] < 0)) {
            const double part = a[1] / (a[1] - b[1]);
            points.push_back({a[0] + part * (b[0] - a[0]), a[2] + part * (b[2] - a[2])});
        }
    }
    return points.empty() ? points : convex_hull(std::move(points));
}

Polyhedron box_at(const Vector3& center_m, const Vector3& size_m, const ObstacleFrame& frame) {
    Polyhedron solid;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const auto side = [&](std::size_t axis) { return ((corner >> axis) & 1U) != 0 ? 0.5 : -0.5; };
        solid.corners_m.push_back(frame(
            {center_m[0] + side(0) * size_m[0], center_m[1] + side(1) * size_m[1], center_m[2] + side(2) * size_m[2]}));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (((corner >> axis) & 1U) == 0) {
                solid.edges.emplace_back(corner, corner | (std::size_t{1} << axis));
            }
        }
    }
    return solid;
}

Vector3 scaled_to(const Vector3& a, double length) {
    return length / std::sqrt(dot(a, a)) * a;
}

Polyhedron prism_of(const Cylinder& cylinder, const ObstacleFrame& frame) {
    const Vector3 half = scaled_to(scaled_to(cylinder.axis, 1), cylinder.length_m / 2);
    const Vector3 other = std::abs(half[0]) < std::abs(half[1]) ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
    const Vector3 u = scaled_to(cross(half, other), cylinder.radius_m);
    const Vector3 v = scaled_to(cross(half, u), cylinder.radius_m);
    Polyhedron solid;
    for (std::size_t i = 0; i < sides; ++i) {
        const auto [sine, cosine] = unit_circle()[i];
        for (const double end : {-1., 1.}) {
            solid.corners_m.push_back(frame(end * half + cosine * u + sine * v));
        }
        const std::size_t here = 2 * i, next = 2 * ((i + 1) % sides);
        solid.edges.insert(solid.edges.end(), {{here, here + 1}, {here, next}, {here + 1, next + 1}});
    }
    return solid;
}

Ring circle(const PlanePoint& center, double radius_m) {
    Ring points;
    for (const auto& [sine, cosine] : unit_circle()) {
        points.push_back({center.x_m + radius_m * cosine, center.z_m + radius_m * sine});
    }
    return points;
}

/// The parts of a surface, as lists of triangles: those that share an edge with one other triangle belong together.
/// Where four meet at an edge, two bodies touch. Corners at the same place are one.
std::vector<std::vector<std::size_t>> parts_of(const std::vector<Vector3>& vertices_m,
                                               const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    std::map<Vector3, std::size_t> corners;
    std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> at_edge;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        std::array<std::size_t, 3> own{};
        std::ranges::transform(triangles[i], own.begin(), [&](std::uint32_t vertex) {
            return corners.emplace(vertices_m[vertex], corners.size()).first->second;
        });
        for (std::size_t side = 0; side < 3; ++side) {
            at_edge[std::minmax(own[side], own[(side + 1) % 3])].push_back(i);
        }
    }
    std::vector<std::size_t> part(triangles.size());
    std::iota(part.begin(), part.end(), std::size_t{0});
    const auto root = [&part](std::size_t i) {
        while (part[i] != i) {
            i = part[i] = part[part[i]];
        }
        return i;
    };
    for (const auto& [edge, around] : at_edge) {
        if (around.size() == 2) {
            part[root(around[0])] = root(around[1]);
        }
    }
    std::map<std::size_t, std::vector<std::size_t>> by_root;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        by_root[root(i)].push_back(i);
    }
    std::vector<std::vector<std::size_t>> parts;
    parts.reserve(by_root.size());
    for (auto& [number, members] : by_root) {
        parts.push_back(std::move(members));
    }
    return parts;
}

/// The projections of the parts of a mesh that are on one side of the plane.
std::vector<Ring> parts_beside(const std::vector<Vector3>& vertices_m,
                               const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    constexpr std::size_t max_parts = 300, max_triangles = 50'000;
    if (triangles.size() > max_triangles) {
        return {};
    }
    std::vector<Ring> rings;
    std::set<std::vector<long>> seen;  // girders left and right of the plane look the same
    for (const std::vector<std::size_t>& part : parts_of(vertices_m, triangles)) {
        std::vector<Vector3> corners_m;
        bool is_left = false, is_right = false;
        for (const std::size_t triangle : part) {
            for (const std::uint32_t vertex : triangles[triangle]) {
                corners_m.push_back(vertices_m[vertex]);
                is_left = is_left || corners_m.back()[1] >= 0;
                is_right = is_right || corners_m.back()[1] < 0;
            }
        }
        if (is_left != is_right) {
            Ring ring = projection(corners_m);
            std::vector<long> rounded;
            for (const PlanePoint& p : ring) {
                rounded.insert(rounded.end(), {std::lround(p.x_m * 1e4), std::lround(p.z_m * 1e4)});
            }
            if (seen.insert(std::move(rounded)).second) {
                rings.push_back(std::move(ring));
            }
        }
        if (rings.size() > max_parts) {
            return {};
        }
    }
    return rings;
}

std::vector<Vector3> vertices_of(const Mesh& mesh, const ObstacleFrame& frame) {
    std::vector<Vector3> vertices_m;
    vertices_m.reserve(mesh.surface->vertices_m.size());
    for (const Vector3& own : mesh.surface->vertices_m) {
        vertices_m.push_back(frame(local_m(mesh, own)));
    }
    return vertices_m;
}

/// Sets the parts of an outline that depend on the kind of shape.
class OutlineOf {
 public:
    OutlineOf(const ObstacleFrame& frame, ObstacleOutline& outline) : frame_(frame), outline_(outline) {}

    void operator()(const Box& box) const { add(box_at({0, 0, 0}, box.size_m, frame_)); }
    void operator()(const Cylinder& cylinder) const { add(prism_of(cylinder, frame_)); }

    void operator()(const Sphere& sphere) const {
        const Vector3 center_m = frame_({0, 0, 0});
        const double squared = sphere.radius_m * sphere.radius_m - center_m[1] * center_m[1];
        outline_.is_cut = squared > 0;
        outline_.rings = {circle(projected(center_m), outline_.is_cut ? std::sqrt(squared) : sphere.radius_m)};
    }

    void operator()(const Mesh& mesh) const {
        const std::vector<Vector3> vertices_m = vertices_of(mesh, frame_);
        MeshSection cut = mesh_section(vertices_m, mesh.surface->triangles);
        outline_.is_cut = !cut.rings.empty() || !cut.lines.empty();
        outline_.rings = std::move(cut.rings);
        outline_.lines = std::move(cut.lines);
        if (!outline_.is_cut) {
            outline_.rings = {projection(vertices_m)};
        } else {
            outline_.beside = parts_beside(vertices_m, mesh.surface->triangles);
        }
    }

    void operator()(const Octomap& octomap) const {
        constexpr double half_diagonal = 0.8661;  // of a cube, in its sides
        std::vector<Ring> sections;
        for_each_solid_box(octomap, [&](const LocalBox& box) {
            const double longest_m = std::max({box.size_m[0], box.size_m[1], box.size_m[2]});
            if (std::abs(frame_(box.center_m)[1]) <= half_diagonal * longest_m) {
                add_section(box_at(box.center_m, box.size_m, frame_), sections);
            }
        });
        outline_.rings = joined_rings(sections);
        outline_.is_cut = !outline_.rings.empty();
        if (!outline_.is_cut) {
            std::vector<PlanePoint> corners;
            for_each_solid_box(octomap, [&](const LocalBox& box) {
                constexpr std::size_t many = 100'000;
                for (const Vector3& corner_m : box_at(box.center_m, box.size_m, frame_).corners_m) {
                    corners.push_back(projected(corner_m));
                }
                if (corners.size() > many) {
                    corners = convex_hull(std::move(corners));
                }
            });
            outline_.rings = {convex_hull(std::move(corners))};
        }
    }

 private:
    static void add_section(const Polyhedron& solid, std::vector<Ring>& rings) {
        if (auto ring = section(solid); ring.size() > 2) {
            rings.push_back(std::move(ring));
        }
    }

    void add(const Polyhedron& solid) const {
        add_section(solid, outline_.rings);
        outline_.is_cut = !outline_.rings.empty();
        if (!outline_.is_cut) {
            outline_.rings = {projection(solid.corners_m)};
        }
    }

    const ObstacleFrame& frame_;
    ObstacleOutline& outline_;
};

/// First `b`, then `a`.
Matrix3 product(const Matrix3& a, const Matrix3& b) {
    Matrix3 both;
    for (std::size_t i = 0; i < 3; ++i) {
        both[i] = a[i][0] * b[0] + a[i][1] * b[1] + a[i][2] * b[2];
    }
    return both;
}

/// A frame far behind the plane of the picture, which then cuts nothing.
ObstacleFrame seen_frame(const Obstacle& obstacle, const Matrix3& rotation, const Vector3& origin_m,
                         const Matrix3& view) {
    static const PlaneOfMotion plane;
    ObstacleFrame frame(obstacle, plane, beside_everything_m);
    frame.center_m = view * (origin_m + rotation * obstacle.center_world_m);
    frame.rotation = product(view, product(rotation, frame.rotation));
    return frame;
}

constexpr Matrix3 no_rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

}  // namespace

std::vector<ObstacleOutline> obstacle_outlines(const Scene& scene, const PlaneOfMotion& plane, double lateral_m) {
    std::vector<ObstacleOutline> outlines;
    for (const Obstacle& obstacle : scene.obstacles()) {
        ObstacleOutline& outline = outlines.emplace_back();
        outline.name = obstacle.name;
        const ObstacleFrame frame(obstacle, plane, lateral_m);
        std::visit(OutlineOf(frame, outline), obstacle.shape);
    }
    return outlines;
}

std::vector<ObstacleOutline> projected_outlines(const Scene& scene, const PlaneOfMotion& plane) {
    return obstacle_outlines(scene, plane, beside_everything_m);
}

std::vector<ObstacleOutline> seen_outlines(const Scene& scene, const Matrix3& view) {
    std::vector<ObstacleOutline> outlines;
    for (const Obstacle& obstacle : scene.obstacles()) {
        ObstacleOutline& outline = outlines.emplace_back();
        outline.name = obstacle.name;
        const ObstacleFrame frame = seen_frame(obstacle, no_rotation, {0, 0, 0}, view);
        std::visit(OutlineOf(frame, outline), obstacle.shape);
        if (const auto* mesh = std::get_if<Mesh>(&obstacle.shape)) {
            if (std::vector<Ring> parts = parts_beside(vertices_of(*mesh, frame), mesh->surface->triangles);
                !parts.empty()) {
                outline.rings = std::move(parts);
            }
        }
        outline.is_cut = true;  // all of it is seen
    }
    return outlines;
}

Ring seen_outline(const SpaceBodyShape& solid, const Matrix3& rotation, const Vector3& origin_m, const Matrix3& view) {
    const auto ring_of = [&](const Shape& shape, const Vector3& center_m) {
        const Obstacle obstacle{"", shape, center_m, {}};
        ObstacleOutline outline;
        const ObstacleFrame frame = seen_frame(obstacle, rotation, origin_m, view);
        std::visit(OutlineOf(frame, outline), obstacle.shape);
        return outline.rings.front();
    };
    if (const auto* capsule = std::get_if<Capsule>(&solid.shape)) {
        Ring ends = ring_of(Sphere{capsule->radius_m}, solid.center_m + capsule->from_m);
        const Ring other = ring_of(Sphere{capsule->radius_m}, solid.center_m + capsule->to_m);
        ends.insert(ends.end(), other.begin(), other.end());
        return convex_hull(std::move(ends));
    }
    return std::visit(
        [&](const auto& shape) -> Ring {
            if constexpr (std::is_constructible_v<Shape, decltype(shape)>) {
                return ring_of(shape, solid.center_m);
            } else {
                return {};
            }
        },
        solid.shape);
}

std::vector<Ring> body_outlines(const std::vector<BodyShape>& bodies) {
    std::vector<Obstacle> obstacles;
    std::transform(bodies.begin(), bodies.end(), std::back_inserter(obstacles), as_obstacle);
    std::vector<Ring> rings;
    for (const ObstacleOutline& outline : projected_outlines(Scene(obstacles), PlaneOfMotion())) {
        rings.push_back(outline.rings.front());
    }
    return rings;
}

}  // namespace downwash

#include "downwash/report/page_solids.hpp"

#include <cmath>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <variant>
#include <vector>

#include "downwash/report/obstacle_frame.hpp"
#include "downwash/report/packed_numbers.hpp"
#include "downwash/scene/solid_surface.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

Vector3 direction(const ObstacleFrame& frame, const Vector3& own) {
    return frame(own) - frame({0, 0, 0});
}

/// The triangles of a solid without a closed form, in the coordinates of the plane: x, lateral, z.
Json triangles_json(const Obstacle& obstacle, const PlaneOfMotion& plane) {
    const TriangleMesh surface = surface_of(obstacle);
    std::vector<float> coordinates;
    for (const Vector3& vertex_m : surface.vertices_m) {
        for (const double coordinate : plane.from_world(vertex_m)) {
            coordinates.push_back(static_cast<float>(coordinate));
        }
    }
    std::vector<std::int32_t> corners;
    for (const auto& triangle : surface.triangles) {
        for (const std::uint32_t corner : triangle) {
            corners.push_back(static_cast<std::int32_t>(corner));
        }
    }
    PackedNumbers vertices, indices;
    vertices.add(coordinates);
    indices.add(corners);
    return {{"triangles", {{"vertices", vertices.text()}, {"indices", indices.text()}}}};
}

/// A page shows only the outlines of meshes and octrees with more triangles, so that it stays small.
constexpr std::size_t max_shown_triangles = 20000;

/// The kind of a shape and its solid.
class SolidOf {
 public:
    SolidOf(const Obstacle& obstacle, const PlaneOfMotion& plane)
        : obstacle_(obstacle), plane_(plane), frame_(obstacle, plane, 0) {}

    Json operator()(const Box& box) const {
        return {
            {"box",
             {{"size_m", box.size_m},
              {"center_m", frame_({0, 0, 0})},
              {"axes", {direction(frame_, {1, 0, 0}), direction(frame_, {0, 1, 0}), direction(frame_, {0, 0, 1})}}}}};
    }
    Json operator()(const Cylinder& cylinder) const {
        const double length = std::hypot(cylinder.axis[0], cylinder.axis[1], cylinder.axis[2]);
        const Vector3 unit{cylinder.axis[0] / length, cylinder.axis[1] / length, cylinder.axis[2] / length};
        return {{"cylinder",
                 {{"radius_m", cylinder.radius_m},
                  {"length_m", cylinder.length_m},
                  {"center_m", frame_({0, 0, 0})},
                  {"axis", direction(frame_, unit)}}}};
    }
    Json operator()(const Sphere& sphere) const {
        return {{"sphere", {{"radius_m", sphere.radius_m}, {"center_m", frame_({0, 0, 0})}}}};
    }
    Json operator()(const Mesh& mesh) const {
        return mesh.surface->triangles.size() > max_shown_triangles ? Json() : triangles_json(obstacle_, plane_);
    }
    Json operator()(const Octomap& octomap) const {
        constexpr std::size_t triangles_of_box = 12;
        return solid_box_count(octomap) * triangles_of_box > max_shown_triangles ? Json()
                                                                                 : triangles_json(obstacle_, plane_);
    }

 private:
    const Obstacle& obstacle_;
    const PlaneOfMotion& plane_;
    ObstacleFrame frame_;
};

constexpr const char* kinds[] = {"box", "cylinder", "sphere", "mesh", "octree"};
static_assert(std::size(kinds) == std::variant_size_v<Shape>);

}  // namespace

Json solid_json(const Obstacle& obstacle, const PlaneOfMotion& plane) {
    return std::visit(SolidOf(obstacle, plane), obstacle.shape);
}

std::string_view kind_of(const Shape& shape) noexcept {
    return kinds[shape.index()];
}

}  // namespace downwash

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "downwash/base/byte_order.hpp"
#include "downwash/base/version.hpp"
#include "downwash/exports/formats.hpp"
#include "downwash/scene/bounding_box.hpp"
#include "downwash/scene/solid_surface.hpp"

// glTF 2.0 in one binary file (Khronos, "glTF 2.0 Specification", 4.4): a head, a piece of JSON, a piece of numbers.

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

// Constants of OpenGL that the format uses.
constexpr int unsigned_int_type = 5125, float_type = 5126;
constexpr int vertex_buffer = 34962, index_buffer = 34963;
constexpr int line_strip_mode = 3;

/// A document that grows node by node.
class Gltf {
 public:
    enum Material { obstacle, vehicle, arm, path };

    /// Numbers, `components` of them an element. @return the number of the accessor
    std::size_t add_floats(const std::vector<float>& numbers, std::size_t components, bool is_vertex) {
        Json minima = Json::array(), maxima = Json::array();
        for (std::size_t i = 0; i < components; ++i) {
            float low = std::numeric_limits<float>::infinity(), high = -low;
            for (std::size_t k = i; k < numbers.size(); k += components) {
                low = std::min(low, numbers[k]);
                high = std::max(high, numbers[k]);
            }
            minima.push_back(low);
            maxima.push_back(high);
        }
        for (const float number : numbers) {
            append_little_endian(bytes_, number);
        }
        constexpr const char* types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
        return add_accessor({{"componentType", float_type},
                             {"count", numbers.size() / components},
                             {"type", types[components]},
                             {"min", std::move(minima)},
                             {"max", std::move(maxima)}},
                            4 * numbers.size(), is_vertex ? vertex_buffer : 0);
    }

    std::size_t add_mesh(const TriangleMesh& surface, Material material) {
        std::vector<float> vertices;
        for (const Vector3& vertex_m : surface.vertices_m) {
            vertices.insert(vertices.end(), {static_cast<float>(vertex_m[0]), static_cast<float>(vertex_m[1]),
                                             static_cast<float>(vertex_m[2])});
        }
        const std::size_t positions = add_floats(vertices, 3, true);
        for (const auto& triangle : surface.triangles) {
            for (const std::uint32_t corner : triangle) {
                append_little_endian(bytes_, corner);
            }
        }
        const std::size_t count = 3 * surface.triangles.size();
        const std::size_t indices = add_accessor(
            {{"componentType", unsigned_int_type}, {"count", count}, {"type", "SCALAR"}}, 4 * count, index_buffer);
        return add_primitive({{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", material}});
    }

    std::size_t add_line(const std::vector<float>& points) {
        const std::size_t positions = add_floats(points, 3, true);
        return add_primitive(
            {{"attributes", {{"POSITION", positions}}}, {"mode", line_strip_mode}, {"material", path}});
    }

    std::size_t add_node(Json node) {
        nodes_.push_back(std::move(node));
        return nodes_.size() - 1;
    }

    /// Moves a node: `path` is "translation" or "rotation".
    void animate(std::size_t node, const char* what, std::size_t times, std::size_t values) {
        channels_.push_back({{"sampler", samplers_.size()}, {"target", {{"node", node}, {"path", what}}}});
        samplers_.push_back({{"input", times}, {"output", values}});
    }

    /// @param root node that turns z up into the format's y up
    [[nodiscard]] std::string text(std::size_t root, const std::string& name) const {
        Json document{{"asset", {{"version", "2.0"}, {"generator", "downwash " + std::string(version())}}},
                      {"scene", 0},
                      {"scenes", {{{"name", name}, {"nodes", {root}}}}},
                      {"nodes", nodes_},
                      {"meshes", meshes_},
                      {"materials", materials()},
                      {"accessors", accessors_},
                      {"bufferViews", views_},
                      {"buffers", {{{"byteLength", bytes_.size()}}}}};
        if (!channels_.empty()) {
            document["animations"] = {{{"name", "flight"}, {"channels", channels_}, {"samplers", samplers_}}};
        }
        std::string json = document.dump(-1, ' ', false, Json::error_handler_t::replace);
        json.resize((json.size() + 3) / 4 * 4, ' ');
        constexpr std::uint32_t magic = 0x46546C67, format_version = 2;
        constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
        constexpr std::size_t head = 12, chunk_head = 8;
        std::string file;
        append_little_endian(file, magic);
        append_little_endian(file, format_version);
        append_little_endian(file, static_cast<std::uint32_t>(head + 2 * chunk_head + json.size() + bytes_.size()));
        append_little_endian(file, static_cast<std::uint32_t>(json.size()));
        append_little_endian(file, json_chunk);
        file += json;
        append_little_endian(file, static_cast<std::uint32_t>(bytes_.size()));
        append_little_endian(file, binary_chunk);
        return file + bytes_;
    }

 private:
    /// The bytes are those added last.
    std::size_t add_accessor(Json accessor, std::size_t size, int target) {
        Json view{{"buffer", 0}, {"byteOffset", bytes_.size() - size}, {"byteLength", size}};
        if (target != 0) {
            view["target"] = target;
        }
        accessor["bufferView"] = views_.size();
        views_.push_back(std::move(view));
        accessors_.push_back(std::move(accessor));
        return accessors_.size() - 1;
    }

    std::size_t add_primitive(Json primitive) {
        meshes_.push_back({{"primitives", {std::move(primitive)}}});
        return meshes_.size() - 1;
    }

    static Json material(const char* name, std::initializer_list<double> color, double metallic) {
        return {{"name", name},
                {"pbrMetallicRoughness",
                 {{"baseColorFactor", color}, {"metallicFactor", metallic}, {"roughnessFactor", 0.8}}},
                {"doubleSided", true}};
    }

    /// In the order of Material.
    static Json materials() {
        return {material("obstacle", {0.62, 0.62, 0.6, 1}, 0), material("vehicle", {0.13, 0.25, 0.42, 1}, 0.2),
                material("arm", {0.84, 0.37, 0, 1}, 0.2), material("path", {0, 0.45, 0.7, 1}, 0)};
    }

    std::string bytes_;
    Json nodes_ = Json::array(), meshes_ = Json::array(), accessors_ = Json::array(), views_ = Json::array();
    Json channels_ = Json::array(), samplers_ = Json::array();
};

/// In the format's order: x, y, z, w. @param q (w, x, y, z)
std::vector<float> rotation_of(const std::array<double, 4>& q) {
    return {static_cast<float>(q[1]), static_cast<float>(q[2]), static_cast<float>(q[3]), static_cast<float>(q[0])};
}

/// About an axis of length 1.
std::vector<float> rotation_about(const Vector3& axis, double angle_rad) {
    const Vector3 part = std::sin(angle_rad / 2) * axis;
    return rotation_of({std::cos(angle_rad / 2), part[0] + 0., part[1] + 0., part[2] + 0.});  // no negative zeros
}

/// A place near to another one in whole kilometres, which floats hold exactly: what is within a kilometre of it has
/// coordinates that floats hold to 0.04 mm.
Vector3 whole_kilometres(const Vector3& place_m) {
    Vector3 whole_m{};
    for (std::size_t k = 0; k < 3; ++k) {
        whole_m[k] = 1000 * std::round(place_m[k] / 1000) + 0.;  // no negative zero
    }
    return whole_m;
}

/// A node with what has an origin of its own, a translation only where that is not 0.
Json node_at(const Vector3& origin_m, Json node) {
    if (origin_m != Vector3{}) {
        node["translation"] = origin_m;
    }
    return node;
}

/// Moves a surface. @return with its vertices less a place
TriangleMesh seen_from(const Vector3& origin_m, TriangleMesh surface) {
    for (Vector3& vertex_m : surface.vertices_m) {
        vertex_m = vertex_m - origin_m;
    }
    return surface;
}

Vector3 middle_of(const TriangleMesh& surface) {
    if (surface.vertices_m.empty()) {
        return {};
    }
    BoundingBox bounds{surface.vertices_m[0], surface.vertices_m[0]};
    for (const Vector3& vertex_m : surface.vertices_m) {
        bounds.include({vertex_m, vertex_m});
    }
    return 0.5 * (bounds.low_m + bounds.high_m);
}

/// The nodes that move.
struct MovingNodes {
    std::size_t vehicle = 0;
    std::vector<std::size_t> links;
};

/// The multirotor with its parts, and the arm on it.
/// @param pose where viewers that show no animation have it
MovingNodes add_robot(Gltf& gltf, const RobotSurfaces& robot, const SpacePose& pose) {
    MovingNodes moving;
    std::vector<std::size_t> parts;
    for (const auto& [name, surface] : robot.body) {
        parts.push_back(gltf.add_node({{"name", name}, {"mesh", gltf.add_mesh(surface, Gltf::vehicle)}}));
    }
    for (std::size_t i = robot.links.size(); i-- > 0;) {  // from the tip, as a node names what is mounted on it
        const RobotSurfaces::Link& link = robot.links[i];
        Json node{{"name", link.name},
                  {"translation", link.joint_m},
                  {"rotation", rotation_about(link.axis, pose.joints_rad[i])}};
        if (!link.surface.triangles.empty()) {
            node["mesh"] = gltf.add_mesh(link.surface, Gltf::arm);
        }
        if (!moving.links.empty()) {
            node["children"] = {moving.links.front()};
        }
        moving.links.insert(moving.links.begin(), gltf.add_node(std::move(node)));
    }
    if (!moving.links.empty()) {
        parts.push_back(moving.links.front());
    }
    moving.vehicle = gltf.add_node({{"name", robot.name},
                                    {"translation", pose.position_m},
                                    {"rotation", rotation_of(pose.attitude)},
                                    {"children", parts}});
    return moving;
}

void append(std::vector<float>& list, const std::vector<float>& more) {
    list.insert(list.end(), more.begin(), more.end());
}

void append(std::vector<float>& list, const Vector3& point_m) {
    for (const double coordinate : point_m) {
        list.push_back(static_cast<float>(coordinate));
    }
}

/// @param origin_m world place from which coordinates count   @return the node that shows the way
std::size_t add_flight(Gltf& gltf, const RunInWorld& run, const RobotSurfaces& robot, const Vector3& origin_m,
                       const MovingNodes& moving) {
    std::vector<float> times, places, attitudes;
    std::vector<std::vector<float>> joints(robot.links.size());
    for (std::size_t row = 0; row < run.flight.rows(); ++row) {
        const SpacePose pose = run.pose(row);
        times.push_back(static_cast<float>((*run.flight.find("t_s"))[row]));
        append(places, pose.position_m - origin_m);
        append(attitudes, rotation_of(pose.attitude));
        for (std::size_t i = 0; i < joints.size(); ++i) {
            append(joints[i], rotation_about(robot.links[i].axis, pose.joints_rad[i]));
        }
    }
    const std::size_t input = gltf.add_floats(times, 1, false);
    gltf.animate(moving.vehicle, "translation", input, gltf.add_floats(places, 3, false));
    gltf.animate(moving.vehicle, "rotation", input, gltf.add_floats(attitudes, 4, false));
    for (std::size_t i = 0; i < joints.size(); ++i) {
        gltf.animate(moving.links[i], "rotation", input, gltf.add_floats(joints[i], 4, false));
    }
    return gltf.add_node({{"name", "flight path"}, {"mesh", gltf.add_line(places)}});
}

}  // namespace

std::string gltf_binary(const RunInWorld& run, const ExportSettings&) {
    Gltf gltf;
    // Buffers hold floats. Everything counts from an origin near the flight, which a node above has as text, in double.
    SpacePose pose = run.flight.rows() > 0 ? run.pose(0) : run.start;
    const Vector3 origin_m = whole_kilometres(pose.position_m);
    pose.position_m = pose.position_m - origin_m;
    std::vector<std::size_t> children;
    for (const Obstacle& obstacle : run.obstacles) {
        const TriangleMesh surface = seen_from(origin_m, surface_of(obstacle));
        const Vector3 own_m = whole_kilometres(middle_of(surface));
        children.push_back(gltf.add_node(node_at(
            own_m, {{"name", obstacle.name}, {"mesh", gltf.add_mesh(seen_from(own_m, surface), Gltf::obstacle)}})));
    }
    const RobotSurfaces robot = run.robot();
    const MovingNodes moving = add_robot(gltf, robot, pose);
    children.push_back(moving.vehicle);
    if (run.flight.rows() > 1) {
        children.push_back(add_flight(gltf, run, robot, origin_m, moving));
    }
    if (origin_m != Vector3{}) {
        children = {gltf.add_node(node_at(origin_m, {{"name", "origin"}, {"children", children}}))};
    }
    constexpr double half_root = 0.70710678118654752;
    const std::size_t root =
        gltf.add_node({{"name", "z up"}, {"rotation", {-half_root, 0., 0., half_root}}, {"children", children}});
    return gltf.text(root, run.name);
}

}  // namespace downwash

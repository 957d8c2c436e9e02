#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "downwash/base/vector3.hpp"

namespace downwash {

/// A solid box, centred on its own frame. Sizes are full edge lengths along the local x, y, z [m], > 0.
struct Box {
    Vector3 size_m{};
};

/// A solid cylinder with flat ends, centred on its own frame.
struct Cylinder {
    double radius_m = 0;    ///< > 0
    double length_m = 0;    ///< end to end along `axis`, > 0
    Vector3 axis{0, 0, 1};  ///< direction in the local frame; any length but zero
};

/// A solid sphere, centred on its own frame.
struct Sphere {
    double radius_m = 0;  ///< > 0
};

/// Triangles and cubes of one file, or of all obstacles of a scene with their other parts: no more are taken, which
/// bounds the memory that a file can ask for (some 150 bytes a piece).
inline constexpr std::size_t max_pieces = 2'000'000;

/// Triangles of a surface: corners are indices of vertices, counter-clockwise seen from outside.
struct TriangleMesh {
    std::vector<Vector3> vertices_m;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    /// What the reader of its file passed over or had to choose, with its place in the file; says nothing to the scene.
    std::vector<std::string> remarks = {};
};

/// A surface from a file. Each closed piece of it is solid, even with triangles wound the wrong way around; one open
/// edge, with an odd number of triangles, makes a sheet of no thickness of its piece.
struct Mesh {
    std::string file;  ///< where it was read; says nothing to the scene
    double scale = 1;  ///< > 0; multiplies the vertices, which are as in the file
    std::shared_ptr<const TriangleMesh> surface;
    Vector3 offset_m{};  ///< subtracted from the vertices, once scaled: the place in the file that is its origin here
};

/// A vertex of a mesh's surface in the local frame [m].
[[nodiscard]] inline Vector3 local_m(const Mesh& mesh, const Vector3& vertex) noexcept {
    return mesh.scale * vertex - mesh.offset_m;
}

/// A cube of space that is occupied, its edges along the local axes.
struct OccupiedCube {
    Vector3 center_local_m{};
    double side_m = 0;  ///< > 0
};

/// A box in the local frame of its obstacle, its edges along the local axes.
struct LocalBox {
    Vector3 center_m, size_m;
};

/// The occupied leaves of an octree, in the local frame, and what its sensor never saw.
struct OccupancyTree {
    double resolution_m = 0;  ///< side of the smallest cubes
    std::vector<OccupiedCube> cubes;

    /// The space without a leaf, within the known box: the bounding box of all occupied and free leaves. Boxes do not
    /// overlap; empty if `lists_unseen` is false.
    std::vector<LocalBox> unseen = {};
    LocalBox known_box = {};     ///< empty if the tree was not read from a file
    double unseen_share = 0;     ///< share of the known box without a leaf
    bool has_free_leaf = false;  ///< without one the file tells nothing of where a sensor looked
    bool lists_unseen = true;    ///< false: the unseen space has too many pieces to be listed
};

/// What the space of an octree counts as that no sensor has seen.
enum class UnknownSpace : std::uint8_t {
    free,      ///< nothing stands there; executed flights count how long they are in it
    occupied,  ///< solid, within the known box
};

/// Each once, in their order.
inline constexpr std::array all_unknown_spaces{UnknownSpace::free, UnknownSpace::occupied};

/// Name as in problem files: "free".
[[nodiscard]] constexpr std::string_view name_of(UnknownSpace unknown) noexcept {
    return unknown == UnknownSpace::free ? "free" : "occupied";
}

/// Occupied space from an octree file; each cube is solid.
struct Octomap {
    std::string file;  ///< where it was read; says nothing to the scene
    std::shared_ptr<const OccupancyTree> tree;
    UnknownSpace unknown = UnknownSpace::free;
};

/// Calls `use(box)` with each solid box of an octree: its cubes and, where it counts as occupied, the unseen space.
template <class Use>
void for_each_solid_box(const Octomap& octomap, const Use& use) {
    for (const OccupiedCube& cube : octomap.tree->cubes) {
        use(LocalBox{cube.center_local_m, {cube.side_m, cube.side_m, cube.side_m}});
    }
    if (octomap.unknown == UnknownSpace::occupied) {
        for (const LocalBox& box : octomap.tree->unseen) {
            use(box);
        }
    }
}

/// How many boxes for_each_solid_box() has.
[[nodiscard]] inline std::size_t solid_box_count(const Octomap& octomap) noexcept {
    return octomap.tree->cubes.size() +
           (octomap.unknown == UnknownSpace::occupied ? octomap.tree->unseen.size() : std::size_t{0});
}

/// What has a closed form.
using Primitive = std::variant<Box, Cylinder, Sphere>;

/// What an obstacle can be.
using Shape = std::variant<Box, Cylinder, Sphere, Mesh, Octomap>;

/// A solid placed in the world frame N (x forward, y left, z up).
struct Obstacle {
    std::string name;
    Shape shape;
    Vector3 center_world_m{};  ///< position of the local frame's origin in N
    Vector3 rpy_rad{};         ///< orientation of the local frame in N: R = Rz(yaw) Ry(pitch) Rx(roll)
};

/// What messages and results call an obstacle of a list: its name or, without one, its key in a problem file, with the
/// file of its shape.
[[nodiscard]] inline std::string label_of(const std::vector<Obstacle>& obstacles, std::size_t number) {
    const Obstacle& obstacle = obstacles[number];
    if (!obstacle.name.empty()) {
        return obstacle.name;
    }
    const auto* mesh = std::get_if<Mesh>(&obstacle.shape);
    const auto* octomap = std::get_if<Octomap>(&obstacle.shape);
    const std::string file = mesh != nullptr ? mesh->file : octomap != nullptr ? octomap->file : "";
    return "environment.obstacles[" + std::to_string(number) + "]" + (file.empty() ? "" : " (" + file + ")");
}

/// A solid that belongs to the multirotor, aligned with its body frame (b1 forward, y left, b3 up).
struct BodyShape {
    Primitive shape;
    Vector3 center_body_m{};  ///< centre in the body frame, from the multirotor's centre of mass
};

/// What of the robot can touch something: the multirotor's bodies and the arm as a capsule.
struct RobotShape {
    std::vector<BodyShape> bodies;
    double joint_x_m = 0;     ///< arm joint in the body frame
    double joint_z_m = 0;     ///< arm joint in the body frame
    double arm_length_m = 0;  ///< joint to end effector
    double arm_radius_m = 0;  ///< radius of the capsule around the arm
};

}  // namespace downwash

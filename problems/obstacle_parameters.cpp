#include "downwash/problems/obstacle_parameters.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <variant>

#include "downwash/base/key_error.hpp"
#include "downwash/base/parameter_factories.hpp"
#include "downwash/scene/mesh_file.hpp"
#include "downwash/scene/octomap_file.hpp"
#include "downwash/scene/shape_digest.hpp"
#include "downwash/scene/shape_parameters.hpp"

namespace downwash {
namespace {

using Obstacles = std::vector<Obstacle>;
using Rows = std::vector<Parameter<Obstacles>>;
using parameters::in_each;

constexpr auto every = [](auto& obstacles) -> auto& {
    return obstacles;
};

std::size_t pieces_of(const Shape& shape) {
    if (const auto* mesh = std::get_if<Mesh>(&shape); mesh && mesh->surface) {
        return mesh->surface->triangles.size();
    }
    if (const auto* octomap = std::get_if<Octomap>(&shape); octomap && octomap->tree) {
        return octomap->tree->cubes.size();
    }
    return 0;
}

std::size_t pieces_of(const std::vector<Obstacle>& obstacles) {
    std::size_t pieces = 0;
    for (const Obstacle& obstacle : obstacles) {
        pieces += pieces_of(obstacle.shape);
    }
    return pieces;
}

/// Reads the file of a shape, or takes what another obstacle has read from it already.
/// @param content where the Kind keeps it
template <class Kind, class Content>
void read_file_of(Obstacles& obstacles, std::size_t index, const std::string& file,
                  std::shared_ptr<const Content> Kind::*content,
                  std::shared_ptr<const Content> (*read)(const std::filesystem::path&)) {
    std::shared_ptr<const Content> found;
    for (const Obstacle& obstacle : obstacles) {
        if (const auto* other = std::get_if<Kind>(&obstacle.shape); other && other->file == file) {
            found = other->*content;
        }
    }
    auto& kept = std::get<Kind>(obstacles[index].shape).*content;
    kept = found ? found : read(file);
    const std::size_t pieces = pieces_of(obstacles);
    if (pieces > max_pieces) {
        kept = nullptr;
        throw InputError(
            {{"", "'" + file + "' makes " + std::to_string(pieces) +
                      " triangles and cubes of all obstacles: expected at most " + std::to_string(max_pieces)}});
    }
}

Parameter<Obstacles> center(const std::string& path, std::string_view description) {
    return parameters::vector<Obstacles>(path + ".center_m", description, {"x", "y", "z"},
                                         in_each(every, &Obstacle::center_world_m))
        .between(-farthest_m, farthest_m);
}

Parameter<Obstacles> orientation(const std::string& path) {
    return parameters::vector<Obstacles>(path + ".rpy_deg", "orientation, R = Rz(yaw) Ry(pitch) Rx(roll)",
                                         {"roll", "pitch", "yaw"}, in_each(every, &Obstacle::rpy_rad))
        .between(-360, 360);
}

/// @param content where the Kind keeps what is in its file   @param digest of that
template <class Kind, class Content>
Parameter<Obstacles> file(const std::string& path, std::string_view description,
                          std::shared_ptr<const Content> Kind::*content,
                          std::shared_ptr<const Content> (*read)(const std::filesystem::path&),
                          std::string (*digest)(const Kind&)) {
    return parameters::file<Obstacles>(
               path + ".file", description,
               [](auto& p, std::size_t i) -> auto& { return std::get<Kind>(p[i].shape).file; },
               [content, read](Obstacles& p, std::size_t i, const std::string& name) {
                   read_file_of(p, i, name, content, read);
               },
               [digest](const Obstacles& p, std::size_t i) { return digest(std::get<Kind>(p[i].shape)); })
        .is_required();
}

std::string digest_of_file(const Mesh& mesh) {
    return digest_of(*mesh.surface);
}
std::string digest_of_file(const Octomap& octomap) {
    return digest_of(octomap);
}

void add_mesh(Rows& rows, const std::string& path) {
    rows.push_back(file(path, "STL (binary or ASCII) or OBJ", &Mesh::surface, &read_mesh, &digest_of_file));
    rows.push_back(parameters::number<Obstacles>(
                       path + ".scale", "metres in one unit of the file: 0.001 for millimetres",
                       [](auto& p, std::size_t i) -> auto& { return std::get<Mesh>(p[i].shape).scale; })
                       .between(1e-6, 1e6));
    rows.push_back(parameters::vector<Obstacles>(
                       path + ".offset_m",
                       "subtracted from the file's coordinates, once scaled: the place in it that center_m places",
                       {"x", "y", "z"},
                       [](auto& p, std::size_t i) -> auto& { return std::get<Mesh>(p[i].shape).offset_m; })
                       .between(-1e9, 1e9));
    rows.push_back(center(path, "where the origin of the file stands"));
    rows.push_back(orientation(path));
}

void add_octomap(Rows& rows, const std::string& path) {
    rows.push_back(file(path, "OctoMap, .bt or .ot", &Octomap::tree, &read_octomap, &digest_of_file));
    rows.push_back(parameters::choice<Obstacles>(
        path + ".unknown",
        "what space without a leaf counts as, within the bounding box of all leaves: executed flights count how long "
        "they are in free one; occupied one is solid",
        parameters::named(all_unknown_spaces),
        [](auto& p, std::size_t i) -> auto& { return std::get<Octomap>(p[i].shape).unknown; }));
    rows.push_back(center(path, "where the origin of the file stands"));
    rows.push_back(orientation(path));
}

}  // namespace

Rows obstacle_rows() {
    Rows rows;
    const std::string path = "obstacles[]";
    const auto shape = in_each(every, &Obstacle::shape);
    rows.push_back(parameters::list<Obstacles>("obstacles", "solids in the world frame", every));
    rows.push_back(parameters::text<Obstacles>(path + ".name", "name, used once", in_each(every, &Obstacle::name)));
    add_shape_rows<Obstacles>(rows, path, shape, [](Rows& to, const std::string& at) {
        to.push_back(center(at, "centre").is_required());
        to.push_back(orientation(at));
    });
    rows.push_back(parameters::alternative<Mesh, Obstacles>(
        path + ".mesh",
        "a surface of triangles: each piece is solid when no edge of it is open, else a sheet with no inside", shape));
    add_mesh(rows, path + ".mesh");
    rows.push_back(parameters::alternative<Octomap, Obstacles>(path + ".octomap",
                                                               "the occupied cubes of an octree, each solid", shape));
    add_octomap(rows, path + ".octomap");
    return rows;
}

}  // namespace downwash

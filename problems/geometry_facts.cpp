#include "downwash/problems/geometry_facts.hpp"

#include <variant>

namespace downwash {

std::vector<GeometryFacts> geometry_facts(const Scene& scene) {
    std::vector<GeometryFacts> all;
    for (std::size_t i = 0; i < scene.obstacles().size(); ++i) {
        const Shape& shape = scene.obstacles()[i].shape;
        if (const auto* mesh = std::get_if<Mesh>(&shape)) {
            all.push_back({i, mesh->surface->triangles.size(), scene.bounds(i), scene.facts(i)});
        } else if (const auto* octomap = std::get_if<Octomap>(&shape)) {
            const std::size_t pieces = piece_count(*octomap);
            all.push_back({i, octomap->tree->cubes.size(), scene.bounds(i), {pieces, pieces, 0, {}}});
        }
    }
    return all;
}

}  // namespace downwash

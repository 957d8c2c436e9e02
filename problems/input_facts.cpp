#include "downwash/problems/input_facts.hpp"

#include <variant>

namespace downwash {
namespace {

GeometryInput geometry_input(const Obstacle& obstacle, const GeometryFacts& facts) {
    const auto* mesh = std::get_if<Mesh>(&obstacle.shape);
    return {"environment.obstacles[" + std::to_string(facts.obstacle) + "]", obstacle.name,
            mesh != nullptr ? mesh->file : std::get<Octomap>(obstacle.shape).file, mesh != nullptr, facts};
}

}  // namespace

InputFacts input_facts(const Problem& problem, const Scene& scene) {
    InputFacts all;
    for (const GeometryFacts& facts : geometry_facts(scene)) {
        all.geometry.push_back(geometry_input(scene.obstacles()[facts.obstacle], facts));
    }
    all.robot = {problem.robot.name, robot_facts(problem.robot)};
    all.data = data_facts(problem);
    return all;
}

const char* surface_name(const SurfaceFacts& surface) {
    return surface.solid_pieces == surface.pieces ? "solid" : surface.solid_pieces == 0 ? "sheet" : "mixed";
}

}  // namespace downwash

#include "downwash/problems/input_facts.hpp"

#include <string>
#include <variant>

namespace downwash {
namespace {

GeometryInput geometry_input(const Obstacle& obstacle, const GeometryFacts& facts) {
    GeometryInput input;
    input.key = "environment.obstacles[" + std::to_string(facts.obstacle) + "]";
    input.name = obstacle.name;
    input.facts = facts;
    if (const auto* mesh = std::get_if<Mesh>(&obstacle.shape)) {
        input.is_mesh = true;
        input.file = mesh->file;
    } else {
        const auto& octomap = std::get<Octomap>(obstacle.shape);
        input.file = octomap.file;
        input.unknown = octomap.unknown;
        if (octomap.tree->has_free_leaf) {
            input.unseen_share = octomap.tree->unseen_share;
        }
    }
    return input;
}

}  // namespace

std::vector<GeometryInput> geometry_inputs(const Scene& scene) {
    std::vector<GeometryInput> all;
    for (const GeometryFacts& facts : geometry_facts(scene)) {
        all.push_back(geometry_input(scene.obstacles()[facts.obstacle], facts));
    }
    return all;
}

InputFacts input_facts(const Problem& problem, const Scene& scene) {
    InputFacts all;
    all.geometry = geometry_inputs(scene);
    all.robot = {problem.robot.name, robot_facts(problem.robot)};
    all.data = data_facts(problem);
    return all;
}

SpaceInputFacts input_facts(const SpaceProblem& problem, const Scene& scene) {
    return {geometry_inputs(scene), {problem.robot.name, space_robot_facts(problem.robot)}, data_facts(problem.aero)};
}

const char* surface_name(const SurfaceFacts& surface) {
    return surface.solid_pieces == surface.pieces ? "solid" : surface.solid_pieces == 0 ? "sheet" : "mixed";
}

}  // namespace downwash

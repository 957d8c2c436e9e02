#include "downwash/report/robot_outline.hpp"

#include <variant>

#include "downwash/report/obstacle_outline.hpp"

namespace downwash {

std::vector<std::vector<PlanePoint>> body_outlines(const std::vector<BodyShape>& bodies) {
    std::vector<Obstacle> obstacles;
    obstacles.reserve(bodies.size());
    for (const BodyShape& body : bodies) {
        obstacles.push_back(as_obstacle(body));
    }
    std::vector<std::vector<PlanePoint>> outlines;
    for (const ObstacleOutline& outline : projected_outlines(Scene(obstacles), PlaneOfMotion())) {
        outlines.push_back(outline.rings.front());
    }
    return outlines;
}

Obstacle as_obstacle(const BodyShape& body) {
    return {"", std::visit([](const auto& shape) { return Shape(shape); }, body.shape), body.center_m, {}};
}

}  // namespace downwash

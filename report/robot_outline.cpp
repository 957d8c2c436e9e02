#include "downwash/report/robot_outline.hpp"

#include "downwash/report/obstacle_outline.hpp"
#include "downwash/scene/obstacle_placement.hpp"

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

}  // namespace downwash

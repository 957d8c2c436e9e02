#include "downwash/simulation/space_robot.hpp"

#include <cstddef>

namespace downwash {

SpaceRobotShape shape_of(const SpaceRobot& robot) {
    SpaceRobotShape shape{robot.body, {}};
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        const SpaceLink& link = robot.plant.links[i];
        SpaceLinkShape& part = shape.links.emplace_back();
        part.joint_m = link.joint_m;
        part.axis = link.axis;
        if (robot.links[i].is_limited) {
            part.lower_limit_rad = robot.links[i].lower_limit_rad;
            part.upper_limit_rad = robot.links[i].upper_limit_rad;
        }
        part.bodies = robot.links[i].body;
    }
    return shape;
}

}  // namespace downwash

#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "downwash/base/vector3.hpp"
#include "downwash/scene/space_shape.hpp"

namespace downwash {

/// The greatest number of links of an arm in space.
inline constexpr std::size_t max_links = 6;

/// What of one link of an arm in space can touch something. At joint angles of zero the axes of all links are parallel
/// to the multirotor's.
struct SpaceLinkShape {
    Vector3 joint_m = {};  ///< joint in the frame of what the link is mounted on: the multirotor, or the link before
    Vector3 axis = {0, 1, 0};  ///< axis of the joint in the same frame; of any length but zero
    double lower_limit_rad = -std::numeric_limits<double>::infinity();  ///< of the joint
    double upper_limit_rad = std::numeric_limits<double>::infinity();   ///< of the joint, >= lower_limit_rad
    std::vector<SpaceBodyShape> bodies;  ///< in the link's own axes, from its joint; none: the link touches nothing
};

/// What of a robot in space can touch something: the bodies of the multirotor and those of each link of its arm.
struct SpaceRobotShape {
    std::vector<SpaceBodyShape> bodies;  ///< of the multirotor, in its frame (x forward, y left, z up)
    std::vector<SpaceLinkShape> links;   ///< from the multirotor outward, up to max_links
};

}  // namespace downwash

#pragma once

#include <variant>

#include "downwash/base/vector3.hpp"
#include "downwash/scene/shapes.hpp"

// Solids of a robot that flies in space.

namespace downwash {

/// The points within a radius of a line segment: a cylinder with round ends. Its frame is that of the solid's centre.
struct Capsule {
    double radius_m = 0;             ///< > 0
    Vector3 from_m = {}, to_m = {};  ///< ends of the segment; equal ones make a sphere
};

/// What a solid of a robot in space can be.
using SpaceShape = std::variant<Box, Cylinder, Sphere, Capsule>;

/// A solid of one body of a robot in space, aligned with the axes of that body.
struct SpaceBodyShape {
    SpaceShape shape;
    /// Origin of the shape's frame: from the multirotor's centre of mass or, for a link, from its joint.
    Vector3 center_m = {};
};

}  // namespace downwash

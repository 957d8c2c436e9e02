#pragma once

// A second way to distances, as plain as possible and sharing nothing with the library but its input types: nearest
// points by alternating projections (Cheney and Goldstein 1959), each answer enclosed by a separating plane.

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "downwash/scene/collision_checker.hpp"
#include "downwash/scene/space_checker.hpp"

namespace reference {

using downwash::Vector3;

/// A rounded box, cylinder or point in the world, `ball_m` added all around; or a triangle.
struct Solid {
    enum class Kind { box, cylinder, triangle } kind = Kind::box;
    Vector3 center_m{};
    /// Right-handed unit vectors in the world; a cylinder's axis is the third. Of a triangle the corners, from the
    /// centre.
    std::array<Vector3, 3> axes{};
    Vector3 half_m{};  ///< box: half edges; cylinder: radius, -, half length
    double ball_m = 0;
};

/// An enclosure of the distance [m]; high is 0 on contact.
struct Enclosure {
    double low, high;

    /// Whether a clearance, below 0 on contact, may be that distance.
    [[nodiscard]] bool holds(double clearance_m, double tolerance_m = 1e-9) const {
        return std::max(0.0, clearance_m) >= low - tolerance_m && clearance_m <= high + 1e-12;
    }
};

/// A length within a billionth of a metre.
inline Approx about(double length_m) {
    return Approx(length_m).epsilon(0).margin(1e-9);
}

Vector3 project(const Solid& solid, const Vector3& p_m);
double distance_to_point(const Solid& solid, const Vector3& p_m);
Enclosure distance(const Solid& a, const Solid& b);

/// The same solid as an obstacle's shape, and back: of primitives only.
downwash::Shape shape_of(const downwash::Primitive& primitive);
downwash::Primitive primitive_of(const downwash::Shape& shape);

/// Of an obstacle that is a primitive.
Solid solid_of(const downwash::Obstacle& obstacle);
Solid triangle(const std::array<Vector3, 3>& corners_m);
Solid disc(const Vector3& center_m, double radius_m);
std::vector<Solid> robot_at(const downwash::PlanarPose& pose, const downwash::PlaneOfMotion& plane,
                            const downwash::RobotShape& robot);

/// Axes and origin of a body in the world.
struct Frame {
    std::array<Vector3, 3> axes;
    Vector3 origin_m;

    [[nodiscard]] Vector3 turned(const Vector3& v) const;
    [[nodiscard]] Vector3 placed(const Vector3& p_m) const;
};
/// Of the multirotor, then of each link.
std::vector<Frame> frames_at(const downwash::SpacePose& pose, const downwash::SpaceRobotShape& robot);
/// The solids of each body: of the multirotor, then of each link.
std::vector<std::vector<Solid>> bodies_at(const downwash::SpacePose& pose, const downwash::SpaceRobotShape& robot);
std::vector<Solid> robot_at(const downwash::SpacePose& pose, const downwash::SpaceRobotShape& robot);

Enclosure clearance(const std::vector<Solid>& robot, const std::vector<Solid>& solids);
Enclosure clearance(const std::vector<Solid>& robot, const std::vector<downwash::Obstacle>& obstacles);

downwash::CollisionChecker checker_of(std::vector<downwash::Obstacle> obstacles, const downwash::RobotShape& robot,
                                      const downwash::PlaneOfMotion& plane = {});

class Dice;

/// Requires that two scenes are as near to a robot, to a disc and, at one height, to a point, at twenty places.
/// @return at how many of them the robot is in contact
int contacts_of_equals(const std::vector<downwash::Obstacle>& found, const std::vector<downwash::Obstacle>& expected,
                       Dice& dice);

/// Draws scenes, robots, planes and poses.
class Dice {
 public:
    explicit Dice(unsigned seed) : engine_(seed) {}
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    bool coin() { return between(0, 1) < 0.5; }
    Vector3 vector(double low, double high) { return {between(low, high), between(low, high), between(low, high)}; }
    downwash::Primitive shape(double least_m, double most_m);
    /// Half of them stand square to the world.
    downwash::Obstacle obstacle();
    /// Lengths and positions on a grid of a quarter metre, angles of whole and half right angles.
    downwash::Obstacle gridded_obstacle();
    std::vector<downwash::Obstacle> obstacles(int count);
    downwash::RobotShape robot();
    /// Half of its solids on links are capsules.
    downwash::SpaceRobotShape space_robot(int links);
    downwash::PlanarPose pose();
    /// Any attitude, joint angles of up to half a turn.
    downwash::SpacePose space_pose();
    downwash::PlaneOfMotion plane();

 private:
    std::mt19937 engine_;
};

}  // namespace reference

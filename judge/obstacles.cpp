#include "downwash/judge/obstacles.hpp"

#include <cmath>
#include <utility>

#include "downwash/base/infinity.hpp"
#include "downwash/judge/placement.hpp"
#include "downwash/judge/solids.hpp"

namespace downwash::judge {
namespace {}  // namespace

struct Obstacles::Solids {
    PlaneOfMotion plane;
    RobotShape robot;
    ObstacleSolids obstacles;
    std::vector<Part> bodies;  ///< in the body frame
    Geometry arm, disc;

    Solids(const PlaneOfMotion& of, const RobotShape& flown, const std::vector<Obstacle>& all)
        : plane(of), robot(flown), obstacles(all) {}

    /// A vector of the plane in the world.
    [[nodiscard]] Eigen::Vector3d direction(double x, double z) const {
        return {x * plane.cos_heading(), x * plane.sin_heading(), z};
    }
};

Obstacles::Obstacles(const std::vector<Obstacle>& obstacles, const PlaneOfMotion& plane, const RobotShape& robot,
                     double rotor_radius_m) {
    auto solids = std::make_unique<Solids>(plane, robot, obstacles);
    for (const BodyShape& body : robot.bodies) {
        std::visit(
            [&](const auto& shape) {
                read_shape(shape, moved(vector_of(body.center_body_m)), [&](Geometry geometry, const Pose& pose) {
                    solids->bodies.emplace_back(std::move(geometry), pose);
                });
            },
            body.shape);
    }
    solids->arm = capsule_of(robot.arm_radius_m, robot.arm_length_m);
    solids->disc = disc_of(rotor_radius_m);
    solids_ = std::move(solids);
}

Obstacles::~Obstacles() = default;

double Obstacles::clearance_m(const PlanarPose& pose) const {
    const Solids& s = *solids_;
    Pose body = moved(vector_of(s.plane.to_world(pose.x_m, pose.lateral_m, pose.z_m)));
    body.linear() = (Eigen::AngleAxisd(s.plane.heading_rad(), Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(pose.pitch_rad, Eigen::Vector3d::UnitY()))
                        .toRotationMatrix();
    double least_m = infinity;
    for (const Part& part : s.bodies) {
        least_m = s.obstacles.distance_m(part.geometry, body * part.pose, least_m);
    }
    const double angle = pose.pitch_rad + pose.arm_rad;
    const Eigen::Vector3d along = s.direction(std::cos(angle), -std::sin(angle));
    const Eigen::Vector3d joint = body * Eigen::Vector3d(s.robot.joint_x_m, 0, s.robot.joint_z_m);
    Pose arm = moved(joint + 0.5 * s.robot.arm_length_m * along);
    arm.linear() = turn_from_z(along).toRotationMatrix();
    return s.obstacles.distance_m(s.arm, arm, least_m);
}

bool Obstacles::disc_keeps(double distance_m, double x_m, double lateral_m, double z_m) const {
    const Pose pose = moved(vector_of(solids_->plane.to_world(x_m, lateral_m, z_m)));
    return solids_->obstacles.distance_m(solids_->disc, pose, distance_m) >= distance_m;
}

}  // namespace downwash::judge

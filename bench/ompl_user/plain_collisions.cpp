#include "plain_collisions.hpp"

#include <fcl/fcl.h>

#include <memory>
#include <numbers>
#include <stdexcept>
#include <variant>

namespace downwash::bench {
namespace {

std::shared_ptr<fcl::CollisionGeometryd> geometry_of(const Box& box) {
    return std::make_shared<fcl::Boxd>(box.size_m[0], box.size_m[1], box.size_m[2]);
}
std::shared_ptr<fcl::CollisionGeometryd> geometry_of(const Cylinder& cylinder) {
    return std::make_shared<fcl::Cylinderd>(cylinder.radius_m, cylinder.length_m);
}
std::shared_ptr<fcl::CollisionGeometryd> geometry_of(const Sphere& sphere) {
    return std::make_shared<fcl::Sphered>(sphere.radius_m);
}
template <class Shape>
std::shared_ptr<fcl::CollisionGeometryd> geometry_of(const Shape&) {
    throw std::invalid_argument("this baseline knows boxes, cylinders and spheres only");
}

Eigen::Quaterniond turn_of(const Cylinder& cylinder) {
    return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(),
                                              Eigen::Vector3d(cylinder.axis[0], cylinder.axis[1], cylinder.axis[2]));
}
template <class Shape>
Eigen::Quaterniond turn_of(const Shape&) {
    return Eigen::Quaterniond::Identity();
}

}  // namespace

PlainCollisions::PlainCollisions(const Problem& problem)
    : plane_(problem.plane),
      joint_m_(problem.robot.arm.joint_x_m, 0, problem.robot.arm.joint_z_m),
      arm_length_m_(problem.robot.arm.length_m) {
    for (const Obstacle& obstacle : problem.obstacles) {
        const Eigen::Quaterniond placed = Eigen::AngleAxisd(obstacle.rpy_rad[2], Eigen::Vector3d::UnitZ()) *
                                          Eigen::AngleAxisd(obstacle.rpy_rad[1], Eigen::Vector3d::UnitY()) *
                                          Eigen::AngleAxisd(obstacle.rpy_rad[0], Eigen::Vector3d::UnitX());
        std::visit(
            [&](const auto& shape) {
                obstacles_.emplace_back(geometry_of(shape), (placed * turn_of(shape)).toRotationMatrix(),
                                        Eigen::Vector3d(obstacle.center_world_m[0], obstacle.center_world_m[1],
                                                        obstacle.center_world_m[2]));
            },
            obstacle.shape);
    }
    for (const BodyShape& part : problem.robot.body) {
        std::visit(
            [&](const auto& shape) {
                parts_.emplace_back(geometry_of(shape));
                part_turns_.push_back(turn_of(shape));
            },
            part.shape);
        part_centers_m_.emplace_back(part.center_body_m[0], part.center_body_m[1], part.center_body_m[2]);
    }
    const ArmParameters& arm = problem.robot.arm;
    parts_.emplace_back(std::make_shared<fcl::Capsuled>(arm.radius_m, arm.length_m));
}

bool PlainCollisions::is_free(const double q[4]) {
    const Eigen::Quaterniond heading(Eigen::AngleAxisd(plane_.heading_rad(), Eigen::Vector3d::UnitZ()));
    const Vector3 origin = plane_.to_world(q[0], 0, q[1]);
    const Eigen::Vector3d position(origin[0], origin[1], origin[2]);
    const Eigen::Quaterniond body = heading * Eigen::AngleAxisd(q[2], Eigen::Vector3d::UnitY());
    for (std::size_t i = 0; i + 1 < parts_.size(); ++i) {
        parts_[i].setTransform((body * part_turns_[i]).toRotationMatrix(), position + body * part_centers_m_[i]);
    }
    // The capsule's axis is z: turned so that it points along the arm.
    const Eigen::Quaterniond arm = body * Eigen::AngleAxisd(q[3] + std::numbers::pi / 2, Eigen::Vector3d::UnitY());
    parts_.back().setTransform(arm.toRotationMatrix(),
                               position + body * joint_m_ + arm * Eigen::Vector3d(0, 0, 0.5 * arm_length_m_));
    for (fcl::CollisionObjectd& part : parts_) {
        part.computeAABB();
        for (const fcl::CollisionObjectd& obstacle : obstacles_) {
            const fcl::CollisionRequestd request;
            fcl::CollisionResultd result;
            if (fcl::collide(&part, &obstacle, request, result) > 0) {
                return false;
            }
        }
    }
    return true;
}

}  // namespace downwash::bench

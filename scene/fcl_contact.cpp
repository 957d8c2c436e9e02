#include "downwash/scene/fcl_contact.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <memory>

namespace downwash {
namespace {

Eigen::Vector3d eigen(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

std::shared_ptr<const fcl::CollisionGeometryd> mesh_of_one(const Convex& triangle) {
    auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBd>>();
    mesh->beginModel(1, 3);
    mesh->addTriangle(eigen(triangle.half_axes_m[0]), eigen(triangle.half_axes_m[1]), eigen(triangle.half_axes_m[2]));
    mesh->endModel();
    return mesh;
}

std::shared_ptr<const fcl::CollisionGeometryd> geometry_of(const Convex& convex) {
    const auto length = [&](std::size_t i) { return 2 * eigen(convex.half_axes_m[i]).norm(); };
    if (convex.is_triangle) {
        return mesh_of_one(convex);
    }
    if (convex.segment_count == 3) {
        return std::make_shared<fcl::Boxd>(length(0), length(1), length(2));
    }
    if (convex.segment_count == 0) {
        return std::make_shared<fcl::Sphered>(convex.ball_radius_m);
    }
    if (convex.disc_radius_m > 0) {
        return std::make_shared<fcl::Cylinderd>(convex.disc_radius_m, length(0));
    }
    return std::make_shared<fcl::Capsuled>(convex.ball_radius_m, length(0));
}

/// FCL's boxes have their edges along x, y, z, its cylinders and capsules their axis along z.
Eigen::Matrix3d rotation_of(const Convex& convex) {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    if (convex.segment_count == 3 && !convex.is_triangle) {
        for (std::size_t i = 0; i < 3; ++i) {
            rotation.col(static_cast<Eigen::Index>(i)) = eigen(convex.half_axes_m[i]).normalized();
        }
    } else if (convex.segment_count == 1) {
        const Eigen::Vector3d axis = eigen(convex.half_axes_m[0]);
        rotation = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
    }
    return rotation;
}

fcl::Transform3d pose_of(const Convex& convex) {
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    pose.linear() = rotation_of(convex);
    pose.translation() = eigen(convex.center_m);
    return pose;
}

}  // namespace

bool fcl_says_contact(const Convex& a, const Convex& b) {
    const fcl::CollisionRequestd request(1, false);
    fcl::CollisionResultd result;
    fcl::collide(geometry_of(a).get(), pose_of(a), geometry_of(b).get(), pose_of(b), request, result);
    return result.isCollision();
}

}  // namespace downwash

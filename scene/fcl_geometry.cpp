#include "downwash/scene/fcl_geometry.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>

#include <cmath>
#include <variant>

#include "downwash/base/infinity.hpp"

namespace downwash::in_fcl {
namespace {

/// Turned so that the z axis, along which FCL's cylinders and capsules lie, shows along a direction.
Pose turned_to(const Pose& pose, const Vector3& direction) {
    Pose turned = pose;
    turned.rotate(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), vector_of(direction)));
    return turned;
}

/// The same for a capsule's own direction, exact along the axes (Duff et al. 2017). @param d of length 1
Pose along(const Pose& pose, const Eigen::Vector3d& d) {
    const double sign = std::copysign(1.0, d.z());
    const double a = -1 / (sign + d.z()), b = d.x() * d.y() * a;
    Pose turned = pose;
    Eigen::Matrix3d axes;
    axes << 1 + sign * d.x() * d.x() * a, b, d.x(),  //
        sign * b, sign + d.y() * d.y() * a, d.y(),   //
        -sign * d.x(), -d.y(), d.z();
    turned.linear() = pose.linear() * axes;
    return turned;
}

}  // namespace

Pose pose_of(const Matrix3& rotation, const Vector3& at_m) {
    Pose pose = Pose::Identity();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            pose.linear()(row, column) = rotation[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
        }
    }
    pose.translation() = vector_of(at_m);
    return pose;
}

std::pair<Geometry, Pose> placed_solid(const SpaceShape& shape, const Pose& pose) {
    struct Maker {
        const Pose& pose;
        std::pair<Geometry, Pose> operator()(const Box& box) const {
            return {std::make_shared<fcl::Boxd>(vector_of(box.size_m)), pose};
        }
        std::pair<Geometry, Pose> operator()(const Sphere& sphere) const {
            return {std::make_shared<fcl::Sphered>(sphere.radius_m), pose};
        }
        std::pair<Geometry, Pose> operator()(const Cylinder& cylinder) const {
            return {std::make_shared<fcl::Cylinderd>(cylinder.radius_m, cylinder.length_m),
                    turned_to(pose, cylinder.axis)};
        }
        std::pair<Geometry, Pose> operator()(const Capsule& capsule) const {
            const Eigen::Vector3d axis = vector_of(capsule.to_m - capsule.from_m);
            const double length_m = axis.norm();
            const Eigen::Vector3d direction =
                length_m > 0 ? Eigen::Vector3d(axis / length_m) : Eigen::Vector3d::UnitZ();
            Pose middle = pose;
            middle.translation() += pose.linear() * vector_of(0.5 * (capsule.from_m + capsule.to_m));
            return {std::make_shared<fcl::Capsuled>(capsule.radius_m, length_m), along(middle, direction)};
        }
    };
    return std::visit(Maker{pose}, shape);
}

double half_extent_m(const fcl::CollisionGeometryd& shape, const Eigen::Vector3d& d) {
    switch (shape.getNodeType()) {
        case fcl::GEOM_BOX:
            return 0.5 * d.cwiseAbs().dot(static_cast<const fcl::Boxd&>(shape).side);
        case fcl::GEOM_SPHERE:
            return static_cast<const fcl::Sphered&>(shape).radius;
        case fcl::GEOM_CAPSULE: {
            const auto& capsule = static_cast<const fcl::Capsuled&>(shape);
            return capsule.radius + 0.5 * capsule.lz * std::abs(d.z());
        }
        case fcl::GEOM_CYLINDER: {
            const auto& cylinder = static_cast<const fcl::Cylinderd&>(shape);
            return cylinder.radius * std::hypot(d.x(), d.y()) + 0.5 * cylinder.lz * std::abs(d.z());
        }
        default:
            return infinity;
    }
}

fcl::AABBd box_around(const fcl::CollisionGeometryd& shape, const Pose& at) {
    Eigen::Vector3d half;
    for (int k = 0; k < 3; ++k) {
        half[k] = half_extent_m(shape, at.linear().row(k).transpose());
    }
    return {at.translation() - half, at.translation() + half};
}

Geometry tree_of(const Triangles& triangles) {
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    model->beginModel(static_cast<int>(triangles.which.size()));
    triangles.each([&](const Triangle& triangle) {
        model->addTriangle(vector_of(triangle[0]), vector_of(triangle[1]), vector_of(triangle[2]));
    });
    model->endModel();
    return model;
}

fcl::AABBd box_around(const Triangles& triangles) {
    fcl::AABBd box;
    triangles.each([&](const Triangle& triangle) {
        for (const Vector3& corner_m : triangle) {
            box += vector_of(corner_m);
        }
    });
    return box;
}

}  // namespace downwash::in_fcl

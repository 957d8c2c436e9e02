#include "downwash/judge/solids.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/base/infinity.hpp"
#include "downwash/judge/placement.hpp"

namespace downwash::judge {
namespace {

constexpr double gjk_tolerance = 1e-12;
/// A distance that is proven up to this is not asked for again [m].
constexpr double trusted_m = 1e-6;

/// A rotor disc is a cylinder so thin [m].
constexpr double disc_thickness_m = 1e-5;

/// Calls add(geometry, pose) for every solid that a shape consists of.
struct ShapeReader {
    Pose pose;
    const TakeSolid& add;

    void operator()(const Box& box) const {
        add(std::make_shared<fcl::Boxd>(box.size_m[0], box.size_m[1], box.size_m[2]), pose);
    }
    void operator()(const Sphere& sphere) const { add(std::make_shared<fcl::Sphered>(sphere.radius_m), pose); }
    void operator()(const Cylinder& cylinder) const {
        Pose turned = pose;
        turned.rotate(turn_from_z(vector_of(cylinder.axis)));
        add(std::make_shared<fcl::Cylinderd>(cylinder.radius_m, cylinder.length_m), turned);
    }
    void operator()(const Mesh& mesh) const {
        auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
        model->beginModel(static_cast<int>(mesh.surface->triangles.size()));
        for (const auto& triangle : mesh.surface->triangles) {
            const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
                return vector_of(local_m(mesh, mesh.surface->vertices_m[triangle[i]]));
            };
            const Eigen::Vector3d a = corner(0);
            const Eigen::Vector3d b = corner(1);
            const Eigen::Vector3d c = corner(2);
            if ((b - a).cross(c - a) != Eigen::Vector3d::Zero()) {
                model->addTriangle(a, b, c);
            }
        }
        model->endModel();
        add(std::move(model), pose);
    }
    void operator()(const Octomap& octomap) const {
        for_each_solid_box(octomap, [this](const LocalBox& box) {
            Pose placed = pose;
            placed.translate(vector_of(box.center_m));
            add(std::make_shared<fcl::Boxd>(vector_of(box.size_m)), placed);
        });
    }
};

/// The farthest that a convex solid reaches along a direction of the world [m]; infinity where the shape is none of
/// ours.
double reach_along(const Eigen::Vector3d& direction, const fcl::CollisionGeometryd& shape, const Pose& at) {
    const Eigen::Vector3d d = at.linear().transpose() * direction;
    const double center_m = direction.dot(at.translation());
    switch (shape.getNodeType()) {
        case fcl::GEOM_BOX:
            return center_m + 0.5 * d.cwiseAbs().dot(static_cast<const fcl::Boxd&>(shape).side);
        case fcl::GEOM_SPHERE:
            return center_m + static_cast<const fcl::Sphered&>(shape).radius;
        case fcl::GEOM_CAPSULE: {
            const auto& capsule = static_cast<const fcl::Capsuled&>(shape);
            return center_m + capsule.radius + 0.5 * capsule.lz * std::abs(d.z());
        }
        case fcl::GEOM_CYLINDER: {
            const auto& cylinder = static_cast<const fcl::Cylinderd&>(shape);
            return center_m + cylinder.radius * std::hypot(d.x(), d.y()) + 0.5 * cylinder.lz * std::abs(d.z());
        }
        default:
            return infinity;
    }
}

/// What one of FCL's solvers says.
struct Answer {
    double distance_m;  ///< 0 on contact
    double proven_m;    ///< no less: the gap along the line between the nearest points that it names
};

Answer answer_of(fcl::GJKSolverType solver, const fcl::CollisionGeometryd& a, const Pose& at_a,
                 const fcl::CollisionGeometryd& b, const Pose& at_b) {
    fcl::DistanceRequestd request(true);
    request.gjk_solver_type = solver;
    request.distance_tolerance = gjk_tolerance;
    fcl::DistanceResultd result;
    const double distance_m = fcl::distance(&a, at_a, &b, at_b, request, result);
    const Eigen::Vector3d line = result.nearest_points[1] - result.nearest_points[0];
    const double length_m = line.norm();
    Answer answer{distance_m > 0 ? distance_m : 0, 0};  // what is no number is contact, too
    if (length_m > 0) {
        const Eigen::Vector3d n = line / length_m;
        answer.proven_m = -reach_along(-n, b, at_b) - reach_along(n, a, at_a);
    }
    return answer;
}

}  // namespace

/// The distance of two solids [m], 0 on contact. Between some of them, a slab and a thin plate for instance, libccd
/// ends far from the minimum; FCL's other solver does so between others. A distance is trusted at once if the gap
/// between both solids is as wide along some direction, which proves it from below. Otherwise the lesser of both
/// counts.
double distance_between(const fcl::CollisionGeometryd& a, const Pose& at_a, const fcl::CollisionGeometryd& b,
                        const Pose& at_b) {
    const Answer first = answer_of(fcl::GST_LIBCCD, a, at_a, b, at_b);
    if (first.distance_m - first.proven_m <= trusted_m || b.getObjectType() == fcl::OT_BVH) {
        return first.distance_m;
    }
    const Answer second = answer_of(fcl::GST_INDEP, a, at_a, b, at_b);
    return second.distance_m - second.proven_m <= trusted_m ? second.distance_m
                                                            : std::min(first.distance_m, second.distance_m);
}

namespace {

/// The nearest of many solids so far.
struct Nearest {
    double distance_m;

    static bool visit(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* nearest, double& bound_m) {
        double& least_m = static_cast<Nearest*>(nearest)->distance_m;
        least_m = std::min(least_m, distance_between(*a->collisionGeometry(), a->getTransform(),
                                                     *b->collisionGeometry(), b->getTransform()));
        bound_m = least_m;
        return least_m <= 0;
    }
};

}  // namespace

Pose moved(const Eigen::Vector3d& by) {
    Pose pose = Pose::Identity();
    pose.translation() = by;
    return pose;
}

// NOLINTNEXTLINE(modernize-pass-by-value): nothing to move in a matrix
Part::Part(Geometry shape, const Pose& at) : geometry(std::move(shape)), pose(at) {
    geometry->computeLocalAABB();
    box = fcl::CollisionObjectd(geometry, pose).getAABB();
}

void read_shape(const Shape& shape, const Pose& pose, const TakeSolid& take) {
    std::visit(ShapeReader{pose, take}, shape);
}

Geometry capsule_of(double radius_m, double length_m) {
    Geometry capsule = std::make_shared<fcl::Capsuled>(radius_m, length_m);
    capsule->computeLocalAABB();
    return capsule;
}

Geometry disc_of(double radius_m) {
    Geometry disc = std::make_shared<fcl::Cylinderd>(radius_m, disc_thickness_m);
    disc->computeLocalAABB();
    return disc;
}

struct ObstacleSolids::Many {
    std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
    fcl::DynamicAABBTreeCollisionManagerd tree;  ///< A tree of those.
};

ObstacleSolids::ObstacleSolids(const std::vector<Obstacle>& obstacles) : many_(std::make_unique<Many>()) {
    constexpr std::size_t max_asked_one_by_one = 64;
    const bool are_many = obstacles.size() > max_asked_one_by_one;
    for (const Obstacle& obstacle : obstacles) {
        const bool is_in_tree = std::holds_alternative<Octomap>(obstacle.shape) ||
                                (are_many && !std::holds_alternative<Mesh>(obstacle.shape));
        read_shape(obstacle.shape, pose_of(obstacle), [&](Geometry geometry, const Pose& pose) {
            if (is_in_tree) {
                geometry->computeLocalAABB();
                many_->objects.push_back(std::make_unique<fcl::CollisionObjectd>(std::move(geometry), pose));
            } else {
                few_.emplace_back(std::move(geometry), pose);
            }
        });
    }
    std::vector<fcl::CollisionObjectd*> objects;
    for (const auto& object : many_->objects) {
        objects.push_back(object.get());
    }
    if (!objects.empty()) {
        many_->tree.registerObjects(objects);
        many_->tree.setup();
    }
}

ObstacleSolids::~ObstacleSolids() = default;

double ObstacleSolids::distance_m(const Geometry& solid, const Pose& pose, double enough_m) const {
    fcl::CollisionObjectd object(solid, pose);
    for (const Part& part : few_) {
        if (object.getAABB().distance(part.box) < enough_m) {
            enough_m = std::min(enough_m, distance_between(*solid, pose, *part.geometry, part.pose));
        }
    }
    if (!many_->objects.empty() && enough_m > 0) {
        Nearest nearest{enough_m};
        many_->tree.distance(&object, &nearest, Nearest::visit);
        enough_m = nearest.distance_m;
    }
    return enough_m;
}

}  // namespace downwash::judge

// FCL's own trees over a whole mesh and a whole octree decide as we do with ours.

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/collision.h>
#include <octomap/OcTree.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "../support/meshes.hpp"
#include "reference.hpp"

using namespace downwash;

namespace {

const Vector3 body_m{0.4, 0.3, 0.1};

/// The body at a pose in the plane y = 0: the arm is a short one inside of it.
RobotShape robot() {
    return {{{Box{body_m}, {}}}, 0, 0, 0.05, 0.02};
}

fcl::Transform3d pose_of(const PlanarPose& pose) {
    fcl::Transform3d frame = fcl::Transform3d::Identity();
    frame.linear() = Eigen::AngleAxisd(pose.pitch_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    frame.translation() = Eigen::Vector3d(pose.x_m, 0, pose.z_m);
    return frame;
}

/// Counts poses in contact and free, but for those within a micrometre of touching.
void compare(const Shape& shape, const fcl::CollisionGeometryd& geometry) {
    const auto scene = std::make_shared<const Scene>(std::vector<Obstacle>{{"", shape, {}, {}}});
    const CollisionChecker checker(scene, {}, robot());
    const fcl::Boxd body(body_m[0], body_m[1], body_m[2]);
    reference::Dice dice(51);
    int contacts = 0;
    int free = 0;
    for (int i = 0; i < 3000; ++i) {
        const PlanarPose pose{dice.between(-1, 1), dice.between(-1, 1), dice.between(-3, 3), 0};
        fcl::CollisionResultd result;
        fcl::collide(&body, pose_of(pose), &geometry, fcl::Transform3d::Identity(), fcl::CollisionRequestd(), result);
        const double clearance = checker.clearance_m(pose);
        if (clearance <= 0 || clearance > 1e-6) {
            CAPTURE(i, clearance);
            REQUIRE(result.isCollision() == (clearance <= 0));
            REQUIRE(result.isCollision() == checker.is_nearer_than(pose, 0));
            (clearance <= 0 ? contacts : free) += 1;
        }
    }
    CHECK(contacts > 150);
    CHECK(free > 150);
}

}  // namespace

TEST_CASE("FCL's tree over a whole mesh finds the same contacts") {
    // The pipe is too thin to hide the body, which FCL would not find inside of it.
    const Mesh pipe = test::pipe_mesh(0.15, 2, 24, 10);
    fcl::BVHModel<fcl::OBBRSSd> model;
    model.beginModel();
    for (const auto& triangle : pipe.surface->triangles) {
        const auto corner = [&](std::size_t i) {
            const Vector3& v = pipe.surface->vertices_m[triangle[i]];
            return Eigen::Vector3d(v[0], v[1], v[2]);
        };
        model.addTriangle(corner(0), corner(1), corner(2));
    }
    model.endModel();
    compare(pipe, model);
}

TEST_CASE("FCL's octree finds the same contacts") {
    const auto is_occupied = [](const Vector3& p) { return std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]) < 0.9; };
    const Octomap octomap = test::octree_of(is_occupied, {-1, -1, -1}, {1, 1, 1}, 0.125);
    const auto tree = std::make_shared<octomap::OcTree>(0.125);
    for (const OccupiedCube& cube : octomap.tree->cubes) {
        tree->updateNode(octomap::point3d(static_cast<float>(cube.center_m[0]), static_cast<float>(cube.center_m[1]),
                                          static_cast<float>(cube.center_m[2])),
                         10.0F);
    }
    const fcl::OcTreed geometry(tree);
    compare(octomap, geometry);
}

// FCL decides contact as we do, between primitives and with its own trees over a whole mesh and a whole octree. Its
// distances are why clearances are not FCL's: between separated solids they are off by millimetres, where a safety
// margin is fifty. Should that test ever fail, FCL has mended them and could take over.

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/meshes.hpp"
#include "reference.hpp"

using namespace downwash;

namespace {

using Geometry = std::shared_ptr<const fcl::CollisionGeometryd>;

struct Placed {
    Geometry geometry;
    fcl::Transform3d pose;
};

Placed placed(const reference::Solid& solid) {
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            pose.linear()(row, column) = solid.axes[static_cast<std::size_t>(column)][static_cast<std::size_t>(row)];
        }
    }
    pose.translation() = Eigen::Vector3d(solid.center_m[0], solid.center_m[1], solid.center_m[2]);
    const Vector3& half = solid.half_m;
    if (solid.ball_m > 0) {
        return {std::make_shared<fcl::Sphered>(solid.ball_m), pose};
    }
    if (solid.kind == reference::Solid::Kind::box) {
        return {std::make_shared<fcl::Boxd>(2 * half[0], 2 * half[1], 2 * half[2]), pose};
    }
    return {std::make_shared<fcl::Cylinderd>(half[0], 2 * half[2]), pose};
}

bool are_in_contact(const Placed& a, const Placed& b) {
    fcl::CollisionResultd result;
    fcl::collide(a.geometry.get(), a.pose, b.geometry.get(), b.pose, fcl::CollisionRequestd(), result);
    return result.isCollision();
}

/// Compares contacts of a body with an obstacle at random poses in the plane y = 0, but for those within a micrometre
/// of touching. The arm is a short one inside of the body.
void compare(const Primitive& body, const Obstacle& obstacle, const Placed& there, int poses, unsigned seed) {
    const CollisionChecker checker = reference::checker_of({obstacle}, {{{body, {}}}, 0, 0, 0.02, 0.01});
    reference::Dice dice(seed);
    int contacts = 0;
    int free = 0;
    for (int i = 0; i < poses; ++i) {
        const PlanarPose pose{dice.between(-1, 1), dice.between(-1, 1), dice.between(-3, 3), 0};
        const Obstacle here{"", reference::shape_of(body), {pose.x_m, 0, pose.z_m}, {0, pose.pitch_rad, 0}};
        const double clearance = checker.clearance_m(pose);
        if (clearance <= 0 || clearance > 2e-6) {
            const bool is_contact = are_in_contact(placed(reference::solid_of(here)), there);
            CAPTURE(i, clearance);
            REQUIRE(is_contact == (clearance <= 0));
            REQUIRE(is_contact == checker.is_nearer_than(pose, 0));
            (clearance <= 0 ? contacts : free) += 1;
        }
    }
    CHECK(contacts > poses / 20);
    CHECK(free > poses / 20);
}

const Primitive plate = Box{{0.4, 0.3, 0.1}};

}  // namespace

TEST_CASE("FCL finds the same contacts between boxes, cylinders and spheres") {
    reference::Dice dice(50);
    for (unsigned round = 0; round < 60; ++round) {
        Obstacle obstacle = dice.obstacle();
        obstacle.shape = reference::shape_of(dice.shape(0.4, 1));
        obstacle.center_world_m = dice.vector(-0.2, 0.2);
        compare(dice.shape(0.1, 0.4), obstacle, placed(reference::solid_of(obstacle)), 200, round);
    }
}

TEST_CASE("FCL's tree over a whole mesh finds the same contacts") {
    // The pipe is too thin to hide the body, which FCL would not find inside of it.
    const Mesh pipe = test::pipe_mesh(0.15, 2, 24, 10);
    const auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    model->beginModel();
    for (const auto& triangle : pipe.surface->triangles) {
        const auto corner = [&](std::size_t i) {
            const Vector3& v = pipe.surface->vertices_m[triangle[i]];
            return Eigen::Vector3d(v[0], v[1], v[2]);
        };
        model->addTriangle(corner(0), corner(1), corner(2));
    }
    model->endModel();
    compare(plate, {"", pipe, {}, {}}, {model, fcl::Transform3d::Identity()}, 3000, 51);
}

TEST_CASE("FCL's octree finds the same contacts") {
    const auto is_occupied = [](const Vector3& p) { return std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]) < 0.9; };
    const Octomap octomap = test::octree_of(is_occupied, {-1, -1, -1}, {1, 1, 1}, 0.125);
    const auto tree = std::make_shared<octomap::OcTree>(0.125);
    for (const OccupiedCube& cube : octomap.tree->cubes) {
        tree->updateNode(
            octomap::point3d(static_cast<float>(cube.center_local_m[0]), static_cast<float>(cube.center_local_m[1]),
                             static_cast<float>(cube.center_local_m[2])),
            10.0F);
    }
    compare(plate, {"", octomap, {}, {}}, {std::make_shared<fcl::OcTreed>(tree), fcl::Transform3d::Identity()}, 3000,
            51);
}

TEST_CASE("FCL's distances between boxes and cylinders are off by more than a millimetre") {
    reference::Dice dice(1);
    const auto solid = [&dice](const Shape& shape) {
        const Vector3 center_m = dice.vector(-1, 1);
        return reference::solid_of({"", shape, center_m, dice.vector(-3, 3)});
    };
    double worst_m = 0;
    for (int i = 0; i < 3000; ++i) {
        const reference::Solid box = solid(Box{dice.vector(0.05, 1)});
        const reference::Solid cylinder = solid(Cylinder{dice.between(0.05, 0.5), dice.between(0.05, 1), {0, 0, 1}});
        const reference::Enclosure truth = reference::distance(box, cylinder);
        if (truth.low > 0.01 && truth.high - truth.low < 1e-6) {
            const Placed a = placed(box);
            const Placed b = placed(cylinder);
            fcl::DistanceResultd result;
            const double measured_m =
                fcl::distance(a.geometry.get(), a.pose, b.geometry.get(), b.pose, fcl::DistanceRequestd(), result);
            worst_m = std::max({worst_m, truth.low - measured_m, measured_m - truth.high});
        }
    }
    CAPTURE(worst_m);
    CHECK(worst_m > 1e-3);
}

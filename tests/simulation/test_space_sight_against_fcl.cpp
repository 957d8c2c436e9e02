#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "../support/random.hpp"
#include "downwash/simulation/space_goal_error.hpp"

// Lines of sight of cameras against thin cylinders of the Flexible Collision Library.

using namespace downwash;

namespace {

using Solid = fcl::CollisionObjectd;

Eigen::Vector3d eigen(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

/// Obstacles, and the same for FCL.
struct Both {
    std::vector<Obstacle> ours;
    std::vector<std::unique_ptr<Solid>> fcls;
};

Both random_obstacles(test::Random& random) {
    Both both;
    const auto vector = [&](double size) {
        return Vector3{random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
    };
    constexpr int count = 18;
    for (int i = 0; i < count; ++i) {
        Obstacle one;
        one.center_world_m = vector(2);
        one.rpy_rad = vector(3);
        std::shared_ptr<fcl::CollisionGeometryd> geometry;
        const double a = random.uniform(0.1, 0.8), b = random.uniform(0.1, 0.8), c = random.uniform(0.1, 0.8);
        if (i % 3 == 0) {
            one.shape = Box{{a, b, c}};
            geometry = std::make_shared<fcl::Boxd>(a, b, c);
        } else if (i % 3 == 1) {
            one.shape = Cylinder{a, b, {0, 0, 1}};
            geometry = std::make_shared<fcl::Cylinderd>(a, b);
        } else {
            one.shape = Sphere{a};
            geometry = std::make_shared<fcl::Sphered>(a);
        }
        const Eigen::Matrix3d turn = (Eigen::AngleAxisd(one.rpy_rad[2], Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(one.rpy_rad[1], Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(one.rpy_rad[0], Eigen::Vector3d::UnitX()))
                                         .toRotationMatrix();
        both.fcls.push_back(std::make_unique<Solid>(geometry, turn, eigen(one.center_world_m)));
        both.ours.push_back(one);
    }
    return both;
}

/// Whether a cylinder on the line from one point toward another, lengthened at both ends, touches an obstacle.
bool is_hit(const Both& both, const Vector3& from_m, const Vector3& to_m, double short_m, double radius_m,
            double longer_m) {
    const Eigen::Vector3d from = eigen(from_m), way = eigen(to_m) - from;
    const double length = way.norm();
    const double begin = -longer_m, end = length - short_m + longer_m;
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), way);
    Solid ray(std::make_shared<fcl::Cylinderd>(radius_m, end - begin), turn.toRotationMatrix(),
              from + (0.5 * (begin + end) / length) * way);
    return std::any_of(both.fcls.begin(), both.fcls.end(), [&](const std::unique_ptr<Solid>& solid) {
        fcl::CollisionResultd result;
        return fcl::collide(&ray, solid.get(), fcl::CollisionRequestd(), result) > 0;
    });
}

}  // namespace

TEST_CASE("A camera sees a target where a thin cylinder of FCL touches nothing, of 2,000 lines") {
    test::Random random(4);
    int seen = 0, hidden = 0, undecided = 0;
    for (int scene = 0; scene < 40; ++scene) {
        const Both both = random_obstacles(random);
        const Scene ours(both.ours);
        for (int i = 0; i < 50; ++i) {
            const auto place = [&] {
                return Vector3{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
            };
            const Vector3 camera_m = place(), target_m = place();
            const bool is_seen = sees(ours, camera_m, target_m);
            CAPTURE(scene, i, is_seen);
            // What lies between both cylinders is as near to the line as the choice of its thickness.
            if (is_hit(both, camera_m, target_m, sight_end_m, 0.5 * sight_radius_m, 0)) {
                CHECK_FALSE(is_seen);
                ++hidden;
            } else if (!is_hit(both, camera_m, target_m, sight_end_m, 1.5 * sight_radius_m, 1.5 * sight_radius_m)) {
                CHECK(is_seen);
                ++seen;
            } else {
                ++undecided;
            }
        }
    }
    CHECK(seen > 500);
    CHECK(hidden > 500);
    CHECK(undecided < 20);
}

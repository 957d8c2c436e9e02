#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <random>

#include "downwash/scene/collision_checker.hpp"
#include "downwash/scene/line_of_sight.hpp"
#include "downwash/scene/space_checker.hpp"

// Lines of sight against FCL, which asks a capsule, and against many points of the line.

using namespace downwash;

namespace {

std::shared_ptr<const TriangleMesh> roof() {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->vertices_m = {{-1, -0.6, 0}, {1, -0.6, 0}, {1, 0, 0.5}, {-1, 0, 0.5}, {1, 0.6, 0}, {-1, 0.6, 0}};
    mesh->triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {3, 4, 5}};
    return mesh;
}

std::vector<Obstacle> some_obstacles() {
    std::vector<Obstacle> all = {{"box", Box{{0.6, 1.1, 0.4}}, {0.5, -0.8, 0.3}, {0.3, 0.2, 0.9}},
                                 {"can", Cylinder{0.3, 1.2, {0.2, 1, 0.3}}, {-0.9, 0.6, -0.4}, {0, 0, 0.5}},
                                 {"ball", Sphere{0.35}, {0.9, 0.9, 0.2}, {}}};
    Mesh mesh;
    mesh.surface = roof();
    all.push_back({"roof", mesh, {0, 0, 1}, {0.1, 0, 0.4}});
    return all;
}

/// FCL's word on a capsule around the line.
bool is_clear_by_fcl(const std::shared_ptr<const Scene>& scene, const Vector3& from_m, const Vector3& to_m,
                     double radius_m) {
    const SpaceRobotShape capsule{{{Capsule{radius_m, from_m, to_m}, {0, 0, 0}}}, {}};
    return !SpaceChecker(scene, capsule, CollisionCheckerKind::fcl).is_nearer_than({}, 0);
}

/// The least distance of a scene from many points of a line.
double sampled_m(const Scene& scene, const Vector3& from_m, const Vector3& to_m) {
    constexpr int points = 400;
    double least_m = 1e9;
    for (int i = 0; i <= points; ++i) {
        least_m = std::min(least_m,
                           disc_clearance_m(scene, from_m + (static_cast<double>(i) / points) * (to_m - from_m), 1e-7));
    }
    return least_m;
}

}  // namespace

TEST_CASE("A line of sight is clear where FCL and many of its points say so") {
    const auto scene = std::make_shared<const Scene>(some_obstacles());
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> place(-2, 2);
    constexpr double radius_m = 0.02;
    int clear = 0, blocked = 0;
    for (int i = 0; i < 600; ++i) {
        const Vector3 from_m{place(random), place(random), place(random)};
        const Vector3 to_m{place(random), place(random), place(random)};
        const bool is_clear = is_line_clear(*scene, from_m, to_m, radius_m);
        const double step_m = std::sqrt(dot(to_m - from_m, to_m - from_m)) / 400;
        const double least_m = sampled_m(*scene, from_m, to_m);
        CAPTURE(i, least_m);
        if (least_m > radius_m + step_m) {
            CHECK(is_clear);
        } else if (least_m < radius_m) {
            CHECK_FALSE(is_clear);
        }
        if (std::abs(least_m - radius_m) > step_m) {
            CHECK(is_clear_by_fcl(scene, from_m, to_m, radius_m) == is_clear);
        }
        ++(is_clear ? clear : blocked);
    }
    CHECK(clear > 100);
    CHECK(blocked > 100);
}

TEST_CASE("A line without length is a point") {
    const Scene scene({{"ball", Sphere{1}, {0, 0, 0}, {}}});
    CHECK(is_line_clear(scene, {0, 0, 1.02}, {0, 0, 1.02}, 0.01));
    CHECK_FALSE(is_line_clear(scene, {0, 0, 1.005}, {0, 0, 1.005}, 0.01));
    CHECK(is_line_clear(Scene({}), {0, 0, 0}, {1, 0, 0}, 1));
}

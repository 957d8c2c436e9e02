#include "scenes.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "../../tests/support/random.hpp"

namespace downwash::bench {
namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

Problem with_random_primitives(Problem problem, unsigned seed) {
    test::Random random(seed);
    const auto uniform = [&random](double low, double high) { return random.uniform(low, high); };
    problem.obstacles.clear();
    for (int i = 0; i < 10; ++i) {
        Obstacle obstacle;
        obstacle.name = "obstacle_" + std::to_string(i);
        switch (i % 3) {  // four boxes, three of either other
            case 0:
                obstacle.shape = Box{{uniform(0.3, 6), uniform(0.3, 4), uniform(0.2, 1.5)}};
                break;
            case 1:
                obstacle.shape = Cylinder{uniform(0.1, 0.8), uniform(1, 10)};
                break;
            default:
                obstacle.shape = Sphere{uniform(0.2, 1.2)};
        }
        obstacle.center_world_m = {uniform(problem.bounds.x_low_m, problem.bounds.x_high_m), uniform(-0.6, 0.6),
                                   uniform(problem.bounds.z_low_m, problem.bounds.z_high_m)};
        obstacle.rpy_rad = {uniform(-pi, pi), uniform(-pi, pi), uniform(-pi, pi)};
        problem.obstacles.push_back(obstacle);
    }
    return problem;
}

Problem with_pipe_mesh(Problem problem, std::uint32_t around, std::uint32_t along) {
    constexpr double radius_m = 0.25;
    constexpr double length_m = 12;
    auto pipe = std::make_shared<TriangleMesh>();
    for (std::uint32_t j = 0; j <= along; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const double angle_rad = 2 * pi * i / around;
            pipe->vertices_m.push_back({length_m * (static_cast<double>(j) / along - 0.5),
                                        radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad)});
        }
    }
    const auto low_end = static_cast<std::uint32_t>(pipe->vertices_m.size());
    pipe->vertices_m.push_back({-0.5 * length_m, 0, 0});
    pipe->vertices_m.push_back({0.5 * length_m, 0, 0});
    for (std::uint32_t i = 0; i < around; ++i) {
        const std::uint32_t next = (i + 1) % around;
        for (std::uint32_t j = 0; j < along; ++j) {
            const std::uint32_t row = j * around;
            pipe->triangles.push_back({row + i, row + next, row + around + i});
            pipe->triangles.push_back({row + next, row + around + next, row + around + i});
        }
        pipe->triangles.push_back({low_end, next, i});
        pipe->triangles.push_back({low_end + 1, along * around + i, along * around + next});
    }
    Obstacle obstacle;
    obstacle.name = "pipe";
    obstacle.shape = Mesh{"", 1, std::move(pipe)};
    obstacle.center_world_m = {0.5 * (problem.bounds.x_low_m + problem.bounds.x_high_m), 0,
                               0.5 * (problem.bounds.z_low_m + problem.bounds.z_high_m)};
    problem.obstacles = {obstacle};
    return problem;
}

}  // namespace downwash::bench

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "../support/meshes.hpp"
#include "../support/random.hpp"
#include "downwash/judge/obstacles.hpp"
#include "downwash/judge/plan_judge.hpp"
#include "downwash/judge/ray_effect.hpp"
#include "downwash/judge/vertical_rays.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/simulation/execution.hpp"
#include "shipped.hpp"

// The judge among so many parts that it casts rays of its own.

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A rough sheet over x from -9 to 9 m and y from -2 to 2 m.
Obstacle rough_deck(double z_m, double bumps_m) {
    Random random(1);
    constexpr std::uint32_t columns = 90;
    constexpr std::uint32_t rows = 20;
    std::vector<Vector3> vertices;
    for (std::uint32_t j = 0; j <= rows; ++j) {
        for (std::uint32_t i = 0; i <= columns; ++i) {
            vertices.push_back({18.0 * i / columns - 9, 4.0 * j / rows - 2, random.uniform(0, bumps_m)});
        }
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t j = 0; j < rows; ++j) {
        for (std::uint32_t i = 0; i < columns; ++i) {
            const std::uint32_t a = j * (columns + 1) + i;
            const std::uint32_t d = a + columns + 1;
            triangles.push_back({a, d + 1, a + 1});
            triangles.push_back({a, d, d + 1});
        }
    }
    return {"deck", mesh_of(std::move(vertices), std::move(triangles)), {0, 0, z_m}, {}};
}

/// The bridge's vehicle under a rough deck over the ground.
Problem under_rough_deck() {
    Problem problem = shipped("bridge_inspection");
    problem.uncertainty.reset();
    problem.plane = PlaneOfMotion({0, 0, 0}, 0);
    problem.obstacles = {{"ground", Box{{60, 60, 1}}, {0, 0, -0.5}, {}}, rough_deck(4, 0.15)};
    problem.start = {};
    problem.start.at = {-3, 3.55, 1.5};
    problem.goal = {};
    problem.goal.kind = ConfigurationGoal{1.0, 3.6, {}, 0.3};
    problem.goal.hold_s = 2;
    return problem;
}

std::vector<Obstacle> boxes(int count) {
    Random random(2);
    std::vector<Obstacle> all;
    for (int i = 0; i < count; ++i) {
        all.push_back({"",
                       Box{{random.uniform(0.1, 0.5), random.uniform(0.1, 0.5), random.uniform(0.1, 0.5)}},
                       {random.uniform(-8, 8), random.uniform(-2, 2), random.uniform(4, 6)},
                       {random.uniform(-0.3, 0.3), 0, random.uniform(-3, 3)}});
    }
    return all;
}

}  // namespace

TEST_CASE("Vertical rays meet parts of every kind where the scene has them") {
    Random random(3);
    std::vector<Obstacle> obstacles = boxes(300);
    for (int i = 0; i < 100; ++i) {
        const Vector3 at{random.uniform(-8, 8), random.uniform(-2, 2), random.uniform(-1, 2)};
        const Vector3 rpy{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
        obstacles.push_back({"", Cylinder{random.uniform(0.1, 0.3), random.uniform(0.2, 3), {1, 0.5, 0.2}}, at, rpy});
        obstacles.push_back({"", Sphere{random.uniform(0.1, 0.3)}, {at[1], at[0], at[2]}, {}});
    }
    obstacles.push_back(rough_deck(3, 0.3));
    obstacles.push_back({"", Box{{60, 60, 1}}, {0, 0, -3}, {}});
    Octomap octomap = octree_of([](const Vector3& p) { return std::hypot(p[0], p[1], p[2]) < 0.4; }, {-0.5, -0.5, -0.5},
                                {0.5, 0.5, 0.5}, 0.1);
    OccupancyTree tree = *octomap.tree;
    tree.unseen = {{{2, 1, 0}, {1, 1.5, 0.4}}};
    octomap = {"", std::make_shared<const OccupancyTree>(std::move(tree)), UnknownSpace::occupied};
    obstacles.push_back({"", octomap, {0, 0, 2.5}, {0.2, 0.3, 0.4}});
    const Scene scene(obstacles);
    const judge::VerticalRays rays(obstacles, 0.2);
    int different = 0;
    int met = 0;
    for (int n = 0; n < 3000; ++n) {
        const Vector3 p{random.uniform(-10, 10), random.uniform(-3, 3), random.uniform(-2, 7)};
        double below = infinity;
        double above = infinity;
        for (std::size_t part = 0; part < scene.part_count(); ++part) {
            const Interval extent = scene.vertical_extent(part, p[0], p[1]);
            if (!extent.empty() && extent.low <= p[2]) {
                below = std::min(below, std::max(0.0, p[2] - extent.high));
            }
            if (!extent.empty() && extent.high >= p[2]) {
                above = std::min(above, std::max(0.0, extent.low - p[2]));
            }
        }
        const auto gaps = rays.gaps(p[0], p[1], p[2]);
        const auto is_same = [](double a, double b) { return a == b || std::abs(a - b) < 1e-7; };
        different += is_same(gaps.below_m, below) && is_same(gaps.above_m, above) ? 0 : 1;
        met += std::isfinite(above) ? 1 : 0;
    }
    CHECK(different <= 2);  // a ray through the very edge of something
    CHECK(met > 1000);
}

TEST_CASE("Among many parts the judge's rays and the direct evaluation agree about K") {
    Problem problem = under_rough_deck();
    Random random(4);
    for (const bool is_deck : {true, false}) {
        if (!is_deck) {
            problem.obstacles = boxes(3000);
        }
        const auto model = make_flight_model(problem);
        const auto rays = judge::RayEffect::made_for(problem.obstacles, model);
        REQUIRE(rays != nullptr);
        double worst = 0;
        double sum = 0;
        int count = 0;
        while (count < 400) {
            const int rotor = random.integer(0, 3);
            const judge::Planar hub{random.uniform(-7, 7), random.uniform(3, is_deck ? 3.95 : 5.5)};
            const Vector3 place = model->plane().to_world(hub.x, model->rotor_lateral_m(rotor), hub.z);
            if (!model->effect(rotor).is_flyable(place)) {
                continue;
            }
            const auto expected = model->sided_factor(rotor, hub.x, hub.z);
            const auto found = rays->at_rotor(rotor, hub);
            const double off = std::max(std::abs(found.all - expected.all), std::abs(found.above - expected.above));
            worst = std::max(worst, off);
            sum += off;
            ++count;
        }
        CAPTURE(is_deck, worst, sum / count);
        CHECK(worst < 8e-3);
        CHECK(sum / count < 1e-3);
    }
}

TEST_CASE("Among few parts the judge casts no rays") {
    for (const char* name : shipped_names) {
        const Problem problem = shipped(name);
        CHECK(judge::RayEffect::made_for(problem.obstacles, make_flight_model(problem)) == nullptr);
    }
}

TEST_CASE("FCL's distances to thousands of boxes are the planner's within a millimetre") {
    Problem problem = under_rough_deck();
    problem.obstacles = boxes(3000);
    const auto model = make_flight_model(problem);
    const judge::Obstacles obstacles(problem.obstacles, problem.plane, problem.robot.shape(),
                                     problem.robot.rotors.radius_m);
    Random random(5);
    for (int n = 0; n < 300; ++n) {
        const PlanarPose pose{random.uniform(-9, 9), random.uniform(1, 4), random.uniform(-0.6, 0.6),
                              random.uniform(0, 3)};
        const double expected_m = model->collisions().clearance_m(pose);
        CAPTURE(pose.x_m, pose.z_m, expected_m);
        REQUIRE(std::abs(obstacles.clearance_m(pose) - std::max(expected_m, 0.0)) < 1e-3);
    }
}

TEST_CASE("Under a rough deck of many triangles the judge flies as the planner does") {
    const Problem problem = under_rough_deck();
    const Plan plan{{{0, at_rest(problem.start.at)}, {800, at_rest({1, 3.6, 1.5})}}, 0.01};
    const judge::JudgedFlight mine = judge::PlanJudge(problem).fly(plan, {});
    const auto model = make_flight_model(problem);
    const Execution theirs = execute(*model, model->state_at({-3, 3.55, 0, 1.5}), plan.reference, problem.goal, true);
    CHECK(theirs.outcome == Outcome::ok);
    CHECK(name_of(mine.outcome) == name_of(theirs.outcome));
    CHECK(std::any_of(theirs.rows.begin(), theirs.rows.end(),
                      [](const FlightRow& row) { return row.rotor_factor[0] > 1.02; }));
    CHECK(mine.min_clearance_m == Approx(theirs.min_clearance_m).margin(1e-3));
    CHECK(mine.energy_j == Approx(theirs.energy_j).epsilon(1e-3));
    CHECK(mine.goal_error_m == Approx(theirs.goal_error_m).margin(1e-3));
}

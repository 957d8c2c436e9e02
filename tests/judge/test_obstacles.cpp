#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "downwash/judge/obstacles.hpp"
#include "downwash/problems/problem_model.hpp"
#include "shipped.hpp"

// The judge asks FCL; the planner's own distances are exact to 1e-8 m.

using namespace downwash;
using namespace downwash::test;

TEST_CASE("FCL's distances to the obstacles of the shipped problems are the planner's within a millimetre") {
    for (const char* name : shipped_names) {
        const Problem problem = shipped(name);
        const auto model = make_flight_model(problem);
        const judge::Obstacles obstacles(problem.obstacles, problem.plane, problem.robot.shape(),
                                         problem.robot.rotors.radius_m);
        Random random(21);
        double worst_m = 0;
        int free = 0;
        int contacts = 0;
        for (int n = 0; n < 4000; ++n) {
            const Bounds& b = problem.bounds;
            const bool is_near_level = n % 2 == 0;
            const PlanarPose pose{random.uniform(b.x_low_m, b.x_high_m), random.uniform(b.z_low_m, b.z_high_m),
                                  is_near_level ? 0 : random.uniform(-0.6, 0.6), random.uniform(-3, 3)};
            const double expected_m = model->collisions().clearance_m(pose);
            const double found_m = obstacles.clearance_m(pose);
            CAPTURE(name, pose.x_m, pose.z_m, pose.pitch_rad, pose.arm_rad, expected_m, found_m);
            if (expected_m <= 0) {
                CHECK(found_m == 0);
                ++contacts;
            } else if (std::isfinite(expected_m)) {
                CHECK(std::abs(found_m - expected_m) < 1e-3);
                worst_m = std::max(worst_m, std::abs(found_m - expected_m));
                ++free;
            } else {
                CHECK(found_m == expected_m);
            }
        }
        INFO(name << " " << worst_m << " m over " << free << " poses, " << contacts << " contacts");
        CHECK(worst_m < 1e-3);
    }
}

TEST_CASE("FCL finds the same flyable area") {
    for (const char* name : shipped_names) {
        const Problem problem = shipped(name);
        const auto model = make_flight_model(problem);
        const judge::Obstacles obstacles(problem.obstacles, problem.plane, problem.robot.shape(),
                                         problem.robot.rotors.radius_m);
        const double distance_m = problem.aero.min_distance_radii * problem.robot.rotors.radius_m;
        Random random(22);
        int different = 0;
        for (int n = 0; n < 2000; ++n) {
            const double x_m = random.uniform(problem.bounds.x_low_m, problem.bounds.x_high_m);
            const double z_m = random.uniform(problem.bounds.z_low_m, problem.bounds.z_high_m);
            const double lateral_m = model->rotor_lateral_m(0);
            const bool expected = model->effect(0).is_flyable(problem.plane.to_world(x_m, lateral_m, z_m));
            different += expected == obstacles.disc_keeps(distance_m, x_m, lateral_m, z_m) ? 0 : 1;
        }
        CAPTURE(name, different);
        CHECK(different <= 1);  // on the boundary
    }
}

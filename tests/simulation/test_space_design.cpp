#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "../support/random.hpp"
#include "../support/space_robots.hpp"
#include "downwash/simulation/space_design.hpp"
#include "downwash/simulation/space_hover.hpp"
#include "downwash/simulation/space_statics.hpp"

using namespace downwash;
using namespace downwash::test;

TEST_CASE("A pendulum below a multirotor that hardly moves asks for half of its square frequency, above it for all") {
    SpaceRobot robot = space_robot(1);
    robot.plant.multirotor.mass_kg = 1e6;
    robot.plant.multirotor.inertia_kg_m2 = {{{1e6, 0, 0}, {0, 1e6, 0}, {0, 0, 1e6}}};
    SpaceLink& link = robot.plant.links[0];
    link.axis = {0, 1, 0};
    link.center_of_mass_m = {0, 0, -0.07};
    const double inertia_kg_m2 = link.body.inertia_kg_m2[1][1] + link.body.mass_kg * 0.07 * 0.07;
    const double square_1_s2 = link.body.mass_kg * standard_gravity_m_s2 * 0.07 / inertia_kg_m2;
    CHECK(joint_stiffness_asked_1_s2(robot, {0}) == Approx(0.5 * square_1_s2).epsilon(1e-4));
    CHECK(joint_stiffness_asked_1_s2(robot, {std::numbers::pi}) == Approx(square_1_s2).epsilon(1e-4));
    CHECK(greatest_joint_stiffness_asked_1_s2(robot) == Approx(square_1_s2).epsilon(1e-4));
    CHECK(joint_stiffness_asked_1_s2(robot, {std::numbers::pi / 2}) < 1e-3 * square_1_s2);
    CHECK(greatest_joint_stiffness_asked_1_s2(space_robot(0)) == 0);
}

TEST_CASE("Designed joints are as fast as the arm asks for and the delay allows, others as they were asked to be") {
    SpaceRobot robot = space_robot(2);
    const double asked_1_s2 = greatest_joint_stiffness_asked_1_s2(robot);
    const SpaceInversion law = designed_inversion(robot);
    CHECK(law.joint.kp_1_s2 == Approx(asked_1_s2 / 1.5));
    CHECK(law.joint.ki_1_s3 == 0);
    CHECK(law.observer_gain_1_s == Approx(0.25 * law.joint.kd_1_s));
    CHECK(law.rate_kp_1_s == Approx(2 * 0.35 / 0.035));
    robot.controller.delay_s = 0.095;
    CHECK(designed_inversion(robot).joint.kp_1_s2 == Approx(3.5 * 3.5));
    SpaceBandwidths wanted;
    wanted.joint_rad_s = 3;
    wanted.observer_gain_1_s = 0;
    wanted.attitude_rad_s = 5;
    const SpaceInversion given = designed_inversion(robot, wanted);
    CHECK(given.joint.kp_1_s2 == 9);
    CHECK(given.joint.ki_1_s3 > 0);
    CHECK(given.observer_gain_1_s == 0);
    CHECK(given.rate_kp_1_s == 10);
}

TEST_CASE("The integrals of a designed cascade carry the arm in any pose") {
    Random random(3);
    for (const double heavy : {0.1, 1.0, 30.0}) {
        SpaceRobot robot = space_robot(2);
        for (SpaceLink& link : robot.plant.links) {
            link.body.mass_kg *= heavy;
        }
        const Px4Cascade law = designed_cascade(robot, {});
        const Px4Cascade alone = cascade_gains_for(robot.plant.time_constant_s, {});
        CHECK(law.velocity.integral_limit == alone.velocity.integral_limit);
        double most_rad_s2 = 0;
        for (int i = 0; i < 200; ++i) {
            std::vector<double> joints_rad(robot.links.size());  // which turn without limits
            for (double& joint_rad : joints_rad) {
                joint_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
            }
            const Vector3 center_m = center_of_mass_m(robot, arm_pose(robot, joints_rad));
            const double weight_n = robot.mass_kg() * standard_gravity_m_s2;
            const Matrix3& inertia = robot.plant.multirotor.inertia_kg_m2;
            most_rad_s2 = std::max({most_rad_s2, weight_n * std::abs(center_m[1]) / inertia[0][0],
                                    weight_n * std::abs(center_m[0]) / inertia[1][1]});
        }
        CAPTURE(heavy, most_rad_s2, law.rate.integral_limit, law.joint.integral_limit);
        CHECK(law.rate.integral_limit >= 1.4 * most_rad_s2);
        CHECK(law.rate.integral_limit <= std::max(alone.rate.integral_limit, 2 * most_rad_s2));
        CHECK((law.rate.integral_limit > alone.rate.integral_limit) == (heavy >= 1));
    }
    CHECK(designed_cascade(space_robot(0), {}).rate.integral_limit == cascade_gains_for(0.02, {}).rate.integral_limit);
}

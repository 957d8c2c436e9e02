#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "../../bench/space_recovery/recovery.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/simulation/space_robot_facts.hpp"

// A small version of bench/space_recovery.sh.

using namespace downwash;
using namespace downwash::bench;

namespace {

SpaceRobot shipped() {
    return read_space_robot(std::filesystem::path(DOWNWASH_PROBLEMS) / "robots/snu_f550_arm2.yaml");
}

}  // namespace

TEST_CASE("With twice the thrust of their weight, vehicles recover from any attitude and rates that they can stop") {
    for (const SpaceRobot& kind : {without_arm(shipped()), shipped()}) {
        const SpaceRobot robot = with_thrust_over_weight(kind, 2);
        CHECK(space_robot_errors(robot).empty());
        CHECK(space_robot_facts(robot).thrust_to_weight == Approx(2));
        for (const SpaceRobot& flown : {robot, under_cascade(robot)}) {
            const Vector3 stoppable = stoppable_rates_rad_s(flown);
            test::Random random(2);
            double least_upward = 1;
            for (int number = 0; number < 20; ++number) {
                const Throw thrown = drawn_throw(stoppable, 1, random);
                const std::array<double, 4>& q = thrown.motion.attitude;
                least_upward = std::min(least_upward, 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
                const Recovery found = recover(flown, thrown.motion);
                CAPTURE(flown.joints(), number, thrown.effort, found.upright_s, found.height_lost_m);
                CHECK(found.is_upright);
                CHECK(found.upright_s < max_recovery_s);
                CHECK(found.home_s >= found.upright_s);
            }
            CHECK(least_upward < -0.9);
        }
    }
}

TEST_CASE("Who has too little thrust does not recover, and falls") {
    const Recovery found = recover(with_thrust_over_weight(without_arm(shipped()), 0.8), {});
    CHECK(!found.is_upright);
    CHECK(!found.is_home);
    CHECK(found.home_s == Approx(max_recovery_s));
    CHECK(found.height_lost_m > 100);
}

TEST_CASE("Stoppable rates are those of the torque and the inertia that the robot file has") {
    const SpaceRobot robot = without_arm(shipped());
    const Vector3 rates = stoppable_rates_rad_s(robot);
    // Hubs at y of 0.1375, 0.275 and 0.1375 m on either side, and three rotors that spin either way.
    const double range_n = 10.6232 - 2.352;
    const double late_s = 0.01 + 0.01 + 0.05;
    const double roll_nm = 0.55 * range_n, yaw_nm = 3 * 0.01161 * range_n;
    CHECK(rates[0] * late_s + 0.03123 * rates[0] * rates[0] / (2 * roll_nm) == Approx(std::numbers::pi));
    CHECK(rates[2] * late_s + 0.03221 * rates[2] * rates[2] / (2 * yaw_nm) == Approx(std::numbers::pi));
    // An arm that stands up adds to the inertia of roll and pitch, and hardly to that of yaw.
    const Vector3 with_arm = stoppable_rates_rad_s(shipped());
    CHECK(with_arm[0] < 0.9 * rates[0]);
    CHECK(with_arm[2] == Approx(rates[2]).epsilon(0.05));
}

TEST_CASE("Throws have the effort that they say, and all attitudes") {
    const Vector3 stoppable{10, 20, 5};
    test::Random random(3);
    int upside_down = 0, beyond = 0;
    for (int number = 0; number < 1000; ++number) {
        const Throw thrown = drawn_throw(stoppable, 2, random);
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            sum += std::pow(thrown.motion.body_rates_rad_s[i] / stoppable[i], 2);
        }
        REQUIRE(std::sqrt(sum) == Approx(thrown.effort).margin(1e-12));
        const std::array<double, 4>& q = thrown.motion.attitude;
        upside_down += 1 - 2 * (q[1] * q[1] + q[2] * q[2]) < 0 ? 1 : 0;
        beyond += thrown.effort > 1 ? 1 : 0;
    }
    CHECK(std::abs(upside_down - 500) < 60);
    CHECK(std::abs(beyond - 500) < 60);
}

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "../support/judged_logs.hpp"
#include "downwash/identification/held_back.hpp"
#include "downwash/identification/identification.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

using namespace downwash;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;

namespace {

SpaceRobot hexarotor() {
    return read_space_robot(DOWNWASH_ROBOTS "/hexa370_arm3.yaml");
}

/// The same without its arm: flights of it are quick to compute.
SpaceRobot bare_hexarotor() {
    SpaceRobot robot = hexarotor();
    robot.plant.links.clear();
    robot.links.clear();
    return robot;
}

const IdentifiedNumber& number_of(const Identification& found, const std::string& name) {
    const auto number = std::ranges::find(found.numbers, name, &IdentifiedNumber::name);
    REQUIRE(number != found.numbers.end());
    return *number;
}

/// A log of a vehicle of the default uncertainty that the judge flew.
LoggedFlight judged_log(const SpaceRobot& robot, const SpaceWorld& world, double length_s, std::uint64_t seed) {
    test::Random random(seed);
    return test::log_of(test::fly_for_log(robot, world, test::identification_reference(robot, length_s, random)),
                        "flight");
}

}  // namespace

TEST_CASE("a flight of the judge tells the vehicle that flew it") {
    const SpaceRobot robot = bare_hexarotor();
    const SpaceWorld world = draw_space_world({}, robot, 5, 3);
    const Identification found = identify(robot, {judged_log(robot, world, 6, 1)});
    std::size_t learned = 0;
    for (const SpaceWorldParameter* parameter : space_world_parameters_of(robot)) {
        const auto number = std::ranges::find(found.numbers, parameter->name, &IdentifiedNumber::name);
        if (number != found.numbers.end() && number->is_learned) {
            ++learned;
            INFO(parameter->name << ": " << number->value << " +- " << number->sd << ", truth "
                                 << parameter->of(world));
            CHECK(std::abs(number->value - parameter->of(world)) < 4 * number->sd);
        }
    }
    CHECK(learned >= 5);
    for (const char* name : {"vehicle.rotor_time_constant_s", "vehicle.delay_s"}) {
        INFO(name);
        CHECK(number_of(found, name).sd < 0.5 * number_of(found, name).before_sd);
    }
    // No acceleration takes the place of the sensors' noise.
    for (const auto& [name, truth] : {std::pair("sensing.position_noise_m", world.position_noise_m),
                                      std::pair("sensing.velocity_noise_m_s", world.velocity_noise_m_s),
                                      std::pair("sensing.gyro_noise_rad_s", world.gyro_noise_rad_s)}) {
        INFO(name);
        const auto noise = std::ranges::find(found.noise, name, &IdentifiedNoise::name);
        REQUIRE(noise != found.noise.end());
        CHECK(noise->sd == Approx(truth).margin(4 * noise->sd_of_sd));
    }
    // A vehicle without an arm turns in yaw by drag torque, which is that of the file: this tells thrust, and so the
    // mass.
    CHECK(number_of(found, "vehicle.thrust_scale").is_learned);
    CHECK(
        std::ranges::none_of(found.left_out, [](const std::string& each) { return each.starts_with("sensing and"); }));
}

TEST_CASE("a hover does not tell mass from thrust, and the answer says so") {
    const SpaceRobot robot = bare_hexarotor();
    SpaceWorld world;
    world.thrust_scale = 0.04;
    SpacePlan hover;
    hover.tick_s = 1 / robot.controller.rate_hz;
    hover.reference.resize(2);
    hover.reference[1].tick = 250;
    for (SpaceKnot& knot : hover.reference) {
        knot.point.position[space::z] = 3;
    }
    const Identification found = identify(robot, {test::log_of(test::fly_for_log(robot, world, hover), "hover")});
    const IdentifiedNumber& mass = number_of(found, "vehicle.mass_scale");
    const IdentifiedNumber& thrust = number_of(found, "vehicle.thrust_scale");
    CHECK_FALSE(mass.is_learned);
    CHECK_THAT(mass.reason, Contains("only together with vehicle.thrust_scale"));
    CHECK(thrust.value - mass.value == Approx(0.04).margin(0.01));  // the ratio is known
    CHECK_FALSE(number_of(found, "vehicle.inertia_scale").is_learned);
    CHECK_FALSE(found.weak.empty());
}

TEST_CASE("a log of the true motion tells neither delay nor biases") {
    const SpaceRobot robot = bare_hexarotor();
    test::Random random(3);
    const auto flight = test::fly_for_log(robot, {}, test::identification_reference(robot, 4.5, random));
    LoggedFlight log = test::log_of(flight, "flight");
    for (std::size_t i = 0; i < log.ticks.size(); ++i) {
        log.ticks[i].seen = test::motion_of(flight.rows[i].motion);
    }
    log.is_true_motion = true;
    const Identification found = identify(robot, {log});
    CHECK_FALSE(number_of(found, "vehicle.delay_s").is_learned);
    CHECK_FALSE(number_of(found, "sensing.yaw_bias_deg").is_learned);
    CHECK(found.noise.empty());
    CHECK_THAT(found.left_out.back(), Contains("the logs have the true motion"));
    const IdentifiedNumber& lag = number_of(found, "vehicle.rotor_time_constant_s");
    CHECK(lag.is_learned);
    CHECK(lag.value == Approx(0).margin(4 * lag.sd));
}

TEST_CASE("a flight held back is within worlds of the right vehicle, and outside of those of a wrong one") {
    const SpaceRobot robot = bare_hexarotor();
    SpaceWorld world;
    world.wind_m_s = {0.3, -0.2, 0};
    world.position_noise_m = 0.005;
    world.velocity_noise_m_s = 0.02;
    world.gyro_noise_rad_s = 0.015;
    world.tape = 11;
    LoggedFlight log = judged_log(robot, world, 6, 4);
    const HeldBackCoverage right = held_back_coverage(robot, log, {}, 40, 1);
    for (const double share : right.share_within) {
        CHECK(share > 0.6);
    }
    // As wide as wind, gusts and noise of any day make it, and no wider: the vehicle is known.
    SpaceRobot known = robot;
    known.uncertainty = Uncertainty{};
    for (const UncertaintyKey& key : space_uncertainty_keys()) {
        if (key.spread != nullptr && key.path.starts_with("vehicle.")) {
            (*known.uncertainty).*key.spread = Spread::of_sd(0);
        }
    }
    const HeldBackCoverage sure = held_back_coverage(known, log, {}, 40, 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        CHECK(sure.share_within[axis] > 0.6);
        CHECK(sure.width_m[axis] < right.width_m[axis]);
    }
    for (LoggedTick& tick : log.ticks) {
        tick.seen.position_m[0] += 0.5;
    }
    CHECK(held_back_coverage(robot, log, {}, 40, 1).share_within[0] < 0.05);
}

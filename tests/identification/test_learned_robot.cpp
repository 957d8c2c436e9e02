#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "../support/scratch_folder.hpp"
#include "downwash/identification/identification.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/space_problem_writer.hpp"

using namespace downwash;  // NOLINT(google-build-using-namespace): a test

namespace {

SpaceRobot hexarotor() {
    return read_space_robot(DOWNWASH_ROBOTS "/hexa370_arm3.yaml");
}

IdentifiedNumber number(const std::string& name, double value, double sd, bool is_learned = true) {
    return {name, 0, 1, value, sd, is_learned, is_learned ? "" : "these flights hardly depend on it"};
}

}  // namespace

TEST_CASE("what was learned of a number becomes its spread, about the mean that was found") {
    Identification found;
    found.numbers = {number("vehicle.mass_scale", 0.03, 0.004)};
    const SpaceRobot learned = learned_robot(hexarotor(), found);
    CHECK(learned.uncertainty->mass_scale == Spread::of_sd(0.004, 0.03));
    CHECK(learned.uncertainty->inertia_scale == Uncertainty{}.inertia_scale);
    CHECK(learned.plant.multirotor.mass_kg == hexarotor().plant.multirotor.mass_kg);
}

TEST_CASE("a key that stands for several numbers gets a spread as wide as they are and as they differ") {
    // Roll: -0.01 with 0.003; pitch: 0.02 with 0.001. Mean 0.005, each 0.015 from it.
    Identification found;
    found.numbers = {number("sensing.pitch_bias_deg roll", -0.01, 0.003),
                     number("sensing.pitch_bias_deg pitch", 0.02, 0.001)};
    const Spread spread = learned_robot(hexarotor(), found).uncertainty->pitch_bias_rad;
    CHECK(spread.form == Spread::Form::sd);
    CHECK(spread.low == Approx(0.005));
    CHECK(spread.high == Approx(std::sqrt(0.5 * (9e-6 + 1e-6) + 0.015 * 0.015)));
}

TEST_CASE("what a flight did not tell counts as it was beside what it told of the same key") {
    Identification found;
    found.numbers = {number("sensing.pitch_bias_deg roll", 0.004, 0.001),
                     number("sensing.pitch_bias_deg pitch", 9, 9, false)};
    const double before = Uncertainty{}.pitch_bias_rad.high;
    const Spread spread = learned_robot(hexarotor(), found).uncertainty->pitch_bias_rad;
    CHECK(spread.low == Approx(0.002));
    CHECK(spread.high == Approx(std::sqrt(0.5 * (1e-6 + before * before) + 4e-6)));
}

TEST_CASE("learned drag changes the coefficients of the robot file, and noise its standard deviations") {
    Identification found;
    found.numbers = {number("multirotor.drag", 0.25, 0.02)};
    found.noise = {{"sensing.velocity_noise_m_s", 0.033, 0.001}, {"attitude [rad]", 1, 1}};
    const SpaceRobot learned = learned_robot(hexarotor(), found);
    CHECK(learned.plant.drag.linear_n_s_m == Approx(1.25 * 0.46));
    CHECK(learned.plant.drag.quadratic_n_s2_m2 == Approx(1.25 * 0.02));
    CHECK(learned.uncertainty->velocity_noise_m_s == Spread::of_sd(0.033));
    CHECK(learned.uncertainty->gyro_noise_rad_s == Uncertainty{}.gyro_noise_rad_s);
}

TEST_CASE("a robot file with learned spreads reads back as it was written") {
    Identification found;
    found.numbers = {number("vehicle.mass_scale", -0.0123, 0.004), number("vehicle.com_offset_m.y", 0.0031, 0.0002),
                     number("vehicle.delay_s", 0.004, 0.001), number("sensing.pitch_bias_deg roll", 0.004, 0.001)};
    const SpaceRobot learned = learned_robot(hexarotor(), found);
    const test::ScratchFolder folder;
    const auto file = folder.path() / "learned.yaml";
    std::ofstream(file) << robot_yaml(learned);
    CHECK(*read_space_robot(file).uncertainty == *learned.uncertainty);
}

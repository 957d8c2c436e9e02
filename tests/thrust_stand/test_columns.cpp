#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include "downwash/base/key_error.hpp"
#include "downwash/thrust_stand/thrust_stand.hpp"

using namespace downwash;
using Catch::Contains;

namespace {

/// All files of `stands` are of one rotor: T = 1.2e-5 w^2, Q = 0.016 T, P = 5 T^1.5.
std::filesystem::path stand_file(const char* name) {
    return std::filesystem::path(DOWNWASH_STANDS) / name;
}

ThrustStand parsed(const std::string& text, const ThrustStandSettings& settings = {}) {
    return parse_thrust_stand({{"stand.csv", text}}, settings);
}

std::string error_of(const std::string& text, const ThrustStandSettings& settings = {}) {
    try {
        static_cast<void>(parsed(text, settings));
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

bool has_column(const StandFile& file, const StandColumn& wanted) {
    for (const StandColumn& column : file.columns) {
        if (column.quantity == wanted.quantity) {
            return column.name == wanted.name && column.unit == wanted.unit;
        }
    }
    return false;
}

}  // namespace

TEST_CASE("a log of RCbenchmark's Series 1580 gives the rotor that it was written for") {
    const ThrustStand stand = read_thrust_stand({stand_file("series_1580.csv")});
    REQUIRE(stand.files.size() == 1);
    const StandFile& file = stand.files[0];
    CHECK(file.rows == 28);
    CHECK(file.measurements == 7);
    CHECK(has_column(file, {"time", "Time (s)", "s"}));
    CHECK(has_column(file, {"throttle", "ESC signal (µs)", "us"}));
    CHECK(has_column(file, {"thrust", "Thrust (kgf)", "kgf"}));
    CHECK(has_column(file, {"torque", "Torque (N·m)", "Nm"}));
    // The optical probe was not there: its column is all zero.
    CHECK(has_column(file, {"speed", "Motor Electrical Speed (RPM)", "RPM"}));
    CHECK(has_column(file, {"power", "Electrical Power (W)", "W"}));
    CHECK(stand.max_thrust_n == Approx(1.2e-5 * 750 * 750).epsilon(1e-6));
    CHECK(stand.min_thrust_n == Approx(1.2e-5 * 250 * 250).epsilon(1e-6));
    CHECK(stand.thrust_coefficient_n_s2->value == Approx(1.2e-5).epsilon(1e-6));
    CHECK(stand.torque_ratio_m->value == Approx(0.016).epsilon(1e-6));
    CHECK(stand.power_coefficient_w_n1p5->value == Approx(5).epsilon(1e-6));
    bool says_that_it_turned = false;
    for (const std::string& remark : stand.remarks) {
        says_that_it_turned = says_that_it_turned || remark.find("sign was turned") != std::string::npos;
    }
    CHECK(says_that_it_turned);
}

TEST_CASE("a motor maker's table with semicolons, decimal commas and percent signs gives the same rotor") {
    ThrustStandSettings settings;
    settings.radius_m = 0.127;
    const ThrustStand stand = read_thrust_stand({stand_file("motor_table.csv")}, settings);
    CHECK(has_column(stand.files[0], {"thrust", "Thrust (G)", "gf"}));
    CHECK(has_column(stand.files[0], {"torque", "Torque (N*m)", "Nm"}));
    CHECK(has_column(stand.files[0], {"throttle", "Throttle", "1"}));
    CHECK(stand.files[0].measurements == 6);
    CHECK(stand.max_thrust_n == Approx(1.2e-5 * 900 * 900).epsilon(1e-7));
    CHECK(stand.thrust_coefficient_n_s2->value == Approx(1.2e-5).epsilon(1e-7));
    CHECK(stand.torque_ratio_m->value == Approx(0.016).epsilon(1e-7));
    CHECK(stand.power_coefficient_w_n1p5->value == Approx(5).epsilon(1e-7));
    // C_T of propellers: T = C_T rho n^2 D^4.
    const double n = 900 / (2 * std::numbers::pi);
    CHECK(*stand.thrust_number == Approx(1.2e-5 * 900 * 900 / (1.225 * n * n * std::pow(0.254, 4))).epsilon(1e-7));
    CHECK_FALSE(stand.thrust_scatter);
    CHECK_FALSE(stand.lag);
}

TEST_CASE("coefficients over speeds, as of UIUC's static tests, give the same rotor once its radius is known") {
    ThrustStandSettings settings;
    settings.radius_m = 0.127;
    const ThrustStand stand = read_thrust_stand({stand_file("static_coefficients.txt")}, settings);
    CHECK(stand.thrust_coefficient_n_s2->value == Approx(1.2e-5).epsilon(1e-7));
    CHECK(stand.torque_ratio_m->value == Approx(0.016).epsilon(1e-7));
    CHECK(stand.max_thrust_n == Approx(1.2e-5 * 600 * 600).epsilon(1e-7));
    CHECK_THROWS_WITH(read_thrust_stand({stand_file("static_coefficients.txt")}), Contains("give --radius-m M"));
    CHECK_THAT(error_of("J,RPM,CT,CP\n0.1,3000,0.1,0.05\n", settings), Contains("stand.csv:1:1: the advance ratio J"));
}

TEST_CASE("every unit of thrust, torque and speed means the same measurement") {
    const auto with = [](const std::string& thrust, double thrust_number, const std::string& torque,
                         double torque_number, const std::string& speed, double speed_number) {
        CAPTURE(thrust, torque, speed);
        const ThrustStand stand =
            parsed(thrust + ";" + torque + ";" + speed + "\n" + std::to_string(thrust_number) + ";" +
                   std::to_string(torque_number) + ";" + std::to_string(speed_number) + "\n");
        CHECK(stand.max_thrust_n == Approx(9.80665).epsilon(1e-5));
        CHECK(stand.torque_ratio_m->value == Approx(0.02).epsilon(1e-5));
        CHECK(stand.thrust_coefficient_n_s2->value == Approx(9.80665 / (900.0 * 900)).epsilon(1e-5));
    };
    constexpr double torque_nm = 0.196133, rpm = 900 * 60 / (2 * std::numbers::pi);
    with("Thrust (gf)", 1000, "Torque (N·m)", torque_nm, "RPM", rpm);
    with("thrust_kgf", 1, "torque_nm", torque_nm, "speed_rad_s", 900);
    with("Thrust [lbf]", 2.2046226, "Torque [lbf in]", torque_nm / 4.4482216 / 0.0254, "Rotation speed (Hz)", rpm / 60);
    with("thrust (ozf)", 35.27396, "torque (ozf·in)", torque_nm / 4.4482216 * 16 / 0.0254, "Speed (rev/s)", rpm / 60);
    with("Thrust/N", 9.80665, "Torque (kgf·cm)", 2, "omega [rad/s]", 900);
    with("Pull (g)", 1000, "torque, mNm", 1e3 * torque_nm, "rpm", rpm);
}

TEST_CASE("columns and units that a file does not say can be given") {
    ThrustStandSettings settings;
    settings.columns = {{"thrust", "Schub"}, {"power", "P_el"}};
    settings.units = {{"thrust", "gf"}};
    const ThrustStand stand = parsed("Schub;P_el\n1000;150\n", settings);
    CHECK(stand.max_thrust_n == Approx(9.80665));
    CHECK(stand.power_coefficient_w_n1p5->value == Approx(150 / std::pow(9.80665, 1.5)));
    settings.columns = {{"thrust", "Schbu"}};
    CHECK_THAT(error_of("Schub;P_el\n1000;150\n", settings), Contains("stand.csv:1: has no column 'Schbu'"));
    settings.columns = {{"trust", "Schub"}};
    CHECK_THAT(error_of("Schub;P_el\n1000;150\n", settings),
               Contains("'trust' is no quantity") && Contains("'thrust'"));
}

TEST_CASE("the power coefficient near a hover is that of the measurements there") {
    // P / T^1.5 falls from 6 to 4.
    const std::string text = "throttle,Thrust (N),Power (W)\n1,1,6\n2,4,40\n3,9,108\n";
    CHECK(parsed(text).power_range == std::pair(4.0, 6.0));
    ThrustStandSettings settings;
    settings.hover_thrust_n = 4.1;
    CHECK(parsed(text, settings).power_coefficient_w_n1p5->value == Approx(5));
    settings.hover_thrust_n = 12;
    CHECK_THAT(error_of(text, settings), Contains("a hover at 12 N was not measured") && Contains("from 1 to 9 N"));
}

TEST_CASE("what cannot be read has its line and its column") {
    CHECK_THAT(error_of("throttle,Thrust (gf),Power (W)\n1,100,10\n2,strong,20\n"), Contains("stand.csv:3:3: "));
    CHECK_THAT(error_of("throttle,Thrust,Power (W)\n1,100,10\n"),
               Contains("stand.csv:1:10: the column 'Thrust' has no unit") && Contains("--unit thrust=UNIT"));
    CHECK_THAT(error_of("throttle,Thrust (stone),Power (W)\n1,100,10\n"),
               Contains("stand.csv:1:10: the column 'Thrust (stone)' is in 'stone': expected N, gf, kgf"));
    CHECK_THAT(error_of("throttle,Power (W)\n1,100\n"),
               Contains("stand.csv:1: has no thrust in 'throttle, Power (W)'"));
    CHECK_THAT(error_of("throttle,Thrust (N)\n1,1\n2,2,3\n"), Contains("stand.csv:3"));
    CHECK_THAT(error_of("throttle,Thrust (N)\n"), Contains("no thrust follows"));
    CHECK_THAT(error_of(""), Contains("holds no table"));
    CHECK_THROWS_WITH(read_thrust_stand({"missing.csv"}), Contains("missing.csv"));
}

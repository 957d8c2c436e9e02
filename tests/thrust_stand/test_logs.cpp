#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "downwash/thrust_stand/thrust_stand.hpp"

using namespace downwash;
using Catch::Contains;

namespace {

/// The rotor that is measured, and how well.
struct Truth {
    double coefficient_n_s2 = 1.1e-5, torque_ratio_m = 0.017, power_w_n1p5 = 4.2;
    double rise_s = 0.06, fall_s = 0.035;
    double step_scatter = 0.02;  ///< of thrust, from one step of equal throttle to the next
    double lag_scatter_s = 0.004;
};

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

/// Sweeps of the throttle up, with the motor at rest between them, at 40 Hz, with noise in every row.
std::string log_of(const Truth& truth, unsigned seed, int sweeps) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    std::string text = "Time (s),ESC signal (µs),Torque (N·m),Thrust (N),RPM,Electrical Power (W)\n";
    double time_s = 0, thrust_n = 0, square = 0;
    const auto hold = [&](int throttle, int rows) {
        const double before_n = thrust_n, before = square, after = std::pow(0.9 * (throttle - 1000), 2);
        const double after_n = truth.coefficient_n_s2 * after * (1 + truth.step_scatter * normal(generator));
        const double lag_s =
            (after_n > before_n ? truth.rise_s : truth.fall_s) + truth.lag_scatter_s * normal(generator);
        for (int row = 0; row < rows; ++row) {
            const double left = std::exp(-row / 40.0 / lag_s);
            thrust_n = after_n + (before_n - after_n) * left;
            square = after + (before - after) * left;
            text += number(time_s) + "," + std::to_string(throttle) + "," +
                    number(truth.torque_ratio_m * thrust_n + 0.0005 * normal(generator)) + "," +
                    number(thrust_n + 0.03 * normal(generator)) + "," +
                    number(std::sqrt(square) * 60 / (2 * std::numbers::pi) + 10 * normal(generator)) + "," +
                    number(truth.power_w_n1p5 * std::pow(thrust_n, 1.5) + 0.5 * normal(generator)) + "\n";
            time_s += 1 / 40.0;
        }
        thrust_n = after_n;
        square = after;
    };
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (int throttle = 1000; throttle <= 2000; throttle += 200) {
            hold(throttle, 60);
        }
    }
    return text;
}

bool holds(const StandEstimate& estimate, double truth) {
    return estimate.low && *estimate.low <= truth && truth <= *estimate.high;
}

bool holds(const StandScatter& scatter, double truth) {
    return scatter.low <= truth && truth <= scatter.high;
}

}  // namespace

TEST_CASE("a noisy log gives the rotor within a few percent, and its keys as YAML") {
    const Truth truth;
    const ThrustStand stand = parse_thrust_stand({{"log.csv", log_of(truth, 1, 5)}});
    CHECK(stand.thrust_coefficient_n_s2->value == Approx(truth.coefficient_n_s2).epsilon(0.02));
    CHECK(stand.torque_ratio_m->value == Approx(truth.torque_ratio_m).epsilon(0.005));
    CHECK(stand.power_coefficient_w_n1p5->value == Approx(truth.power_w_n1p5).epsilon(0.005));
    CHECK(stand.max_thrust_n == Approx(truth.coefficient_n_s2 * 900 * 900).epsilon(0.03));
    CHECK(stand.min_thrust_n == Approx(truth.coefficient_n_s2 * 180 * 180).epsilon(0.06));
    REQUIRE(stand.lag);
    CHECK(stand.lag->is_of_rise);
    CHECK(stand.lag->is_of_speed);
    CHECK(stand.lag->steps == 20);  // the first of each sweep is too small to tell
    CHECK(stand.lag->time_constant_s.value == Approx(truth.rise_s).epsilon(0.05));
    const std::string yaml = thrust_stand_yaml(stand);
    CHECK_THAT(yaml, Contains("# From log.csv") && Contains("rotors:\n  min_thrust_n: ") &&
                         Contains("\n  max_thrust_n: ") && Contains("\n  torque_ratio_m: 0.01") &&
                         Contains("\n  time_constant_s: 0.0") && Contains("\n  power_coefficient_w_n1p5: 4.") &&
                         Contains("\nuncertainty:\n  vehicle:\n    rotor_thrust_scale: {sd: 0.0") &&
                         Contains("\n    rotor_time_constant_s: {sd: 0.00"));
}

TEST_CASE("true values are inside the 95 % intervals in 88 to 100 % of sixty noisy logs") {
    const Truth truth;
    constexpr int logs = 60;
    int coefficients = 0, ratios = 0, powers = 0, lags = 0, thrust_scatters = 0, lag_scatters = 0;
    for (unsigned seed = 0; seed < logs; ++seed) {
        const ThrustStand stand = parse_thrust_stand({{"log.csv", log_of(truth, 100 + seed, 4)}});
        coefficients += holds(*stand.thrust_coefficient_n_s2, truth.coefficient_n_s2) ? 1 : 0;
        ratios += holds(*stand.torque_ratio_m, truth.torque_ratio_m) ? 1 : 0;
        powers += holds(*stand.power_coefficient_w_n1p5, truth.power_w_n1p5) ? 1 : 0;
        lags += holds(stand.lag->time_constant_s, truth.rise_s) ? 1 : 0;
        thrust_scatters += holds(*stand.thrust_scatter, truth.step_scatter) ? 1 : 0;
        lag_scatters += holds(*stand.lag->scatter_s, truth.lag_scatter_s) ? 1 : 0;
    }
    // Of 60 at 95 %, 51 or fewer would come once in 2000 times.
    constexpr int least = 52;
    CHECK(coefficients >= least);
    CHECK(ratios >= least);
    CHECK(powers >= least);
    CHECK(lags >= least);
    CHECK(thrust_scatters >= least);
    CHECK(lag_scatters >= least);
}

TEST_CASE("repetitions in several files and in unordered rows count together") {
    const std::string first = "throttle,Thrust (gf)\n1200,100\n1500,400\n2000,1000\n";
    const std::string second = "throttle;Thrust (N)\n2000;10,0\n1200;1,0\n1500;4,1\n";
    const ThrustStand stand = parse_thrust_stand({{"a.csv", first}, {"b.csv", second}});
    CHECK(stand.files.size() == 2);
    CHECK(stand.max_thrust_n == Approx(0.5 * (9.80665 + 10)));
    CHECK(stand.min_thrust_n == Approx(0.5 * (0.980665 + 1)));
    REQUIRE(stand.thrust_scatter);
    CHECK(stand.thrust_scatter->freedom == 3);
    // Pairs: the variance of each is half the square of its relative difference.
    double squares = 0;
    for (const auto& [a, b] : {std::pair(0.980665, 1.0), {3.92266, 4.1}, {9.80665, 10.0}}) {
        squares += 0.5 * std::pow(2 * (a - b) / (a + b), 2);
    }
    CHECK(stand.thrust_scatter->sd == Approx(std::sqrt(squares / 3)));
}

TEST_CASE("the slower of rise and fall is the lag") {
    Truth truth;
    truth.rise_s = 0.03;
    truth.fall_s = 0.08;
    const ThrustStand stand = parse_thrust_stand({{"log.csv", log_of(truth, 7, 4)}});
    REQUIRE(stand.lag);
    CHECK_FALSE(stand.lag->is_of_rise);
    CHECK(stand.lag->steps == 3);
    CHECK(stand.lag->time_constant_s.value == Approx(0.08).epsilon(0.1));
}

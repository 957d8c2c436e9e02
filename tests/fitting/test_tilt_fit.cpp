#include "downwash/fitting/tilt_fit.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "../support/error_of.hpp"
#include "downwash/effects/sided_factor.hpp"

using namespace downwash;

namespace {

/// Level ratios at three distances, and tilted ones that follow the law exactly.
std::string exact_data(double loss) {
    std::string text = "source,tilt_deg,z_over_r,thrust_ratio\n";
    for (const auto& [z, change] : {std::pair{0.6, 0.19}, {1.0, 0.09}, {2.0, 0.03}}) {
        text += "level,0," + std::to_string(z) + "," + std::to_string(1 + change) + "\n";
        for (const int tilt_deg : {10, 30}) {
            const double sine = std::sin(tilt_deg * std::acos(-1.0) / 180);
            const double tilted = change * change / (change + loss * sine * sine);
            text += (tilt_deg == 10 ? "one," : "two,") + std::to_string(tilt_deg) + "," + std::to_string(z) + "," +
                    std::to_string(1 + tilted) + "\n";
        }
    }
    return text;
}

}  // namespace

TEST_CASE("The tilt loss of data that follow the law is found") {
    for (const double loss : {0.05, 0.4, 3.0}) {
        const TiltFit fit = fit_tilt_loss(parse_measurements(exact_data(loss), "m.csv"));
        CHECK(fit.fitted.tilt_loss == Approx(loss).epsilon(2e-4));  // six decimals in the file
        CHECK(fit.fitted.rmse < 1e-6);
        CHECK(fit.fitted.points == 6);
        CHECK(fit.as_level.max_error > 0.005);
        REQUIRE(fit.left_out.size() == 2);
        CHECK(fit.left_out[0].first == "one");
        CHECK(fit.left_out[0].second.tilt_loss == Approx(loss).epsilon(2e-4));
        CHECK(fit.left_out[0].second.points == 3);
    }
}

TEST_CASE("The default tilt loss is what the shipped measurements say, within its standard error") {
    const TiltFit fit = fit_tilt_loss(read_measurements(DOWNWASH_TILTED_ROTORS));
    REQUIRE(fit.standard_error);
    CHECK(std::abs(fit.fitted.tilt_loss - default_ground_tilt_loss) < *fit.standard_error);
    CHECK(fit.fitted.points == 53);
    CHECK(fit.fitted.rmse < 0.011);
    CHECK(fit.as_level.rmse > 0.025);
    for (const auto& [source, score] : fit.left_out) {
        CAPTURE(source);
        CHECK(score.rmse < 0.0135);
    }
}

TEST_CASE("Without level or without tilted measurements there is no tilt loss") {
    CHECK_THROWS_WITH(
        fit_tilt_loss(parse_measurements("z_over_r,thrust_ratio,tilt_deg\n1,1.1,0\n1,1.05,20\n", "m.csv")),
        "a tilt loss needs measurements without tilt at two distances or more: these have 1");
    CHECK_THROWS_WITH(fit_tilt_loss(parse_measurements("z_over_r,thrust_ratio\n1,1.1\n2,1.05\n", "m.csv")),
                      "a tilt loss needs measurements of tilted rotors: expected a column tilt_deg with some above 0");
}

TEST_CASE("Effects that do not fade leave a tilt loss of 0") {
    const TiltFit fit = fit_tilt_loss(
        parse_measurements("z_over_r,thrust_ratio,tilt_deg\n1,1.1,0\n2,1.05,0\n1,1.11,20\n2,1.06,20\n", "m.csv"));
    CHECK(fit.fitted.tilt_loss == 0);
    CHECK(fit.fitted.is_at_bound);
    CHECK_FALSE(fit.standard_error);
    CHECK(fit.left_out.empty());
}

TEST_CASE("A tilt loss stays within the range of problem files, and says where it ends there") {
    const auto fitted_to = [](const std::string& tilted) {
        return fit_tilt_loss(parse_measurements(
            "z_over_r,thrust_ratio,tilt_deg,source\n1,1.1,0,level\n2,1.05,0,level\n" + tilted, "m.csv"));
    };
    // Nothing is left at 10 degrees, as of a loss without end.
    const TiltFit fit = fitted_to("1,1,10,one\n2,1,10,two\n");
    CHECK(fit.fitted.tilt_loss == 100);
    CHECK(fit.fitted.is_at_bound);
    CHECK_FALSE(fit.standard_error);
    CHECK_FALSE(fit.as_level.is_at_bound);
    REQUIRE(fit.left_out.size() == 2);
    CHECK(fit.left_out[0].second.is_at_bound);
    // 0.1^2 / (0.1 + 99 sin^2 10 deg) and 0.05^2 / (0.05 + 99 sin^2 10 deg).
    const TiltFit within = fitted_to("1,1.003240,10,one\n2,1.000823,10,two\n");
    CHECK(within.fitted.tilt_loss == Approx(99).epsilon(1e-3));
    CHECK_FALSE(within.fitted.is_at_bound);
    CHECK(within.standard_error);
}

TEST_CASE(
    "A tilt loss is that of one surface, within the distances of its level measurements, if they show an effect") {
    const auto error_of_fit = [](const std::string& rows) {
        return test::error_of([&] {
            return fit_tilt_loss(parse_measurements("z_over_r,thrust_ratio,tilt_deg,surface\n" + rows, "m.csv"));
        });
    };
    const std::string level = "0.6,1.2,0,ground\n2,1.03,0,ground\n";
    CHECK(error_of_fit(level + "0.6,1.1,20,ground\n2,1.02,20,ground\n") == "none");
    CHECK(error_of_fit(level + "1,1.05,20,ground\n1,1.2,20,ceiling\n") ==
          "a tilt loss is that of one surface: expected only measurements at ground or ceiling");
    CHECK(error_of_fit(level + "1,1.05,20,ground\n0.5,1.2,20,ground\n") ==
          "line 5 has a tilted rotor at the z_over_r 0.5, and those without tilt are from 0.6 to 2; expected tilted "
          "rotors within that range");
    CHECK(error_of_fit(level + "2.1,1.01,20,ground\n") ==
          "line 4 has a tilted rotor at the z_over_r 2.1, and those without tilt are from 0.6 to 2; expected tilted "
          "rotors within that range");
    CHECK(error_of_fit("1,1,0,ground\n2,1,0,ground\n1,1.01,20,ground\n") ==
          "a tilt loss needs an effect that fades: without tilt the thrust ratio is 1 at every tilted rotor");
}

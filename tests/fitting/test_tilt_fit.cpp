#include "downwash/fitting/tilt_fit.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "downwash/base/key_error.hpp"
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
    CHECK(fit.left_out.empty());
}

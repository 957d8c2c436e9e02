#include "downwash/fitting/effect_scatter.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/aeromap/aero_settings.hpp"
#include "downwash/simulation/uncertainty.hpp"

using namespace downwash;

namespace {

const EffectScatter& scatter_of(const std::vector<EffectScatter>& all, EffectModel model) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const EffectScatter& s) { return s.model == model; });
    REQUIRE(found != all.end());
    return *found;
}

}  // namespace

TEST_CASE("Bias and scatter are relative to the model's K - 1, those of tilted rotors and near points left out") {
    // K - 1 of Cheeseman and Bennett: 1/3 at 0.5, 1/15 at 1.
    const auto all =
        effect_scatter({parse_measurements("z_over_r,thrust_ratio,surface,tilt_deg\n0.5,1.5,ground,\n"
                                           "1,1.08,ground,\n0.3,1.1,ground,\n1,3,ground,20\n1,3,,\n",
                                           "m.csv")});
    const EffectScatter& scatter = scatter_of(all, EffectModel::cheeseman_bennett);
    CHECK(scatter.surface == "ground");
    const double x[] = {1.0 / 3, 1.0 / 15};
    const double e[] = {0.5 - x[0], 0.08 - x[1]};
    const double xx = x[0] * x[0] + x[1] * x[1];
    const double bias = (e[0] * x[0] + e[1] * x[1]) / xx;
    const double rest = std::pow(e[0] - bias * x[0], 2) + std::pow(e[1] - bias * x[1], 2);
    CHECK(scatter.all.points == 2);
    CHECK(scatter.all.bias == Approx(bias).epsilon(1e-9));
    CHECK(scatter.all.scatter == Approx(std::sqrt(rest / xx)).epsilon(1e-6));
    CHECK(scatter.bands[0].points == 1);
    CHECK(scatter.bands[1].bias == Approx(0.5).epsilon(1e-9));
    CHECK(scatter.bands[1].scatter == Approx(0).margin(1e-7));
}

TEST_CASE("The default uncertainty of surface effects is the scatter of the shipped measurements, to 0.05") {
    const auto all =
        effect_scatter({read_measurements(DOWNWASH_MEASUREMENTS), read_measurements(DOWNWASH_TILTED_ROTORS)});
    const auto rounded = [&](EffectModel model) { return std::round(20 * scatter_of(all, model).all.scatter) / 20; };
    const AeroSettings settings;
    const Uncertainty usual;
    CHECK(usual.ceiling_scale == Spread::of_sd(rounded(settings.ceiling.model)));
    // Uniform, of the same standard deviation.
    const double half_width = std::sqrt(3.0) * rounded(settings.ground.model);
    CHECK(usual.ground_scale == Spread::over(-std::round(10 * half_width) / 10, std::round(10 * half_width) / 10));
}

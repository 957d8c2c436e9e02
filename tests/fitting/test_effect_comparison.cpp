#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "downwash/base/key_error.hpp"
#include "downwash/fitting/effect_comparison.hpp"
#include "downwash/fitting/effect_fit.hpp"

using namespace downwash;

namespace {

const ModelScore& score_of(const DataSetComparison& set, EffectModel model, bool is_refitted) {
    const auto found = std::find_if(set.scores.begin(), set.scores.end(), [&](const ModelScore& score) {
        return score.effect.model == model && score.is_refitted == is_refitted;
    });
    REQUIRE(found != set.scores.end());
    return *found;
}

bool has_model(const DataSetComparison& set, EffectModel model) {
    return std::any_of(set.scores.begin(), set.scores.end(),
                       [model](const ModelScore& score) { return score.effect.model == model; });
}

}  // namespace

namespace {

std::vector<DataSetComparison> compared(const Measurements& measurements, const RotorNeighbours& neighbours = {}) {
    return compare_effects({measurements}, neighbours);
}

}  // namespace

TEST_CASE("A model is compared with measurements as it is flown, band by band") {
    // Cheeseman and Bennett: a pole at 0.2, so the cap of 2; 4/3 at 0.5, 16/15 at 1, 64/63 at 2.
    const auto sets =
        compared(parse_measurements("z_over_r,thrust_ratio\n0.2,1.5\n0.5,1.3\n1,1.1\n1,1.2\n2,1\n", "m.csv"));
    REQUIRE(sets.size() == 1);
    CHECK(sets[0].points == 5);
    CHECK(sets[0].z_low == 0.2);
    CHECK(sets[0].z_high == 2);
    const ModelScore& score = score_of(sets[0], EffectModel::cheeseman_bennett, false);
    REQUIRE(score.bands.size() == 4);
    CHECK(score.bands[0].mean_error == Approx(0.5));
    CHECK(score.bands[1].mean_error == Approx(4.0 / 3 - 1.3));
    CHECK(score.bands[2].points == 2);
    CHECK(score.bands[2].mean_error == Approx(16.0 / 15 - 1.15));
    CHECK(score.bands[3].mean_error == Approx(1.0 / 63));
    const double squares = 0.25 + std::pow(4.0 / 3 - 1.3, 2) + std::pow(16.0 / 15 - 1.1, 2) +
                           std::pow(16.0 / 15 - 1.2, 2) + std::pow(1.0 / 63, 2);
    CHECK(score.rmse == Approx(std::sqrt(squares / 5)));
    const ModelScore& free_air = score_of(sets[0], EffectModel::none, false);
    CHECK(free_air.rmse == Approx(std::sqrt((0.25 + 0.09 + 0.01 + 0.04) / 5)));
}

TEST_CASE("The shipped measurements are compared source by source and surface by surface") {
    const auto sets = compared(read_measurements(DOWNWASH_MEASUREMENTS));
    REQUIRE(sets.size() == 3);
    CHECK((sets[0].source == "jirs2024" && sets[0].surface == "ceiling" && sets[0].points == 16));
    CHECK((sets[1].source == "jirs2024" && sets[1].surface == "ground" && sets[1].points == 16));
    CHECK((sets[2].source == "hydrus15_isolated" && sets[2].surface == "ceiling" && sets[2].points == 13));
    for (const DataSetComparison& set : sets) {
        const bool is_ground = set.surface == "ground";
        CHECK(has_model(set, EffectModel::cheeseman_bennett) == is_ground);
        CHECK(has_model(set, EffectModel::sanchez_cuevas) == !is_ground);
        CHECK_FALSE(has_model(set, EffectModel::multirotor_images));
        CHECK_FALSE(has_model(set, EffectModel::table));
        // A refit, where neither cap nor bound interferes, is no worse than the source's own numbers.
        for (const ModelScore& score : set.scores) {
            if (score.is_refitted) {
                CHECK_FALSE(score.is_at_bound);
                CHECK(score.rmse <= score_of(set, score.effect.model, false).rmse);
            }
        }
    }
    const ModelScore& refitted = score_of(sets[2], EffectModel::sanchez_cuevas, true);
    CHECK(refitted.rmse == Approx(0.00345907).epsilon(1e-4));  // gnuplot's, see test_effect_fit.cpp
}

TEST_CASE("Multirotor models are compared when the vehicle is known") {
    const auto sets =
        compared(parse_measurements("z_over_r,thrust_ratio,surface\n1,1.4,ground\n2,1.2,ground\n", "m.csv"),
                 square_quadrotor(2.5));
    REQUIRE(sets.size() == 1);
    // Thesis (2.14) with d/R = 2.5 at z = R: the losses are 1/16, 1/(6.25 + 4)^1.5 and 0.5/(12.5 + 4)^1.5.
    const double loss = 1.0 / 16 + std::pow(10.25, -1.5) + 0.5 * std::pow(16.5, -1.5);
    CHECK(score_of(sets[0], EffectModel::multirotor_images, false).bands[2].mean_error == Approx(1 / (1 - loss) - 1.4));
    CHECK(has_model(sets[0], EffectModel::multirotor_body));
}

TEST_CASE("Where a refit is impossible only the source's numbers are compared, from hundreds of sources nothing") {
    const auto sets = compared(parse_measurements("z_over_r,thrust_ratio\n1,1.1\n1,1.2\n", "m.csv"));
    REQUIRE(sets.size() == 1);
    const auto is_of_he = [](const ModelScore& score) { return score.effect.model == EffectModel::he; };
    CHECK(std::count_if(sets[0].scores.begin(), sets[0].scores.end(), is_of_he) == 1);
    std::string text = "z_over_r,thrust_ratio,source\n";
    for (int i = 0; i < 101; ++i) {
        text += "1,1.1," + std::to_string(i) + "\n";
    }
    CHECK_THROWS_AS(compared(parse_measurements(text, "m.csv")), InputError);
}

TEST_CASE("A surface that no model was made for is an error with the line that has it") {
    const auto measured_at = [](const std::string& surface) {
        return parse_measurements("z_over_r,thrust_ratio,surface\n1,1.1,ground\n2,1.1," + surface + "\n", "m.csv");
    };
    CHECK(compared(measured_at("ceiling")).size() == 2);
    CHECK(compared(measured_at("")).size() == 2);
    CHECK_THROWS_WITH(compared(measured_at("cieling")),
                      "m.csv:3:7: has the surface 'cieling'; expected ground or ceiling; did you mean 'ceiling'?");
}

TEST_CASE("Tilted rotors are a data set for every tilt, and K fades as in flight") {
    // Cheeseman and Bennett's K - 1 at one radius is 1/15; at 30 degrees sin^2 is 1/4.
    const auto sets = compared(parse_measurements(
        "z_over_r,thrust_ratio,surface,tilt_deg\n1,1.07,ground,\n1,1.05,ground,30\n1,1.04,ceiling,30\n", "m.csv"));
    REQUIRE(sets.size() == 3);
    CHECK(sets[0].tilt_deg == 0);
    CHECK(sets[1].tilt_deg == 30);
    const ModelScore& over_ground = score_of(sets[1], EffectModel::cheeseman_bennett, false);
    const double faded = std::pow(1.0 / 15, 2) / (1.0 / 15 + 0.37 / 4);
    CHECK(over_ground.bands[2].mean_error == Approx(1 + faded - 1.05).epsilon(1e-9));
    CHECK(over_ground.level_rmse == Approx(std::abs(16.0 / 15 - 1.05)).epsilon(1e-9));
    CHECK_FALSE(has_model(sets[1], EffectModel::sanchez_cuevas));
    const ModelScore& under_ceiling = score_of(sets[2], EffectModel::sanchez_cuevas, false);
    CHECK(under_ceiling.rmse == under_ceiling.level_rmse);
}

TEST_CASE("A refit is tried on all other sources at the same surface") {
    const auto sets =
        compared(parse_measurements("z_over_r,thrust_ratio,surface,source\n0.5,1.3,ground,a\n1,1.1,ground,a\n"
                                    "1,1.2,ground,b\n2,1.1,ground,b\n1,1.3,ceiling,b\n",
                                    "m.csv"));
    const ModelScore& li = score_of(sets[0], EffectModel::li, true);
    const double rho = li.effect.parameters[0];
    const auto k = [rho](double z) { return 1 / (1 - rho / (16 * z * z)); };
    REQUIRE(li.others_rmse);
    CHECK(*li.others_rmse == Approx(std::sqrt((std::pow(k(1) - 1.2, 2) + std::pow(k(2) - 1.1, 2)) / 2)).epsilon(1e-9));
    CHECK_FALSE(score_of(sets[0], EffectModel::li, false).others_rmse);
}

TEST_CASE("With its tilt loss the default ground model is within 0.02 of every bench with tilted rotors") {
    const auto sets = compared(read_measurements(DOWNWASH_TILTED_ROTORS));
    REQUIRE(sets.size() == 7);
    for (const DataSetComparison& set : sets) {
        CAPTURE(set.source, set.tilt_deg);
        const ModelScore& score = score_of(set, EffectModel::cheeseman_bennett, false);
        CHECK(score.rmse < 0.02);
        if (set.tilt_deg > 15) {
            CHECK(score.rmse < 0.75 * score.level_rmse);
        }
    }
}

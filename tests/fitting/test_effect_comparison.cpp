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

TEST_CASE("A model is compared with measurements as it is flown, band by band") {
    // Cheeseman and Bennett: a pole at 0.2, so the cap of 2; 4/3 at 0.5, 16/15 at 1, 64/63 at 2.
    const auto sets =
        compare_effects(parse_measurements("z_over_r,thrust_ratio\n0.2,1.5\n0.5,1.3\n1,1.1\n1,1.2\n2,1\n", "m.csv"));
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
    const auto sets = compare_effects(read_measurements(DOWNWASH_MEASUREMENTS));
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
        compare_effects(parse_measurements("z_over_r,thrust_ratio,surface\n1,1.4,ground\n2,1.2,ground\n", "m.csv"),
                        square_quadrotor(2.5));
    REQUIRE(sets.size() == 1);
    // Thesis (2.14) with d/R = 2.5 at z = R: the losses are 1/16, 1/(6.25 + 4)^1.5 and 0.5/(12.5 + 4)^1.5.
    const double loss = 1.0 / 16 + std::pow(10.25, -1.5) + 0.5 * std::pow(16.5, -1.5);
    CHECK(score_of(sets[0], EffectModel::multirotor_images, false).bands[2].mean_error == Approx(1 / (1 - loss) - 1.4));
    CHECK(has_model(sets[0], EffectModel::multirotor_body));
}

TEST_CASE("Where a refit is impossible only the source's numbers are compared, from hundreds of sources nothing") {
    const auto sets = compare_effects(parse_measurements("z_over_r,thrust_ratio\n1,1.1\n1,1.2\n", "m.csv"));
    REQUIRE(sets.size() == 1);
    const auto is_of_he = [](const ModelScore& score) { return score.effect.model == EffectModel::he; };
    CHECK(std::count_if(sets[0].scores.begin(), sets[0].scores.end(), is_of_he) == 1);
    std::string text = "z_over_r,thrust_ratio,source\n";
    for (int i = 0; i < 101; ++i) {
        text += "1,1.1," + std::to_string(i) + "\n";
    }
    CHECK_THROWS_AS(compare_effects(parse_measurements(text, "m.csv")), InputError);
}

TEST_CASE("A surface that no model was made for is an error with the line that has it") {
    const auto measured_at = [](const std::string& surface) {
        return parse_measurements("z_over_r,thrust_ratio,surface\n1,1.1,ground\n2,1.1," + surface + "\n", "m.csv");
    };
    CHECK(compare_effects(measured_at("ceiling")).size() == 2);
    CHECK(compare_effects(measured_at("")).size() == 2);
    CHECK_THROWS_WITH(compare_effects(measured_at("cieling")),
                      "line 3 of the measurements has the surface 'cieling'; expected ground or ceiling; did you mean "
                      "'ceiling'?");
}

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "../support/random.hpp"
#include "downwash/base/text.hpp"
#include "downwash/effects/effect_curve.hpp"
#include "downwash/effects/effect_table.hpp"

using namespace downwash;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Values far from the cap.
double free_factor(const SurfaceEffect& effect, double zeta, const RotorNeighbours& neighbours = {}) {
    return EffectCurve(effect, 10, neighbours)(zeta);
}

}  // namespace

TEST_CASE("The formulas have the hand-computed values") {
    const SurfaceEffect ground = EffectModel::cheeseman_bennett;
    CHECK(free_factor(ground, 0.5) == Approx(4.0 / 3).epsilon(1e-14));
    CHECK(free_factor(ground, 1) == Approx(16.0 / 15).epsilon(1e-14));
    CHECK(free_factor(ground, 2) == Approx(64.0 / 63).epsilon(1e-14));
    // Sanchez-Cuevas: zeta + K2/R = 1 and 2: K = 1 / (1 - 1 / 6.924) and 1 / (1 - 1 / 27.696)
    SurfaceEffect ceiling = EffectModel::sanchez_cuevas;
    CHECK(free_factor(ceiling, 0.6832) == Approx(6.924 / 5.924).epsilon(1e-14));
    CHECK(free_factor(ceiling, 1.6832) == Approx(27.696 / 26.696).epsilon(1e-14));
    ceiling.parameters = {4, 0};
    CHECK(free_factor(ceiling, 1) == Approx(4.0 / 3).epsilon(1e-14));
    SurfaceEffect li = EffectModel::li;
    li.parameters[0] = 4;
    CHECK(free_factor(li, 1) == Approx(4.0 / 3).epsilon(1e-14));
    // 1 + 0.4 e^-2.2, e^-2.2 = 0.110803158362333907...
    CHECK(free_factor(EffectModel::he, 1) == Approx(1.0443212633449335628).epsilon(1e-14));
    // (0.9926 + 0.03794 * 4)^(2/3) = 1.14436^(2/3); cubed it is 1.14436^2 = 1.3095598096
    CHECK(std::pow(free_factor(EffectModel::hayden, 1), 3) == Approx(1.3095598096).epsilon(1e-14));
    CHECK(free_factor(EffectModel::hayden, 10) == 1);  // 0.9926 + 0.0015176 lies below 1
    // sqrt(1 + 1/8 * 8/9 ...): zeta = 1/sqrt(24) makes the root 2
    CHECK(free_factor(EffectModel::momentum_theory, 1 / std::sqrt(24.0)) == Approx(1.5).epsilon(1e-14));
    // The fairing: thesis (4.8) at z = 0.04 m with R = 0.1194 m: 1 / (1 - (1 / 0.081) (0.1194 / 1.066)^2)
    const double ratio = 0.1194 / 1.066;
    CHECK(free_factor(EffectModel::fairing_cfd, 0.04 / 0.1194) ==
          Approx(1 / (1 - ratio * ratio / 0.081)).epsilon(1e-13));
    CHECK(free_factor(EffectModel::fairing_cfd, 0.04 / 0.1194) == Approx(1.183).margin(5e-4));
}

TEST_CASE("A rotor's images are summed from where the others stand, of a square quadrotor to the thesis' (2.14)") {
    test::Random random(3);
    for (int i = 0; i < 200; ++i) {
        const double d = random.uniform(2.05, 4);
        const double z = random.uniform(0.5, 5);
        const double denominator = 1 - std::pow(1 / (4 * z), 2) - z / std::pow(d * d + 4 * z * z, 1.5) -
                                   0.5 * z / std::pow(2 * d * d + 4 * z * z, 1.5);
        REQUIRE(free_factor(EffectModel::multirotor_images, z, square_quadrotor(d)) ==
                Approx(1 / denominator).epsilon(1e-8));  // distances are rounded to 1e-9
    }
    // Three rotors in a row, two radii apart: by hand from (2.15) at z = R.
    const std::vector<Vector3> row{{-0.3, 0, 0.05}, {0, 0, 0.05}, {0.3, 0, 0.05}};
    const double near = 1 / std::pow(4 + 4.0, 1.5);
    const double far = 1 / std::pow(16 + 4.0, 1.5);
    const double own = 1.0 / 16;
    CHECK(free_factor(EffectModel::multirotor_images, 1, neighbours_of(row, 0, 0.15)) ==
          Approx(1 / (1 - own - 0.5 * (near + far))).epsilon(1e-9));
    CHECK(free_factor(EffectModel::multirotor_images, 1, neighbours_of(row, 1, 0.15)) ==
          Approx(1 / (1 - own - near)).epsilon(1e-9));
    CHECK(neighbours_of(row, 0, 0.15).distances_radii == neighbours_of(row, 2, 0.15).distances_radii);
    CHECK(free_factor(EffectModel::multirotor_images, 1) ==
          Approx(free_factor(EffectModel::cheeseman_bennett, 1)).epsilon(1e-14));
}

TEST_CASE("The fountain gives the whole quadrotor about 1.45 at one radius and 1.16 at two") {
    const RotorNeighbours quadrotor = square_quadrotor(2.5);
    CHECK(quadrotor.center_radii == Approx(2.5 / std::sqrt(2.0)).epsilon(1e-8));
    CHECK(free_factor(EffectModel::multirotor_body, 1, quadrotor) == Approx(1.45).margin(0.005));
    CHECK(free_factor(EffectModel::multirotor_body, 2, quadrotor) == Approx(1.16).margin(0.005));
    SurfaceEffect weak = EffectModel::multirotor_body;
    weak.parameters[0] = 0;
    CHECK(free_factor(weak, 1, quadrotor) == free_factor(EffectModel::multirotor_images, 1, quadrotor));
    // (2.17) by hand: K_b = 1, b = 3 R, z = R
    weak.parameters = {1, 3};
    const double loss =
        1.0 / 16 + 1 / std::pow(6.25 + 4, 1.5) + 0.5 / std::pow(12.5 + 4, 1.5) + 2 / std::pow(9 + 4.0, 1.5);
    CHECK(free_factor(weak, 1, quadrotor) == Approx(1 / (1 - loss)).epsilon(1e-8));
}

TEST_CASE("What the fountain adds is the difference of whole vehicle and images") {
    const RotorNeighbours quadrotor = square_quadrotor(2.7);
    const EffectCurve fountain = EffectCurve::fountain(EffectModel::multirotor_body, 2, quadrotor);
    for (double zeta = 0; zeta < 6; zeta += 0.01) {
        REQUIRE(fountain(zeta) == Approx(1 + EffectCurve(EffectModel::multirotor_body, 2, quadrotor)(zeta) -
                                         EffectCurve(EffectModel::multirotor_images, 2, quadrotor)(zeta)));
    }
    CHECK(fountain(0) == 1);
    CHECK(fountain(infinity) == 1);
    CHECK(fountain(1) > 1.2);
}

TEST_CASE("The ceiling model gives the percentages of the thesis at three attitudes") {
    // Thesis (4.6): a rotor radius of 0.1194 m, rotors 0.25 m from the centre whose distance to the ceiling is z.
    const EffectCurve ceiling(EffectModel::sanchez_cuevas, 2);
    const auto percent_more = [&](double pitch_deg, double z) {
        const double lift = 0.25 * std::sin(pitch_deg * 3.14159265358979323846 / 180);
        return 100 * (ceiling((z - lift) / 0.1194) / ceiling((z + lift) / 0.1194) - 1);
    };
    CHECK(percent_more(10, 0.10) == Approx(21.9).margin(0.05));
    CHECK(percent_more(3, 0.10) == Approx(4.8).margin(0.05));
    CHECK(percent_more(10, 0.25) == Approx(1.6).margin(0.05));
}

TEST_CASE("Every formula stays between 1 and its cap, falls with distance and vanishes far away") {
    const RotorNeighbours quadrotor = square_quadrotor(2.5);
    for (const EffectModelInfo& model : effect_models()) {
        if (model.model == EffectModel::table || model.model == EffectModel::none) {
            continue;
        }
        CAPTURE(std::string(model.name));
        const EffectCurve curve(model.model, 2, quadrotor);
        double nearer = curve(0);
        CHECK(nearer > 1.2);
        for (double zeta = 0.001; zeta < 8; zeta += 0.001) {
            const double factor = curve(zeta);
            REQUIRE(factor >= 1);
            REQUIRE(factor <= nearer);
            nearer = factor;
        }
        CHECK(curve(300) < 1.001);
        CHECK(curve(infinity) == Approx(1).margin(1e-15));
        CHECK(EffectCurve(model.model, 1.15, quadrotor)(0.01) == 1.15);
    }
    CHECK(EffectCurve(EffectModel::cheeseman_bennett, 2)(0.25) == 2);
    CHECK(EffectCurve(EffectModel::none, 2)(0) == 1);
}

TEST_CASE("No point of a curve differs more from 1 than its bound says") {
    const RotorNeighbours quadrotor = square_quadrotor(2.5);
    SurfaceEffect strong = EffectModel::multirotor_body;
    strong.parameters[0] = 6;
    for (const EffectCurve& curve :
         {EffectCurve(EffectModel::cheeseman_bennett, 2), EffectCurve(EffectModel::hayden, 2),
          EffectCurve(strong, 2, quadrotor), EffectCurve::fountain(EffectModel::multirotor_body, 2, quadrotor),
          EffectCurve::fountain(strong, 2, quadrotor)}) {
        double largest = 0;
        for (double zeta = 12; zeta > 0; zeta -= 0.0007) {
            largest = std::max(largest, std::abs(curve(zeta) - 1));
            REQUIRE(curve.largest_change_beyond(zeta) >= largest * (1 - 1e-12));
            REQUIRE(curve.largest_change_beyond(zeta) <= 1.07 * largest + 0.01);
        }
    }
}

TEST_CASE("A curve knows where it meets its cap, and up to where it is flat for want of knowledge") {
    // 1 / (1 - 1/16z^2) = 2 at z = 1/sqrt(8)
    CHECK(EffectCurve(EffectModel::cheeseman_bennett, 2).cap_distance() == Approx(1 / std::sqrt(8.0)).epsilon(1e-12));
    CHECK(EffectCurve(EffectModel::he, 2).cap_distance() < 0);
    CHECK(EffectCurve(EffectModel::none, 2).cap_distance() < 0);
    const auto of_table = [](const EffectTable& table, double max_factor) {
        SurfaceEffect effect(EffectModel::table);
        effect.table = std::make_shared<const EffectTable>(table);
        return EffectCurve(effect, max_factor).flat_distance();
    };
    // (z/R + 0.3168)^2 = 1.3 / (0.3 * 6.924)
    CHECK(EffectCurve(EffectModel::sanchez_cuevas, 1.3).flat_distance() ==
          Approx(std::sqrt(1.3 / (0.3 * 6.924)) - 0.3168).epsilon(1e-12));
    CHECK(EffectCurve(EffectModel::he, 2).flat_distance() < 0);
    CHECK(EffectCurve(EffectModel::none, 1).flat_distance() < 0);
    CHECK(EffectCurve(EffectModel::sanchez_cuevas, 1).flat_distance() >= 1000);  // flat everywhere
    CHECK(of_table(EffectTable({0.6, 1, 3}, {}, {1.3, 1.2, 1}), 2) == 0.6);
    CHECK(of_table(EffectTable({0.6, 1, 3}, {}, {1.4, 1.2, 1}), 1.2) == Approx(1).epsilon(1e-9));
    // Over a second distance: at 5 the second row reaches the cap, so that the third ends it.
    const EffectTable with_walls({0.6, 1, 3}, {0, 5, 9}, {1.1, 1.5, 1.1, 1.1, 1.3, 1.1, 1, 1, 1});
    CHECK(of_table(with_walls, 1.25) == 3);
    CHECK(of_table(with_walls, 1.4) == 1);
    CHECK(of_table(with_walls, 1.6) == 0.6);
    // K - 1 fades as 1 / z^2 from 0.8 at 3: 0.2 at 6.
    CHECK(EffectTable({0.6, 3}, {}, {1.9, 1.8}).distance_below(1.225) == Approx(6));
}

TEST_CASE("Models are found by the name that a problem file uses, and say where they hold") {
    for (const EffectModelInfo& model : effect_models()) {
        CAPTURE(model.name);
        CHECK(find_effect_model(model.name) == &model);
        CHECK(&info(model.model) == &model);
        CHECK(!model.source.empty());
        CHECK(!model.validity.empty());
        CHECK(model.valid_from < model.valid_to);
        // What the text says in words.
        const std::string validity(model.validity);
        for (const double end : {model.valid_from, model.valid_to}) {
            if (end > 0 && std::isfinite(end)) {
                CHECK(validity.find(to_text(end)) != std::string::npos);
            }
        }
        const bool has_end = model.valid_from > 0 || std::isfinite(model.valid_to);
        CHECK(has_end == validity.starts_with("z/R"));
    }
    // Names that problem files contain stay.
    for (const char* name : {"none", "cheeseman-bennett", "multirotor-images", "multirotor-body", "hayden", "li", "he",
                             "sanchez-cuevas", "fairing-cfd", "momentum-theory", "table"}) {
        CHECK(find_effect_model(name) != nullptr);
    }
    CHECK(find_effect_model("cheeseman") == nullptr);
    CHECK(find_effect_model("") == nullptr);
}

TEST_CASE("A table over two distances is read far from the second surface where nothing is said of it") {
    SurfaceEffect effect(EffectModel::table);
    effect.table = std::make_shared<const EffectTable>(std::vector{0.5, 1.0}, std::vector{0.0, 2.0},
                                                       std::vector{1.8, 1.4, 1.3, 1.1});
    CHECK(formula_factor(effect, 0.5) == 1.4);
    CHECK(formula_factor(effect, 1) == 1.1);
    effect.d_over_r = 0;
    CHECK(formula_factor(effect, 0.5) == 1.8);
    CHECK(formula_factor(effect, 1) == 1.3);
}

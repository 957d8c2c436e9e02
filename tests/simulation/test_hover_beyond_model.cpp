#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/effects/effect_table.hpp"
#include "hover_scenes.hpp"

using namespace downwash;
using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

namespace {

/// The ceiling problem with an arm that reaches beyond no surface.
Problem with_short_arm() {
    Problem problem = ceiling_problem();
    problem.robot.arm.length_m = 0.3;
    problem.robot.arm.center_of_mass_m = 0.15;
    problem.robot.arm.inertia_kg_m2 = 0.001;
    return problem;
}

}  // namespace

TEST_CASE("where a near ceiling is beyond the cap hover is not called stable") {
    Problem problem = ceiling_alone();
    const auto verdict_below = [&](double max_factor, double gap_m) {
        problem.aero.max_factor = max_factor;
        return below_ceiling(*make_flight_model(problem), gap_m).verdict;
    };
    // K reaches 1.3 where (z/R + 0.3168)^2 = 1.3 / (0.3 * 6.924).
    const double cap_m = radius_m * (std::sqrt(1.3 / (0.3 * 6.924)) - 0.3168);
    for (const double gap_m : {0.06, 0.08, cap_m - 1e-3, cap_m + 0.9e-3}) {
        INFO(gap_m << " m below");
        CHECK(verdict_below(2, gap_m) == HoldVerdict::unstable);
        CHECK(verdict_below(1.3, gap_m) != HoldVerdict::stable);
    }
    CHECK(verdict_below(1.3, 0.06) == HoldVerdict::unknown);
    CHECK(verdict_below(1.3, cap_m - 1.1e-3) == HoldVerdict::unknown);
    CHECK(verdict_below(1.3, cap_m + 2e-3) == HoldVerdict::unstable);
    CHECK(verdict_below(1.3, 0.4) == HoldVerdict::stable);
    CHECK(verdict_below(1, 0.4) == HoldVerdict::unknown);  // a model that is told to know nothing
    problem.aero.ceiling = EffectModel::none;
    CHECK(verdict_below(1, 0.4) == HoldVerdict::stable);
}

TEST_CASE("a lower cap never makes a hover under surfaces stable") {
    Random random(12);
    Problem problem = cluttered_problem();
    problem.aero.ground = EffectModel::none;  // over edges a cap on its side does
    const auto free = make_flight_model(problem);
    problem.aero.max_factor = 1.15;
    const auto capped = make_flight_model(problem);
    int unstable = 0, unknown = 0;
    for (int i = 0; i < 3000; ++i) {
        const double x_m = random.uniform(-2, 4);
        const double z_m = random.uniform(0.2, 4.9);
        const HoldVerdict verdict = analyse_hover(*capped, x_m, z_m, quarter_turn).verdict;
        unknown += verdict == HoldVerdict::unknown ? 1 : 0;
        if (analyse_hover(*free, x_m, z_m, quarter_turn).verdict == HoldVerdict::unstable) {
            INFO("at " << x_m << ", " << z_m);
            CHECK(verdict != HoldVerdict::stable);
            ++unstable;
        }
    }
    CHECK(unstable > 30);
    CHECK(unknown > 30);
}

TEST_CASE("nearer to a ceiling than a table was measured hover is not called stable") {
    Problem problem = ceiling_alone();
    problem.aero.ceiling = EffectModel::table;
    problem.aero.ceiling.table = std::make_shared<const EffectTable>(
        std::vector<double>{1, 3, 9}, std::vector<double>{}, std::vector<double>{1.05, 1.01, 1});
    const auto verdict_below = [&problem](double radii) {
        return below_ceiling(*make_flight_model(problem), radii * radius_m).verdict;
    };
    CHECK(verdict_below(0.5) == HoldVerdict::unknown);
    CHECK(verdict_below(0.99) == HoldVerdict::unknown);
    CHECK(verdict_below(1.01) == HoldVerdict::stable);  // 4.7 N/m against 99 N/m
    // One pair of rotors that sees it is enough.
    problem.obstacles = {box("slab", {2, 4, 1}, {1.52, 0, 5.5})};
    CHECK(verdict_below(0.5) == HoldVerdict::stable);  // 0.52 m, the discs reach 0.5105 m
    problem.obstacles = {box("slab", {2, 4, 1}, {1.5, 0, 5.5})};
    CHECK(verdict_below(0.5) == HoldVerdict::unknown);
}

TEST_CASE("between two surfaces whose sum is capped hover is not called stable where the upper one pulls more") {
    // Shelf and ceiling 1.2 m apart, the arm pointing sideways.
    Problem problem = with_short_arm();
    problem.obstacles = {box("shelf", {30, 8, 1}, {0, 0, 4.0}), problem.obstacles[1]};
    // 0.12 m below the ceiling K = 1.17 of the ceiling and 1.04 of the shelf 0.38 m below.
    problem.aero.max_factor = 1.19;
    const double z_m = ceiling_m - 0.12 - hub_height_m;
    const HoverAnalysis a = analyse_hover(*make_flight_model(problem), 0, z_m, 0);
    INFO(name_of(a.verdict));
    CHECK(a.stability.force_slope_n_m == Approx(0).margin(1e-9));  // the cap hides it
    CHECK(a.verdict == HoldVerdict::unknown);
    problem.aero.max_factor = 2;
    CHECK(analyse_hover(*make_flight_model(problem), 0, z_m, 0).verdict == HoldVerdict::unstable);
    // Low over the ground a cap leaves hover stable.
    Problem low = with_short_arm();
    low.aero.max_factor = 1.05;  // K = 1.09 without
    CHECK(analyse_hover(*make_flight_model(low), 0, 0.1, 0).verdict == HoldVerdict::stable);
}

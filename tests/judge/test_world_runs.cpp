#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "../support/test_problem.hpp"
#include "downwash/base/quantile.hpp"
#include "downwash/judge/world_runs.hpp"
#include "downwash/simulation/world_parameters.hpp"

using namespace downwash;
using namespace downwash::test;

TEST_CASE("Intervals of Clopper and Pearson are those of tables") {
    // 0 of 299: 1 - 0.025^(1/299); 5 of 10 and 1 of 20: Clopper and Pearson 1934, as printed in many tables.
    CHECK(judge::probability_of(0, 299).low == 0);
    CHECK(judge::probability_of(0, 299).high == Approx(1 - std::pow(0.025, 1.0 / 299)));
    CHECK(judge::probability_of(10, 10).low == Approx(std::pow(0.025, 0.1)));
    CHECK(judge::probability_of(10, 10).high == 1);
    CHECK(judge::probability_of(5, 10).low == Approx(0.1871).margin(5e-5));
    CHECK(judge::probability_of(5, 10).high == Approx(0.8129).margin(5e-5));
    CHECK(judge::probability_of(1, 20).low == Approx(0.0013).margin(5e-5));
    CHECK(judge::probability_of(1, 20).high == Approx(0.2487).margin(5e-5));
    CHECK(judge::probability_of(1, 20).estimate == 0.05);
}

TEST_CASE("Quantiles lie linearly between order statistics") {
    CHECK(quantile({4, 1, 3, 2}, 0.5) == Approx(2.5));
    CHECK(quantile({4, 1, 3, 2}, 0) == 1);
    CHECK(quantile({4, 1, 3, 2}, 1) == 4);
    CHECK(quantile({10, 20, 30}, 0.1) == Approx(12));
    constexpr double infinity = std::numeric_limits<double>::infinity();
    CHECK(quantile({infinity, infinity, infinity}, 0.3) == infinity);
}

TEST_CASE("Rank correlation follows the order, whatever the scale, with mean ranks for ties") {
    CHECK(*judge::rank_correlation(std::vector{1.0, 2.0, 3.0}, std::vector{1.0, 10.0, 1e9}) == Approx(1));
    CHECK(*judge::rank_correlation(std::vector{1.0, 2.0, 3.0}, std::vector{5.0, 0.0, -7.0}) == Approx(-1));
    // Ranks 1 2 3 4 against 2 1 4 3: 1 - 6 (1 + 1 + 1 + 1) / (4 * 15).
    CHECK(*judge::rank_correlation(std::vector{1.0, 2.0, 3.0, 4.0}, std::vector{0.2, 0.1, 0.4, 0.3}) == Approx(0.6));
    // Ranks 1 2.5 2.5 4 against 1 2 3 4: 4.5 / sqrt(4.5 * 5).
    CHECK(*judge::rank_correlation(std::vector{1.0, 7.0, 7.0, 9.0}, std::vector{1.0, 2.0, 3.0, 4.0}) ==
          Approx(4.5 / std::sqrt(22.5)));
    CHECK_FALSE(judge::rank_correlation(std::vector{1.0, 2.0}, std::vector{3.0, 3.0}));
}

TEST_CASE("Tenths of a sample rise with its values") {
    std::vector<double> values;
    std::vector<bool> hits;
    for (int i = 0; i < 20; ++i) {
        values.push_back(20 - i);
        hits.push_back(i < 3);  // the three greatest values
    }
    const auto shares = judge::share_by_decile(values, hits);
    REQUIRE(shares);
    CHECK((*shares)[9] == 1);
    CHECK((*shares)[8] == 0.5);
    CHECK((*shares)[7] == 0);
    CHECK_FALSE(judge::share_by_decile(std::vector{1.0, 2.0}, {true, false}));
}

TEST_CASE("Statistics of a sample made by hand") {
    Problem problem = ceiling_problem();
    std::vector<judge::WorldRun> runs;
    std::vector<World> worlds;
    for (std::uint64_t i = 1; i <= 100; ++i) {
        judge::WorldRun run{i, judge::Outcome::ok, 0.01 * static_cast<double>(i), 0.1, 1000};
        World world;
        world.ceiling_scale = -0.001 * static_cast<double>(i);  // the stronger, the nearer
        world.mass_scale = i % 2 == 0 ? 0.01 : -0.01;
        if (i == 3) {
            run.outcome = judge::Outcome::collision;
            run.is_lateral_collision = true;
        } else if (i == 50) {
            run.outcome = judge::Outcome::goal_missed;
        }
        runs.push_back(run);
        worlds.push_back(world);
    }
    const judge::WorldRuns found = judge::statistics_of(runs, worlds, problem);
    CHECK(found.failures == 2);
    CHECK(found.collisions == 1);
    CHECK(found.lateral_collisions == 1);
    CHECK(found.failure_probability.estimate == 0.02);
    CHECK(found.clearance_p50_m == Approx(0.505));
    CHECK(found.clearance_p01_m == Approx(0.0199));
    REQUIRE(found.sensitivity.size() == 2);  // what does not vary is left out
    CHECK(found.sensitivity[0].parameter == "aero.ceiling_scale");
    CHECK(*found.sensitivity[0].rank_correlation == Approx(-1));
    CHECK((*found.sensitivity[0].failure_share_by_decile)[9] == Approx(0.1));
    CHECK((*found.sensitivity[0].failure_share_by_decile)[5] == Approx(0.1));
    CHECK(found.sensitivity[1].parameter == "vehicle.mass_scale");
    REQUIRE(found.worst.size() == 10);
    CHECK(found.worst[0].world == 3);
    CHECK(found.worst[1].world == 50);
    CHECK(found.worst[2].world == 1);
}

TEST_CASE("Flights in worlds are the same on any number of threads, and each alone") {
    Problem problem = ceiling_problem();
    problem.goal = configuration_goal(-3, 2);
    problem.uncertainty.emplace();
    problem.uncertainty->rotor_time_constant_s = {};
    Plan plan;
    plan.tick_s = 0.01;
    plan.reference = {{0, at_rest({-4, 2, quarter_turn})}, {400, at_rest({-3, 2, quarter_turn})}};
    const judge::PlanJudge judge(problem);
    judge::WorldRunOptions options;
    options.runs = 12;
    options.seed = 5;
    const auto one = judge::fly_in_worlds(judge, plan, options);
    options.threads = 2;
    const auto two = judge::fly_in_worlds(judge, plan, options);
    REQUIRE(one);
    REQUIRE(two);
    for (std::size_t i = 0; i < 12; ++i) {
        CHECK(one->runs[i].world == i + 1);
        CHECK(one->runs[i].outcome == two->runs[i].outcome);
        CHECK(std::memcmp(&one->runs[i].min_clearance_m, &two->runs[i].min_clearance_m, sizeof(double)) == 0);
        CHECK(std::memcmp(&one->runs[i].energy_j, &two->runs[i].energy_j, sizeof(double)) == 0);
    }
    const World seventh = draw_world(*problem.uncertainty, problem.robot, 5, 7);
    CHECK(judge.fly(plan, {true, seventh}).energy_j == one->runs[6].energy_j);
    std::stop_source stopped;
    stopped.request_stop();
    options.stop = stopped.get_token();
    CHECK_FALSE(judge::fly_in_worlds(judge, plan, options));
}

TEST_CASE("A clearance over time has the least value of each step, and flights keep their last one") {
    judge::JudgedFlight whole, broken;
    for (int tick = 0; tick <= 40; ++tick) {
        judge::JudgedRow row;
        row.t_s = 0.01 * tick;
        row.clearance_m = 1 - 0.01 * tick;
        whole.rows.push_back(row);
        if (tick <= 15) {
            row.clearance_m = 0.5;
            broken.rows.push_back(row);
        }
    }
    broken.outcome = judge::Outcome::collision;  // between two ticks
    const judge::ClearanceTrace first = judge::clearance_trace(whole, 0.1);
    REQUIRE(first.size() == 5);
    CHECK(first[0] == Approx(0.91));
    CHECK(first[3] == Approx(0.61));
    CHECK(first[4] == Approx(0.6));
    const judge::ClearanceTrace second = judge::clearance_trace(broken, 0.1);
    CHECK(second == judge::ClearanceTrace{0.5F, 0});
    const judge::ClearanceFan fan = judge::clearance_fan({first, second}, 0.1);
    CHECK(fan.step_s == 0.1);
    REQUIRE(fan.minimum.size() == 5);
    CHECK(fan.minimum[0] == Approx(0.5));
    CHECK(fan.p50[0] == Approx((0.91 + 0.5) / 2));
    CHECK(fan.p10[4] == Approx(0.06));
    CHECK(fan.p01[4] == Approx(0.006));
    CHECK(fan.minimum[4] == 0);
}

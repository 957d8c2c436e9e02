#include "downwash/bench/campaign_report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "campaign_results.hpp"

using namespace downwash;
using namespace downwash::bench;
using Catch::Contains;

namespace {

CampaignReport report_of(const CampaignResults& results) {
    FiguresMaker maker;
    std::vector<RunFigures> runs;
    for (const Run& run : results.runs) {
        runs.push_back(maker.figures_of(run));
    }
    return bench::report_of(results.plan, runs);
}

Run unsolved(std::size_t planner, std::uint32_t seed, RunStatus status) {
    Run run;
    run.planner = planner;
    run.seed = seed;
    run.status = status;
    run.wall_s = 0.3;
    return run;
}

Run solved(std::size_t planner, std::uint32_t seed, double first_s = 0.1, double cost = 100,
           Outcome outcome = Outcome::ok) {
    Run run = unsolved(planner, seed, RunStatus::solved);
    run.wall_s = first_s + 0.2;
    run.first_solution_s = first_s;
    run.cost = cost;
    run.improvements = {{first_s, 10, cost + 50, {}}, {first_s + 0.3, 40, cost, {}}};
    run.flight = FlightFigures{outcome, cost + 1, 0, 0, 0, 0.06, 0};
    return run;
}

/// One problem, two planners, four seeds: the first solves all, the second three with one collision.
CampaignResults some_results() {
    CampaignResults results;
    results.plan.settings = {{"campaign", "trial"}};
    results.plan.experiments = {{"bridge", "energy"}};
    results.plan.planners = {{Variant::mp_arm_ada, "rrt-star", {}}, {Variant::mp_arm, "rrt-star", {}}};
    results.plan.seeds = {1, 2, 3, 7};
    results.plan.time_limit_s = 1;
    results.runs = {solved(0, 1, 0.1, 100),
                    solved(0, 2, 0.2, 110),
                    solved(0, 3, 0.3, 120),
                    solved(0, 7, 0.4, 130),
                    solved(1, 1, 0.01, 90),
                    unsolved(1, 2, RunStatus::none),
                    solved(1, 3, 0.02, 95, Outcome::collision),
                    solved(1, 7, 0.03, 97)};
    return results;
}

/// Planners of different margins on problems with one seed, without runs.
CampaignResults margins(std::vector<Experiment> experiments, const std::vector<double>& margins_m) {
    CampaignResults results;
    results.plan.experiments = std::move(experiments);
    for (const double margin_m : margins_m) {
        results.plan.planners.push_back({Variant::mp_arm, "rrt-star", margin_m});
    }
    results.plan.seeds = {1};
    return results;
}

Run on_second_problem(Run run) {
    run.experiment = 1;
    return run;
}

}  // namespace

TEST_CASE("every seed is in the denominator, and what has no value is infinite") {
    const CampaignReport report = report_of(some_results());
    REQUIRE(report.cells.size() == 2);
    const CellFigures& aware = report.cells[0];
    CHECK(aware.solved.hits == 4);
    CHECK(aware.first_solution_s.median == Approx(0.25));
    CHECK(aware.flown_cost.median == Approx(116));
    CHECK(aware.min_clearance_m == 0.06);
    const CellFigures& geometric = report.cells[1];
    CHECK(geometric.solved.hits == 3);
    CHECK(geometric.solved.attempts == 4);
    CHECK(geometric.failed_flights.hits == 1);
    CHECK(geometric.failed_flights.attempts == 4);
    CHECK(geometric.held.hits == 2);
    CHECK(geometric.first_solution_s.median == Approx(0.025));
    CHECK(std::isinf(geometric.first_solution_s.quantile_95));
    CHECK(std::isinf(geometric.flown_cost.median));  // 91, 98, infinite, infinite
}

TEST_CASE("costs over time are those of the best plan so far, as far as the limit allows, flown where that is known") {
    CampaignResults results = some_results();
    const CampaignReport report = report_of(results);
    const auto& costs = report.cells[0].cost_over_time;
    REQUIRE(costs.size() == 3);  // 0.1, 0.3 and 1 s
    CHECK(costs[0].time_s == 0.1);
    CHECK(std::isinf(costs[0].cost.median));     // one of four has a plan
    CHECK(costs[1].cost.median == Approx(165));  // 150, 160, 170, infinite
    CHECK(costs[2].cost.median == Approx(115));
    for (Run& run : results.runs) {
        for (Improvement& improvement : run.improvements) {
            improvement.flown_cost = improvement.cost + 7;
        }
    }
    CHECK(report_of(results).cells[0].cost_over_time[2].cost.median == Approx(122));
}

TEST_CASE("failures are listed by cause with their seeds") {
    CampaignResults results = some_results();
    results.runs[5].status = RunStatus::impossible;
    results.runs[5].error = "start: is in collision";
    const CampaignReport report = report_of(results);
    REQUIRE(report.failures.size() == 2);
    CHECK(report.failures[0].cause == "impossible: start: is in collision");
    CHECK(report.failures[0].seeds == std::vector<std::uint32_t>{2});
    CHECK(report.failures[1].cause == "collision");
    CHECK(report.failures[1].planner == 1);
    CHECK_THAT(markdown_of(report), Contains("2 of 8 runs have no flight that hovers at the goal.") &&
                                        Contains("- bridge, energy, mp-arm rrt-star: collision: seeds 3\n"));
}

TEST_CASE("planners are compared on equal seeds") {
    const CampaignReport report = report_of(some_results());
    REQUIRE(report.comparisons.size() == 2);
    CHECK(report.comparisons[0].measure == "first solution [s]");
    CHECK(report.comparisons[0].pairing.first_smaller == 1);  // the seed that the second does not solve
    CHECK(report.comparisons[0].pairing.second_smaller == 3);
    CHECK(report.comparisons[0].pairing.median_difference == Approx(0.28));
    CHECK(report.comparisons[1].measure == "executed cost");
    CHECK(report.comparisons[1].pairing.finite == 2);
    CHECK(report.comparisons[1].pairing.median_difference == Approx((10 + 33) / 2.0));
}

TEST_CASE("an unfinished campaign says so and meets no target") {
    CampaignResults results = some_results();
    CampaignExpectation target;
    target.solved_ratio = 1;
    target.failed_flights = 0;
    target.first_solution_median_s = 0.25;
    target.first_solution_95_s = 0.39;
    results.plan.expectations = {target};
    const CampaignReport whole = report_of(results);
    CHECK(whole.meets_its_targets());
    CHECK(whole.targets.size() == 4);

    results.runs.erase(results.runs.begin());
    const CampaignReport part = report_of(results);
    CHECK(part.cells[0].missing == 1);
    CHECK(part.cells[0].solved.attempts == 3);
    CHECK_FALSE(part.meets_its_targets());
    CHECK_THAT(markdown_of(part), Contains("7 of 8 runs done: **the campaign is not finished**"));
}

TEST_CASE("each target is missed on its own") {
    using Target = CampaignExpectation;
    const auto with = [](auto member, auto value) {
        Target target;
        target.variant = Variant::mp_arm;
        target.*member = value;
        return target;
    };
    const auto [target, found] = GENERATE_COPY(std::pair(with(&Target::solved_ratio, 0.8), "3/4"),
                                               std::pair(with(&Target::failed_flights, 0U), "1/4"),
                                               std::pair(with(&Target::first_solution_median_s, 0.024), "0.025 s"),
                                               std::pair(with(&Target::first_solution_95_s, 100.0), "none"),
                                               std::pair(with(&Target::verified_median_s, 0.0249), "0.025 s"));
    CampaignResults results = some_results();
    results.plan.expectations = {target};
    const CampaignReport report = report_of(results);
    REQUIRE(report.targets.size() == 1);
    CHECK(report.targets[0].found == found);
    CHECK_FALSE(report.targets[0].is_met);
    CHECK_FALSE(report.meets_its_targets());
}

TEST_CASE("a median cost is held against the least that any planner has flown there") {
    CampaignResults results = some_results();
    results.plan.planners[1].variant = Variant::mp_arm_ada;
    results.plan.planners[1].algorithm = "sst";
    CampaignExpectation target;
    target.algorithm = "rrt-star";
    target.cost_after_s = 1;
    // 115 is the median of 100 to 130; the least flight is one of sst, 91.
    target.cost_to_best = 115.0 / 91 + 1e-9;
    results.plan.expectations = {target};
    const CampaignReport kept = report_of(results);
    REQUIRE(kept.targets.size() == 1);  // none for sst
    CHECK(kept.targets[0].is_met);
    CHECK(kept.targets[0].found == "1.264");
    results.plan.expectations[0].cost_to_best = 115.0 / 91 - 1e-9;
    CHECK_FALSE(report_of(results).targets[0].is_met);
    results.runs.pop_back();  // of sst: the best is not known yet
    results.plan.expectations[0].cost_to_best = 2;
    CHECK_FALSE(report_of(results).targets[0].is_met);
}

TEST_CASE("a median cost is held against that of a rival at a time of its own") {
    CampaignResults results = some_results();
    results.plan.planners[1] = {Variant::mp_arm_ada, "sst", {}};
    CampaignExpectation target;
    target.algorithm = "sst";
    target.cost_after_s = 0.5;  // 90, 95, 97 and an infinite one
    target.cheaper_than = "rrt-star";
    target.cheaper_than_after_s = 0.3;  // 150, 160, 170 and an infinite one
    results.plan.expectations = {target};
    const CampaignReport report = report_of(results);
    REQUIRE(report.targets.size() == 1);
    CHECK(report.targets[0].planner == 1);
    CHECK(report.targets[0].found == "96 against 165");
    CHECK(report.targets[0].is_met);
    results.plan.expectations[0].cost_after_s = 0.005;  // before its first plan
    CHECK(report_of(results).targets[0].found == "none against 165");
    CHECK_FALSE(report_of(results).targets[0].is_met);
}

TEST_CASE("the safe margin is the least from which on no flight fails, and what it costs is told") {
    CampaignResults results = margins({{"easy", "energy"}, {"hard", "energy"}}, {0.05, 0.1, 0.2, 0.4});
    // easy collides at 0.05 and, by chance not at 0.1, again at 0.2; hard collides up to 0.1 and cannot be solved at
    // 0.4.
    const Outcome hit = Outcome::collision;
    for (const auto& [planner, easy, hard] :
         {std::tuple(0U, hit, hit), std::tuple(1U, Outcome::ok, hit), std::tuple(2U, hit, Outcome::ok)}) {
        results.runs.push_back(solved(planner, 1, 0.1, 100, easy));
        results.runs.push_back(on_second_problem(solved(planner, 1, 0.1, 100, hard)));
    }
    results.runs.push_back(solved(3, 1));
    results.runs.push_back(on_second_problem(unsolved(3, 1, RunStatus::impossible)));

    const CampaignReport report = report_of(results);
    REQUIRE(report.margins.size() == 1);
    const MarginFinding& finding = report.margins[0];
    CHECK(finding.safe_margin_m == 0.4);
    REQUIRE(finding.alone.size() == 2);
    REQUIRE(finding.alone[0].has_value());
    REQUIRE(finding.alone[1].has_value());
    CHECK(finding.alone[0]->margin_m == 0.4);
    CHECK(finding.alone[0]->solved.hits == 1);
    CHECK(finding.alone[1]->margin_m == 0.2);
    CHECK(finding.alone[1]->solved.hits == 1);
    REQUIRE(finding.solved_when_safe.size() == 2);
    CHECK(finding.solved_when_safe[0].hits == 1);
    CHECK(finding.solved_when_safe[1].hits == 0);
    CHECK_THAT(markdown_of(report),
               Contains("| hard, energy | 0.2 m | 1/1 [20.7, 100.0 %] | 0/1 [0.0, 79.3 %] | **no longer reached** |"));
    CHECK(report.comparisons.empty());  // planners of different margins are no pair

    // A margin that is safe only because nothing is reached with it is told apart.
    CampaignResults unreached = margins({{"bridge", "energy"}}, {0.1, 0.2});
    unreached.runs = {solved(0, 1, 0.1, 100, hit), unsolved(1, 1, RunStatus::impossible)};
    CHECK_THAT(markdown_of(report_of(unreached)),
               Contains("| bridge, energy | 0.2 m | 0/1 [0.0, 79.3 %] | 0/1 [0.0, 79.3 %] | "
                        "**out of reach before it is safe** |"));
}

TEST_CASE("runs without a plan are listed with how near they came") {
    CampaignResults results = some_results();
    for (const auto& [place, distance_m] : {std::pair(5U, 0.3), std::pair(7U, 0.1234)}) {
        results.runs[place] = unsolved(1, results.runs[place].seed, RunStatus::approximate);
        results.runs[place].nearest_approach_m = distance_m;
    }
    CHECK_THAT(markdown_of(report_of(results)),
               Contains("mp-arm rrt-star: approximate, 0.123 to 0.3 m from the goal region: seeds 2 7"));
}

TEST_CASE("curves have a step for every first solution and end with the searches") {
    const CellFigures cell = report_of(some_results()).cells[1];
    REQUIRE(cell.solved_over_time.size() == 3);
    CHECK(cell.solved_over_time[1].time_s == 0.02);
    CHECK(cell.solved_over_time[1].solved.hits == 2);
    CHECK(cell.solved_over_time[1].solved.attempts == 4);  // of all attempted seeds
    REQUIRE(cell.cost_curve.size() > 16);                  // two decades, sixteen moments each
    CHECK(cell.cost_curve.front().time_s == Approx(0.01));
    CHECK(cell.cost_curve.back().time_s == 1);
    CHECK(cell.cost_curve.back().cost.median == Approx(96));  // 90, 95, 97 and an infinite one
    CHECK(cell.seeds.size() == 4);
    CHECK(cell.seeds[1].cause == "none");
    CHECK(cell.seeds[3].cause.empty());
    CHECK(cell.seeds[3].flown_cost == 98);
}

TEST_CASE("planners are counted over all problems together too") {
    CampaignResults results = some_results();
    results.plan.experiments.push_back({"rack", "energy"});
    for (std::uint32_t seed = 1; seed < 4; ++seed) {
        results.runs.push_back(on_second_problem(solved(1, seed, 0.1, 100, Outcome::unstable)));
    }
    const CampaignReport report = report_of(results);
    REQUIRE(report.totals.size() == 2);
    CHECK(report.totals[1].failed_flights.hits == 4);
    CHECK(report.totals[1].failed_flights.attempts == 7);
    CHECK(report.totals[1].failed_flights.high == Approx(share_of(4, 7).high));
    CHECK_THAT(markdown_of(report), Contains("All problems together:"));
    CHECK_THAT(markdown_of(report_of(some_results())), !Contains("All problems together:"));
}

TEST_CASE("the table of a paper escapes what LaTeX would take for a command") {
    CampaignResults results = some_results();
    results.plan.experiments[0].problem = "50%_of {a} \\bridge & more~^$#";
    const std::string latex = latex_of(report_of(results));
    CHECK_THAT(
        latex,
        Contains("50\\%\\_of \\{a\\} \\textbackslash{}bridge \\& "
                 "more\\textasciitilde{}\\textasciicircum{}\\$\\#, energy & mp-arm-ada rrt-star & "
                 "4/4 [51.0, 100.0] & 0/4 [0.0, 49.0] & 0.250 [0.175, 0.325] & 116 [108, 124] \\\\\n") &&
            Contains(" & mp-arm rrt-star & 2/4 [15.0, 85.0] & 1/4 [4.6, 69.9] & 0.0250 [0.0175, --] & -- \\\\\n") &&
            Catch::EndsWith("\\bottomrule\n\\end{tabular}\n"));
}

TEST_CASE("the same table is there as CSV, with what is infinite left empty") {
    CampaignResults results = some_results();
    results.plan.experiments[0].problem = "a \"bridge\", old";
    const std::string csv = csv_of(report_of(results));
    const std::size_t first = csv.find("\r\n") + 2, second = csv.find("\r\n", first) + 2;
    const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
    CHECK(csv.substr(first).starts_with("\"a \"\"bridge\"\", old\",energy,mp-arm-ada,rrt-star,,,4,0,4,"));
    CHECK(commas(csv.substr(first, second - first)) == commas(csv.substr(0, first)) + 1);
    CHECK(csv.ends_with(",91,96.25,,,,,,,,,,,,\r\n"));  // flown: 91, 98 and two infinite ones
}

TEST_CASE("the report is the same in JSON, null for what is infinite") {
    const auto json = nlohmann::json::parse(json_of(report_of(some_results())));
    CHECK(json.at("runs_done") == 8);
    CHECK(json.at("cells").at(1).at("solved").at("hits") == 3);
    CHECK(json.at("cells").at(1).at("first_solution_s").at("95").is_null());
    CHECK(json.at("cells").at(0).at("first_solution_s").at("50") == Approx(0.25));
    CHECK(json.at("failures").at(1).at("seeds") == nlohmann::json{3});
    CHECK(json.at("cells").at(1).at("seeds").at("flown_cost").at(1).is_null());
    CHECK(json.at("totals").at(1).at("held").at("hits") == 2);
}

TEST_CASE("settings are numbers and flags in JSON, and no limit is null") {
    CampaignResults results = some_results();
    results.plan.settings = {{"campaign", "12"},
                             {"jobs", "2"},
                             {"time_limit_s", "0.5"},
                             {"max_iterations", "none"},
                             {"stop_at_first_solution", "false"},
                             {"seeds", "1-3, 7"}};
    const auto settings = nlohmann::json::parse(json_of(report_of(results))).at("settings");
    CHECK(settings == nlohmann::json{{"campaign", "12"},
                                     {"jobs", 2},
                                     {"time_limit_s", 0.5},
                                     {"max_iterations", nullptr},
                                     {"stop_at_first_solution", false},
                                     {"seeds", "1-3, 7"}});
}

TEST_CASE("no zero has a minus sign, however little a flight touched") {
    CampaignResults results = some_results();
    results.runs[0].flight->min_clearance_m = -0.0000004;
    results.runs[4].flight->min_clearance_m = -0.0;
    const CampaignReport report = report_of(results);
    for (const std::string& text : {markdown_of(report), latex_of(report), csv_of(report), json_of(report)}) {
        CHECK_FALSE(std::regex_search(text, std::regex("-0(\\.0+)?([^.0-9e]|$)")));
    }
}

TEST_CASE("seeds that follow each other are told as a range") {
    CHECK(seeds_text({1, 2, 3, 7}) == "1-3 7");
    CHECK(seeds_text({5}) == "5");
    CHECK(seeds_text({4294967295U, 0}) == "4294967295 0");
    CHECK(seeds_text({3, 2, 1, 2}) == "3 2 1-2");
}

TEST_CASE("flights in worlds are pooled over the seeds, with the interval of Clopper and Pearson") {
    CampaignResults results = some_results();
    CHECK(nlohmann::json::parse(json_of(report_of(results)))["cells"][0]["in_worlds"].is_null());
    CHECK_THAT(markdown_of(report_of(results)), !Contains("In other worlds"));
    for (std::size_t i = 0; i < 4; ++i) {
        Run& run = results.runs[i];
        run.certificate = CertificateFigures{i != 0, 300, i, 1};
        run.first_certified_s = i != 0 ? std::optional(0.1 * static_cast<double>(i)) : std::nullopt;
        run.in_worlds = WorldFigures{100, i, {{"aero.ceiling_scale", false, i == 3}}};
    }
    results.runs[6].in_worlds = WorldFigures{100, 90, {{"aero.ceiling_scale", true, true}}};  // collides anyway
    results.plan.evaluation_worlds = 100;
    CampaignExpectation target;
    target.max_failure_share = 0.015;
    target.certified_ratio = 0.75;
    target.first_certified_median_s = 0.25;
    results.plan.expectations = {target};
    const CampaignReport report = report_of(results);
    const WorldsFigures& figures = report.cells[0].in_worlds;
    CHECK(figures.tested == 4);
    CHECK(figures.certified.hits == 3);
    CHECK(figures.certified.attempts == 4);
    CHECK(figures.first_certified_s.median == Approx(0.25));  // 0.1, 0.2, 0.3, none
    CHECK(figures.failed.hits == 6);
    CHECK(figures.failed.attempts == 400);
    CHECK(figures.failed.low == Approx(0.00552411));  // worked out by bisection of the binomial sums, apart from us
    CHECK(figures.failed.high == Approx(0.0323613));
    REQUIRE(figures.alone.size() == 1);
    CHECK(figures.alone[0].failed_low == 0);
    CHECK(figures.alone[0].failed_high == 1);
    CHECK(report.cells[1].in_worlds.alone.empty());
    CHECK(report.totals[1].in_worlds.failed.hits == 90);
    CHECK(report.meets_its_targets());
    results.plan.expectations[0].max_failure_share = 0.0149;
    CHECK_FALSE(report_of(results).meets_its_targets());
    results.runs[0].in_worlds.reset();
    results.plan.expectations[0].certified_ratio = 0.76;
    CHECK_FALSE(report_of(results).meets_its_targets());
    CHECK_THAT(markdown_of(report),
               Contains("| bridge, energy | mp-arm-ada rrt-star | aero.ceiling_scale | 0/4 | 1/4 |"));
    for (Run& run : results.runs) {
        if (run.in_worlds) {
            run.in_worlds->alone.clear();
        }
    }
    CHECK_THAT(markdown_of(report_of(results)), Contains("None lets a plan fail.") && !Contains("| at 2 % |"));
    CHECK_THAT(csv_of(report), Contains(",400,6,"));
    CHECK_THAT(latex_of(report), Contains("6/400 [0.6, 3.2]"));
}

TEST_CASE("the page of a large campaign has some of its seeds, the same of every planner, and all counts") {
    CampaignResults results = some_results();
    CHECK(nlohmann::json::parse(page_json_of(report_of(results))).at("seed_step") == 1);
    CHECK(nlohmann::json::parse(page_json_of(report_of(results))) ==
          nlohmann::json::parse(json_of(report_of(results))));
    results.plan.seeds.clear();
    results.runs.clear();
    constexpr std::uint32_t seeds = 6000;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        results.plan.seeds.push_back(seed);
        results.runs.push_back(solved(0, seed, 0.1 + 1e-5 * seed, 100 + 0.01 * seed));
        results.runs.push_back(seed % 4 == 0 ? unsolved(1, seed, RunStatus::none) : solved(1, seed));
    }
    const CampaignReport report = report_of(results);
    CHECK(report.cells[0].solved_over_time.size() == max_steps);
    CHECK(report.cells[0].solved_over_time.back().solved.hits == seeds);
    CHECK(report.cells[0].held_over_cost.back().held == seeds);
    const std::string text = page_json_of(report);
    CHECK(text.size() < 1000000);
    const auto page = nlohmann::json::parse(text);
    CHECK(page.at("seed_step") == 3);  // 12000 runs, 5000 of them at most
    const auto& cells = page.at("cells");
    CHECK(cells[0].at("seeds").at("seed").size() == 2000);
    CHECK(cells[0].at("seeds").at("seed") == cells[1].at("seeds").at("seed"));
    CHECK(cells[1].at("solved").at("hits") == 4500);
    CHECK(page.at("failures")[0].at("count") == 1500);
    CHECK(page.at("failures")[0].at("seeds").size() == 200);
    const auto whole = nlohmann::json::parse(json_of(report));
    CHECK(whole.at("cells")[1].at("seeds").at("seed").size() == seeds);
    CHECK(whole.at("failures")[0].at("seeds").size() == 1500);
}

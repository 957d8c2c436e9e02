#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "../support/scratch_folder.hpp"
#include "../support/test_problem.hpp"
#include "downwash/bench/awareness_study/awareness_figures.hpp"
#include "downwash/bench/awareness_study/awareness_run.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/problems/problem_reader.hpp"

using namespace downwash;
using namespace downwash::bench;
using Catch::Contains;
using downwash::test::ScratchFolder;

namespace {

/// The study in miniature: two problems of a group each, of the same scene.
AwarenessSettings small_study() {
    AwarenessSettings settings;
    Problem problem = test::ceiling_problem();
    problem.uncertainty = Uncertainty();
    settings.ideal = problem.robot;
    settings.ideal.name = "ideal";
    settings.ideal.rotors.time_constant_s = 0;
    problem.name = "first_place";
    settings.problems.push_back({problem, ProblemGroup::shipped});
    problem.name = "second_place";
    settings.problems.push_back({problem, ProblemGroup::engineering});
    settings.lines = cell_lines();
    return settings;
}

/// A run of a condition whose plan holds and fails in one of a thousand fresh worlds.
AwarenessRow row_of(const Condition& condition, const std::string& problem, std::uint32_t seed) {
    AwarenessRow row;
    row.condition = condition;
    row.problem = problem;
    row.seed = seed;
    row.hash = "any";
    row.commit = source_commit();
    row.status = RunStatus::solved;
    row.wall_s = 1;
    row.first_candidate_s = 0.1;
    row.planned_cost = 90;
    row.executed = ExecutedFlight{Outcome::ok, 100, 0.2, 20};
    row.fresh = FreshFlights{1000, 1};
    return row;
}

constexpr Condition certified_at(Variant level) {
    return {PlanKind::reported, level, Asked::certified, true, RobotChoice::own, 1};
}

const Comparison& named(const AwarenessFigures& figures, Metric metric, Variant second,
                        const Condition& like = certified_at(Variant::mp_arm_ada)) {
    const auto found =
        std::find_if(figures.comparisons.begin(), figures.comparisons.end(), [&](const Comparison& each) {
            return each.metric == metric && each.first == like && each.second.level == second &&
                   each.second.asked == like.asked && each.second.checks == like.checks &&
                   each.group == ProblemGroup::shipped && each.problem.empty();
        });
    REQUIRE(found != figures.comparisons.end());
    return *found;
}

}  // namespace

TEST_CASE("the table of cells has every combination once, and claims have fifty seeds") {
    std::set<std::string> names;
    std::size_t count = 0;
    for (const CellLine& line : cell_lines()) {
        CAPTURE(line.name);
        for (const Condition& condition : conditions_of(line)) {
            CHECK(names.insert(name_of(condition)).second);
            ++count;
        }
    }
    // First candidates: 3 levels, 2 settings, 3 robots. Reported: 3 levels, 3 settings, 2 checks, 3 robots, 2 limits.
    CHECK(count == 3 * 2 * 3 + 3 * 3 * 2 * 3 * 2);
    const AwarenessSettings settings = small_study();
    for (const Comparison& comparison : declared_comparisons(settings)) {
        if (!comparison.is_claim) {
            continue;
        }
        for (const Condition& condition : {comparison.first, comparison.second}) {
            const auto line = std::find_if(cell_lines().begin(), cell_lines().end(), [&](const CellLine& each) {
                const std::vector<Condition> all = conditions_of(each);
                return std::find(all.begin(), all.end(), condition) != all.end();
            });
            REQUIRE(line != cell_lines().end());
            CHECK(line->seeds >= seeds_of_claims);
            CHECK(line->is_default);
        }
    }
}

TEST_CASE("a search gets what its condition says, and its plan is judged with the uncertainty in any case") {
    const AwarenessSettings settings = small_study();
    AwarenessTask task{0, 0, certified_at(Variant::mp_arm_da), 7};
    Problem problem = searched_problem(settings, task);
    CHECK(problem.planner.variant == Variant::mp_arm_da);
    CHECK(problem.planner.certify);
    CHECK(problem.planner.check_execution);
    CHECK(problem.planner.seed == 7);
    CHECK(problem.planner.time_limit_s == 1);
    CHECK(problem.uncertainty.has_value());
    task.condition.asked = Asked::worlds;
    CHECK_FALSE(searched_problem(settings, task).planner.certify);
    task.condition.asked = Asked::nominal;
    task.condition.robot = RobotChoice::ideal;
    problem = searched_problem(settings, task);
    CHECK_FALSE(problem.uncertainty.has_value());
    CHECK(problem.robot.name == "ideal");
    CHECK(judged_problem(settings, 0, RobotChoice::ideal).uncertainty.has_value());
    CHECK(judged_problem(settings, 0, RobotChoice::ideal).robot.name == "ideal");
    CHECK(judged_problem(settings, 0, RobotChoice::no_observer).robot.name ==
          settings.problems[0].problem.robot.name + "_no_observer");
}

TEST_CASE("shares are parts of all runs, and keep the levels of a pair together") {
    AwarenessSettings settings = small_study();
    const std::vector<AwarenessTask> all = tasks_of(settings);
    std::size_t sum = 0;
    for (std::uint64_t number = 1; number <= 4; ++number) {
        const std::vector<AwarenessTask> some = share_of(all, {number, 4});
        sum += some.size();
        for (std::size_t i = 0; i + 2 < some.size(); i += 3) {
            CHECK(some[i].seed == some[i + 2].seed);
            CHECK(some[i].problem == some[i + 2].problem);
            CHECK(some[i].condition.level != some[i + 2].condition.level);
        }
    }
    CHECK(sum == all.size());
}

TEST_CASE("a row is read as it was written, and what is no row is passed over") {
    const ScratchFolder folder;
    AwarenessRows rows(folder / "runs.jsonl");
    CHECK(rows.read().empty());
    AwarenessRow row = row_of(certified_at(Variant::mp_arm), "a_place", 3);
    row.first_certified_s = 0.7;
    row.tested = CertificateFigures{true, 437, 0, 2};
    row.executed->min_clearance_m = std::numeric_limits<double>::infinity();
    AwarenessRow without_plan = row_of(certified_at(Variant::mp_arm_ada), "a_place", 4);
    without_plan.status = RunStatus::approximate;
    without_plan.planned_cost.reset();
    without_plan.executed.reset();
    without_plan.fresh.reset();
    without_plan.first_candidate_s.reset();
    without_plan.nearest_approach_m = 0.5;
    without_plan.missed = "certificate";
    rows.add(row);
    {
        std::ofstream out(folder / "runs.jsonl", std::ios::app);
        out << line_of(row).substr(0, 40);  // a program that was killed
    }
    rows.add(without_plan);
    CHECK(rows.read() == std::vector{row, without_plan});
    CHECK_FALSE(row_of("{}").has_value());
    CHECK_FALSE(row_of("").has_value());
}

TEST_CASE("comparisons count pairs, and say which of two is better after Holm") {
    AwarenessSettings settings = small_study();
    std::vector<AwarenessRow> rows;
    const Condition ada = certified_at(Variant::mp_arm_ada), da = certified_at(Variant::mp_arm_da);
    for (std::uint32_t seed = 1; seed <= 50; ++seed) {
        AwarenessRow first = row_of(ada, "first_place", seed), second = row_of(da, "first_place", seed);
        first.first_certified_s = 0.5;
        second.executed->cost = 110;
        if (seed <= 20) {  // no certificate
            second.status = RunStatus::approximate;
            second.missed = "certificate";
            second.executed.reset();
            second.fresh.reset();
        } else {
            second.first_certified_s = 1;
        }
        rows.push_back(first);
        rows.push_back(second);
    }
    const AwarenessFigures figures = awareness_figures(settings, rows);
    const Comparison& reach = named(figures, Metric::reach, Variant::mp_arm_da);
    CHECK(reach.is_claim);
    CHECK(reach.pairs == 50);
    CHECK(reach.counts.both == 30);
    CHECK(reach.counts.first_only == 20);
    CHECK(reach.effect.value == Approx(0.4));
    CHECK(reach.p == Approx(2 * std::pow(0.5, 20)));
    CHECK(reach.p_adjusted > reach.p);
    CHECK(verdict_of(reach) == "first better");
    const Comparison& cost = named(figures, Metric::cost, Variant::mp_arm_da);
    CHECK(cost.pairs == 30);
    CHECK(cost.left_out == 20);
    CHECK(cost.effect.value == Approx(100.0 / 110));
    CHECK(verdict_of(cost) == "first better");
    // A certificate that never comes is later than any: all fifty pairs count, and 30 have a ratio.
    const Comparison& time = named(figures, Metric::certificate_time, Variant::mp_arm_da);
    CHECK(time.pairs == 50);
    CHECK(time.effect.value == Approx(0.5));
    CHECK(time.p == Approx(2 * std::pow(0.5, 50)));
    CHECK(verdict_of(named(figures, Metric::fresh_failures, Variant::mp_arm_da)) == "no difference shown");
    CHECK(verdict_of(named(figures, Metric::reach, Variant::mp_arm)) == "no data");

    const auto cell = std::find_if(figures.cells.begin(), figures.cells.end(), [&](const AwarenessCell& each) {
        return each.condition == da && each.group == ProblemGroup::shipped;
    });
    REQUIRE(cell != figures.cells.end());
    CHECK(cell->attempted == 50);
    CHECK(cell->planned.hits == 30);
    CHECK(cell->missed.at("certificate") == 20);
    CHECK(cell->fresh_failures.value == Approx(0.001));
    CHECK(cell->unreliable.hits == 0);
    CHECK(cell->cost_ratio.median == Approx(1.1));
    CHECK(figures.best.at({"first_place", RobotChoice::own}).cost == 100);

    CHECK_THAT(markdown_of(figures),
               Contains("| mp-arm-ada against mp-arm-da, reported, certified, checked, 1 s, own |") &&
                   Contains("first better |"));
    const auto json = nlohmann::json::parse(json_of(figures));
    CHECK(json["study"] == "awareness");
    CHECK(json["comparisons"].size() == figures.comparisons.size());
}

TEST_CASE("the study runs, resumes, and runs again what has changed") {
    const ScratchFolder folder;
    AwarenessSettings settings = small_study();
    settings.lines.clear();
    for (const char* name : {"first", "certified-1s"}) {
        settings.lines.push_back(*std::find_if(cell_lines().begin(), cell_lines().end(),
                                               [&](const CellLine& line) { return line.name == name; }));
        settings.lines.back().seeds = 1;
        settings.lines.back().worlds = 3;
        settings.lines.back().time_limit_s = name == std::string("first") ? 1 : 0.2;
    }
    AwarenessRunOptions options;
    options.out = folder.path();
    options.jobs = 1;
    options.map_cache = folder / "maps";
    options.share = {1, 2};
    run_awareness(settings, options);
    const std::vector<AwarenessRow> half = current_rows(settings, options.out, {});
    CHECK(half.size() == 9);
    options.share = {};
    run_awareness(settings, options);
    const std::vector<AwarenessRow> rows = current_rows(settings, options.out, {});
    REQUIRE(rows.size() == 18);  // 2 problems, 3 levels, nominal and worlds first, certified later
    CHECK(std::equal(half.begin(), half.end(), rows.begin()));
    CHECK(missing_tasks(settings, {}, rows).empty());
    for (const AwarenessRow& row : rows) {
        CAPTURE(line_of(row));
        CHECK(row.error.empty());
        if (row.has_plan()) {
            REQUIRE(row.executed.has_value());
            REQUIRE(row.fresh.has_value());
            CHECK(row.fresh->worlds == 3);
        }
    }
    CHECK(std::count_if(rows.begin(), rows.end(), [](const AwarenessRow& row) { return row.has_plan(); }) >= 6);
    const AwarenessFigures figures = awareness_figures(settings, rows);
    CHECK(figures.planned == 18);
    CHECK(figures.done == 18);
    CHECK_THAT(plan_markdown(settings, rows, 1), Contains("0.0 hours left"));

    // Another scene is another run; so is another number of worlds, or another program.
    settings.problems[0].problem.planner.safety_margin_m += 0.01;
    CHECK(current_rows(settings, options.out, {}).size() == 9);
    settings.lines[0].worlds = 4;
    CHECK(current_rows(settings, options.out, {}).size() == 3);
}

TEST_CASE("the engineers' problems can be read, and nothing in them is likely not meant") {
    const std::filesystem::path folder =
        std::filesystem::path(DOWNWASH_PROBLEMS).parent_path() / "bench/awareness_study/problems";
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".yaml") {
            continue;
        }
        CAPTURE(entry.path().string());
        std::string warnings;
        const Problem problem = read_problem(entry.path(), {}, {},
                                             [&](const LocatedError& warning) { warnings += warning.message + "\n"; });
        CHECK(warnings.empty());
        CHECK(problem.name == entry.path().stem().string());
        CHECK(problem.uncertainty.has_value());
        ++count;
    }
    CHECK(count == 5);
}

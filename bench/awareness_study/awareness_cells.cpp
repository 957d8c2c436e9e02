#include "downwash/bench/awareness_study/awareness_cells.hpp"

#include <algorithm>
#include <type_traits>
#include <variant>

#include "downwash/base/text.hpp"

namespace downwash::bench {
namespace {

using enum Asked;

const std::vector<Asked> both_nominal_and_worlds{nominal, worlds};
const std::vector<bool> unchecked{false}, checked{true}, either{false, true};
const std::vector<RobotChoice> own{RobotChoice::own}, others{RobotChoice::ideal, RobotChoice::no_observer};
const std::vector<ProblemGroup> all_groups{ProblemGroup::shipped, ProblemGroup::engineering},
    shipped{ProblemGroup::shipped};

/// A vehicle whose law has no observer.
Robot without_observer(Robot robot) {
    robot.name += "_no_observer";
    std::visit(
        []<class Law>(Law& law) {
            if constexpr (std::is_same_v<Law, ModelInversion> || std::is_same_v<Law, CascadedPid>) {
                law.aids.observer.reset();
            }
        },
        robot.controller.law);
    return robot;
}

/// @pre settings has an ideal robot if it is chosen
Problem flown_by(const AwarenessSettings& settings, std::size_t problem, RobotChoice robot) {
    Problem flown = settings.problems.at(problem).problem;
    if (robot == RobotChoice::ideal) {
        flown.robot = settings.ideal;
    } else if (robot == RobotChoice::no_observer) {
        flown.robot = without_observer(flown.robot);
    }
    return flown;
}

}  // namespace

std::string_view name_of(Asked asked) {
    static constexpr std::array<std::string_view, 3> names{"nominal", "worlds", "certified"};
    return names.at(static_cast<std::size_t>(asked));
}

std::string_view name_of(PlanKind kind) {
    return kind == PlanKind::first ? "first" : "reported";
}

std::string_view name_of(RobotChoice robot) {
    static constexpr std::array<std::string_view, 3> names{"own", "ideal", "no-observer"};
    return names.at(static_cast<std::size_t>(robot));
}

std::string_view name_of(ProblemGroup group) {
    return group == ProblemGroup::shipped ? "shipped" : "engineering";
}

std::string name_of(const Condition& condition) {
    std::string name(name_of(condition.kind));
    for (const std::string_view part :
         {downwash::name_of(condition.level), name_of(condition.asked),
          std::string_view(condition.checks ? "checked" : "unchecked"), name_of(condition.robot)}) {
        name.append(" ").append(part);
    }
    return name + " " + to_text(condition.time_limit_s) + " s";
}

const std::vector<CellLine>& cell_lines() {
    constexpr auto first = PlanKind::first;
    constexpr auto reported = PlanKind::reported;
    static const std::vector<CellLine> lines{
        {"first", "what a model accepts first, before anything else looks at it", first, both_nominal_and_worlds,
         unchecked, own, all_groups, 10, seeds_of_claims, 2000},
        {"first-robots", "the same with other controllers", first, both_nominal_and_worlds, unchecked, others, shipped,
         10, seeds_of_claims, 500},
        {"certified-1s",
         "certified plans, executed before they count",
         reported,
         {certified},
         checked,
         own,
         all_groups,
         1,
         seeds_of_claims,
         2000},
        {"certified-robots-1s",
         "the same with other controllers",
         reported,
         {certified},
         checked,
         others,
         shipped,
         1,
         20,
         500},
        {"certified-10s",
         "whether more time changes it",
         reported,
         {certified},
         checked,
         own,
         all_groups,
         10,
         10,
         2000},
        {"certified-unchecked-1s",
         "a certificate without the execution",
         reported,
         {certified},
         unchecked,
         own,
         all_groups,
         1,
         6,
         500},
        {"settings-1s", "without worlds, or without a certificate", reported, both_nominal_and_worlds, either, own,
         all_groups, 1, 6, 500},
        {"settings-robots-1s", "the same with other controllers", reported, both_nominal_and_worlds, either, others,
         shipped, 1, 2, 500},
        {"certified-unchecked-robots-1s",
         "the same with other controllers",
         reported,
         {certified},
         unchecked,
         others,
         shipped,
         1,
         2,
         500},
        // The rest of the table, for those who have the time.
        {"certified-unchecked-10s",
         "the rest of the table",
         reported,
         {certified},
         unchecked,
         own,
         all_groups,
         10,
         2,
         500,
         false},
        {"settings-10s", "the rest of the table", reported, both_nominal_and_worlds, either, own, all_groups, 10, 2,
         500, false},
        {"certified-robots-10s",
         "the rest of the table",
         reported,
         {certified},
         either,
         others,
         shipped,
         10,
         2,
         500,
         false},
        {"settings-robots-10s", "the rest of the table", reported, both_nominal_and_worlds, either, others, shipped, 10,
         2, 500, false},
    };
    return lines;
}

std::vector<Condition> conditions_of(const CellLine& line) {
    std::vector<Condition> conditions;
    for (const RobotChoice robot : line.robots) {
        for (const Asked asked : line.asked) {
            for (const bool checks : line.checks) {
                for (const Variant level : all_variants) {
                    conditions.push_back({line.kind, level, asked, checks, robot, line.time_limit_s});
                }
            }
        }
    }
    return conditions;
}

std::vector<AwarenessTask> tasks_of(const AwarenessSettings& settings) {
    std::vector<AwarenessTask> tasks;
    std::uint32_t seeds = 0;
    for (const CellLine& line : settings.lines) {
        seeds = std::max(seeds, line.seeds);
    }
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        for (std::size_t l = 0; l < settings.lines.size(); ++l) {
            const CellLine& line = settings.lines[l];
            if (seed > line.seeds) {
                continue;
            }
            for (std::size_t p = 0; p < settings.problems.size(); ++p) {
                const ProblemGroup group = settings.problems[p].group;
                if (std::find(line.groups.begin(), line.groups.end(), group) == line.groups.end()) {
                    continue;
                }
                for (const Condition& condition : conditions_of(line)) {
                    if (flies(condition.robot, group)) {
                        tasks.push_back({l, p, condition, seed});
                    }
                }
            }
        }
    }
    return tasks;
}

std::vector<AwarenessTask> share_of(const std::vector<AwarenessTask>& tasks, const TaskShare& share) {
    std::vector<AwarenessTask> some;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        if (i / all_variants.size() % share.count + 1 == share.number) {  // the levels of a condition stay together
            some.push_back(tasks[i]);
        }
    }
    return some;
}

Problem judged_problem(const AwarenessSettings& settings, std::size_t problem, RobotChoice robot) {
    return flown_by(settings, problem, robot);
}

Problem searched_problem(const AwarenessSettings& settings, const AwarenessTask& task) {
    const Condition& condition = task.condition;
    Problem searched = flown_by(settings, task.problem, condition.robot);
    PlannerSettings& planner = searched.planner;
    planner.variant = condition.level;
    planner.algorithm = "rrt-star";
    planner.certify = condition.asked == Asked::certified;
    planner.check_execution = condition.checks;
    planner.time_limit_s = condition.time_limit_s;
    planner.max_iterations.reset();
    planner.seed = task.seed;
    if (condition.asked == Asked::nominal) {
        searched.uncertainty.reset();
    }
    return searched;
}

double expected_s(const CellLine& line) {
    // Measured on the machine of bench/results with two searches at a time, over the shipped problems.
    constexpr double first_candidate_s = 0.2, setup_and_end_s = 0.3, flight_s = 0.0007;
    const double search_s = line.kind == PlanKind::first ? first_candidate_s : line.time_limit_s + setup_and_end_s;
    return search_s + flight_s * static_cast<double>(line.worlds);
}

}  // namespace downwash::bench

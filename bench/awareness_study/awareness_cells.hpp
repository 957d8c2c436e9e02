#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/problems/problem.hpp"

namespace downwash::bench {

/// What a search of the study is asked for.
enum class Asked : std::uint8_t {
    nominal,    ///< a plan for the nominal world: the problem without its uncertainty
    worlds,     ///< a plan whose edges hold in several worlds, without a certificate
    certified,  ///< the same with a certificate
};
inline constexpr std::array all_asked{Asked::nominal, Asked::worlds, Asked::certified};

/// Which plan of a search counts.
enum class PlanKind : std::uint8_t {
    first,     ///< the first one that the planner's own model accepts, whatever its executed flight
    reported,  ///< the one that is reported at the time limit
};

/// Whose vehicle flies.
enum class RobotChoice : std::uint8_t {
    own,          ///< the problem's
    ideal,        ///< `ars_lrm_ideal`: no lag, no delay, a soft height controller
    no_observer,  ///< the problem's, without its observer
};
inline constexpr std::array all_robot_choices{RobotChoice::own, RobotChoice::ideal, RobotChoice::no_observer};

/// Where a problem of the study comes from.
enum class ProblemGroup : std::uint8_t {
    shipped,      ///< the folder problems/
    engineering,  ///< the folder bench/awareness_study/problems/: written for this study before anything was run
};
inline constexpr std::array all_problem_groups{ProblemGroup::shipped, ProblemGroup::engineering};

[[nodiscard]] std::string_view name_of(Asked asked);         ///< "nominal", "worlds", "certified"
[[nodiscard]] std::string_view name_of(PlanKind kind);       ///< "first", "reported"
[[nodiscard]] std::string_view name_of(RobotChoice robot);   ///< "own", "ideal", "no-observer"
[[nodiscard]] std::string_view name_of(ProblemGroup group);  ///< "shipped", "engineering"

/// How plans are made: everything but problem and seed.
struct Condition {
    PlanKind kind = PlanKind::first;
    Variant level = Variant::mp_arm_ada;
    Asked asked = Asked::nominal;
    bool checks = false;  ///< planner.check_execution
    RobotChoice robot = RobotChoice::own;
    double time_limit_s = 1;  ///< of a first candidate the most that it may take

    bool operator==(const Condition&) const = default;
};

/// "reported mp-arm-ada certified checked own 1 s": unique.
[[nodiscard]] std::string name_of(const Condition& condition);

/// A line of the study's table: the conditions that it joins, on all problems of some groups.
struct CellLine {
    std::string name;  ///< "claims-1s"
    std::string why;
    PlanKind kind = PlanKind::first;
    std::vector<Asked> asked;
    std::vector<bool> checks;
    std::vector<RobotChoice> robots;  ///< others than `own` fly the shipped problems only
    std::vector<ProblemGroup> groups;
    double time_limit_s = 1;
    std::uint32_t seeds = 10;     ///< 1 to `seeds` for each of the three levels
    std::uint64_t worlds = 2000;  ///< fresh worlds in which every plan is flown
    bool is_default = true;       ///< run unless lines are named
};

/// The table. A condition stands in one line only.
[[nodiscard]] const std::vector<CellLine>& cell_lines();

/// Least number of seeds for a line about which the study makes claims.
inline constexpr std::uint32_t seeds_of_claims = 50;

/// The conditions of a line, for all levels, in the order in which they are run.
[[nodiscard]] std::vector<Condition> conditions_of(const CellLine& line);

/// Problems of a group by a robot: whether the study has that.
[[nodiscard]] constexpr bool flies(RobotChoice robot, ProblemGroup group) {
    return robot == RobotChoice::own || group == ProblemGroup::shipped;
}

/// A problem of the study.
struct StudyProblem {
    Problem problem;  ///< with an uncertainty
    ProblemGroup group = ProblemGroup::shipped;
};

/// What is studied.
struct AwarenessSettings {
    std::vector<StudyProblem> problems;
    Robot ideal;                       ///< robot of RobotChoice::ideal
    std::vector<CellLine> lines = {};  ///< lines of the table
};

/// A run of the study.
struct AwarenessTask {
    std::size_t line = 0;     ///< of AwarenessSettings::lines
    std::size_t problem = 0;  ///< of AwarenessSettings::problems
    Condition condition;
    std::uint32_t seed = 1;
};

/// All runs, seeds outermost: an interrupted study has about as many runs of every condition, and the runs of a pair
/// are near in time.
[[nodiscard]] std::vector<AwarenessTask> tasks_of(const AwarenessSettings& settings);

/// One of several programs that share the runs among them: "2/3".
struct TaskShare {
    std::uint64_t number = 1;  ///< 1 to count
    std::uint64_t count = 1;
};

/// Its runs: every count-th, all levels of a condition, problem and seed together.
/// @param tasks as of tasks_of()
[[nodiscard]] std::vector<AwarenessTask> share_of(const std::vector<AwarenessTask>& tasks, const TaskShare& share);

/// The problem as a search under this condition gets it: robot, level, uncertainty, keys, limits and seed.
[[nodiscard]] Problem searched_problem(const AwarenessSettings& settings, const AwarenessTask& task);

/// The problem in whose worlds the plan is flown: the same robot, with the uncertainty.
[[nodiscard]] Problem judged_problem(const AwarenessSettings& settings, std::size_t problem, RobotChoice robot);

/// What a run is expected to take on one thread before any was made [s]: a search to its limit (a first candidate
/// to `first_candidate_s`), its setup, and the flights in worlds.
[[nodiscard]] double expected_s(const CellLine& line);

}  // namespace downwash::bench

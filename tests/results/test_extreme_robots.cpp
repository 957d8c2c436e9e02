#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "../support/scratch_folder.hpp"
#include "../support/solved_run.hpp"
#include "downwash/base/files.hpp"
#include "downwash/judge/plan_judge.hpp"
#include "downwash/problems/problem_check.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/results/claims.hpp"
#include "downwash/results/run_record.hpp"
#include "downwash/simulation/robot_parameters.hpp"

using namespace downwash;
using test::ScratchFolder;

namespace {

/// Draws values from within the ranges of the parameter table: ends, and whatever lies orders of magnitude between.
class Extremes {
 public:
    explicit Extremes(std::uint32_t seed) : random_(seed) {}

    std::size_t below(std::size_t count) { return random_() % count; }

    /// In the unit of the file.
    double within(const Range& range) {
        const double low = range.low.value_or(-1e9), high = range.high.value_or(1e9);
        switch (below(4)) {
            case 0:
                return range.excludes_low ? std::nextafter(low, high) : low;
            case 1:
                return range.excludes_high ? std::nextafter(high, low) : high;
            default:
                break;
        }
        constexpr double smallest = 1e-300;
        const bool is_negative = low < 0 && below(2) == 0;
        const double greatest = is_negative ? -low : high;
        const double least = low > 0 ? low : smallest;
        const double size = least * std::pow(greatest / least, std::uniform_real_distribution(0.0, 1.0)(random_));
        return is_negative ? -size : size;
    }

    /// A robot of which some numbers are extreme.
    Robot robot() {
        Robot robot = test::test_robot();
        struct Place {
            const Parameter<Robot>* parameter;
            std::size_t index;
        };
        std::vector<Place> numbers;
        for_each_value(robot_parameters(), robot,
                       [&](const Parameter<Robot>& parameter, const std::string&, std::size_t index) {
                           if (parameter.kind == ParameterKind::number || parameter.kind == ParameterKind::numbers ||
                               parameter.kind == ParameterKind::points) {
                               numbers.push_back({&parameter, index});
                           }
                       });
        for (std::size_t i = 0, count = 1 + below(3); i < count; ++i) {
            const auto& [parameter, index] = numbers[below(numbers.size())];
            const double unit = is_in_degrees(parameter->path) ? std::numbers::pi / 180 : 1;
            Value value = parameter->get(robot, index);
            if (auto* number = std::get_if<double>(&value)) {
                *number = unit * within(parameter->range);
            } else if (auto* list = std::get_if<std::vector<double>>(&value)) {
                (*list)[below(list->size())] = unit * within(parameter->range);
            } else if (auto* points = std::get_if<std::vector<Vector3>>(&value)) {
                (*points)[below(points->size())][below(3)] = within(parameter->range);
            }
            parameter->set(robot, index, value);
        }
        return robot;
    }

 private:
    std::mt19937 random_;
};

/// Half a metre up and to the right in open air.
Problem short_way(const Robot& robot) {
    Problem problem;
    problem.name = "extreme";
    problem.robot = robot;
    problem.bounds = {-20, 20, -20, 20};
    problem.start.at[plane::x] = 0;
    problem.start.at[plane::z] = 2;
    problem.start.at[plane::arm] = test::quarter_turn;
    problem.goal = test::configuration_goal(0.5, 2.5);
    problem.goal.hold_s = 1;
    problem.planner.variant = Variant::mp_arm_da;
    problem.planner.seed = 1;
    problem.planner.max_iterations = 10;
    return problem;
}

/// Writes a run and reads it again: throws where a number is not finite or beyond its range.
void check_readable(const Problem& problem, const Solution& solution) {
    const ScratchFolder folder;
    Execution nothing_flown;
    nothing_flown.rotor_count = static_cast<int>(problem.robot.rotors.positions_m.size());
    const Execution flight = solution.execution.value_or(nothing_flown);
    for (const auto& [name, content] : run_files(problem, "problem.yaml", solution, flight, folder.path())) {
        write_file(folder / name, content);
    }
    const RunRecord record = read_run(folder.path());
    CHECK(record.flight.rows() == flight.rows.size());
    if (solution.execution) {
        const Claims claims = read_claims((folder / "solution.json").string(), record.problem);
        REQUIRE(claims.flight.has_value());
        CHECK(claims.flight->energy_j == flight.energy_j);
        CHECK(record.solution_text.find("\"energy_j\": null") == std::string::npos);
        CHECK(record.solution_text.find("\"max_saturation\": null") == std::string::npos);
        CHECK(record.solution_text.find("\"max_tracking_error_m\": null") == std::string::npos);
    }
}

/// A straight way to the goal of a problem, flown by a robot.
Solution flown_by(const Robot& robot, const Problem& problem) {
    Problem other = problem;
    other.robot = robot;
    const auto model = make_flight_model(other);
    const double tick_s = model->tick().tick_s;
    const Configuration start = problem.start.at;
    const Configuration goal{start[plane::x] + 0.5, start[plane::z] + 0.5, start[plane::arm]};
    Solution solution;
    solution.status = Status::solved;
    solution.algorithm = "rrt-star";
    solution.plan = Plan{{{0, at_rest(start)}, {std::llround(2 / tick_s), at_rest(goal)}}, tick_s};
    solution.execution =
        execute(*model, start_state(*model, problem.start), solution.plan->reference, problem.goal, false);
    solution.execution_cost = solution.execution->energy_j;
    return solution;
}

}  // namespace

TEST_CASE("robots at the ends of all ranges are refused, or every number of their flights is finite and read again") {
    Extremes extremes(7);
    int refused = 0, ok = 0, unstable = 0;
    constexpr int robots = 400;
    for (int i = 0; i < robots; ++i) {
        const Problem problem = short_way(extremes.robot());
        CAPTURE(i);
        const std::vector<KeyError> errors = problem_errors(problem);
        if (!errors.empty()) {
            ++refused;
            CHECK_FALSE(errors[0].key.empty());
            CHECK_FALSE(errors[0].message.empty());
            continue;
        }
        const Solution solution = flown_by(problem.robot, problem);
        check_readable(problem, solution);
        ok += solution.execution->outcome == Outcome::ok ? 1 : 0;
        unstable += solution.execution->outcome == Outcome::unstable ? 1 : 0;

        const judge::JudgedFlight judged = judge::PlanJudge(problem).fly(*solution.plan, {});
        CHECK(std::isfinite(judged.energy_j + judged.max_tracking_error_m + judged.goal_error_m + judged.length_m));
        for (const judge::JudgedRow& row : judged.rows) {
            REQUIRE(std::isfinite(row.pose.x_m + row.pose.z_m + row.pose.pitch_rad + row.pose.arm_rad + row.vx_m_s +
                                  row.vz_m_s + row.energy_j));
        }
    }
    CHECK(refused > robots / 20);
    CHECK(ok > robots / 20);
    CHECK(unstable > robots / 20);
}

TEST_CASE("searches for robots at the ends of all ranges leave files that are read again") {
    Extremes extremes(8);
    for (int i = 0; i < 40; ++i) {
        const Problem problem = short_way(extremes.robot());
        CAPTURE(i);
        if (problem_errors(problem).empty()) {
            check_readable(problem, solve(problem));
        }
    }
}

TEST_CASE("a flight that takes more energy than anything that flies is read again") {
    Problem problem = test::ceiling_problem();
    problem.robot.rotors.power_coefficient_w_n1p5 = 1e6;  // 4 x 12.1 N^1.5 x 1e6 W/N^1.5: over 0.1 GW
    const test::SolvedRun run(problem);
    REQUIRE(run.solution.execution->outcome == Outcome::ok);
    CHECK(run.solution.execution->energy_j > 1e9);
    CHECK(read_run(run.folder()).flight.find("energy_j")->back() == run.solution.execution->energy_j);
}

TEST_CASE("a flight whose numbers are no longer finite is unstable, and ends with the last row that is") {
    const Problem problem = short_way(test::test_robot());
    Problem broken = problem;
    broken.robot.multirotor.mass_kg = 1e-300;  // never read from a file: its key has a range
    broken.robot.arm.mass_kg = 1e-300;
    broken.robot.multirotor.pitch_inertia_kg_m2 = 1e-300;
    CHECK(problem_errors(broken).size() >= 3);
    const Solution solution = flown_by(broken.robot, problem);
    CHECK(solution.execution->outcome == Outcome::unstable);
    check_readable(problem, solution);
    const judge::JudgedFlight judged = judge::PlanJudge(broken).fly(*solution.plan, {});
    CHECK(judged.outcome == judge::Outcome::unstable);
    CHECK(std::isfinite(judged.energy_j));
}

// Time to the first solution of what a practitioner would build from OMPL, beside ours, on the same problem with the
// same map in one run; seeds take turns. Prints Markdown. Every seed is in the denominator.

#include <fmt/core.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "../support/measuring.hpp"
#include "downwash/base/quantile.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/bench/ompl_user/user_planner.hpp"
#include "downwash/bench/statistics.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/simulation/world_parameters.hpp"

using namespace downwash;

namespace {

struct Options {
    std::string problem;
    std::uint32_t seeds = 200;
    double time_limit_s = 20;
    std::uint32_t world_seeds = 40;
    double world_time_limit_s = 60;
    std::uint64_t worlds = 20;
};

constexpr const char* our_name = "downwash rrt-star";

struct Row {
    std::string name;
    std::vector<double> times_s;  ///< times of every seed; infinite where nothing was found
};

std::string milliseconds(double time_s) {
    return std::isfinite(time_s) ? fmt::format("{:.1f}", 1e3 * time_s) : "-";
}

/// The nominal world and those with the numbers 1, 2, ... of the problem's uncertainty, as particles of a user.
std::vector<FlownWorld> particles_of(const Problem& problem, std::uint64_t count) {
    std::vector<FlownWorld> worlds;
    for (std::uint64_t i = 0; i < count; ++i) {
        worlds.push_back(make_world(problem.robot, draw_world(*problem.uncertainty, problem.robot, 1, i)));
    }
    return worlds;
}

/// How many times as long the user's set-up takes. Both medians lie in their ranges with 95 % confidence.
void print_ratio(const Row& user, const Row& ours) {
    constexpr double min_ratio = 50;
    constexpr double confidence_of_each = 0.975;
    const double ratio = quantile(user.times_s, 0.5) / quantile(ours.times_s, 0.5);
    const bench::Range theirs = bench::median_range(user.times_s, confidence_of_each);
    const bench::Range own = bench::median_range(ours.times_s, confidence_of_each);
    fmt::print("\n| bound | found | |\n| --- | --- | --- |\n");
    bench::print_bound(fmt::format("the median of {} is at least {} times sooner than a user's", ours.name, min_ratio),
                       fmt::format("{:.1f} times, 95 % interval {:.1f} to {:.1f}", ratio,
                                   std::max(0.0, theirs.low) / own.high, theirs.high / std::max(0.0, own.low)),
                       ratio >= min_ratio);
}

void print_times(const std::vector<Row>& rows) {
    fmt::print(
        "| planner | solved | 95 % interval | 25 % ms | median ms | 75 % ms | 95 % ms |\n"
        "| --- | --: | --: | --: | --: | --: | --: |\n");
    for (const Row& row : rows) {
        const auto hits =
            std::count_if(row.times_s.begin(), row.times_s.end(), [](double t) { return std::isfinite(t); });
        const bench::Share solved = bench::share_of(static_cast<std::size_t>(hits), row.times_s.size());
        fmt::print("| {} | {}/{} | {:.3f} to {:.3f} |", row.name, solved.hits, solved.attempts, solved.low,
                   solved.high);
        for (const double q : {0.25, 0.5, 0.75, 0.95}) {
            fmt::print(" {} |", milliseconds(quantile(row.times_s, q)));
        }
        fmt::print("\n");
    }
    const auto ours = std::find_if(rows.begin(), rows.end(), [](const Row& row) { return row.name == our_name; });
    print_ratio(rows.front(), *ours);
}

void print(const Options& options, const Problem& problem, const std::vector<Row>& rows) {
    fmt::print(
        "# First solutions beside OMPL: {}\n\nCommit {}; {}; {} seeds, {} s each, one thread, aerodynamics-aware.\n\n",
        problem.name, bench::source_commit(), bench::processor(), options.seeds, options.time_limit_s);
    print_times(rows);
}

/// RandUP-RRT beside our tree in as many worlds.
void print_in_worlds(const Options& options, const std::vector<Row>& rows) {
    fmt::print(
        "\n## In {} worlds\n\n{} seeds, {} s each. A user's RandUP-RRT moves one particle for each world: the nominal "
        "one "
        "and draws of mass, arm mass, inertia, centre of mass,\nthrust of all rotors and of each, K - 1, and the place "
        "of the scene. Its ODE has no lag, delay, drag, wind, bias or noise: its worlds differ less than ours.\nOurs "
        "has "
        "all of them in every world, with the margin, the rules and the hover at the goal. Its time is that of the "
        "first "
        "plan that holds in all worlds,\nwith or without a certificate.\n\n",
        options.worlds, options.world_seeds, options.world_time_limit_s);
    print_times(rows);
}

std::optional<double> first_solution_s(Problem problem, const std::string& algorithm, std::uint32_t seed,
                                       const std::shared_ptr<const AeroMap>& map) {
    problem.planner.algorithm = algorithm;
    problem.planner.seed = seed;
    SolveOptions options;
    options.stop_at_first_solution = true;
    options.map = map;
    const Solution solution = solve(problem, options);
    return solution.status == Status::solved || solution.certificate ? solution.planning.first_solution_wall_s
                                                                     : std::nullopt;
}

void note(Row& row, const std::optional<double>& time_s) {
    row.times_s.push_back(time_s.value_or(std::numeric_limits<double>::infinity()));
}

/// First solutions in the nominal world.
void run_as_believed(const Options& options, Problem problem, const FlightModel& model,
                     const std::shared_ptr<const AeroMap>& map) {
    problem.uncertainty.reset();
    problem.planner.time_limit_s = options.time_limit_s;
    const bench::UserPlanner user(problem, model, map.get());
    std::vector<Row> rows{{"control::RRT, ODESolver, FCL (a user's)", {}}};
    for (const AlgorithmInfo& algorithm : algorithms()) {
        if (algorithm.plans_flights) {
            rows.push_back({fmt::format("downwash {}", algorithm.name), {}});
        }
    }
    for (std::uint32_t seed = 1; seed <= options.seeds; ++seed) {
        note(rows[0], user.time_to_first_solution_s(options.time_limit_s));
        std::size_t row = 1;
        for (const AlgorithmInfo& algorithm : algorithms()) {
            if (algorithm.plans_flights) {
                note(rows[row++], first_solution_s(problem, std::string(algorithm.name), seed, map));
            }
        }
    }
    print(options, problem, rows);
}

/// First plans that hold in several worlds.
void run_in_worlds(const Options& options, Problem problem, const FlightModel& model,
                   const std::shared_ptr<const AeroMap>& map) {
    problem.planner.time_limit_s = options.world_time_limit_s;
    problem.planner.worlds = options.worlds;
    const bench::UserPlanner user(problem, model, map.get(), particles_of(problem, options.worlds));
    std::vector<Row> rows{{"RandUP-RRT, ODESolver, FCL (a user's)", {}}, {our_name, {}}};
    for (std::uint32_t seed = 1; seed <= options.world_seeds; ++seed) {
        note(rows[0], user.time_to_first_solution_s(options.world_time_limit_s));
        note(rows[1], first_solution_s(problem, "rrt-star", seed, map));
    }
    print_in_worlds(options, rows);
}

void run(const Options& options) {
    Problem problem = read_problem(options.problem);
    problem.planner.variant = Variant::mp_arm_ada;
    problem.planner.max_iterations.reset();
    const auto model = make_flight_model(problem);
    const auto map = model->make_whole_map(problem.bounds);
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    ompl::RNG::setSeed(1);  // once: OMPL takes no other
    run_as_believed(options, problem, *model, map);
    if (problem.uncertainty && options.worlds > 0) {
        run_in_worlds(options, problem, *model, map);
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App program("First solutions of a typical OMPL set-up beside ours, as Markdown");
    program.add_option("PROBLEM", options.problem, "problem file; obstacles boxes, cylinders, spheres")->required();
    program.add_option("--seeds", options.seeds, "runs of each planner")->check(CLI::Range(1, 10000));
    program.add_option("--time-limit", options.time_limit_s, "of each run [s]")->check(CLI::Range(0.01, 3600.0));
    program.add_option("--worlds", options.worlds, "worlds of the second comparison; 0: without it")
        ->check(CLI::Range(0, 1000));
    program.add_option("--world-seeds", options.world_seeds, "runs of each planner in worlds")
        ->check(CLI::Range(1, 10000));
    program.add_option("--world-time-limit", options.world_time_limit_s, "of each of them [s]")
        ->check(CLI::Range(0.01, 3600.0));
    return bench::run_program(program, argc, argv, [&options] { run(options); });
}

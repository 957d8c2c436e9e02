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

using namespace downwash;

namespace {

struct Options {
    std::string problem;
    std::uint32_t seeds = 200;
    double time_limit_s = 20;
};

constexpr const char* our_name = "downwash rrt-star";

struct Row {
    std::string name;
    std::vector<double> times_s;  ///< of every seed; infinite where nothing was found
};

std::string milliseconds(double time_s) {
    return std::isfinite(time_s) ? fmt::format("{:.1f}", 1e3 * time_s) : "-";
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

void print(const Options& options, const Problem& problem, const std::vector<Row>& rows) {
    fmt::print(
        "# First solutions beside OMPL: {}\n\nCommit {}; {}; {} seeds, {} s each, one thread, aerodynamics-aware.\n\n"
        "| planner | solved | 95 % interval | 25 % ms | median ms | 75 % ms | 95 % ms |\n"
        "| --- | --: | --: | --: | --: | --: | --: |\n",
        problem.name, bench::source_commit(), bench::processor(), options.seeds, options.time_limit_s);
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

std::optional<double> first_solution_s(Problem problem, const std::string& algorithm, std::uint32_t seed,
                                       const std::shared_ptr<const AeroMap>& map) {
    problem.planner.algorithm = algorithm;
    problem.planner.seed = seed;
    SolveOptions options;
    options.stop_at_first_solution = true;
    options.map = map;
    const Solution solution = solve(problem, options);
    return solution.status == Status::solved ? solution.planning.first_solution_wall_s : std::nullopt;
}

void run(const Options& options) {
    Problem problem = read_problem(options.problem);
    problem.planner.variant = Variant::mp_arm_ada;
    problem.planner.max_iterations.reset();
    problem.planner.time_limit_s = options.time_limit_s;
    const auto model = make_flight_model(problem);
    const auto map = model->make_map(problem.bounds);
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    ompl::RNG::setSeed(1);  // once: OMPL takes no other
    const bench::UserPlanner user(problem, *model, map.get());

    std::vector<Row> rows{{"control::RRT, ODESolver, FCL (a user's)", {}}};
    for (const AlgorithmInfo& algorithm : algorithms()) {
        if (algorithm.plans_flights) {
            rows.push_back({fmt::format("downwash {}", algorithm.name), {}});
        }
    }
    const auto note = [](Row& row, const std::optional<double>& time_s) {
        row.times_s.push_back(time_s.value_or(std::numeric_limits<double>::infinity()));
    };
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

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App program("First solutions of a typical OMPL set-up beside ours, as Markdown");
    program.add_option("PROBLEM", options.problem, "problem file; obstacles boxes, cylinders, spheres")->required();
    program.add_option("--seeds", options.seeds, "runs of each planner")->check(CLI::Range(1, 10000));
    program.add_option("--time-limit", options.time_limit_s, "of each run [s]")->check(CLI::Range(0.01, 3600.0));
    return bench::run_program(program, argc, argv, [&options] { run(options); });
}

// Our own collision checker beside FCL's, by queries and by whole searches. Prints Markdown.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "../support/measuring.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/bench/statistics.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

struct Given {
    std::vector<std::string> problems;
    std::uint64_t iterations = 300;
    std::uint32_t seeds = 10;
};

/// One search.
struct Search {
    double first_s = HUGE_VAL;  ///< processor time to the first plan; infinite without one
    double iterations_per_s = 0;
    Solution solution;
};

/// A problem's searches with either checker, by seed.
struct Searches {
    std::string name;
    std::array<std::vector<Search>, 2> with;  ///< by CollisionCheckerKind
};

Search searched(const Problem& problem, const std::shared_ptr<const AeroMap>& map) {
    Search search;
    SolveOptions options;
    options.map = map;
    const PlannableProblem checked = plannable(problem);
    const double begin_s = processor_time_s(CLOCK_PROCESS_CPUTIME_ID);
    const auto spent_s = [begin_s] { return processor_time_s(CLOCK_PROCESS_CPUTIME_ID) - begin_s; };
    options.on_plan = [&](const FoundPlan&) { search.first_s = std::min(search.first_s, spent_s()); };
    search.solution = solve(checked, options);
    search.iterations_per_s = static_cast<double>(search.solution.planning.iterations) / spent_s();
    return search;
}

/// The searches of both checkers take turns, so that whatever slows the machine down slows both.
Searches searches_of(Problem problem, const Given& given) {
    Searches searches{problem.name, {}};
    problem.planner.variant = Variant::mp_arm_ada;
    problem.planner.max_iterations = given.iterations;
    problem.planner.time_limit_s.reset();
    problem.uncertainty.reset();
    const auto map = make_flight_model(problem)->make_whole_map(problem.bounds);
    for (std::uint32_t seed = 1; seed <= given.seeds; ++seed) {
        problem.planner.seed = seed;
        for (const CollisionCheckerKind kind : all_collision_checkers) {
            problem.planner.collision_checker = kind;
            searches.with[static_cast<std::size_t>(kind)].push_back(searched(problem, map));
        }
    }
    return searches;
}

bool is_same_flight(const Solution& a, const Solution& b) {
    const auto rows = [](const Solution& s) { return s.execution ? s.execution->rows : std::vector<FlightRow>{}; };
    const auto x = rows(a), y = rows(b);
    return a.status == b.status && std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const auto& p, const auto& q) {
               return std::memcmp(p.q, q.q, sizeof p.q) == 0 && std::memcmp(p.u, q.u, sizeof p.u) == 0;
           });
}

/// Processor time of a query at the poses of a flight [s].
template <class Ask>
double per_query_s(const std::vector<FlightRow>& rows, const Ask& ask) {
    return best_of(3,
                   [&] {
                       double sum = 0;
                       for (const FlightRow& row : rows) {
                           sum += static_cast<double>(ask(pose_of(row.q)));
                       }
                       keep(sum);
                   }) /
           static_cast<double>(rows.size());
}

/// The seeds whose flights differ, for whoever looks into them.
void print_differences(const std::vector<Searches>& all) {
    std::string differing;
    for (const Searches& searches : all) {
        for (std::size_t i = 0; i < searches.with[0].size(); ++i) {
            if (!is_same_flight(searches.with[0][i].solution, searches.with[1][i].solution)) {
                differing += fmt::format("{}{}, seed {}", differing.empty() ? "" : "; ", searches.name, i + 1);
            }
        }
    }
    fmt::print("\nFlights that differ: {}.\n", differing.empty() ? "none" : differing);
}

std::string time_text(double s) {
    return s < 1e-6 ? fmt::format("{:.0f} ns", 1e9 * s) : fmt::format("{:.1f} us", 1e6 * s);
}

/// A row: each query with our own checker, with FCL's, and how many times longer FCL's takes.
void print_queries(const Problem& problem, const std::vector<FlightRow>& rows) {
    const auto scene = std::make_shared<const Scene>(problem.obstacles);
    std::array<std::array<double, 3>, 2> took{};
    for (const CollisionCheckerKind kind : all_collision_checkers) {
        const CollisionChecker checker(scene, problem.plane, problem.robot.shape(), kind);
        const double margin_m = problem.planner.safety_margin_m;
        keep(checker.clearance_m(pose_of(rows.front().q)));  // FCL's objects are made
        took[static_cast<std::size_t>(kind)] = {
            per_query_s(rows, [&](const PlanarPose& pose) { return checker.is_nearer_than(pose, 0) ? 1 : 0; }),
            per_query_s(rows, [&](const PlanarPose& pose) { return checker.is_nearer_than(pose, margin_m) ? 1 : 0; }),
            per_query_s(rows, [&](const PlanarPose& pose) { return std::min(checker.clearance_m(pose), 1e3); })};
    }
    fmt::print("| {} | {} |", problem.name, rows.size());
    for (std::size_t query = 0; query < 3; ++query) {
        fmt::print(" {} | {} | {:.1f} |", time_text(took[0][query]), time_text(took[1][query]),
                   took[1][query] / took[0][query]);
    }
    fmt::print("\n");
}

/// "1.2 (1.0 to 1.5)": the median and its 95 % interval.
std::string median_text(std::vector<double> values, int digits) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    const double median = values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
    const auto range = median_range(values, 0.95);
    return fmt::format("{:.{}f} ({:.{}f} to {:.{}f})", median, digits, range.low, digits, range.high, digits);
}

std::vector<double> figures(const std::vector<Search>& searches, double (*of)(const Search&)) {
    std::vector<double> all(searches.size());
    std::transform(searches.begin(), searches.end(), all.begin(), of);
    return all;
}

void print_searches(const Searches& searches) {
    const auto& [own, fcl] = searches.with;
    const auto first_ms = [](const Search& s) { return 1e3 * s.first_s; };
    const auto rate = [](const Search& s) { return s.iterations_per_s; };
    std::vector<double> ratios;
    std::size_t same = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
        ratios.push_back(own[i].iterations_per_s / fcl[i].iterations_per_s);
        same += is_same_flight(own[i].solution, fcl[i].solution) ? 1 : 0;
    }
    const auto solved = [](const std::vector<Search>& all) {
        return std::count_if(all.begin(), all.end(),
                             [](const Search& s) { return s.solution.status == Status::solved; });
    };
    fmt::print("| {} | {}, {} | {} | {} | {} | {} | {} | {} |\n", searches.name, solved(own), solved(fcl),
               median_text(figures(own, first_ms), 0), median_text(figures(fcl, first_ms), 0),
               median_text(figures(own, rate), 0), median_text(figures(fcl, rate), 0), median_text(ratios, 2), same);
}

/// What FCL's decisions add to the flight that is executed for every plan.
void print_execution(const Problem& problem, const Solution& solution) {
    const auto model = make_flight_model(problem);
    const FlightState start = start_state(*model, problem.start);
    const double flight_s =
        best_of(3, [&] { keep(execute(*model, start, solution.plan->reference, goals_of(problem), true).energy_j); });
    const CollisionChecker fcl(std::make_shared<const Scene>(problem.obstacles), problem.plane, problem.robot.shape(),
                               CollisionCheckerKind::fcl);
    const std::vector<FlightRow>& rows = solution.execution->rows;
    keep(fcl.clearance_m(pose_of(rows.front().q)));
    const double decisions_s = static_cast<double>(rows.size()) * per_query_s(rows, [&](const PlanarPose& pose) {
                                   return fcl.is_nearer_than(pose, 0) ? 1 : 0;
                               });
    fmt::print("| {} | {} | {:.1f} ms | {:.2f} ms | {:.1f} % |\n", problem.name, rows.size(), 1e3 * flight_s,
               1e3 * decisions_s, 100 * decisions_s / flight_s);
}

void run(const Given& given) {
    fmt::print(
        "# Collision checkers\n\nCommit {}; {}. `bench/collision_checkers.sh` writes this page. `own` is our GJK "
        "(`scene/convex`), `fcl` is FCL 0.7 with its tree of bounding boxes and both of its solvers "
        "(`scene/fcl_distances`). All times are processor times of one thread, and both checkers took turns.\n\n",
        source_commit(), processor());
    std::vector<Problem> problems;
    std::vector<Searches> all;
    for (const std::string& file : given.problems) {
        problems.push_back(read_problem(file));
        all.push_back(searches_of(problems.back(), given));
    }
    fmt::print(
        "## Searches\n\nMP-ARM-ADA in the nominal world, {} iterations, seeds 1 to {}, problems checked and aero maps "
        "ready. Medians with "
        "their 95 % intervals. A first plan has been flown with direct aerodynamics. `same` counts seeds whose "
        "executed flights are the same to the last bit.\n\n| problem | "
        "solved: own, fcl | first plan, own [ms] | first plan, fcl [ms] | iterations/s, own | iterations/s, fcl | "
        "iterations/s, own over fcl | same |\n| --- | --: | --: | --: | --: | --: | --: | --: |\n",
        given.iterations, given.seeds);
    for (const Searches& searches : all) {
        print_searches(searches);
    }
    print_differences(all);
    fmt::print(
        "\n## Queries\n\nThe time of a query at the poses of the executed flight of seed 1, best of three.\n\n| "
        "problem "
        "| poses | contact, own | fcl | fcl/own | nearer than the margin, own | fcl | fcl/own | clearance, own | fcl | "
        "fcl/own |\n| --- | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: |\n");
    for (std::size_t i = 0; i < problems.size(); ++i) {
        const Solution& first = all[i].with[0].front().solution;
        if (first.execution) {
            print_queries(problems[i], first.execution->rows);
        }
    }
    fmt::print(
        "\n## Executed flights\n\nFCL decides contact in every executed flight. What its decisions take of the flight "
        "of seed 1, planned with `own`, best of three.\n\n| problem | ticks | flight | decisions of FCL | share |\n| "
        "--- | --: | --: | --: | --: |\n");
    for (std::size_t i = 0; i < problems.size(); ++i) {
        const Solution& first = all[i].with[0].front().solution;
        if (first.execution) {
            print_execution(problems[i], first);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    Given given;
    CLI::App program("Our own collision checker beside FCL's, as Markdown");
    program.add_option("PROBLEM", given.problems, "problem files")->required();
    program.add_option("--iterations", given.iterations, "of each search")->check(CLI::Range(10, 1000000));
    program.add_option("--seeds", given.seeds, "of each problem, from 1")->check(CLI::Range(1, 1000));
    return run_program(program, argc, argv, [&given] { run(given); });
}

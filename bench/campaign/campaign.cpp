// Problems x variants x seeds, one CSV row per run, resumable; then a table with Wilson intervals. Every seed that was
// attempted stays in the denominator, and failures are listed.

#include <fmt/core.h>
#include <fmt/ostream.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "../wilson.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"

using namespace downwash;

namespace {

struct Options {
    std::vector<std::string> problems;
    std::string out;
    std::string commit = "unknown";
    int seeds = 10;
    double time_limit_s = 3;
    bool stops_at_first = false;
    bool requires_aware_success = false;
};

struct Run {
    std::string problem, variant;
    unsigned seed = 0;
    std::string status, outcome;
    double first_solution_s = -1, cost = 0, execution_cost = 0, min_clearance_m = 0;
    unsigned long iterations = 0, edges = 0, discarded = 0;
};

constexpr const char* columns =
    "problem,variant,seed,status,outcome,first_solution_s,cost,execution_cost,min_clearance_m,iterations,edges,"
    "discarded";

/// What a file of runs was made with; runs of another kind are never mixed in.
std::string provenance(const Options& options) {
    return fmt::format("# commit {}, {} s per run, one thread{}", options.commit, options.time_limit_s,
                       options.stops_at_first ? ", stopping at the first solution" : "");
}

Run parsed(const std::string& line) {
    std::istringstream in(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(in, cell, ',');) {
        cells.push_back(cell);
    }
    if (cells.size() != 12) {
        throw std::runtime_error("not a row of a campaign: " + line);
    }
    return {cells[0],
            cells[1],
            static_cast<unsigned>(std::stoul(cells[2])),
            cells[3],
            cells[4],
            std::stod(cells[5]),
            std::stod(cells[6]),
            std::stod(cells[7]),
            std::stod(cells[8]),
            std::stoul(cells[9]),
            std::stoul(cells[10]),
            std::stoul(cells[11])};
}

std::vector<Run> read_runs(const Options& options) {
    std::vector<Run> runs;
    std::ifstream in(options.out);
    std::string line;
    if (!std::getline(in, line)) {
        return runs;
    }
    if (line != provenance(options)) {
        throw std::runtime_error(fmt::format("{} holds other runs ({}); move it away first", options.out, line));
    }
    std::getline(in, line);
    while (std::getline(in, line)) {
        if (in.eof()) {
            break;  // a row that a kill cut short has no end of line
        }
        runs.push_back(parsed(line));
    }
    return runs;
}

void write_runs(const Options& options, const std::vector<Run>& runs) {
    const std::string beside = options.out + ".new";
    {
        std::ofstream out(beside);
        out << provenance(options) << '\n' << columns << '\n';
        for (const Run& r : runs) {
            fmt::print(out, "{},{},{},{},{},{},{},{},{},{},{},{}\n", r.problem, r.variant, r.seed, r.status, r.outcome,
                       r.first_solution_s, r.cost, r.execution_cost, r.min_clearance_m, r.iterations, r.edges,
                       r.discarded);
        }
        if (!out.flush()) {
            throw std::runtime_error("cannot write " + beside);
        }
    }
    std::filesystem::rename(beside, options.out);
}

Run attempt(Problem problem, Variant variant, unsigned seed, const Options& options,
            const std::shared_ptr<const AeroMap>& map) {
    problem.planner.variant = variant;
    problem.planner.seed = seed;
    problem.planner.time_limit_s = options.time_limit_s;
    SolveOptions how;
    how.stop_at_first_solution = options.stops_at_first;
    how.map = map;
    const Solution solution = solve(problem, how);
    Run run;
    run.problem = problem.name;
    run.variant = name_of(variant);
    run.seed = seed;
    run.status = name_of(solution.status);
    run.outcome = solution.execution ? name_of(solution.execution->outcome) : "none";
    run.first_solution_s = solution.planning.first_solution_wall_s.value_or(-1);
    run.cost = solution.cost;
    run.execution_cost = solution.execution_cost;
    run.min_clearance_m = solution.execution ? solution.execution->min_clearance_m : 0;
    run.iterations = solution.planning.iterations;
    run.edges = solution.planning.edges_simulated;
    const auto& rejected = solution.planning.rejected;
    run.discarded = rejected.count("direct_flight") != 0 ? rejected.at("direct_flight") : 0;
    return run;
}

double quantile(std::vector<double> values, double q) {
    if (values.empty()) {
        return std::nan("");
    }
    std::sort(values.begin(), values.end());
    const double at = q * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(at);
    const std::size_t high = std::min(low + 1, values.size() - 1);
    return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
}

std::string share(std::size_t hits, std::size_t n) {
    const auto [low, high] = bench::wilson(hits, n);
    return fmt::format("{}/{} [{:.0f}, {:.0f} %]", hits, n, 100 * low, 100 * high);
}

void print_table(const Options& options, const std::vector<Run>& runs) {
    fmt::print(
        "{}\n\nShares of all attempted seeds with 95 % Wilson intervals. `failed flight`: the plan, flown with "
        "direct aerodynamics and held at the goal,\ncollided, left the flyable area, became unstable or missed "
        "the goal. `discarded`: plans of the aware planner that failed so and were not reported.\n\n",
        provenance(options).substr(2));
    fmt::print(
        "| problem | variant | solved | failed flight | first solution, median (95 %) | flown cost of those that held, "
        "median | least "
        "clearance | discarded |\n|---|---|---|---|---|---|---|---|\n");
    std::vector<std::pair<std::string, std::string>> groups;
    for (const Run& run : runs) {
        if (std::find(groups.begin(), groups.end(), std::pair(run.problem, run.variant)) == groups.end()) {
            groups.emplace_back(run.problem, run.variant);
        }
    }
    std::vector<std::string> failures;
    for (const auto& [problem, variant] : groups) {
        std::size_t n = 0, solved = 0, failed = 0;
        unsigned long discarded = 0;
        std::vector<double> first, cost;
        double clearance = HUGE_VAL;
        for (const Run& run : runs) {
            if (run.problem != problem || run.variant != variant) {
                continue;
            }
            ++n;
            discarded += run.discarded;
            if (run.status != "solved") {
                failures.push_back(fmt::format("{} {} seed {}: {}", problem, variant, run.seed, run.status));
                continue;
            }
            ++solved;
            first.push_back(run.first_solution_s);
            clearance = std::min(clearance, run.min_clearance_m);
            if (run.outcome == "ok") {
                cost.push_back(run.execution_cost);
            } else {
                ++failed;
                failures.push_back(fmt::format("{} {} seed {}: {}", problem, variant, run.seed, run.outcome));
            }
        }
        const std::string median_cost = cost.empty() ? "none" : fmt::format("{:.0f}", quantile(cost, 0.5));
        fmt::print("| {} | {} | {} | {} | {:.1f} ms ({:.1f} ms) | {} | {:.3f} m | {} |\n", problem, variant,
                   share(solved, n), share(failed, n), 1e3 * quantile(first, 0.5), 1e3 * quantile(first, 0.95),
                   median_cost, clearance, discarded);
    }
    fmt::print("\n{} runs without a flight that held:\n\n", failures.size());
    for (const std::string& failure : failures) {
        fmt::print("- {}\n", failure);
    }
}

/// Whether the aware planner solved at least 98 % of the seeds of every problem and none of its flights failed.
bool aware_planner_holds(const std::vector<Run>& runs) {
    std::map<std::string, std::pair<int, int>> solved_of;
    bool none_failed = true;
    for (const Run& run : runs) {
        if (run.variant == "mp-arm-ada") {
            auto& [solved, n] = solved_of[run.problem];
            ++n;
            solved += run.status == "solved" ? 1 : 0;
            none_failed = none_failed && (run.status != "solved" || run.outcome == "ok");
        }
    }
    return none_failed && std::all_of(solved_of.begin(), solved_of.end(), [](const auto& entry) {
               return entry.second.first >= 0.98 * entry.second.second;
           });
}

void run_campaign(const Options& options) {
    std::vector<Run> runs = read_runs(options);
    for (const std::string& file : options.problems) {
        const Problem problem = read_problem(file);
        const auto model = make_flight_model(problem);
        const auto map = problem.aero.enabled ? model->make_map(problem.bounds) : nullptr;
        for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_da, Variant::mp_arm_ada}) {
            for (unsigned seed = 1; seed <= static_cast<unsigned>(options.seeds); ++seed) {
                const bool is_done = std::any_of(runs.begin(), runs.end(), [&](const Run& run) {
                    return run.problem == problem.name && run.variant == name_of(variant) && run.seed == seed;
                });
                if (!is_done) {
                    fmt::print(stderr, "{} {} seed {}\n", problem.name, name_of(variant), seed);
                    runs.push_back(attempt(problem, variant, seed, options, map));
                    write_runs(options, runs);
                }
            }
        }
    }
    print_table(options, runs);
    if (options.requires_aware_success && !aware_planner_holds(runs)) {
        throw std::runtime_error("the aerodynamics-aware planner missed a plan or reported a flight that failed");
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Problems x variants x seeds; resumable: runs that the output file holds are not repeated");
    app.add_option("problems", options.problems, "problem files")->required();
    app.add_option("--out", options.out, "CSV file of the runs, continued if it exists")->required();
    app.add_option("--commit", options.commit, "commit that the runs are made from");
    app.add_option("--seeds", options.seeds, "seeds 1 to this")->check(CLI::PositiveNumber);
    app.add_option("--time-limit", options.time_limit_s, "search time per run [s]")->check(CLI::PositiveNumber);
    app.add_flag("--stop-at-first", options.stops_at_first, "end each search with its first solution");
    app.add_flag("--require-aware-success", options.requires_aware_success,
                 "fail unless mp-arm-ada solves 98 % of the seeds and none of its flights fails");
    CLI11_PARSE(app, argc, argv);
    try {
        run_campaign(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}

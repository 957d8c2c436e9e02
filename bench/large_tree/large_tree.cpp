// The cost of an iteration and of a node while a tree grows to a hundred thousand nodes. Prints Markdown.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <array>
#include <stdexcept>
#include <stop_token>
#include <string>

#include "../support/measuring.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"

using namespace downwash;

namespace {

struct Options {
    std::string problem;
    std::uint64_t nodes = 100000;
    std::uint32_t seed = 1;
};

/// Iterations while the tree has about so many nodes: a tenth less to a tenth more.
struct Stage {
    std::uint64_t nodes = 0;
    std::uint64_t first_iteration = 0, last_iteration = 0;
    double first_s = 0, last_s = 0;  ///< processor time
    double bytes = 0;                ///< that the search has taken so far

    [[nodiscard]] bool covers(std::uint64_t n) const {
        const double share = static_cast<double>(n) / static_cast<double>(nodes);
        return share >= 0.9 && share <= 1.1;
    }
    void note(std::uint64_t iteration, double now_s, double grown_bytes) {
        if (first_iteration == 0) {
            first_iteration = iteration;
            first_s = now_s;
        }
        last_iteration = iteration;
        last_s = now_s;
        bytes = grown_bytes;
    }
    [[nodiscard]] double iteration_s() const {
        if (last_iteration == first_iteration) {
            throw std::runtime_error(fmt::format("too few reports around {} nodes to time iterations", nodes));
        }
        return (last_s - first_s) / static_cast<double>(last_iteration - first_iteration);
    }
};

void run(const Options& options) {
    Problem problem = read_problem(options.problem);
    problem.planner.variant = Variant::mp_arm_ada;
    problem.planner.seed = options.seed;
    problem.planner.max_iterations = 100 * options.nodes;  // the stages end it
    problem.planner.time_limit_s.reset();
    std::array<Stage, 4> stages{};
    for (std::size_t i = 0; i < stages.size(); ++i) {
        stages[i].nodes = options.nodes * std::array<std::uint64_t, 4>{1, 3, 6, 10}[i] / 10;
    }
    SolveOptions solve_options;
    solve_options.map = make_flight_model(problem)->make_whole_map(problem.bounds);
    const double before = bench::memory_bytes();
    std::stop_source enough;
    solve_options.stop = enough.get_token();
    solve_options.on_progress = [&](const Progress& progress) {
        for (Stage& stage : stages) {
            if (stage.covers(progress.nodes)) {
                stage.note(progress.iterations, bench::processor_time_s(), bench::memory_bytes() - before);
            }
        }
        if (progress.nodes > stages.back().nodes * 11 / 10) {
            enough.request_stop();
        }
    };
    const Solution solution = solve(problem, solve_options);

    fmt::print(
        "# Cost of a large tree\n\nCommit {}; {}; {}, mp-arm-ada, seed {}, one thread. Processor time of an "
        "iteration, its share of the "
        "refinement included, while the tree has about so many nodes, and how much memory the search has taken by "
        "then, the aero map apart. "
        "`bench/large_tree.sh` writes this page.\n\n| nodes | iteration | memory |\n| --: | --: | --: |\n",
        bench::source_commit(), bench::processor(), problem.name, options.seed);
    for (const Stage& stage : stages) {
        fmt::print("| {} | {:.0f} us | {:.0f} MB |\n", stage.nodes, 1e6 * stage.iteration_s(), 1e-6 * stage.bytes);
    }
    const double ratio = stages.back().iteration_s() / stages.front().iteration_s();
    fmt::print("\n| bound | found | |\n| --- | --: | --- |\n");
    bench::print_bound(fmt::format("an iteration at {} nodes costs at most 3 times one at {}", stages.back().nodes,
                                   stages.front().nodes),
                       fmt::format("{:.2f} times", ratio), ratio <= 3);
    bench::print_bound(fmt::format("{} nodes take less than 300 MB", stages.back().nodes),
                       fmt::format("{:.0f} MB", 1e-6 * stages.back().bytes), stages.back().bytes < 300e6);
    fmt::print("\nThe plan after {} iterations costs {:.0f}.\n", solution.planning.iterations, solution.cost);
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App program("The cost of an iteration and of a node while a tree grows, as Markdown");
    program.add_option("PROBLEM", options.problem, "problem file")->required();
    program.add_option("--nodes", options.nodes, "of the tree at its end")->check(CLI::Range(1000, 10000000));
    program.add_option("--seed", options.seed, "of the search");
    return bench::run_program(program, argc, argv, [&options] { run(options); });
}

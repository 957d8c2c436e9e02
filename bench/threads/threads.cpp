// What more threads bring to a search, on the threads of this machine. Prints Markdown.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>
#include <fstream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "../support/measuring.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

struct Given {
    std::vector<std::string> problems;
    std::uint64_t iterations = 150;           ///< in worlds
    std::uint64_t nominal_iterations = 1000;  ///< in the nominal world
    std::uint32_t seeds = 2;
};

/// Time that all processors have worked since the machine started [s]; 0 where the system does not say.
double machine_busy_s() {
    std::ifstream stat("/proc/stat");
    std::string word;
    double user = 0, nice = 0, system = 0, idle = 0, wait = 0, irq = 0, soft = 0;
    stat >> word >> user >> nice >> system >> idle >> wait >> irq >> soft;
    return stat ? 0.01 * (user + nice + system + irq + soft) : 0;
}

/// Time that searches took.
struct Took {
    double wall_s = 0, processor_s = 0;
    double others_s = 0;  ///< of all processors, taken by other programs

    Took& operator+=(const Took& other) {
        wall_s += other.wall_s;
        processor_s += other.processor_s;
        others_s += other.others_s;
        return *this;
    }
};

template <class Work>
Took timed(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    const double processor_0 = processor_time_s(CLOCK_PROCESS_CPUTIME_ID), busy_0 = machine_busy_s();
    work();
    Took took{std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
              processor_time_s(CLOCK_PROCESS_CPUTIME_ID) - processor_0, 0};
    took.others_s = std::max(0.0, machine_busy_s() - busy_0 - took.processor_s);
    return took;
}

bool is_same(const Solution& a, const Solution& b) {
    const auto& x = a.plan ? a.plan->reference : std::vector<ReferenceKnot>{};
    const auto& y = b.plan ? b.plan->reference : std::vector<ReferenceKnot>{};
    return a.status == b.status && a.planning.edges_simulated == b.planning.edges_simulated && x.size() == y.size() &&
           std::memcmp(&a.cost, &b.cost, sizeof a.cost) == 0 &&
           std::equal(x.begin(), x.end(), y.begin(), [](const ReferenceKnot& p, const ReferenceKnot& q) {
               return p.tick == q.tick && p.point == q.point;
           });
}

/// 1, 2, 4, ... up to the processors of the machine, at least 2.
std::vector<int> thread_counts() {
    std::vector<int> counts{1};
    while (counts.back() < 2 || 2U * static_cast<unsigned>(counts.back()) <= processor_count()) {
        counts.push_back(2 * counts.back());
    }
    return counts;
}

/// By number of threads.
using Times = std::map<int, Took>;

Times measured(Problem problem, const std::vector<int>& counts, std::uint32_t seeds) {
    Times times;
    SolveOptions options;
    options.map = make_flight_model(problem)->make_whole_map(problem.bounds);
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        problem.planner.seed = seed;
        std::optional<Solution> on_one;
        for (const int threads : counts) {
            options.threads = threads;
            Solution solution;
            times[threads] += timed([&] { solution = solve(problem, options); });
            if (on_one && !is_same(solution, *on_one)) {
                throw std::runtime_error(
                    fmt::format("{}, seed {}: the plan depends on the number of threads", problem.name, seed));
            }
            on_one = on_one ? std::move(on_one) : std::optional(std::move(solution));
        }
    }
    return times;
}

void print_row(const std::string& name, const Times& times) {
    const Took& one = times.at(1);
    for (const auto& [threads, took] : times) {
        fmt::print("| {} | {} | {:.2f} s | {:.2f} | {:.3f} | {:.0f} % |\n", name, threads, took.wall_s,
                   one.wall_s / took.wall_s, took.processor_s / one.processor_s,
                   100 * took.others_s / (processor_count() * took.wall_s));
    }
}

void run(const Given& given) {
    const std::vector<int> counts = thread_counts();
    fmt::print(
        "# Threads of a search\n\nCommit {}; {}. MP-ARM-ADA, seeds 1 to {}, aero maps ready. `bench/threads.sh` writes "
        "this page. Times are sums over seeds; the speed-up and the processor time are those over one thread. Others: "
        "the share of all processors that other programs took meanwhile; it can only lower the speed-up. The plans and "
        "counts of a search were the same on every number of threads.\n\n",
        source_commit(), processor(), given.seeds);
    for (const bool in_worlds : {true, false}) {
        const std::uint64_t iterations = in_worlds ? given.iterations : given.nominal_iterations;
        fmt::print("## {}: {} iterations\n\n| problem | threads | wall time | speed-up | processor time | others |\n",
                   in_worlds ? "In worlds, with the problems' own uncertainty" : "In the nominal world", iterations);
        fmt::print("| --- | --: | --: | --: | --: | --: |\n");
        Times all;
        for (const std::string& file : given.problems) {
            Problem problem = read_problem(file);
            problem.planner.variant = Variant::mp_arm_ada;
            problem.planner.max_iterations = iterations;
            problem.planner.time_limit_s.reset();
            if (!in_worlds) {
                problem.uncertainty.reset();
            }
            const Times times = measured(problem, counts, given.seeds);
            print_row(problem.name, times);
            for (const auto& [threads, took] : times) {
                all[threads] += took;
            }
        }
        print_row("all", all);
        fmt::print("\n");
    }
}

}  // namespace

int main(int argc, char** argv) {
    Given given;
    CLI::App program("What more threads bring to a search, as Markdown");
    program.add_option("PROBLEM", given.problems, "problem files")->required();
    program.add_option("--iterations", given.iterations, "of each search in worlds")->check(CLI::Range(50, 1000000));
    program.add_option("--nominal-iterations", given.nominal_iterations, "of each search in the nominal world")
        ->check(CLI::Range(50, 1000000));
    program.add_option("--seeds", given.seeds, "of each problem, from 1")->check(CLI::Range(1, 1000));
    return run_program(program, argc, argv, [&given] { run(given); });
}

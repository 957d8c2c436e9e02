// Times K at many points, directly and from a map, and searches that end at once, on one thread.
// bench/python_calls.py does the same from Python.

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "downwash/bench/support/measuring.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::bench {
namespace {

double seconds_of(const std::function<void()>& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Pairs of doubles, as numpy.ndarray.tofile() writes them.
std::vector<double> read_points(const std::string& file) {
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    std::vector<double> points(static_cast<std::size_t>(stream.tellg()) / sizeof(double));
    stream.seekg(0);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the bytes of numbers
    stream.read(reinterpret_cast<char*>(points.data()), static_cast<std::streamsize>(points.size() * sizeof(double)));
    return points;
}

void measure(const std::string& problem_file, const std::string& points_file, const std::string& quick_file,
             int searches) {
    const PlannableProblem plannable = read_plannable_problem(problem_file);
    const FlightModel& model = *plannable.model;
    const std::vector<double> points = read_points(points_file);
    std::vector<double> k(points.size() / 2);
    const double direct_s = best_of(1, [&] {
        for (std::size_t i = 0; i < k.size(); ++i) {
            k[i] = model.direct_factor(0, points[2 * i], points[2 * i + 1]);
        }
    });
    double sum = 0;
    for (const double each : k) {
        sum += each;
    }
    const auto map = model.make_whole_map(plannable.problem.bounds);
    const double map_s = best_of(1, [&] {
        for (std::size_t i = 0; i < k.size(); ++i) {
            k[i] = map->factor(model.rotor_layer(0), points[2 * i], points[2 * i + 1]);
        }
    });
    keep(k.back());
    const PlannableProblem quick = read_plannable_problem(quick_file);
    SolveOptions options;
    options.keep_tree = true;
    double solve_s = HUGE_VAL;
    for (int i = 0; i < searches; ++i) {
        solve_s = std::min(solve_s, seconds_of([&] { keep(solve(quick, options).cost); }));
    }
    fmt::print("{{\"direct_s\": {}, \"map_s\": {}, \"solve_s\": {}, \"sum\": {}}}\n", direct_s, map_s, solve_s, sum);
}

}  // namespace
}  // namespace downwash::bench

int main(int argc, char** argv) {
    std::string problem, points, quick;
    int searches = 0;
    CLI::App program("Times calls of the library; bench/python_calls.py compares them with those from Python");
    program.add_option("PROBLEM", problem)->required();
    program.add_option("POINTS", points, "file of pairs of doubles")->required();
    program.add_option("QUICK", quick, "problem of a search that ends at once")->required();
    program.add_option("SEARCHES", searches, "how many of them")->required();
    return downwash::bench::run_program(program, argc, argv,
                                        [&] { downwash::bench::measure(problem, points, quick, searches); });
}

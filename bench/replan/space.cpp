// An obstacle turns out to be lower while a vehicle in space is on its way: how soon a planner has a safe answer, at
// many moments of a plan.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/planner/planner.hpp"
#include "downwash/problems/space_problem_reader.hpp"

using namespace downwash;

namespace {

struct Given {
    std::string file, obstacle;
    double lower_m = 0.05;
    int moments = 100;
};

/// Processor time of this thread: others may have the machine.
double thread_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double quantile(std::vector<double> values, double q) {
    std::ranges::sort(values);
    return values.empty() ? 0 : values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

int run(const Given& given) {
    SpaceProblem problem = read_space_problem(given.file);
    problem.planner.max_iterations = 10'000;
    problem.planner.certify = false;  // in flight, the first answer has none
    const auto found = std::ranges::find(problem.obstacles, given.obstacle, &Obstacle::name);
    if (found == problem.obstacles.end()) {
        throw_input_error("has no obstacle called '" + given.obstacle + "'", "environment.obstacles");
    }
    SpaceSceneChange there, back;
    there.put = back.put = {*found};
    there.put.front().center_world_m[2] -= given.lower_m;

    SpaceSolveOptions options;
    options.stop_at_first_solution = true;
    SpacePlanner planner(problem, options);
    if (planner.solve().status != Status::solved) {
        fmt::print("no plan for {}\n", problem.name);
        return 1;
    }
    const SpacePlan plan = *planner.plan();
    const std::int64_t end = plan.reference.back().tick;
    std::map<std::string, int> advice;
    std::vector<double> safe_s, all_s;
    for (int i = 0; i < given.moments; ++i) {
        const std::int64_t tick = end * i / given.moments;
        const SpaceStart here = planner.predicted(problem.start, plan, tick);
        planner.adopt(plan);
        SpaceReplanOptions how;
        how.time_limit_s = 0;  // nothing but the first answer and whether the plan still holds
        double begun_s = thread_s(), first_s = -1;
        how.on_answer = [&](const SpaceAnswer& answer) {
            if (first_s < 0) {
                first_s = thread_s() - begun_s;
                ++advice[std::string(name_of(answer.advice))];
                if (answer.advice == Advice::stop) {
                    safe_s.push_back(first_s);
                }
                all_s.push_back(first_s);
            }
        };
        static_cast<void>(planner.replan(here, tick, there, how));
        how.on_answer = {};
        static_cast<void>(planner.replan(here, tick, back, how));
    }
    fmt::print("{}: {} moments of a plan of {:.1f} s, {} {:.2f} m lower\n", problem.name, given.moments,
               plan.duration_s(), given.obstacle, given.lower_m);
    fmt::print("first answers: {}\n",
               joined(advice, ", ", [](const auto& each) { return fmt::format("{} {}", each.second, each.first); }));
    fmt::print(
        "first safe answer, processor time: median {:.1f} ms, 95 % within {:.1f} ms; all answers: 95 % within "
        "{:.1f} ms\n",
        1e3 * quantile(safe_s, 0.5), 1e3 * quantile(safe_s, 0.95), 1e3 * quantile(all_s, 0.95));
    return 0;
}

}  // namespace

int main(int count, char** words) {
    if (count < 3) {
        fmt::print(stderr, "usage: {} PROBLEM.yaml OBSTACLE [MOMENTS]\n", words[0]);
        return 2;
    }
    Given given{words[1], words[2]};
    if (count > 3) {
        given.moments = std::stoi(words[3]);
    }
    return run(given);
}

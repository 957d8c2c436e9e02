// An obstacle turns out to be lower while a vehicle in space is on its way: how soon a planner has a safe answer, at
// many moments of a plan.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "../support/measuring.hpp"
#include "answers.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/quantile.hpp"
#include "downwash/planner/planner.hpp"
#include "downwash/problems/space_problem_reader.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

constexpr double bound_ms = 20;

struct Given {
    std::string file, obstacle;
    double lower_m = 0.05;
    int moments = 40;
};

/// First answers at many moments, in milliseconds of the calling thread's processor time: others may have the machine.
struct FirstAnswers {
    std::map<std::string, int> advice;
    std::vector<double> safe_ms, all_ms;
};

FirstAnswers first_answers(const Given& given, SpacePlanner& planner, const SpaceStart& start) {
    SpaceSceneChange there, back;
    there.put = back.put = {*std::ranges::find(planner.problem().obstacles, given.obstacle, &Obstacle::name)};
    there.put.front().center_world_m[2] -= given.lower_m;
    const SpacePlan plan = *planner.plan();
    FirstAnswers first;
    for (int i = 0; i < given.moments; ++i) {
        const std::int64_t tick = plan.reference.back().tick * i / given.moments;
        const SpaceStart here = planner.predicted(start, plan, tick);
        planner.adopt(plan);
        SpaceReplanOptions how;
        how.time_limit_s = 0;  // nothing but the first answer and whether the plan still holds
        const double begun_s = processor_time_s();
        bool is_first = true;
        how.on_answer = [&](const SpaceAnswer& answer) {
            if (!is_first) {
                return;
            }
            is_first = false;
            first.all_ms.push_back(1e3 * (processor_time_s() - begun_s));
            ++first.advice[std::string(name_of(answer.advice))];
            if (answer.advice != Advice::none) {
                first.safe_ms.push_back(first.all_ms.back());
            }
        };
        static_cast<void>(planner.replan(here, tick, there, how));
        how.on_answer = {};
        static_cast<void>(planner.replan(here, tick, back, how));
    }
    return first;
}

void run(const Given& given) {
    SpaceProblem problem = read_space_problem(given.file);
    problem.planner.max_iterations = 10'000;
    problem.planner.time_limit_s.reset();
    problem.planner.certify = false;  // in flight, the first answer has none
    if (std::ranges::find(problem.obstacles, given.obstacle, &Obstacle::name) == problem.obstacles.end()) {
        throw_input_error("has no obstacle called '" + given.obstacle + "'", "environment.obstacles");
    }
    SpaceSolveOptions options;
    options.stop_at_first_solution = true;
    SpacePlanner planner(problem, options);
    if (planner.solve().status != Status::solved) {
        throw std::runtime_error("no plan for " + problem.name);
    }
    fmt::print(
        "`{}`, a plan of {:.1f} s. At {} moments of it, evenly spread, `{}` is {:.2f} m lower than believed.\n\n",
        problem.name, planner.plan()->duration_s(), given.moments, given.obstacle, given.lower_m);
    const FirstAnswers first = first_answers(given, planner, problem.start);
    fmt::print("| | |\n| --- | ---: |\n| first answers | {} |\n", listed(first.advice));
    for (const auto& [what, times_ms] :
         {std::pair("first safe answer", first.safe_ms), {"all answers", first.all_ms}}) {
        fmt::print("| {}, processor time | median {:.1f} ms, 95 % within {:.1f} ms, all within {:.1f} ms |\n", what,
                   quantile(times_ms, 0.5), quantile(times_ms, 0.95), quantile(times_ms, 1));
    }
    const double in_time = share(first.safe_ms, bound_ms);
    fmt::print("\n| bound | found | |\n| --- | --- | --- |\n");
    print_bound(fmt::format("first safe answer within {:g} ms at 95 % of the moments that have one", bound_ms),
                fmt::format("{:.1f} % of {}", 100 * in_time, first.safe_ms.size()),
                !first.safe_ms.empty() && in_time >= 0.95);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App program("Lowers an obstacle in the middle of a flight in space.");
    Given given;
    program.add_option("problem", given.file, "problem file")->required();
    program.add_option("obstacle", given.obstacle, "its name")->required();
    program.add_option("--moments", given.moments, "of the plan");
    program.add_option("--lower", given.lower_m, "by so much [m]");
    return run_program(program, argc, argv, [&] { run(given); });
}

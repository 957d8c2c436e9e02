// Plans from C++ with an installed Downwash: read a problem, search until the first plan, ask how its flight went.
// Usage: embed PROBLEM.yaml

#include <cstdio>
#include <exception>

#include <downwash/planner/solve.hpp>
#include <downwash/problems/problem_reader.hpp>

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: embed PROBLEM.yaml\n");
        return 2;
    }
    try {
        const downwash::Problem problem = downwash::read_problem(arguments[1]);

        downwash::SolveOptions options;
        options.stop_at_first_solution = true;
        const downwash::Solution solution = downwash::solve(problem, options);

        if (solution.status != downwash::Status::solved || !solution.plan || !solution.execution) {
            std::printf("%s: no plan within the limits\n", problem.name.c_str());
            return 1;
        }
        const bool flown = solution.execution->outcome == downwash::Outcome::ok;
        std::printf("%s: %zu waypoints, %.1f s of flight, %s\n", problem.name.c_str(), solution.plan->waypoints.size(),
                    solution.plan->duration_s(), flown ? "flown to the goal" : "but its flight failed");
        return flown ? 0 : 3;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}

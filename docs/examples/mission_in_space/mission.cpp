// A mission in space: a vehicle flies a plan, a sensor finds an obstacle 5 cm lower than the drawing has it, and the
// vehicle goes on along a new plan from the middle of its flight. In the end an independent judge flies all of it among
// the true obstacles, and the first plan alone for comparison.
// Usage: mission_in_space PROBLEM.yaml OBSTACLE
// Exit codes: 0 the flight is good, 1 it is not or there is no plan, 2 bad input.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>

#include <downwash/base/key_error.hpp>
#include <downwash/judge/space_plan_judge.hpp>
#include <downwash/planner/planner.hpp>
#include <downwash/problems/space_problem_reader.hpp>

using namespace downwash;

namespace {

constexpr double lower_m = 0.05;  ///< than on the drawing
constexpr double sight_m = 1;     ///< of the sensor, from any part of the robot
constexpr double sensor_period_s = 0.1;
constexpr double lead_s = 0.5;             ///< from what the sensor says to the first tick of the new plan
constexpr std::uint64_t iterations = 300;  ///< of a search; in flight, give it a time limit

/// The obstacle of that name, lower.
Obstacle lowered(const SpaceProblem& problem, const std::string& name) {
    const auto found = std::ranges::find(problem.obstacles, name, &Obstacle::name);
    if (found == problem.obstacles.end()) {
        throw_input_error("has no obstacle called '" + name + "'", "environment.obstacles");
    }
    Obstacle obstacle = *found;
    obstacle.center_world_m[2] -= lower_m;
    return obstacle;
}

/// The problem as it really is.
SpaceProblem with(SpaceProblem problem, const Obstacle& obstacle) {
    *std::ranges::find(problem.obstacles, obstacle.name, &Obstacle::name) = obstacle;
    return problem;
}

/// The tick of a plan at which the sensor first sees an obstacle.
std::optional<std::int64_t> seen_at(const SpaceProblem& truth, const Obstacle& obstacle, const SpacePlan& plan) {
    const SpaceFlight flight = SpaceProblemModel(truth).execute(plan);
    const SpaceChecker sensor(std::make_shared<const Scene>(std::vector{obstacle}), shape_of(truth.robot));
    const auto period = static_cast<std::size_t>(std::llround(sensor_period_s / plan.tick_s));
    for (std::size_t tick = 0; tick < flight.rows.size(); tick += period) {
        if (sensor.clearance_m(among_obstacles(flight.rows[tick].motion, {}), sight_m) < sight_m) {
            return static_cast<std::int64_t>(tick);
        }
    }
    return std::nullopt;
}

void say(double t_s, const SpaceAnswer& answer) {
    const double(&end)[space_axes<max_joints>] = answer.plan.reference.back().point.position;
    std::printf("%8.2f s  %s after %.0f ms: %.2f s to (%.3f, %.3f, %.3f) m\n", t_s,
                std::string(name_of(answer.advice)).c_str(), 1e3 * answer.after_wall_s, answer.plan.duration_s(),
                end[space::x], end[space::y], end[space::z]);
}

/// Flies a plan among the true obstacles.
bool is_good(const char* what, const SpaceProblem& truth, const SpacePlan& plan) {
    const judge::SpaceJudgedFlight flight = judge::SpacePlanJudge(truth).fly(plan);
    std::printf("%s: %s, least clearance %.3f m\n", what, std::string(name_of(flight.outcome)).c_str(),
                flight.min_clearance_m);
    return flight.outcome == judge::Outcome::ok;
}

int fly(SpaceProblem drawing, const std::string& name) {
    drawing.planner.max_iterations = iterations;
    drawing.planner.time_limit_s.reset();
    const Obstacle obstacle = lowered(drawing, name);
    const SpaceProblem truth = with(drawing, obstacle);
    SpaceSolveOptions options;
    options.stop_at_first_solution = true;
    SpacePlanner planner(drawing, options);
    if (planner.solve().status != Status::solved) {
        std::fprintf(stderr, "no plan\n");
        return 1;
    }
    const SpacePlan first = *planner.plan();
    std::printf("    0.00 s  first plan: %.2f s\n", first.duration_s());
    SpacePlan flown = first;
    if (const auto seen = seen_at(truth, obstacle, first)) {
        const double seen_s = static_cast<double>(*seen) * first.tick_s;
        std::printf("%8.2f s  %s is %.3f m lower than on the drawing\n", seen_s, name.c_str(), lower_m);
        const std::int64_t from = *seen + std::llround(lead_s / first.tick_s);
        SpaceSceneChange change;
        change.put = {obstacle};
        SpaceReplanOptions how;
        how.max_iterations = iterations;
        how.on_answer = [&](const SpaceAnswer& answer) { say(seen_s, answer); };
        const SpaceAnswer answer = planner.replan(planner.predicted(drawing.start, first, from), from, change, how);
        flown = first.beginning(from).followed_by(answer.plan);
    }
    is_good("the first plan alone", truth, first);
    return is_good("the mission", truth, flown) ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
    if (count != 3) {
        std::fprintf(stderr, "usage: %s PROBLEM.yaml OBSTACLE\n", words[0]);
        return 2;
    }
    try {
        return fly(read_space_problem(words[1]), words[2]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}

// Obstacles come, move and go while a vehicle is on its way: how soon a Planner has a safe answer, what its plan costs
// after a second beside that of a search from scratch, and whether the answers keep vehicles in worlds from collisions.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "../support/measuring.hpp"
#include "answers.hpp"
#include "downwash/base/quantile.hpp"
#include "downwash/planner/planner.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/world_parameters.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

struct Given {
    std::string file;
    int moments = 200;
    int flights = 1000;
    unsigned seed = 1;
    int threads = 2;
    double budget_s = 1;
    double fresh_s = 5;
};

SolveOptions options_of(const Given& given) {
    SolveOptions options;
    options.threads = given.threads;
    return options;
}

class Draw {
 public:
    explicit Draw(unsigned seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
    }
    int below(int count) { return static_cast<int>(uniform(0, count)); }

 private:
    std::mt19937 engine_;
};

/// A change of the scene, and the one that takes it back.
struct Change {
    std::string kind;
    SceneChange there;
    SceneChange back;
};

Obstacle box_at(double x_m, double z_m, double size_m) {
    return {"surprise", Box{{size_m, size_m, size_m}}, {x_m, 0, z_m}, {}};
}

/// A box somewhere beside the rest of the way, or an obstacle that turns out up to 0.3 m elsewhere, or is gone.
Change drawn_change(const Problem& problem, const Plan& plan, std::int64_t tick, Draw& draw) {
    const int kind = draw.below(4);
    if (kind < 2) {
        const auto last = plan.reference.back().tick;
        const ReferencePoint ahead =
            plan.at(tick + static_cast<std::int64_t>(draw.uniform(0.2, 1) * static_cast<double>(last - tick)));
        const Obstacle box = box_at(ahead.position[0] + draw.uniform(-1.5, 1.5),
                                    ahead.position[1] + draw.uniform(-1.5, 1.5), draw.uniform(0.2, 0.8));
        return {"of a new box", {{box}, {}, {}}, {{}, {box.name}, {}}};
    }
    const auto movable = static_cast<int>(problem.obstacles.size()) - 1;  // the first is the ground
    const Obstacle& old = problem.obstacles[1 + static_cast<std::size_t>(draw.below(movable))];
    if (kind == 2) {
        Obstacle moved = old;
        moved.center_world_m[0] += draw.uniform(-0.3, 0.3);
        moved.center_world_m[2] += draw.uniform(-0.1, 0.1);
        return {"of an obstacle elsewhere", {{moved}, {}, {}}, {{old}, {}, {}}};
    }
    return {"of an obstacle gone", {{}, {old.name}, {}}, {{old}, {}, {}}};
}

/// A problem after a change, or nothing where it has errors, the vehicle's place included.
std::optional<Problem> changed(Problem problem, const SceneChange& change, const Start& start) {
    for (const std::string& name : change.removed) {
        std::erase_if(problem.obstacles, [&](const Obstacle& each) { return each.name == name; });
    }
    for (const Obstacle& put : change.put) {
        std::erase_if(problem.obstacles, [&](const Obstacle& each) { return each.name == put.name; });
        problem.obstacles.push_back(put);
    }
    problem.start = start;
    if (!problem_errors(problem).empty()) {
        return std::nullopt;
    }
    return problem;
}

/// Moments and changes without a simulated outcome.
void report_moments(const Given& given, const Problem& problem, Planner& planner, const Plan& plan,
                    const Start& start) {
    Draw draw(given.seed);
    std::vector<double> first_ms, keep_ms, ratios;
    std::map<std::string, int> kinds, first, last;
    int unsolved = 0, fresh_unsolved = 0;
    for (int i = 0; i < given.moments;) {
        const auto tick = static_cast<std::int64_t>(draw.uniform(0, static_cast<double>(plan.reference.back().tick)));
        planner.adopt(plan);
        const Start here = planner.predicted(start, plan, tick);
        const Change change = drawn_change(problem, plan, tick, draw);
        const auto after = changed(problem, change.there, here);
        if (!after) {
            continue;
        }
        ++i;
        ++kinds[change.kind];
        bool is_first = true;
        ReplanOptions options;
        options.time_limit_s = given.budget_s;
        options.on_answer = [&](const Answer& answer) {
            if (is_first) {
                ++first[std::string(name_of(answer.advice))];
                if (answer.advice != Advice::none) {
                    first_ms.push_back(1e3 * answer.after_wall_s);
                }
            }
            is_first = false;
            if (answer.advice == Advice::keep) {
                keep_ms.push_back(1e3 * answer.after_wall_s);
            }
        };
        const Answer answer = planner.replan(here, tick, change.there, options);
        ++last[std::string(name_of(answer.advice))];
        Problem fresh = *after;
        fresh.planner.time_limit_s = given.fresh_s;
        fresh.planner.max_iterations.reset();
        const Solution reference = solve(fresh, options_of(given));
        const bool is_solved = answer.advice == Advice::keep || answer.advice == Advice::follow;
        unsolved += !is_solved && reference.status == Status::solved ? 1 : 0;
        fresh_unsolved += is_solved && reference.status != Status::solved ? 1 : 0;
        if (is_solved && reference.status == Status::solved) {
            ratios.push_back(answer.cost / reference.execution_cost);
        }
        ReplanOptions none;
        none.time_limit_s = 1e-9;
        planner.replan(here, tick, change.back, none);
        planner.adopt(plan);
    }
    fmt::print("## Moments\n\n{} moments, each with one change: {}.\n\n| | |\n| --- | ---: |\n", given.moments,
               listed(kinds));
    fmt::print("| first answers | {} |\n", listed(first));
    const double in_time = 100 * share(first_ms, 10);
    fmt::print(
        "| first safe answer | median {:.1f} ms, 95 % within {:.1f} ms; within 10 ms {:.1f} % of the moments that have "
        "one, {:.1f} % of all |\n",
        quantile(first_ms, 0.5), quantile(first_ms, 0.95), in_time,
        in_time * static_cast<double>(first_ms.size()) / given.moments);
    fmt::print(
        "| that the last plan still holds is known | {} times, median after {:.1f} ms, 95 % within {:.1f} ms |\n",
        keep_ms.size(), quantile(keep_ms, 0.5), quantile(keep_ms, 0.95));
    fmt::print("| answers after {:g} s | {} |\n", given.budget_s, listed(last));
    fmt::print(
        "| cost over that of a fresh search of {:g} s | median {:.3f}, 90 % below {:.3f}, {:.1f} % below 1.1 ({}) |\n",
        given.fresh_s, quantile(ratios, 0.5), quantile(ratios, 0.9), 100 * share(ratios, 1.1), ratios.size());
    fmt::print("| solved only by the fresh search, only by replanning | {}, {} |\n\n", unsolved, fresh_unsolved);
}

/// What becomes of a flight that follows an answer in its world.
Execution flown(const Planner& planner, const FlightState& state, const Answer& answer, const FlownWorld& world,
                std::int64_t tick) {
    std::vector<Goal> goals{planner.problem().goal};
    if (answer.advice == Advice::stop || answer.advice == Advice::none) {
        const Configuration last = answer.plan.last();
        goals = {Goal{}};
        goals[0].kind = ConfigurationGoal{last[plane::x], last[plane::z], last[plane::arm], 1, 1};
    }
    return execute(planner.model(), state, answer.plan.reference, goals, true, {&world, tick});
}

/// The vehicle of a world in the middle of its flight; nothing where it does not get so far.
std::optional<FlightState> state_in(const Planner& planner, const FlownWorld& world, const Start& start,
                                    const Plan& plan, std::int64_t tick) {
    auto state = hovering_start(planner.model(), start_state(planner.model(), start), true, {&world});
    if (state && !fly_along(planner.model(), planner.map(), plan, tick, *state, {&world})) {
        state.reset();
    }
    return state;
}

/// Flights in worlds in which a box appears on the way; with room to stop before it, or without.
void report_flights(const Given& given, const Problem& problem, Planner& planner, const Plan& plan,
                    const Start& start) {
    Draw draw(given.seed + 1);
    struct Count {
        int flights = 0, collisions = 0, told = 0;
        std::map<std::string, int> advice;
        std::vector<std::string> surprises;  ///< lost, and not announced
    };
    Count counts[2];
    const double tick_s = planner.model().tick().tick_s;
    for (int i = 0; i < given.flights;) {
        const bool has_room = i % 2 == 0;
        const FlownWorld world = make_world(problem.robot, draw_world(*problem.uncertainty, problem.robot,
                                                                      given.seed + 77, static_cast<std::uint64_t>(i)));
        const auto tick = static_cast<std::int64_t>(draw.uniform(0, static_cast<double>(plan.reference.back().tick)));
        planner.adopt(plan);
        const ReferencePoint reference = plan.at(tick);
        const double speed = std::hypot(reference.velocity[0], reference.velocity[1]);
        const double room_m =
            has_room ? 1.6 + speed * speed / (2 * problem.motion.max_acceleration_m_s2) * 1.5 : draw.uniform(0.9, 1.2);
        const auto state = state_in(planner, world, start, plan, tick);
        if (!state || speed < 0.2) {
            continue;
        }
        const double size_m = 0.5;
        const double away_m = room_m + 0.5 * size_m;
        const Obstacle box = box_at(state->plant.q[0] + away_m * reference.velocity[0] / speed,
                                    state->plant.q[1] + away_m * reference.velocity[1] / speed, size_m);
        const Start here = start_of(planner.model(), *state, reference);
        const SceneChange there{{box}, {}, {}};
        if (!changed(problem, there, here)) {
            continue;
        }
        ReplanOptions options;
        options.time_limit_s = 1e-3;  // what is known at once
        const Answer answer = planner.replan(here, tick, there, options);
        const Execution flight = flown(planner, *state, answer, world, tick);
        Count& count = counts[has_room ? 0 : 1];
        ++count.flights;
        ++count.advice[std::string(name_of(answer.advice))];
        const bool is_lost = flight.outcome == Outcome::collision || flight.outcome == Outcome::unstable ||
                             flight.outcome == Outcome::left_flyable_area;
        count.collisions += is_lost ? 1 : 0;
        count.told += is_lost && answer.advice == Advice::none ? 1 : 0;
        ++i;
        planner.replan(here, tick, {{}, {box.name}, {}}, options);
        if (is_lost && answer.advice != Advice::none) {
            const Answer left{Advice::keep, plan.rest_after(tick), 0, 0, {}};
            const Execution alone = flown(planner, *state, left, world, tick);
            count.surprises.push_back(fmt::format(
                "flight {}, answer {}: {} after {:.1f} s, {:.2f} m/s and {:.2f} m before the box; without the box the "
                "plan ends with: {}",
                i, name_of(answer.advice), name_of(flight.outcome), flight.duration_s, speed, room_m,
                name_of(alone.outcome)));
        }
    }
    fmt::print(
        "## Flights\n\nA box of 0.5 m appears on the way of a flight in a drawn world (tick {:g} s), and "
        "the best answer without a search is flown in that world.\n\n"
        "| | flights | answers | lost | of these announced |\n"
        "| --- | ---: | --- | ---: | ---: |\n",
        tick_s);
    for (const bool has_room : {true, false}) {
        const Count& count = counts[has_room ? 0 : 1];
        fmt::print("| {} | {} | {} | {} | {} |\n", has_room ? "with room to stop" : "without", count.flights,
                   listed(count.advice), count.collisions, count.told);
    }
    std::string surprises;
    for (const Count& count : counts) {
        for (const std::string& surprise : count.surprises) {
            surprises += "- " + surprise + "\n";
        }
    }
    if (!surprises.empty()) {
        fmt::print("\nLost and not announced:\n\n{}", surprises);
    }
}

void run(const Given& given) {
    Problem problem = read_problem(given.file);
    constexpr double first_plan_s = 5;
    problem.planner.time_limit_s = first_plan_s;
    problem.planner.seed = given.seed;
    Planner planner(problem, options_of(given));
    const Solution& solution = planner.solve();
    if (solution.status != Status::solved) {
        throw std::runtime_error("the problem was not solved");
    }
    const Plan plan = *solution.plan;
    const Start start = problem.start;
    if (given.moments > 0) {
        report_moments(given, problem, planner, plan, start);
    }
    if (given.flights > 0 && problem.uncertainty) {
        report_flights(given, problem, planner, plan, start);
    }
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App program("Replans in the middle of flights.");
    Given given;
    program.add_option("problem", given.file, "problem file")->required();
    program.add_option("--moments", given.moments, "moments of changes");
    program.add_option("--flights", given.flights, "simulated flights");
    program.add_option("--seed", given.seed, "of everything that is drawn");
    program.add_option("--threads", given.threads, "of searches");
    program.add_option("--budget", given.budget_s, "wall time of a replan [s]");
    program.add_option("--fresh", given.fresh_s, "wall time of a search from scratch [s]");
    return run_program(program, argc, argv, [&] { run(given); });
}

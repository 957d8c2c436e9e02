// How often targets in any order get a certified flight within a time limit, beside the list of the same targets in the
// shortest order. Prints Markdown; every scene counts.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../../tests/support/random.hpp"
#include "../support/measuring.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/visit_order.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

struct Options {
    std::string open;                ///< problem of which robot and settings of open scenes are taken
    std::vector<std::string> files;  ///< problems with targets of their own
    unsigned scenes = 20;
    std::vector<std::size_t> targets{3, 5, 8};
    std::vector<double> times_s{10, 30, 60};
    int threads = 2;
    unsigned seed = 1;
    bool is_first_enough = false;  ///< a search that has what counts is not carried on for a lower cost
};

struct Place {
    double x_m, z_m;
};

/// The place of a goal, if it has one alone.
std::optional<Place> place_of(const Goal& goal) {
    if (const auto* at = std::get_if<ConfigurationGoal>(&goal.kind); at != nullptr && at->x_m && at->z_m) {
        return Place{*at->x_m, *at->z_m};
    }
    if (const auto* at = std::get_if<EndEffectorGoal>(&goal.kind)) {
        return Place{at->x_m, at->z_m};
    }
    return std::nullopt;
}

void move_to(Goal& goal, const Place& place) {
    if (auto* at = std::get_if<ConfigurationGoal>(&goal.kind)) {
        at->x_m = place.x_m;
        at->z_m = place.z_m;
    } else if (auto* end = std::get_if<EndEffectorGoal>(&goal.kind)) {
        end->x_m = place.x_m;
        end->z_m = place.z_m;
    }
}

double distance_m(const Place& a, const Place& b) {
    return std::hypot(a.x_m - b.x_m, a.z_m - b.z_m);
}

/// Adds goals like the first target at places in a rectangle, none near another, until there are enough.
void add_targets(Problem& problem, const Goal& like, const Bounds& in, double apart_m, std::size_t count,
                 test::Random& random) {
    while (problem.targets.size() < count) {
        const Place place{random.uniform(in.x_low_m, in.x_high_m), random.uniform(in.z_low_m, in.z_high_m)};
        if (std::ranges::all_of(problem.targets, [&](const Goal& other) {
                return distance_m(place, place_of(other).value()) >= apart_m;
            })) {
            problem.targets.push_back(like);
            move_to(problem.targets.back(), place);
        }
    }
}

/// Targets over the ground and a way back, in the worlds of `uncertainty: {}`.
Problem open_scene(const Options& options, std::size_t targets, unsigned seed) {
    Problem problem = read_problem(options.open);
    problem.name = fmt::format("open-{}", seed);
    problem.bounds = {-12, 12, 0.8, 11.5};
    problem.obstacles = {{"ground", Box{{60, 40, 1}}, {0, 0, -0.5}, {}}};
    problem.start = {};
    problem.start.at[plane::x] = -10;
    problem.start.at[plane::z] = 3;
    problem.start.at[plane::arm] = 1.5707963267948966;
    problem.goal = {};
    problem.goals_before.clear();
    problem.targets.clear();
    problem.uncertainty.emplace();
    Goal target;
    target.kind = ConfigurationGoal{.x_m = 0, .z_m = 3, .arm_rad = {}, .tolerance_m = 0.15};
    target.hold_s = 5;
    test::Random random(seed);
    add_targets(problem, target, {-11, 11, 2, 10.5}, 2, targets, random);
    problem.return_to = target;
    problem.return_to->kind = ConfigurationGoal{.x_m = -10, .z_m = 3, .arm_rad = {}, .tolerance_m = 0.3};
    return problem;
}

/// The targets of a file: the first ones, and others between them.
Problem scene_of(const std::string& file, std::size_t targets) {
    Problem problem = read_problem(file);
    std::vector<Place> places;
    for (const Goal& target : problem.targets) {
        if (const std::optional<Place> place = place_of(target)) {
            places.push_back(*place);
        }
    }
    if (places.empty() || places.size() != problem.targets.size()) {
        throw_input_error("expected targets in any order, each at one place", "goal.in_any_order");
    }
    const auto [left, right] = std::ranges::minmax(places, {}, &Place::x_m);
    const auto [low, high] = std::ranges::minmax(places, {}, &Place::z_m);
    const Goal like = problem.targets.front();
    problem.targets.resize(std::min(targets, problem.targets.size()));
    test::Random random(1);
    add_targets(problem, like, {left.x_m, right.x_m, low.z_m, high.z_m}, 0.5, targets, random);
    return problem;
}

/// The order with the shortest straight way, back included.
VisitOrder shortest(const Problem& problem) {
    const Place start{problem.start.at[plane::x], problem.start.at[plane::z]};
    std::vector<std::size_t> order(problem.targets.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::vector<std::size_t> best = order;
    const auto length_m = [&](const std::vector<std::size_t>& targets) {
        Place at = start;
        double sum_m = 0;
        for (const std::size_t target : targets) {
            const Place next = place_of(problem.targets[target]).value();
            sum_m += distance_m(at, next);
            at = next;
        }
        return problem.return_to ? sum_m + distance_m(at, place_of(*problem.return_to).value_or(start)) : sum_m;
    };
    double best_m = length_m(best);
    while (std::ranges::next_permutation(order).found) {
        if (const double m = length_m(order); m < best_m) {
            best_m = m;
            best = order;
        }
    }
    VisitOrder visits;
    for (const std::size_t target : best) {
        visits.visits.push_back({target, std::nullopt});
    }
    return visits;
}

/// What came of one search.
struct Tried {
    bool is_certified = false;  ///< through all targets; in the nominal world alone, solved
    double cost = 0, wall_s = 0;
    std::string why;  ///< not
};

Tried tried_once(const Problem& problem, const SolveOptions& how) {
    const Solution solution = solve(problem, how);
    const bool is_whole = !solution.order || solution.order->left_out.empty();
    Tried outcome;
    outcome.is_certified = solution.status == Status::solved && is_whole;
    outcome.cost = solution.execution_cost;
    outcome.wall_s = solution.planning.wall_s;
    if (!outcome.is_certified) {
        outcome.why = solution.obstruction ? solution.obstruction->cause : "target left out";
        if (solution.missed_goal) {
            outcome.why += fmt::format(" (goal {})", *solution.missed_goal);
        }
    }
    return outcome;
}

/// What a search goes on to find is never worse than its first plan, so a first plan that counts tells the outcome.
Tried tried(const Problem& problem, SolveOptions how, bool is_first_enough) {
    how.stop_at_first_solution = is_first_enough;
    const Tried first = tried_once(problem, how);
    if (first.is_certified || !is_first_enough) {
        return first;
    }
    how.stop_at_first_solution = false;
    return tried_once(problem, how);
}

struct Row {
    Row(std::size_t of, double limit_s, std::string name) : targets(of), time_s(limit_s), scenes(std::move(name)) {}

    std::size_t targets;
    double time_s;
    std::string scenes;
    int count = 0, any_order = 0, list = 0, both = 0;
    double cost_ratio = 0;  ///< sum over scenes that both have
    std::vector<std::string> failures;
};

void add(Row& row, const Problem& problem, double time_s, const Options& options) {
    Problem limited = problem;
    limited.planner.max_iterations.reset();
    limited.planner.time_limit_s = time_s;
    SolveOptions how;
    how.threads = options.threads;
    const Tried any = tried(limited, how, options.is_first_enough);
    Problem list = in_order(limited, shortest(limited));
    list.energy_budget_j.reset();  // of targets in any order alone
    const Tried in_turn = tried(list, how, options.is_first_enough);
    ++row.count;
    row.any_order += any.is_certified ? 1 : 0;
    row.list += in_turn.is_certified ? 1 : 0;
    if (any.is_certified && in_turn.is_certified) {
        ++row.both;
        row.cost_ratio += any.cost / in_turn.cost;
    }
    if (!any.is_certified) {
        row.failures.push_back(fmt::format("{}: {} after {:.1f} s", problem.name, any.why, any.wall_s));
    }
    fmt::print(stderr, "{}, {} targets, {:g} s: any order {} ({:.1f} s), list {} ({:.1f} s)\n", problem.name,
               row.targets, time_s, any.is_certified ? "certified" : any.why, any.wall_s,
               in_turn.is_certified ? "certified" : in_turn.why, in_turn.wall_s);
}

void print(const std::vector<Row>& rows, const Options& options) {
    fmt::print(
        "# Targets in any order, certified\n\n"
        "Commit {}, g++ {}, {}, {} thread{} a search, one search at a time, seed {}. `bench/order_certified.sh` writes "
        "this page.\n\n"
        "{} random open scenes with a way back, in the worlds of `uncertainty: {{}}`, and the given files with their "
        "own settings. *List*: the same targets as a list in the\nshortest order, with as much time. A search counts "
        "if its flight visits all targets and is solved, with a certificate where worlds are asked for. *Cost*: any "
        "order by list,\nthe mean over scenes that both have{}.\n\n"
        "| scenes | targets | limit | any order | list | cost |\n|---|---|---|---|---|---|\n",
        source_commit(), __VERSION__, DOWNWASH_BUILD_TYPE, options.threads, options.threads == 1 ? "" : "s",
        options.seed, options.scenes,
        options.is_first_enough ? ", of first plans: a search ends with the first that counts" : "");
    bool is_kept = true;
    for (const Row& row : rows) {
        fmt::print("| {} | {} | {:g} s | {} of {} | {} of {} | {} |\n", row.scenes, row.targets, row.time_s,
                   row.any_order, row.count, row.list, row.count,
                   row.both > 0 ? fmt::format("{:.3f}", row.cost_ratio / row.both) : "none");
        is_kept = is_kept && row.any_order >= row.list;
    }
    fmt::print("\nAt least as many in any order as by the list, in every row: {}.\n", is_kept ? "yes" : "no");
    for (const Row& row : rows) {
        for (const std::string& failure : row.failures) {
            fmt::print("\n- {} targets, {:g} s, {}", row.targets, row.time_s, failure);
        }
    }
    fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Certified flights through targets in any order beside those of a list, as Markdown");
    app.add_option("problem", options.open, "problem file of which robot and settings of open scenes are taken")
        ->required();
    app.add_option("--file", options.files, "another problem with targets in any order; may be given again");
    app.add_option("--scenes", options.scenes, "random open scenes");
    app.add_option("--targets", options.targets, "targets in each")->delimiter(',')->check(CLI::Range(1, 10));
    app.add_option("--times", options.times_s, "of every search [s]")->delimiter(',')->check(CLI::PositiveNumber);
    app.add_option("--threads", options.threads, "of a search")->check(CLI::PositiveNumber);
    app.add_flag("--first", options.is_first_enough, "end each search with the first plan that counts");
    app.add_option("--seed", options.seed, "of the first scene");
    return run_program(app, argc, argv, [&options] {
        std::vector<Row> rows;
        for (const std::size_t targets : options.targets) {
            for (const double time_s : options.times_s) {
                Row open(targets, time_s, "open");
                for (unsigned i = 0; i < options.scenes; ++i) {
                    add(open, open_scene(options, targets, options.seed + i), time_s, options);
                }
                if (open.count > 0) {
                    rows.push_back(std::move(open));
                }
                for (const std::string& file : options.files) {
                    const Problem problem = scene_of(file, targets);
                    Row own(targets, time_s, problem.name);
                    add(own, problem, time_s, options);
                    rows.push_back(std::move(own));
                }
            }
        }
        print(rows, options);
    });
}

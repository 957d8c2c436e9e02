// Orders of targets that the planner chooses against the given order, nearest-first and the exact order over flown
// legs, in random scenes. Prints Markdown; every scene counts.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "../../tests/support/random.hpp"
#include "../support/measuring.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

struct Options {
    std::string problem;
    unsigned scenes = 20;
    std::size_t targets = 8;
    double time_s = 10;
    std::uint64_t leg_iterations = 350;
    int jobs = 2;
    unsigned seed = 1;
};

/// Blocks in the plane of motion and places between them, none near another or the start.
Problem random_scene(const Options& options, unsigned seed) {
    test::Random random(seed);
    Problem problem = read_problem(options.problem);
    problem.name = fmt::format("scene_{}", seed);
    problem.bounds = {-12, 12, 0.8, 11.5};
    problem.obstacles.clear();
    problem.start = {};
    problem.start.at[plane::x] = -10;
    problem.start.at[plane::z] = 3;
    problem.start.at[plane::arm] = 1.5707963267948966;
    constexpr int blocks = 6;
    while (problem.obstacles.size() < blocks) {
        const double x_m = random.uniform(-9, 9), z_m = random.uniform(2, 10);
        const double width_m = random.uniform(0.5, 2.5), height_m = random.uniform(0.5, 2.5);
        if (std::abs(x_m - problem.start.at[plane::x]) > 3 || std::abs(z_m - problem.start.at[plane::z]) > 2.5) {
            problem.obstacles.push_back(
                {fmt::format("block_{}", problem.obstacles.size()), Box{{width_m, 6, height_m}}, {x_m, 0, z_m}, {}});
        }
    }
    const auto is_free = [&](double x_m, double z_m) {
        return std::ranges::none_of(problem.obstacles, [&](const Obstacle& block) {
            const Vector3& size_m = std::get<Box>(block.shape).size_m;
            return std::abs(x_m - block.center_world_m[0]) < size_m[0] / 2 + 1 &&
                   std::abs(z_m - block.center_world_m[2]) < size_m[2] / 2 + 1;
        });
    };
    const auto is_apart = [&](double x_m, double z_m) {
        return std::ranges::none_of(problem.targets, [&](const Goal& other) {
            const auto& place = std::get<ConfigurationGoal>(other.kind);
            return std::hypot(x_m - *place.x_m, z_m - *place.z_m) < 2;
        });
    };
    problem.goal = {};
    while (problem.targets.size() < options.targets) {
        const double x_m = random.uniform(-11, 11), z_m = random.uniform(1.8, 10.5);
        if (is_free(x_m, z_m) && is_apart(x_m, z_m)) {
            Goal target;
            target.kind = ConfigurationGoal{.x_m = x_m, .z_m = z_m, .arm_rad = {}, .tolerance_m = 0.15};
            target.hold_s = 1;
            problem.targets.push_back(target);
        }
    }
    problem.planner.time_limit_s = options.time_s;
    problem.planner.max_iterations.reset();
    problem.uncertainty.reset();
    return problem;
}

using Order = std::vector<std::size_t>;  ///< the targets in the order of visits, from 0

constexpr double none = std::numeric_limits<double>::infinity();

/// What all legs cost when executed, the hover at the target included.
struct Legs {
    std::vector<double> from_start;            ///< to each target
    std::vector<std::vector<double>> between;  ///< from each target to each

    [[nodiscard]] double cost_of(const Order& order) const {
        double sum = from_start[order.front()];
        for (std::size_t i = 1; i < order.size(); ++i) {
            sum += between[order[i - 1]][order[i]];
        }
        return sum;
    }
    [[nodiscard]] Order exact() const {
        Order order = as_given();
        Order best = order;
        while (std::ranges::next_permutation(order).found) {
            if (cost_of(order) < cost_of(best)) {
                best = order;
            }
        }
        return best;
    }
    [[nodiscard]] Order nearest_first() const {
        Order left = as_given(), order;
        while (!left.empty()) {
            const std::vector<double>& costs = order.empty() ? from_start : between[order.back()];
            const auto next = std::ranges::min_element(left, {}, [&](std::size_t target) { return costs[target]; });
            order.push_back(*next);
            left.erase(next);
        }
        return order;
    }
    [[nodiscard]] Order as_given() const {
        Order order(from_start.size());
        std::iota(order.begin(), order.end(), 0);
        return order;
    }
};

/// Each leg is planned as a problem of its own, by two searches of which the cheaper flight counts; by more, where
/// these find none. Those from a target begin where that from the start ended.
Legs flown_legs(const Problem& problem, const Options& options, const SolveOptions& how) {
    Problem leg = problem;
    leg.targets.clear();
    leg.planner.time_limit_s.reset();
    leg.planner.max_iterations = options.leg_iterations;
    std::vector<Start> hovers(problem.targets.size(), problem.start);
    const auto fly = [&](const Start& start, std::size_t to) {
        leg.start = start;
        leg.goal = problem.targets[to];
        double cost = none;
        constexpr unsigned searches = 2, most_searches = 10;
        for (unsigned seed = 1; seed <= (std::isinf(cost) ? most_searches : searches); ++seed) {
            leg.planner.seed = seed;
            const Solution found = solve(leg, how);
            if (found.status == Status::solved && found.execution_cost < cost) {
                cost = found.execution_cost;
                hovers[to] = Start::resting_at(found.plan->last());
            }
        }
        return cost;
    };
    Legs legs;
    for (std::size_t to = 0; to < problem.targets.size(); ++to) {
        legs.from_start.push_back(fly(problem.start, to));
    }
    const std::vector<Start> starts = hovers;
    for (std::size_t from = 0; from < starts.size(); ++from) {
        legs.between.emplace_back(starts.size(), none);
        for (std::size_t to = 0; to < starts.size(); ++to) {
            if (to != from) {
                legs.between[from][to] = fly(starts[from], to);
            }
        }
    }
    return legs;
}

/// The executed cost of the flight in an order; empty without one.
std::optional<double> executed_cost(const Problem& problem, const Order& targets, const SolveOptions& how) {
    VisitOrder order;
    for (const std::size_t target : targets) {
        order.visits.push_back({target, std::nullopt});
    }
    const Solution solution = solve(in_order(problem, order), how);
    return solution.status == Status::solved ? std::optional(solution.execution_cost) : std::nullopt;
}

struct Row {
    unsigned scene = 0;
    std::uint64_t legs = 0;                     ///< that the planner flew to compare orders
    bool is_exact = false, is_nearest = false;  ///< the chosen order is the exact one, that of nearest-first
    double legs_chosen = none, legs_exact = 0, legs_nearest = 0, legs_given = 0;  ///< costs by the reference
    std::optional<double> chosen, exact, nearest;                                 ///< executed
};

std::string ratio(double a, double b) {
    return fmt::format("{:.3f}", a / b);
}

std::string ratio(const std::optional<double>& a, const std::optional<double>& b) {
    return a && b ? ratio(*a, *b) : "none";
}

Row measured(const Problem& problem, const Options& options, unsigned scene) {
    SolveOptions how;
    how.map = problem.aero.enabled ? make_flight_model(problem)->make_whole_map(problem.bounds) : nullptr;
    const Solution solution = solve(problem, how);
    Order chosen;
    for (const Visit& visit : solution.order->visits) {
        chosen.push_back(visit.target);
    }
    const Legs legs = flown_legs(problem, options, how);
    const Order exact = legs.exact(), nearest = legs.nearest_first();
    Row row;
    row.scene = scene;
    row.legs = solution.order->legs;
    row.is_exact = chosen == exact;
    row.is_nearest = chosen == nearest;
    if (solution.status == Status::solved) {
        row.chosen = solution.execution_cost;
        row.legs_chosen = legs.cost_of(chosen);
    }
    row.legs_exact = legs.cost_of(exact);
    row.legs_nearest = legs.cost_of(nearest);
    row.legs_given = legs.cost_of(legs.as_given());
    row.exact = executed_cost(problem, exact, how);
    row.nearest = nearest == exact ? row.exact : executed_cost(problem, nearest, how);
    return row;
}

std::string same(bool is_same) {
    return is_same ? " (same)" : "";
}

void print(const std::vector<Row>& rows, const Options& options) {
    fmt::print(
        "# Targets in any order\n\n"
        "Commit {}, g++ {}, {}, one thread a search, seed {}. `bench/order.sh` writes this page.\n\n"
        "{} random scenes with six blocks and {} targets, in the nominal world, objective energy. The planner gets "
        "{:g} "
        "s for a scene;\n{} searches ran at a time. *Legs* is how many it flew to compare orders.\n\n"
        "*By legs*: each of the {} legs from the start to a target and between two targets is planned as a problem of "
        "its own, by two searches of {}\niterations, of which the cheaper flight counts, and by up to eight more where "
        "these find none. The planner does not see these flights. The cost\nof the order that it chose, by these legs, "
        "is divided by that of the cheapest of all orders (exact), of nearest-first and of the order of the file.\n\n"
        "*Executed*: the cost of the executed flight of `in_any_order`, divided by that of the flight in the other "
        "order. The planner is given that order as\na list, with as much time, of which it needs none to compare "
        "orders. "
        "Below 1 the chosen order is cheaper. *Same*: both orders are one and the same,\nand the ratio shows how far "
        "two searches in one order differ.\n\n"
        "| scene | legs | by legs: exact | nearest-first | given | executed: exact | nearest-first |\n"
        "|---|---|---|---|---|---|---|\n",
        source_commit(), __VERSION__, DOWNWASH_BUILD_TYPE, options.seed, options.scenes, options.targets,
        options.time_s, options.jobs, options.targets * options.targets, options.leg_iterations);
    constexpr double allowed = 1.03;
    double worst = 0, worst_executed = 0, worst_nearest = 0;
    int failures = 0, dearer_than_nearest = 0, dear = 0, executed_dear = 0, executed_dearer = 0, dearer_in_same = 0;
    for (const Row& row : rows) {
        fmt::print("| {} | {} | {} | {} | {} | {}{} | {}{} |\n", row.scene, row.legs,
                   ratio(row.legs_chosen, row.legs_exact), ratio(row.legs_chosen, row.legs_nearest),
                   ratio(row.legs_chosen, row.legs_given), ratio(row.chosen, row.exact), same(row.is_exact),
                   ratio(row.chosen, row.nearest), same(row.is_nearest));
        worst = std::max(worst, row.legs_chosen / row.legs_exact);
        dearer_than_nearest += row.legs_chosen > row.legs_nearest * (1 + 1e-9) ? 1 : 0;
        dear += row.legs_chosen > allowed * row.legs_exact ? 1 : 0;
        executed_dear += row.chosen && row.exact && *row.chosen > allowed * *row.exact ? 1 : 0;
        failures += row.chosen ? 0 : 1;
        if (row.chosen && row.exact) {
            worst_executed = std::max(worst_executed, *row.chosen / *row.exact);
        }
        if (row.chosen && row.nearest) {
            worst_nearest = std::max(worst_nearest, *row.chosen / *row.nearest);
            const bool is_dearer = *row.chosen > *row.nearest;
            executed_dearer += is_dearer ? 1 : 0;
            dearer_in_same += is_dearer && row.is_nearest ? 1 : 0;
        }
    }
    fmt::print(
        "\nBy legs, the chosen order costs at most {:.3f} of the exact one, more than {} of it in {} of {} scenes, and "
        "more "
        "than nearest-first in {}.\nExecuted, it costs at most {:.3f} of the exact one, more than {} of it in {} "
        "scenes; "
        "more than nearest-first in {} scenes, in {} of them in the same order, at most {:.3f} of it.\nIn {} of {} "
        "scenes no flight through all targets was found.\n",
        worst, allowed, dear, rows.size(), dearer_than_nearest, worst_executed, allowed, executed_dear, executed_dearer,
        dearer_in_same, worst_nearest, failures, rows.size());
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Chosen orders of targets against others, as Markdown");
    app.add_option("problem", options.problem, "problem file of which robot and settings are taken")->required();
    app.add_option("--scenes", options.scenes, "random scenes")->check(CLI::PositiveNumber);
    app.add_option("--targets", options.targets, "targets in each")->check(CLI::Range(1, 10));
    app.add_option("--time", options.time_s, "of every search [s]")->check(CLI::PositiveNumber);
    app.add_option("--leg-iterations", options.leg_iterations, "of each leg that orders are measured by")
        ->check(CLI::PositiveNumber);
    app.add_option("-j,--jobs", options.jobs, "scenes at a time")->check(CLI::PositiveNumber);
    app.add_option("--seed", options.seed, "of the first scene");
    return run_program(app, argc, argv, [&options] {
        std::vector<Row> rows(options.scenes);
        run_parallel(rows.size(), options.jobs, [&](std::size_t i) {
            const unsigned scene = options.seed + static_cast<unsigned>(i);
            const Row row = measured(random_scene(options, scene), options, scene);
            fmt::print(stderr, "scene {}: by legs {} of the exact order, {} of nearest-first; executed {}, {}\n", scene,
                       ratio(row.legs_chosen, row.legs_exact), ratio(row.legs_chosen, row.legs_nearest),
                       ratio(row.chosen, row.exact), ratio(row.chosen, row.nearest));
            rows[i] = row;
        });
        print(rows, options);
    });
}

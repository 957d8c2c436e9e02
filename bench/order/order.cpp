// Orders of targets that the planner chooses against the given order, nearest-first and the exact order over flown legs,
// in random scenes. Prints Markdown; every scene counts.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "../../tests/support/random.hpp"
#include "../support/measuring.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/planner/flight_search.hpp"
#include "downwash/planner/order_comparison.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"

using namespace downwash;
using namespace downwash::bench;
using planning::LegCosts;
using planning::PlaceOrder;

namespace {

struct Options {
    std::string problem;
    unsigned scenes = 20;
    std::size_t targets = 8;
    std::uint64_t iterations = 20000;
    std::uint64_t leg_iterations = 200;
    int threads = 2;
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
    problem.start.x_m = -10;
    problem.start.z_m = 3;
    problem.start.arm_rad = 1.5707963267948966;
    constexpr int blocks = 6;
    while (problem.obstacles.size() < blocks) {
        const double x_m = random.uniform(-9, 9), z_m = random.uniform(2, 10);
        const double width_m = random.uniform(0.5, 2.5), height_m = random.uniform(0.5, 2.5);
        if (std::abs(x_m - problem.start.x_m) > 3 || std::abs(z_m - problem.start.z_m) > 2.5) {
            problem.obstacles.push_back({fmt::format("block_{}", problem.obstacles.size()),
                                         Box{{width_m, 6, height_m}},
                                         {x_m, 0, z_m},
                                         {}});
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
            return std::hypot(x_m - *other.configuration->x_m, z_m - *other.configuration->z_m) < 2;
        });
    };
    problem.goal = {};
    while (problem.targets.size() < options.targets) {
        const double x_m = random.uniform(-11, 11), z_m = random.uniform(1.8, 10.5);
        if (is_free(x_m, z_m) && is_apart(x_m, z_m)) {
            Goal target;
            target.configuration = ConfigurationGoal{.x_m = x_m, .z_m = z_m, .arm_rad = {}, .tolerance_m = 0.15};
            target.hold_s = 1;
            problem.targets.push_back(target);
        }
    }
    problem.planner.time_limit_s.reset();
    problem.planner.max_iterations = options.iterations;
    problem.uncertainty.reset();
    return problem;
}

/// Orders by the same flown legs: that which the planner chooses, and all that there are.
struct Orders {
    PlaceOrder chosen;
    LegCosts costs;          ///< of all legs, those that the planner flew the same
    std::uint64_t legs = 0;  ///< that it flew
};

Orders orders_of(const Problem& problem, const Options& options) {
    const auto model = make_flight_model(problem);
    const auto map = problem.aero.enabled ? model->make_map(problem.bounds, options.threads) : nullptr;
    SolveOptions how;
    how.threads = options.threads;
    planning::LegTable table(
        problem, *model, map.get(), how,
        [&](const Problem& leg, const SolveOptions& of_leg, const planning::Course& before, Solution& into) {
            static_cast<void>(planning::search_flights(leg, leg, *model, map.get(), before, nullptr, of_leg, into));
        });
    planning::OrderComparison comparison(table, [] { return false; });
    PlannerSettings settings;
    settings.max_iterations = options.leg_iterations * options.targets * 6;
    SearchRecord work;
    comparison.compare(planning::SearchBudget(settings), work);
    Orders orders{comparison.chosen(), table.flown_costs(), table.legs_flown()};
    settings.max_iterations = options.leg_iterations;
    const planning::SearchBudget of_leg(settings);
    const std::size_t outside = table.estimates().outside();
    for (const bool has_hovers : {false, true}) {
        for (std::size_t from = has_hovers ? 0 : outside; from <= outside; ++from) {
            for (std::size_t to = 0; to < outside; ++to) {
                for (int i = 0; i < 2 && std::isinf(orders.costs.leg(from, to).cost) && !table.is_known(from, to) &&
                                !table.fly(from, to, of_leg, work);
                     ++i) {
                }
            }
        }
    }
    orders.costs = table.flown_costs();
    return orders;
}

/// The executed cost of the flight in an order; empty without one.
std::optional<double> executed_cost(const Problem& problem, const std::vector<std::size_t>& places,
                                    const SolveOptions& how) {
    VisitOrder order;
    for (const std::size_t place : places) {
        order.visits.push_back({place, std::nullopt});
    }
    const Solution solution = solve(in_order(problem, order), how);
    return solution.status == Status::solved ? std::optional(solution.execution_cost) : std::nullopt;
}

struct Row {
    unsigned scene = 0;
    std::uint64_t legs = 0;
    double legs_chosen = 0, legs_exact = 0, legs_nearest = 0, legs_given = 0;  ///< costs by flown legs
    std::optional<double> chosen, exact, nearest, given;                       ///< executed
};

std::string ratio(double a, double b) {
    return fmt::format("{:.3f}", a / b);
}

std::string ratio(const std::optional<double>& a, const std::optional<double>& b) {
    return a && b ? ratio(*a, *b) : "none";
}

Row measured(const Problem& problem, const Options& options, unsigned scene) {
    SolveOptions how;
    how.threads = options.threads;
    Row row;
    row.scene = scene;
    const Solution solution = solve(problem, how);
    if (solution.status == Status::solved) {
        row.chosen = solution.execution_cost;
    }
    const Orders orders = orders_of(problem, options);
    const LegCosts& costs = orders.costs;
    const PlaceOrder exact = planning::best_order(costs);
    const PlaceOrder nearest = planning::nearest_first(costs);
    std::vector<std::size_t> given(options.targets);
    std::iota(given.begin(), given.end(), 0);
    row.legs_chosen = planning::order_of(costs, orders.chosen.places).cost;
    row.legs = orders.legs;
    row.legs_exact = exact.cost;
    row.legs_nearest = nearest.cost;
    row.legs_given = planning::order_of(costs, given).cost;
    row.exact = executed_cost(problem, exact.places, how);
    row.nearest = nearest.places == exact.places ? row.exact : executed_cost(problem, nearest.places, how);
    row.given = executed_cost(problem, given, how);
    return row;
}

void print(const std::vector<Row>& rows, const Options& options) {
    fmt::print(
        "# Targets in any order\n\nCommit {}, g++ {}, {}, {} threads, seed {}. `bench/order.sh` writes this page.\n\n"
        "{} random scenes with six blocks and {} targets, everything as believed, objective energy, {} iterations a "
        "search.\n*By legs*: the planner's comparison flies the legs that it needs, at first for up to {} iterations; "
        "then all others of the {} are flown for as\nlong. The cost of the order that it chose by these legs is divided "
        "by that of the cheapest of all orders (exact), of nearest-first and of the given\norder. *Executed*: the cost "
        "of the executed flight of `in_any_order`, divided by that of the flight in the other order, which the planner "
        "was given as\na list, with as many iterations and the same seed. Below 1 the chosen order is cheaper.\n\n"
        "| scene | legs | by legs: exact | nearest-first | given | executed: exact | nearest-first | given |\n"
        "|---|---|---|---|---|---|---|---|\n",
        source_commit(), __VERSION__, DOWNWASH_BUILD_TYPE, options.threads, options.seed, options.scenes,
        options.targets, options.iterations, options.leg_iterations, options.targets * options.targets);
    double worst = 0, worst_executed = 0, worst_nearest = 0;
    int failures = 0, dearer_than_nearest = 0;
    for (const Row& row : rows) {
        fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} |\n", row.scene, row.legs,
                   ratio(row.legs_chosen, row.legs_exact), ratio(row.legs_chosen, row.legs_nearest),
                   ratio(row.legs_chosen, row.legs_given), ratio(row.chosen, row.exact),
                   ratio(row.chosen, row.nearest), ratio(row.chosen, row.given));
        worst = std::max(worst, row.legs_chosen / row.legs_exact);
        dearer_than_nearest += row.legs_chosen > row.legs_nearest * (1 + 1e-9) ? 1 : 0;
        failures += row.chosen ? 0 : 1;
        if (row.chosen && row.exact) {
            worst_executed = std::max(worst_executed, *row.chosen / *row.exact);
        }
        if (row.chosen && row.nearest) {
            worst_nearest = std::max(worst_nearest, *row.chosen / *row.nearest);
        }
    }
    fmt::print(
        "\nAt most, the chosen order costs {:.3f} of the exact one by legs, {:.3f} of it when executed, and {:.3f} of "
        "nearest-first when executed. By legs it costs\nmore than nearest-first in {} of {} scenes. Without a flight "
        "through all targets: {} of {} scenes.\n",
        worst, worst_executed, worst_nearest, dearer_than_nearest, rows.size(), failures, rows.size());
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Chosen orders of targets against others, as Markdown");
    app.add_option("problem", options.problem, "problem file of which robot and settings are taken")->required();
    app.add_option("--scenes", options.scenes, "random scenes")->check(CLI::PositiveNumber);
    app.add_option("--targets", options.targets, "targets in each")->check(CLI::Range(1, 10));
    app.add_option("--iterations", options.iterations, "of every search")->check(CLI::PositiveNumber);
    app.add_option("--threads", options.threads, "of every search")->check(CLI::PositiveNumber);
    app.add_option("--seed", options.seed, "of the first scene");
    return run_program(app, argc, argv, [&options] {
        std::vector<Row> rows;
        for (unsigned i = 0; i < options.scenes; ++i) {
            const unsigned scene = options.seed + i;
            rows.push_back(measured(random_scene(options, scene), options, scene));
            fmt::print(stderr, "scene {}: by legs {} of the exact order, {} of nearest-first; executed {}, {}\n", scene,
                       ratio(rows.back().legs_chosen, rows.back().legs_exact),
                       ratio(rows.back().legs_chosen, rows.back().legs_nearest),
                       ratio(rows.back().chosen, rows.back().exact), ratio(rows.back().chosen, rows.back().nearest));
        }
        print(rows, options);
    });
}

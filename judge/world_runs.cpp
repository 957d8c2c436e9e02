#include "downwash/judge/world_runs.hpp"

#include <algorithm>
#include <tuple>

#include "downwash/base/parallel.hpp"
#include "downwash/base/quantile.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash::judge {
namespace {

constexpr std::size_t most_worst = 10;

template <class Figure>
std::vector<double> figures_of(const std::vector<WorldRun>& runs, const Figure& figure) {
    std::vector<double> values;
    values.reserve(runs.size());
    for (const WorldRun& run : runs) {
        values.push_back(figure(run));
    }
    return values;
}

std::array<double, 3> upper_quantiles(const std::vector<double>& values) {
    return {quantile(values, 0.5), quantile(values, 0.9), quantile(values, 0.99)};
}

std::vector<WorldRun> worst_of(std::vector<WorldRun> runs) {
    const auto order = [](const WorldRun& run) {
        return std::tuple(run.outcome == Outcome::ok, run.min_clearance_m, run.world);
    };
    const std::size_t count = std::min(most_worst, runs.size());
    std::partial_sort(runs.begin(), runs.begin() + static_cast<std::ptrdiff_t>(count), runs.end(),
                      [&](const WorldRun& a, const WorldRun& b) { return order(a) < order(b); });
    runs.resize(count);
    return runs;
}

}  // namespace

WorldRuns statistics_of(std::vector<WorldRun> runs, const std::vector<DrawnValues>& drawn) {
    WorldRuns result;
    std::vector<bool> has_failed;
    for (const WorldRun& run : runs) {
        has_failed.push_back(run.outcome != Outcome::ok);
        result.failures += has_failed.back() ? 1 : 0;
        result.collisions += run.outcome == Outcome::collision ? 1 : 0;
        result.lateral_collisions += run.is_lateral_collision ? 1 : 0;
    }
    result.collision_probability = probability_of(result.collisions, runs.size());
    result.failure_probability = probability_of(result.failures, runs.size());
    const std::vector<double> clearance = figures_of(runs, [](const WorldRun& r) { return r.min_clearance_m; });
    result.clearance_p01_m = quantile(clearance, 0.01);
    result.clearance_p10_m = quantile(clearance, 0.1);
    result.clearance_p50_m = quantile(clearance, 0.5);
    result.tracking_error_m =
        upper_quantiles(figures_of(runs, [](const WorldRun& r) { return r.max_tracking_error_m; }));
    result.energy_j = upper_quantiles(figures_of(runs, [](const WorldRun& r) { return r.energy_j; }));

    for (const DrawnValues& each : drawn) {
        const std::vector<double>& values = each.of_world;
        if (std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) != values.end()) {
            result.sensitivity.push_back(
                {each.parameter, rank_correlation(values, clearance), share_by_decile(values, has_failed)});
        }
    }
    result.worst = worst_of(runs);
    result.runs = std::move(runs);
    return result;
}

WorldRuns statistics_of(std::vector<WorldRun> runs, const std::vector<World>& worlds, const Problem& problem) {
    const auto rotors = static_cast<int>(problem.robot.rotors.positions_m.size());
    std::vector<DrawnValues> drawn;
    for (const WorldParameter& parameter : world_parameters()) {
        if (parameter.rotor < rotors) {
            DrawnValues& values = drawn.emplace_back(DrawnValues{std::string(parameter.name), {}});
            for (const World& world : worlds) {
                values.of_world.push_back(parameter.of(world));
            }
        }
    }
    return statistics_of(std::move(runs), drawn);
}

std::optional<WorldRuns> fly_in_worlds(const PlanJudge& judge, const Plan& plan, const WorldRunOptions& options) {
    const Problem& problem = judge.problem();
    std::vector<World> worlds;
    for (std::uint64_t i = 1; i <= options.runs; ++i) {
        worlds.push_back(draw_world(*problem.uncertainty, problem.robot, options.seed, i));
    }
    std::vector<WorldRun> runs(worlds.size());
    std::vector<ClearanceTrace> traces(options.fan_step_s > 0 ? worlds.size() : 0);
    run_parallel(
        worlds.size(), options.threads,
        [&](std::size_t i) {
            if (options.stop.stop_requested()) {
                return;
            }
            const JudgedFlight flight = judge.fly(plan, {true, worlds[i]});
            runs[i] = {i + 1,
                       flight.outcome,
                       flight.min_clearance_m,
                       flight.max_tracking_error_m,
                       flight.energy_j,
                       flight.is_lateral_collision};
            if (!traces.empty()) {
                traces[i] = clearance_trace(flight, options.fan_step_s);
            }
        },
        options.on_progress);
    if (options.stop.stop_requested()) {
        return std::nullopt;
    }
    WorldRuns result = statistics_of(std::move(runs), worlds, problem);
    if (!traces.empty()) {
        result.fan = clearance_fan(traces, options.fan_step_s);
    }
    return result;
}

}  // namespace downwash::judge

// What one core does per second on the shipped bridge: ticks, look-ups, collision checks, edges. Compare ratios of one
// run, not figures of different machines or days; see README.md.

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "bridge.hpp"
#include "downwash/aeromap/map_cache.hpp"
#include "downwash/aeromap/volume_map.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/simulation/flight_batch.hpp"
#include "downwash/simulation/flight_loop.hpp"

using namespace downwash;
using bench::Bridge;

namespace {

/// A flight along the slot under the deck, where the surface effect is at work.
const ReferenceSegment& slot_segment() {
    static const ReferenceSegment segment(at_rest({-6, 9.0, -0.6}), at_rest({0, 9.3, -0.2}), 1200, 0.01);
    return segment;
}

FlightState slot_start(const Bridge& bridge) {
    return bridge.model->state_at({-6, 9.0, 0, -0.6});
}

template <class Factor>
void fly_ticks(benchmark::State& state, Factor&& factor) {
    const Bridge& bridge = Bridge::get();
    std::int64_t ticks = 0;
    for ([[maybe_unused]] auto _ : state) {
        FlightState vehicle = slot_start(bridge);
        simulation::fly_ticks(bridge.model->tick(), slot_segment(), factor, dynamics::OneStep{}, vehicle,
                              [](const auto&...) { return Rejection::none; });
        benchmark::DoNotOptimize(vehicle);
        ticks += slot_segment().ticks();
    }
    state.SetItemsProcessed(ticks);
}

void tick_without_effect(benchmark::State& state) {
    fly_ticks(state, simulation::NoEffect{});
}
BENCHMARK(tick_without_effect);

void tick_with_map(benchmark::State& state) {
    const Bridge& bridge = Bridge::get();
    fly_ticks(state, simulation::MapEffect<double>(simulation::rotor_maps(*bridge.model, *bridge.map)));
}
BENCHMARK(tick_with_map);

void tick_with_direct_effect(benchmark::State& state) {
    fly_ticks(state, simulation::DirectFactor{*Bridge::get().model});
}
BENCHMARK(tick_with_direct_effect);

std::vector<PlanarPose> random_queries(const Bounds& bounds) {
    std::mt19937_64 engine(1);
    const auto uniform = [&engine](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    };
    std::vector<PlanarPose> queries(4096);
    for (PlanarPose& q : queries) {
        q = {uniform(bounds.x_low_m, bounds.x_high_m), uniform(bounds.z_low_m, bounds.z_high_m), uniform(-0.2, 0.2),
             uniform(-3, 3)};
    }
    return queries;
}

void map_look_up(benchmark::State& state) {
    const Bridge& bridge = Bridge::get();
    const std::vector<PlanarPose> queries = random_queries(bridge.problem.bounds);
    for ([[maybe_unused]] auto _ : state) {
        for (const PlanarPose& q : queries) {
            benchmark::DoNotOptimize(bridge.map->factor(0, q.x_m, q.z_m));
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(queries.size()));
}
BENCHMARK(map_look_up);

void direct_effect(benchmark::State& state) {
    const Bridge& bridge = Bridge::get();
    const std::vector<PlanarPose> queries = random_queries(bridge.problem.bounds);
    for ([[maybe_unused]] auto _ : state) {
        for (const PlanarPose& q : queries) {
            benchmark::DoNotOptimize(bridge.model->effect(0).factor({q.x_m, 0.32, q.z_m}));
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(queries.size()));
}
BENCHMARK(direct_effect);

void collision_check(benchmark::State& state) {
    const Bridge& bridge = Bridge::get();
    const std::vector<PlanarPose> queries = random_queries(bridge.problem.bounds);
    for ([[maybe_unused]] auto _ : state) {
        for (const PlanarPose& q : queries) {
            benchmark::DoNotOptimize(bridge.model->collisions().is_nearer_than(q, 0.05));
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(queries.size()));
}
BENCHMARK(collision_check);

void clearance(benchmark::State& state) {
    const Bridge& bridge = Bridge::get();
    const std::vector<PlanarPose> queries = random_queries(bridge.problem.bounds);
    for ([[maybe_unused]] auto _ : state) {
        for (const PlanarPose& q : queries) {
            benchmark::DoNotOptimize(bridge.model->collisions().clearance_m(q));
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(queries.size()));
}
BENCHMARK(clearance);

void map_build(benchmark::State& state) {
    const Bridge& bridge = Bridge::get();
    for ([[maybe_unused]] auto _ : state) {
        benchmark::DoNotOptimize(bridge.model->make_map(bridge.problem.bounds));
    }
    state.counters["MB"] = static_cast<double>(bridge.map->memory_bytes()) * 1e-6;
}
BENCHMARK(map_build)->Unit(benchmark::kMillisecond);

/// What map_build costs from the second run on: key, file, digest and sampled values included.
void map_load(benchmark::State& state) {
    const Bridge& bridge = Bridge::get();
    const auto folder = std::filesystem::temp_directory_path() / ("downwash-bench-" + std::to_string(getpid()));
    const MapCache cache(folder);
    cache.keep(*bridge.map);
    for ([[maybe_unused]] auto _ : state) {
        if (!cache.find(bridge.map->layers(), bridge.map->plane(), bridge.map->extent())) {
            state.SkipWithError("the map was not found");
            break;
        }
    }
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
}
BENCHMARK(map_load)->Unit(benchmark::kMillisecond);

/// 30 m3 under the deck: its underside, the walkway's top and edges, the cross girder.
struct UnderDeck {
    Bounds extent{-8, -2, 8, 10};
    double lateral_m = 1.25;  ///< to either side

    [[nodiscard]] VolumeMap map() const {
        const Bridge& bridge = Bridge::get();
        return {std::make_shared<const DirectEffect>(bridge.model->effect(0)), bridge.model->plane(), extent,
                -lateral_m, lateral_m};
    }
};

void volume_build(benchmark::State& state) {
    Bridge::get();
    std::size_t bytes = 0;
    for ([[maybe_unused]] auto _ : state) {
        bytes = UnderDeck().map().memory_bytes();
    }
    state.counters["MB"] = static_cast<double>(bytes) * 1e-6;
}
BENCHMARK(volume_build)->Unit(benchmark::kMillisecond);

void volume_look_up(benchmark::State& state) {
    const UnderDeck block;
    const VolumeMap map = block.map();
    std::mt19937_64 engine(1);
    const auto uniform = [&engine](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    };
    std::vector<Vector3> hubs_m(65536);
    for (Vector3& hub_m : hubs_m) {
        const double x_m = uniform(block.extent.x_low_m, block.extent.x_high_m);
        const double lateral_m = uniform(-block.lateral_m, block.lateral_m);
        hub_m =
            Bridge::get().model->plane().to_world(x_m, lateral_m, uniform(block.extent.z_low_m, block.extent.z_high_m));
    }
    for ([[maybe_unused]] auto _ : state) {
        for (const Vector3& hub_m : hubs_m) {
            benchmark::DoNotOptimize(map.factor(hub_m));
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(hubs_m.size()));
}
BENCHMARK(volume_look_up);

/// Random edges all over the bridge under all rules, side by side.
void batch(benchmark::State& state, bool is_aware, Instructions instructions, int threads) {
    const Bridge& bridge = Bridge::get();
    FlightRules rules;
    rules.bounds = bridge.problem.bounds;
    FlightPool pool(*bridge.model, is_aware ? bridge.map.get() : nullptr, rules, nullptr, threads, instructions);
    const double tick_s = bridge.model->tick().tick_s;
    std::vector<FlightJob> edges;
    const std::vector<PlanarPose> from = random_queries(bridge.problem.bounds);
    for (std::size_t i = 0; edges.size() < 512; ++i) {
        const Configuration at{from[i].x_m, from[i].z_m, from[i].arm_rad};
        if (!bridge.model->collisions().is_nearer_than(level_at(at), rules.margin_m)) {
            const Configuration to{at.x_m + 20 * from[i].pitch_rad, at.z_m, at.arm_rad + 0.5};
            edges.push_back({bridge.model->state_at(level_at(at)), {{{at_rest(at), at_rest(to), 800, tick_s}}}});
        }
    }
    std::int64_t ticks = 0;
    for ([[maybe_unused]] auto _ : state) {
        std::vector<FlightJob> jobs = edges;
        pool.fly(jobs);
        for (const FlightJob& job : jobs) {
            ticks += job.legs[0].flight.ticks;
        }
    }
    state.SetItemsProcessed(ticks);
}

/// With every set of instructions that there is here, and with two threads.
[[maybe_unused]] const bool batches_are_registered = [] {
    constexpr const char* names[] = {"baseline", "avx2", "avx512"};
    for (const bool is_aware : {false, true}) {
        const std::string variant = is_aware ? "aerodynamics_aware" : "dynamics_aware";
        for (const Instructions instructions : known_instructions()) {
            const std::string name = "batch/" + variant + '_' + names[static_cast<int>(instructions)];
            benchmark::RegisterBenchmark(name.c_str(), batch, is_aware, instructions, 1);
        }
        benchmark::RegisterBenchmark(("batch/" + variant + "_two_threads").c_str(), batch, is_aware,
                                     best_instructions(), 2)
            ->UseRealTime();
    }
    return true;
}();

/// Edges that whole searches of three seeds fly, up to the same iteration whatever the number of threads. Several at
/// once share nothing but the map: what processors give to one search with as many threads can hardly be more.
void search(benchmark::State& state, std::uint64_t iterations, int threads, std::size_t at_once) {
    const Bridge& bridge = Bridge::get();
    SolveOptions how;
    how.threads = threads;
    how.map = bridge.map;
    std::atomic<std::int64_t> edges = 0;
    for ([[maybe_unused]] auto _ : state) {
        for (const std::uint32_t seed : {1U, 2U, 3U}) {
            Problem problem = bridge.problem;
            problem.planner.seed = seed;
            problem.planner.max_iterations = iterations;
            problem.planner.time_limit_s.reset();
            run_parallel(at_once, static_cast<int>(at_once), [&](std::size_t /*search*/) {
                edges += static_cast<std::int64_t>(solve(problem, how).planning.edges_simulated);
            });
        }
    }
    state.SetItemsProcessed(edges);
}

/// What one thread does in some ten seconds, as long as a search lasts unless told otherwise, and in the first few.
[[maybe_unused]] const bool searches_are_registered = [] {
    constexpr std::uint64_t whole = 15'000;
    constexpr std::uint64_t first_seconds = 4'000;
    const auto add = [](const char* name, std::uint64_t iterations, int threads, std::size_t at_once) {
        benchmark::RegisterBenchmark(name, search, iterations, threads, at_once)
            ->UseRealTime()
            ->Unit(benchmark::kMillisecond)
            ->Repetitions(3);
    };
    add("search/one_thread", whole, 1, 1);
    add("search/two_threads", whole, 2, 1);
    add("search/two_at_once", whole, 1, 2);
    add("search/first_seconds_one_thread", first_seconds, 1, 1);
    add("search/first_seconds_two_threads", first_seconds, 2, 1);
    return true;
}();

/// A whole edge of 6 m through the slot under all rules: ticks, map, flyable area, collisions.
void edge(benchmark::State& state, bool is_aware) {
    const Bridge& bridge = Bridge::get();
    FlightRules rules;
    rules.bounds = bridge.problem.bounds;
    std::int64_t ticks = 0;
    for ([[maybe_unused]] auto _ : state) {
        FlightState vehicle = slot_start(bridge);
        const SegmentFlight flight =
            fly(*bridge.model, is_aware ? bridge.map.get() : nullptr, rules, slot_segment(), vehicle);
        if (flight.rejection != Rejection::none) {
            state.SkipWithError("the edge was rejected");
            break;
        }
        ticks += flight.ticks;
    }
    state.SetItemsProcessed(state.iterations());
    state.counters["ticks"] = benchmark::Counter(static_cast<double>(ticks), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(edge, dynamics_aware, false);
BENCHMARK_CAPTURE(edge, aerodynamics_aware, true);

}  // namespace

// Work per second of one core on the shipped bridge: ticks, look-ups, collision checks, edges. Compare ratios of one
// run, not figures of different machines or days; see README.md. bench_aero_map measures maps and volumes.

#include <benchmark/benchmark.h>

#include <atomic>
#include <string>
#include <vector>

#include "../../tests/support/random.hpp"
#include "bridge.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/simulation/direct_field.hpp"
#include "downwash/simulation/flight_batch.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "downwash/simulation/map_effect.hpp"
#include "downwash/simulation/world_parameters.hpp"

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

template <class Field>
void fly_ticks(benchmark::State& state, const Field& field) {
    const Bridge& bridge = Bridge::get();
    simulation::FlightEffectOf effect{field};
    const simulation::FlightLoop loop(bridge.model->tick(), nullptr, effect);
    std::int64_t ticks = 0;
    for ([[maybe_unused]] auto _ : state) {
        FlightState vehicle = slot_start(bridge);
        loop.fly(0, slot_segment(), vehicle, [](const auto&...) { return Rejection::none; });
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
    const simulation::RotorMaps maps = simulation::rotor_maps(*bridge.model, *bridge.map);
    fly_ticks(state, simulation::MapEffect<double>(maps));
}
BENCHMARK(tick_with_map);

void tick_with_direct_effect(benchmark::State& state) {
    fly_ticks(state, simulation::DirectField(*Bridge::get().model));
}
BENCHMARK(tick_with_direct_effect);

std::vector<PlanarPose> random_queries(const Bounds& bounds) {
    test::Random random(1);
    std::vector<PlanarPose> queries(4096);
    for (PlanarPose& q : queries) {
        q = {random.uniform(bounds.x_low_m, bounds.x_high_m), random.uniform(bounds.z_low_m, bounds.z_high_m),
             random.uniform(-0.2, 0.2), random.uniform(-3, 3)};
    }
    return queries;
}

/// One query of something, at random poses within the bounds.
template <class Ask>
void each_query(benchmark::State& state, const Ask& ask) {
    const std::vector<PlanarPose> queries = random_queries(Bridge::get().problem.bounds);
    for ([[maybe_unused]] auto _ : state) {
        for (const PlanarPose& q : queries) {
            benchmark::DoNotOptimize(ask(q));
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(queries.size()));
}

void map_look_up(benchmark::State& state) {
    each_query(state, [&map = *Bridge::get().map](const PlanarPose& q) { return map.factor(0, q.x_m, q.z_m); });
}
BENCHMARK(map_look_up);

void direct_effect(benchmark::State& state) {
    each_query(state, [&effect = Bridge::get().model->effect(0)](const PlanarPose& q) {
        return effect.factor({q.x_m, 0.32, q.z_m});
    });
}
BENCHMARK(direct_effect);

void collision_check(benchmark::State& state) {
    each_query(state, [&collisions = Bridge::get().model->collisions()](const PlanarPose& q) {
        return collisions.is_nearer_than(q, 0.05);
    });
}
BENCHMARK(collision_check);

void clearance(benchmark::State& state) {
    each_query(state, [&collisions = Bridge::get().model->collisions()](const PlanarPose& q) {
        return collisions.clearance_m(q);
    });
}
BENCHMARK(clearance);

/// What the planner's own model knows.
enum class Model : std::uint8_t { dynamics, aerodynamics, worlds };

/// Control laws for the bridge's vehicle; the first is that of its file.
struct Flown {
    const char* name;
    bool is_cascaded, observes, reads;
    bool is_in_wash = false;  ///< its arm turns below its front and its rear rotor, and feels them
};
constexpr Flown laws[] = {{"of_the_file", false, false, false},
                          {"observer", false, true, false},
                          {"feed_forward", false, false, true},
                          {"observer_and_feed_forward", false, true, true},
                          {"cascaded", true, false, false},
                          {"cascaded_observer", true, true, false},
                          {"cascaded_feed_forward", true, false, true},
                          {"cascaded_both", true, true, true}};

constexpr Flown in_wash{"in_the_wash", false, false, false, true};

/// The vehicle with such a law.
std::shared_ptr<const FlightModel> model_with(const Flown& flown) {
    Problem problem = Bridge::get().problem;
    if (flown.is_cascaded) {
        CascadedPid law;
        law.rotor_lead = 1;
        problem.robot.controller.law = law;
    }
    std::visit(
        [&](auto& law) {
            if (flown.observes) {
                law.aids.observer.emplace();
            }
            if (flown.reads) {
                law.aids.feed_forward.emplace();
            }
        },
        problem.robot.controller.law);
    if (flown.is_in_wash) {
        problem.robot.rotors.positions_m = {{0.45, 0, 0.06}, {-0.45, 0, 0.06}, {0, 0.45, 0.06}, {0, -0.45, 0.06}};
        problem.robot.arm.wash.emplace();
    }
    return make_flight_model(problem);
}

/// Random edges all over the bridge under all rules, side by side; those in worlds each in one of its own, with noise
/// and gusts.
void batch(benchmark::State& state, Model model, Instructions instructions, int threads, const Flown& flown) {
    const Bridge& bridge = Bridge::get();
    const std::shared_ptr<const FlightModel> vehicle = model_with(flown);
    FlightRules rules;
    rules.bounds = bridge.problem.bounds;
    const AeroMap* const map = model == Model::dynamics ? nullptr : bridge.map.get();
    FlightPool pool(*vehicle, map, rules, nullptr, threads, instructions);
    std::vector<FlownWorld> worlds;
    for (std::uint64_t i = 1; i <= 512; ++i) {
        worlds.push_back(make_world(bridge.problem.robot, draw_world(Uncertainty{}, bridge.problem.robot, 1, i)));
    }
    const double tick_s = vehicle->tick().tick_s;
    std::vector<FlightJob> edges;
    const std::vector<PlanarPose> from = random_queries(bridge.problem.bounds);
    for (std::size_t i = 0; edges.size() < 512; ++i) {
        const Configuration at{from[i].x_m, from[i].z_m, from[i].arm_rad};
        if (!vehicle->collisions().is_nearer_than(level_at(at), rules.margin_m)) {
            const Configuration to{at[plane::x] + 20 * from[i].pitch_rad, at[plane::z], at[plane::arm] + 0.5};
            edges.push_back({vehicle->state_at(level_at(at)), {{{at_rest(at), at_rest(to), 800, tick_s}}}});
            if (model == Model::worlds) {
                FlightJob& edge = edges.back();
                edge.world = &worlds[edges.size() - 1];
                edge.start.world = memory_at_start(*edge.world, edge.start.plant);
            }
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
    for (const Model model : {Model::dynamics, Model::aerodynamics, Model::worlds}) {
        const std::string variant = model == Model::dynamics       ? "dynamics_aware"
                                    : model == Model::aerodynamics ? "aerodynamics_aware"
                                                                   : "in_worlds";
        for (const Instructions instructions : known_instructions()) {
            const std::string name = "batch/" + variant + '_' + names[static_cast<int>(instructions)];
            benchmark::RegisterBenchmark(name.c_str(), batch, model, instructions, 1, laws[0]);
        }
        benchmark::RegisterBenchmark(("batch/" + variant + "_two_threads").c_str(), batch, model, best_instructions(),
                                     2, laws[0])
            ->UseRealTime();
    }
    benchmark::RegisterBenchmark("batch/dynamics_aware_in_the_wash", batch, Model::dynamics, best_instructions(), 1,
                                 in_wash);
    for (const Flown& flown : laws) {
        benchmark::RegisterBenchmark((std::string("law/") + flown.name).c_str(), batch, Model::aerodynamics,
                                     best_instructions(), 1, flown);
    }
    return true;
}();

/// Edges that whole searches of three seeds fly in the nominal world, up to the same iteration whatever the number of
/// threads. Several at once share nothing but the map: what processors give to one search with as many threads can
/// hardly be more.
void search(benchmark::State& state, std::uint64_t iterations, int threads, std::size_t at_once) {
    const Bridge& bridge = Bridge::get();
    SolveOptions how;
    how.threads = threads;
    how.map = bridge.map;
    std::atomic<std::int64_t> edges = 0;
    for ([[maybe_unused]] auto _ : state) {
        for (const std::uint32_t seed : {1U, 2U, 3U}) {
            Problem problem = bridge.problem;
            problem.uncertainty.reset();
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

/// How soon searches end that have a time limit of 0.1 s: of every algorithm, and one whose edges are flights of
/// minutes.
void limited_search(benchmark::State& state, const Problem& problem) {
    for ([[maybe_unused]] auto _ : state) {
        benchmark::DoNotOptimize(solve(problem).planning.iterations);
    }
    state.SetItemsProcessed(state.iterations());
}

[[maybe_unused]] const bool limited_searches_are_registered = [] {
    const auto add = [](const std::string& name, Problem problem) {
        problem.planner.time_limit_s = 0.1;
        problem.planner.max_iterations.reset();
        benchmark::RegisterBenchmark(("limited_search/" + name).c_str(), limited_search, std::move(problem))
            ->UseRealTime()
            ->Unit(benchmark::kMillisecond);
    };
    Problem problem = read_problem(DOWNWASH_PROBLEMS "/open_air.yaml");
    for (const AlgorithmInfo& algorithm : algorithms()) {
        problem.planner.algorithm = algorithm.name;
        problem.planner.variant = algorithm.plans_flights ? Variant::mp_arm_da : Variant::mp_arm;
        add(std::string(algorithm.name), problem);
    }
    problem.planner.algorithm = "rrt-star";
    problem.planner.variant = Variant::mp_arm_da;
    problem.motion.max_speed_m_s = 0.01;
    problem.robot.controller.rate_hz = 500;
    problem.robot.controller.delay_s = 1 / problem.robot.controller.rate_hz;  // short, as at 100 Hz
    add("long_flights", problem);
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

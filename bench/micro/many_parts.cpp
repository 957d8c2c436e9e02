// Direct evaluation of K, and flights with it, where many triangles or boxes stand over the rotors. Each scene lies
// over the same field; compare with the few boxes of the same run.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../../tests/support/random.hpp"
#include "bridge.hpp"
#include "downwash/simulation/execution.hpp"

using namespace downwash;
using bench::Bridge;

namespace {

constexpr double field_m = 40;
constexpr double deck_m = 10;  ///< height of what lies over the rotors

Obstacle ground() {
    return {"ground", Box{{120, 120, 1}}, {0, 0, -0.5}, {}};
}

/// A sheet of about so many triangles over the field, with bumps up and down.
std::vector<Obstacle> deck_of(std::int64_t triangles, double bumps_m) {
    test::Random random(1);
    const auto cells = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(triangles) / 2)));
    auto sheet = std::make_shared<TriangleMesh>();
    for (std::uint32_t j = 0; j <= cells; ++j) {
        for (std::uint32_t i = 0; i <= cells; ++i) {
            sheet->vertices_m.push_back({field_m * (i / static_cast<double>(cells) - 0.5),
                                         field_m * (j / static_cast<double>(cells) - 0.5),
                                         deck_m + (bumps_m > 0 ? random.uniform(-bumps_m, bumps_m) : 0)});
        }
    }
    for (std::uint32_t j = 0; j < cells; ++j) {
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t a = j * (cells + 1) + i;
            const std::uint32_t d = a + cells + 1;
            sheet->triangles.push_back({a, d + 1, a + 1});
            sheet->triangles.push_back({a, d, d + 1});
        }
    }
    return {ground(), {"deck", Mesh{"", 1, std::move(sheet)}, {}, {}}};
}

/// Boxes at random over the field, with undersides up to 1.5 m above the height of the deck: of equal number per area,
/// so that more are smaller.
std::vector<Obstacle> boxes_of(std::int64_t count) {
    test::Random random(1);
    std::vector<Obstacle> all{ground()};
    const double side_m = 0.5 * field_m / std::sqrt(static_cast<double>(count));
    for (std::int64_t i = 1; i < count; ++i) {
        const double height_m = random.uniform(0.2, 1);
        all.push_back({"box",
                       Box{{side_m, side_m, height_m}},
                       {random.uniform(-0.5, 0.5) * field_m, random.uniform(-0.5, 0.5) * field_m,
                        deck_m + random.uniform(0, 1.5) + 0.5 * height_m},
                       {}});
    }
    return all;
}

enum Kind : std::uint8_t { few_boxes, boxes, flat_deck, rough_deck };

std::vector<Obstacle> obstacles_of(std::int64_t kind, std::int64_t parts) {
    switch (kind) {
        case few_boxes:
            return {ground(),
                    {"deck", Box{{20, 8, 1}}, {-8, 0, deck_m + 0.5}, {}},
                    {"girder", Box{{30, 0.4, 0.6}}, {0, 0.9, deck_m - 0.3}, {}},
                    {"pier", Box{{1.5, 4, 10}}, {6, 0, 5}, {}}};
        case boxes:
            return boxes_of(parts);
        default:
            return deck_of(parts, kind == rough_deck ? 0.3 : 0);
    }
}

/// The robot of the bridge among obstacles. The last scene is kept.
const FlightModel& model_in(std::int64_t kind, std::int64_t parts) {
    static std::pair<std::int64_t, std::int64_t> of{-1, -1};
    static std::shared_ptr<const FlightModel> model;
    if (of != std::pair(kind, parts)) {
        Problem problem = Bridge::get().problem;
        problem.obstacles = obstacles_of(kind, parts);
        model = make_flight_model(problem);
        of = {kind, parts};
    }
    return *model;
}

/// @param state its ranges: kind, parts, distance of the rotors from the height of the deck in centimetres
double rotor_height_m(const benchmark::State& state) {
    return deck_m - 0.01 * static_cast<double>(state.range(2));
}

void direct_effect_under_many_parts(benchmark::State& state) {
    const FlightModel& model = model_in(state.range(0), state.range(1));
    const double z = rotor_height_m(state);
    test::Random random(1);
    std::vector<double> x(512);
    std::generate(x.begin(), x.end(), [&] { return random.uniform(-6, 0); });
    for ([[maybe_unused]] auto _ : state) {
        for (const double at : x) {
            benchmark::DoNotOptimize(model.direct_factor(0, at, z));
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(x.size()));
}

/// A straight flight of 6 m in 12 s and a hover, as plans are executed.
void direct_flight_under_many_parts(benchmark::State& state) {
    const FlightModel& model = model_in(state.range(0), state.range(1));
    const double z = rotor_height_m(state) - 0.06;
    constexpr double arm_rad = 1.5;  // hangs down
    Goal goal;
    goal.kind = ConfigurationGoal{0, z, {}, 0.5};
    goal.hold_s = 2;
    const std::vector<ReferenceKnot> knots{{0, at_rest({-6, z, arm_rad})}, {1200, at_rest({0, z, arm_rad})}};
    const FlightState start = model.state_at({-6, z, 0, arm_rad});
    for ([[maybe_unused]] auto _ : state) {
        const Execution execution = execute(model, start, knots, goal, true);
        if (execution.rows.size() < 1300) {
            state.SkipWithError(std::string(name_of(execution.outcome)).c_str());
        }
    }
    state.SetItemsProcessed(state.iterations() * 1400);
}

void scenes(benchmark::internal::Benchmark* of) {
    of->ArgNames({"kind", "parts", "cm"});
    for (const std::int64_t cm : {60, 300}) {
        of->Args({few_boxes, 4, cm});
        for (const std::int64_t count : {1000, 10000, 100000}) {
            of->Args({boxes, count, cm});
        }
        for (const std::int64_t kind : {flat_deck, rough_deck}) {
            for (const std::int64_t count : {968, 10082, 100352, 999698}) {
                of->Args({kind, count, cm});
            }
        }
    }
    of->Unit(benchmark::kMillisecond);
}
BENCHMARK(direct_effect_under_many_parts)->Apply(scenes);
BENCHMARK(direct_flight_under_many_parts)->Apply(scenes);

}  // namespace

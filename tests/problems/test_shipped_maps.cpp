#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "../support/hard_places.hpp"
#include "../support/random.hpp"
#include "downwash/aeromap/volume_map.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"

using namespace downwash;

namespace {

/// Those with surface effects, in the order of their files.
std::vector<Problem> shipped_problems() {
    std::set<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(DOWNWASH_PROBLEMS)) {
        if (entry.path().extension() == ".yaml") {
            files.insert(entry.path());
        }
    }
    std::vector<Problem> problems;
    for (const auto& file : files) {
        problems.push_back(read_problem(file));
    }
    std::erase_if(problems, [](const Problem& problem) { return !problem.aero.enabled; });
    return problems;
}

std::size_t any_layer(test::Random& random, const AeroMap& map) {
    return static_cast<std::size_t>(random.integer(0, static_cast<int>(map.layers().size()) - 1));
}

Vector3 any_hub(test::Random& random, const AeroMap& map, std::size_t layer) {
    const double x_m = random.uniform(map.extent().x_low_m, map.extent().x_high_m);
    const double z_m = random.uniform(map.extent().z_low_m, map.extent().z_high_m);
    return map.plane().to_world(x_m, map.layers()[layer].lateral_m, z_m);
}

/// A flyable hub in the plane where the effect is felt.
std::optional<Vector3> felt_hub(const FlightModel& model, const Bounds& bounds) {
    test::Random random(5);
    for (int tries = 0; tries < 20000; ++tries) {
        const double x_m = random.uniform(bounds.x_low_m, bounds.x_high_m);
        const Vector3 hub_m = model.plane().to_world(x_m, 0, random.uniform(bounds.z_low_m, bounds.z_high_m));
        if (model.effect(0).factor(hub_m) > 1.15 && model.effect(0).is_flyable(hub_m)) {
            return hub_m;
        }
    }
    return std::nullopt;
}

}  // namespace

TEST_CASE("The map of every shipped problem is within 0.01 of the direct effect wherever one may fly") {
    const auto problems = shipped_problems();
    REQUIRE(problems.size() >= 5);
    for (const Problem& problem : problems) {
        const auto map = make_flight_model(problem)->make_whole_map(problem.bounds, 2);
        const Bounds& extent = map->extent();
        test::MapComparison found{*map};
        test::Random random(17);
        for (int tries = 0; found.points < 20000 && tries < 4000000; ++tries) {
            const double x = random.uniform(extent.x_low_m, extent.x_high_m);
            const double z = random.uniform(extent.z_low_m, extent.z_high_m);
            const std::size_t layer = any_layer(random, *map);
            // Nine points of ten where the effect is felt.
            if (tries % 10 == 0 || std::abs(map->factor(layer, x, z) - 1) >= 0.02) {
                found.look(layer, x, z);
            }
        }
        CAPTURE(problem.name, found.worst, map->memory_bytes());
        CHECK(found.points == 20000);
        CHECK(found.worst <= 0.01);
        CHECK(map->memory_bytes() < 64U << 20U);
    }
}

TEST_CASE("The map of every shipped problem is within 0.01 near edges of shadows and at the least clearance") {
    int hard_problems = 0;
    for (const Problem& problem : shipped_problems()) {
        const auto map = make_flight_model(problem)->make_whole_map(problem.bounds, 2);
        test::MapComparison found{*map};
        test::Random random(18);
        int near_edges = 0;
        int at_rims = 0;
        for (int tries = 0; near_edges < 4000 && tries < 40000; ++tries) {
            const std::size_t layer = any_layer(random, *map);
            const Vector3 at = map->plane().from_world(test::near_shadow_edge(random, *map->layers()[layer].effect));
            near_edges += found.look(layer, at[0], at[2]) ? 1 : 0;
        }
        for (int tries = 0; at_rims < 500 && tries < 40000; ++tries) {
            const std::size_t layer = any_layer(random, *map);
            const Vector3 from_m = any_hub(random, *map, layer);
            const Vector3 to_m = any_hub(random, *map, layer);
            if (const auto rim_m = test::at_rim(*map->layers()[layer].effect, from_m, to_m)) {
                const Vector3 at = map->plane().from_world(*rim_m);
                at_rims += found.look(layer, at[0], at[2]) ? 1 : 0;
            }
        }
        CAPTURE(problem.name, found.worst, near_edges, at_rims);
        CHECK(found.worst <= 0.01);
        hard_problems += near_edges == 4000 && at_rims == 500 ? 1 : 0;
    }
    CHECK(hard_problems >= 5);  // in open air there is nothing near
}

TEST_CASE("A volume in every shipped problem without meshes is within 0.01 of the direct effect") {
    int problems = 0;
    for (const Problem& problem : shipped_problems()) {
        const auto model = make_flight_model(problem);
        const Scene& scene = model->effect(0).scene();
        const auto effect = std::make_shared<const DirectEffect>(model->effect(0));
        const auto center_m = felt_hub(*model, problem.bounds);
        if (scene.part_count() > scene.primitive_count() || !center_m) {
            continue;
        }
        const PlaneOfMotion frame(*center_m, model->plane().heading_rad() + 0.1);
        const VolumeMap map(effect, frame, {-0.4, 0.4, -0.4, 0.4}, -0.3, 0.3);
        test::Random random(19);
        double worst = 0;
        int points = 0;
        for (int tries = 0; tries < 40000; ++tries) {
            const Vector3 hub_m = tries % 2 == 0 ? frame.to_world(random.uniform(-0.4, 0.4), random.uniform(-0.3, 0.3),
                                                                  random.uniform(-0.4, 0.4))
                                                 : test::near_shadow_edge(random, *effect);
            const Vector3 at = frame.from_world(hub_m);
            if (std::abs(at[0]) <= 0.4 && std::abs(at[1]) <= 0.3 && std::abs(at[2]) <= 0.4 &&
                effect->is_flyable(hub_m)) {
                worst = std::max(worst, std::abs(map.factor(hub_m) - effect->factor(hub_m)));
                ++points;
            }
        }
        CAPTURE(problem.name, worst, map.polynomials());
        CHECK(points > 2000);
        CHECK(map.polynomials() > 0);
        CHECK(worst <= 0.01);
        ++problems;
    }
    CHECK(problems >= 4);
}

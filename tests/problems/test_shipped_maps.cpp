#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "../support/hard_places.hpp"
#include "../support/random.hpp"
#include "downwash/aeromap/volume_map.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"

using namespace downwash;

namespace {

std::vector<std::filesystem::path> shipped_problems() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(DOWNWASH_PROBLEMS)) {
        if (entry.path().extension() == ".yaml") {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// Map against direct evaluation at hubs in a layer.
struct Comparison {
    const AeroMap& map;
    double worst = 0;

    /// @return whether the hub counts: it is within the map and flyable
    bool look(std::size_t layer, double x_m, double z_m) {
        const Bounds& extent = map.extent();
        if (x_m < extent.x_low_m || x_m > extent.x_high_m || z_m < extent.z_low_m || z_m > extent.z_high_m ||
            !map.is_flyable(layer, x_m, z_m)) {
            return false;
        }
        const MapLayer& from = map.layers()[layer];
        const double direct = from.effect->factor(map.plane().to_world(x_m, from.lateral_m, z_m));
        worst = std::max(worst, std::abs(map.factor(layer, x_m, z_m) - direct));
        return true;
    }
};

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
    const auto files = shipped_problems();
    REQUIRE(files.size() >= 5);
    for (const auto& file : files) {
        const Problem problem = read_problem(file);
        if (!problem.aero.enabled) {
            continue;
        }
        const auto model = make_flight_model(problem);
        const auto map = model->make_map(problem.bounds, 2);
        const Bounds& extent = map->extent();
        Comparison found{*map};
        test::Random random(17);
        int points = 0;
        for (int tries = 0; points < 20000 && tries < 4000000; ++tries) {
            const double x = random.uniform(extent.x_low_m, extent.x_high_m);
            const double z = random.uniform(extent.z_low_m, extent.z_high_m);
            const auto layer = static_cast<std::size_t>(random.integer(0, static_cast<int>(map->layers().size()) - 1));
            // Nine points of ten where the effect is felt.
            if (tries % 10 != 0 && std::abs(map->factor(layer, x, z) - 1) < 0.02) {
                continue;
            }
            points += found.look(layer, x, z) ? 1 : 0;
        }
        CAPTURE(file.string(), found.worst, map->memory_bytes());
        CHECK(points == 20000);
        CHECK(found.worst <= 0.01);
        CHECK(map->memory_bytes() < 64U << 20U);
    }
}

TEST_CASE("The map of every shipped problem is within 0.01 near edges of shadows and at the least clearance") {
    int hard_problems = 0;
    for (const auto& file : shipped_problems()) {
        const Problem problem = read_problem(file);
        if (!problem.aero.enabled) {
            continue;
        }
        const auto model = make_flight_model(problem);
        const auto map = model->make_map(problem.bounds, 2);
        Comparison found{*map};
        test::Random random(18);
        int near_edges = 0;
        int at_rims = 0;
        const int layers = static_cast<int>(map->layers().size());
        for (int tries = 0; near_edges < 4000 && tries < 40000; ++tries) {
            const auto layer = static_cast<std::size_t>(random.integer(0, layers - 1));
            const Vector3 at = map->plane().from_world(test::near_shadow_edge(random, *map->layers()[layer].effect));
            near_edges += found.look(layer, at[0], at[2]) ? 1 : 0;
        }
        for (int tries = 0; at_rims < 500 && tries < 40000; ++tries) {
            const auto layer = static_cast<std::size_t>(random.integer(0, layers - 1));
            const Vector3 from_m = any_hub(random, *map, layer);
            const Vector3 to_m = any_hub(random, *map, layer);
            if (const auto rim_m = test::at_rim(*map->layers()[layer].effect, from_m, to_m)) {
                const Vector3 at = map->plane().from_world(*rim_m);
                at_rims += found.look(layer, at[0], at[2]) ? 1 : 0;
            }
        }
        CAPTURE(file.string(), found.worst, near_edges, at_rims);
        CHECK(found.worst <= 0.01);
        hard_problems += near_edges == 4000 && at_rims == 500 ? 1 : 0;
    }
    CHECK(hard_problems >= 5);  // in open air there is nothing near
}

TEST_CASE("A volume in every shipped problem without meshes is within 0.01 of the direct effect") {
    int problems = 0;
    for (const auto& file : shipped_problems()) {
        const Problem problem = read_problem(file);
        const auto model = make_flight_model(problem);
        const Scene& scene = model->effect(0).scene();
        if (!problem.aero.enabled || scene.part_count() > scene.primitive_count()) {
            continue;
        }
        const auto effect = std::make_shared<const DirectEffect>(model->effect(0));
        const auto center_m = felt_hub(*model, problem.bounds);
        if (!center_m) {
            continue;
        }
        const PlaneOfMotion frame(*center_m, model->plane().heading_rad() + 0.1);
        const VolumeMap map(effect, frame, {-0.4, 0.4, -0.4, 0.4}, -0.3, 0.3, 2);
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
        CAPTURE(file.string(), worst, map.polynomials());
        CHECK(points > 2000);
        CHECK(map.polynomials() > 0);
        CHECK(worst <= 0.01);
        ++problems;
    }
    CHECK(problems >= 4);
}

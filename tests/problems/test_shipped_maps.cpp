#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <vector>

#include "../support/random.hpp"
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
        const MapExtent& extent = map->extent();
        test::Random random(17);
        double worst = 0;
        int points = 0;
        for (int tries = 0; points < 20000 && tries < 4000000; ++tries) {
            const double x = random.uniform(extent.x_low_m, extent.x_high_m);
            const double z = random.uniform(extent.z_low_m, extent.z_high_m);
            const auto layer = static_cast<std::size_t>(random.integer(0, static_cast<int>(map->layers().size()) - 1));
            // Nine points of ten where the effect is felt.
            if (tries % 10 != 0 && std::abs(map->factor(layer, x, z) - 1) < 0.02) {
                continue;
            }
            if (map->is_flyable(layer, x, z)) {
                const MapLayer& from = map->layers()[layer];
                const double direct = from.effect->factor(map->plane().to_world(x, from.lateral_m, z));
                worst = std::max(worst, std::abs(map->factor(layer, x, z) - direct));
                ++points;
            }
        }
        CAPTURE(file.string(), worst, map->memory_bytes());
        CHECK(points == 20000);
        CHECK(worst <= 0.01);
        CHECK(map->memory_bytes() < 64U << 20U);
    }
}

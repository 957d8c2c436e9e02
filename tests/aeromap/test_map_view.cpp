#include <catch2/catch.hpp>
#include <cmath>

#include "scenes.hpp"

using namespace downwash;

namespace {

/// A part of the bridge: cells of one patch, of many, and ones that nobody may fly in.
const AeroMap& map_at_a_girder() {
    static const AeroMap map(test::layers(test::effect_in(test::bridge(), 0.19), {0.1}), {}, {-6, 6, 0, 8});
    return map;
}

bool is_same_patch(const MapPatch& a, const MapPatch& b) {
    return a.u == b.u && a.w == b.w && a.steps_x == b.steps_x && a.steps_z == b.steps_z;
}

/// Exact: the share of a place in the patch is, and that of any other place falls outside [0, 1) however it is rounded.
bool is_in_patch(double s, double t) {
    return s >= 0 && s < 1 && t >= 0 && t < 1;
}

}  // namespace

TEST_CASE("A patch gives K and the flyability of the map to the last bit") {
    const AeroMap& map = map_at_a_girder();
    const MapView& view = map.view(0);
    test::Random random(1);
    int refined = 0;
    for (int n = 0; n < 20000; ++n) {
        const double x_m = random.uniform(-6, 6);
        const double z_m = random.uniform(0, 8);
        const double u = (x_m - view.x_low_m) * view.cells_per_m;
        const double w = (z_m - view.z_low_m) * view.cells_per_m;
        REQUIRE(view.contains(u, w));
        const MapPatch patch = patch_at(view, u, w);
        const double s = (u - patch.u) * patch.steps_x;
        const double t = (w - patch.w) * patch.steps_z;
        REQUIRE(is_in_patch(s, t));
        REQUIRE(bilinear(patch.corner, s, t) == map.factor(0, x_m, z_m));
        if (patch.flyability != CellFlyability::mixed) {
            REQUIRE((patch.flyability == CellFlyability::flyable) == map.is_flyable(0, x_m, z_m));
        }
        refined += patch.steps_x > 1 ? 1 : 0;
    }
    CHECK(refined > 100);
}

TEST_CASE("A place is in a patch exactly when it is the patch around the place, on the borders too") {
    const MapView& view = map_at_a_girder().view(0);
    test::Random random(2);
    int inside = 0, outside = 0;
    for (int n = 0; n < 20000; ++n) {
        const MapPatch patch = patch_at(view, random.uniform(1, view.columns - 1), random.uniform(1, view.rows - 1));
        // Corners, next to them, and anywhere around.
        const auto beside = [&random](double low, double size) {
            const double place = low + size * random.integer(0, 1);
            switch (random.integer(0, 3)) {
                case 0:
                    return place;
                case 1:
                    return std::nextafter(place, 0);
                case 2:
                    return std::nextafter(place, 1e9);
                default:
                    return low + size * random.uniform(-1, 2);
            }
        };
        const double u = beside(patch.u, 1 / patch.steps_x);
        const double w = beside(patch.w, 1 / patch.steps_z);
        REQUIRE(view.contains(u, w));
        const bool is_in = is_in_patch((u - patch.u) * patch.steps_x, (w - patch.w) * patch.steps_z);
        REQUIRE(is_in == is_same_patch(patch, patch_at(view, u, w)));
        ++(is_in ? inside : outside);
    }
    CHECK(inside > 4000);
    CHECK(outside > 4000);
}

TEST_CASE("No place is in no patch, and places outside the map have none") {
    const MapView& view = map_at_a_girder().view(0);
    for (const double u : {0.0, 17.5, -HUGE_VAL, std::nan("")}) {
        CHECK_FALSE(is_in_patch((u - no_patch.u) * no_patch.steps_x, (u - no_patch.w) * no_patch.steps_z));
    }
    CHECK(view.contains(0, 0));
    CHECK_FALSE(view.contains(-1e-300, 0));
    CHECK_FALSE(view.contains(view.columns, 0));
    CHECK_FALSE(view.contains(0, view.rows));
    CHECK_FALSE(view.contains(std::nan(""), 1));
    CHECK_FALSE(view.contains(1, HUGE_VAL));
}

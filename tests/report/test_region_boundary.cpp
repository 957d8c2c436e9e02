#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/report/region_boundary.hpp"
#include "pictures.hpp"

using namespace downwash;

TEST_CASE("the boundary of a disc is one closed line on its circle") {
    const auto lines =
        region_boundary([](double x, double z) { return std::hypot(x - 0.1, z + 0.2) < 1; }, {-2, 2, -2, 2}, 60, 50);
    REQUIRE(lines.size() == 1);
    for (const PlanePoint& p : lines[0]) {
        CHECK(std::hypot(p.x_m - 0.1, p.z_m + 0.2) == Approx(1).margin(2e-4));
    }
    CHECK(lines[0].front().x_m == lines[0].back().x_m);
    CHECK(lines[0].front().z_m == lines[0].back().z_m);
    CHECK(std::abs(test::area_of(lines[0])) == Approx(3.14159265).epsilon(0.01));
}

TEST_CASE("a hole is a line of its own, and one that meets the rim of the extent is open") {
    const auto ring = region_boundary(
        [](double x, double z) { return std::hypot(x, z) < 1.5 && std::hypot(x, z) > 0.5; }, {-2, 2, -2, 2}, 40, 40);
    CHECK(ring.size() == 2);
    const auto slope = region_boundary([](double x, double z) { return z < 0.3 * x; }, {-2, 2, -2, 2}, 40, 40);
    REQUIRE(slope.size() == 1);
    CHECK(std::min(slope[0].front().x_m, slope[0].back().x_m) == Approx(-2));
    CHECK(std::max(slope[0].front().x_m, slope[0].back().x_m) == Approx(2));
    for (const PlanePoint& p : slope[0]) {
        CHECK(p.z_m == Approx(0.3 * p.x_m).margin(2e-4));
    }
}

TEST_CASE("regions that touch at a corner of the grid are kept apart, and none is lost") {
    // A chequerboard whose fields are two cells: every field is a ring of its own.
    const auto lines = region_boundary(
        [](double x, double z) { return (static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(z))) % 2 == 0; },
        {0.25, 4.25, 0.25, 4.25}, 8, 8);
    std::size_t points = 0;
    for (const auto& line : lines) {
        points += line.size();
    }
    CHECK(points > 40);
    CHECK(region_boundary([](double, double) { return true; }, {0, 1, 0, 1}, 5, 5).empty());
    CHECK(region_boundary([](double, double) { return false; }, {0, 1, 0, 1}, 5, 5).empty());
}

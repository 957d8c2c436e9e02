#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "../support/random.hpp"
#include "downwash/report/field_figure.hpp"
#include "downwash/report/planar_geometry.hpp"
#include "pictures.hpp"

using namespace downwash;
using downwash::test::area_of;

namespace {

/// The square of column i and row k among squares of a side, turned by an angle about the origin.
Ring square(int i, int k, double side_m, double angle_rad) {
    Ring ring;
    for (const auto& [di, dk] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
        const double x = (i + di) * side_m, z = (k + dk) * side_m;
        ring.push_back(
            {x * std::cos(angle_rad) - z * std::sin(angle_rad), x * std::sin(angle_rad) + z * std::cos(angle_rad)});
    }
    return ring;
}

}  // namespace

TEST_CASE("squares side by side become one outline, and a gap among them a hole") {
    std::vector<Ring> squares;
    for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 3; ++i) {
            if (i != 1 || k != 1) {
                squares.push_back(square(i, k, 0.1, 0.3));
            }
        }
    }
    auto joined = joined_rings(squares);
    REQUIRE(joined.size() == 2);
    std::sort(joined.begin(), joined.end(), [](const Ring& a, const Ring& b) { return area_of(a) < area_of(b); });
    CHECK(joined[0].size() == 4);
    CHECK(area_of(joined[0]) == Approx(-0.01));
    CHECK(joined[1].size() == 4);
    CHECK(area_of(joined[1]) == Approx(0.09));
    CHECK(joined_rings({}).empty());
}

TEST_CASE("joined outlines hold the area of their squares, however these lie") {
    test::Random random(11);
    for (int pattern = 0; pattern < 300; ++pattern) {
        const double angle_rad = random.uniform(-3, 3), side_m = random.uniform(0.02, 0.5);
        std::vector<Ring> squares;
        for (int k = 0; k < 12; ++k) {
            for (int i = 0; i < 12; ++i) {
                if (random.integer(0, 2) > 0) {
                    squares.push_back(square(i - 6, k, side_m, angle_rad));
                }
            }
        }
        double area = 0;
        std::size_t corners = 0;
        for (const Ring& ring : joined_rings(squares)) {
            area += area_of(ring);
            corners += ring.size();
        }
        CHECK(area == Approx(static_cast<double>(squares.size()) * side_m * side_m));
        CHECK(corners < 3 * squares.size());
    }
}

TEST_CASE("the picture of a scan with many cubes in the plane stays small") {
    OccupancyTree wall{0.02, {}};
    OccupancyTree sponge{0.02, {}};
    test::Random random(5);
    for (int i = 0; i < 200; ++i) {
        for (int k = 0; k < 200; ++k) {
            wall.cubes.push_back({{0.02 * i, 0.001, 0.02 * k}, 0.02});
            if (random.integer(0, 1) == 1) {
                sponge.cubes.push_back({{0.02 * i, 0.001, 5 + 0.02 * k}, 0.02});
            }
        }
    }
    const Scene scene({{"wall", Octomap{"", std::make_shared<const OccupancyTree>(wall)}, {}, {}},
                       {"sponge", Octomap{"", std::make_shared<const OccupancyTree>(sponge)}, {}, {}}});
    const auto outlines = obstacle_outlines(scene, PlaneOfMotion(), 0);
    REQUIRE(outlines.size() == 2);
    CHECK(outlines[0].rings.size() == 1);
    CHECK(outlines[0].rings[0].size() == 4);

    FieldFigure figure;
    figure.extent = {-200, 200, -100, 100};  // 0.33 m a pixel
    figure.scale = factor_scale("K [1]", {1, 2});
    figure.value = [](double, double) { return 1.0; };
    figure.obstacles = outlines;
    CHECK(draw(figure, {PictureFormat::svg, 1200}).size() < 100'000);
    figure.extent = {-1, 6, -1, 10};
    CHECK(draw(figure, {PictureFormat::svg, 1200}).size() < 3'000'000);
}

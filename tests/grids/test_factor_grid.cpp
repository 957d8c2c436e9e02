#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "../support/error_of.hpp"
#include "downwash/grids/factor_grid.hpp"
#include "grids.hpp"

using namespace downwash;
using test::two_by_two;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::string error_of(const FactorGridParts& parts) {
    return test::error_of([&] { return FactorGrid(parts); });
}

}  // namespace

TEST_CASE("a planar grid interpolates linearly in x and z of its frame at any lateral distance") {
    const FactorGrid grid(two_by_two());
    CHECK(grid.is_planar());
    CHECK(grid.nodes() == 4);
    CHECK(grid.factor({0, 0, 0}) == 1);
    CHECK(grid.factor({1, 0, 0}) == 2);
    CHECK(grid.factor({1, 0, 2}) == 22);
    CHECK(grid.factor({0.25, -3, 1.5}) == Approx(1.25 + 15).epsilon(1e-15));
    // Placed by a frame x of the grid runs along the world's y.
    FactorGridParts parts = two_by_two();
    parts.frame = PlaneOfMotion({10, 20, 30}, std::acos(0.0));
    parts.x = {5, 6, 2};
    const FactorGrid placed(parts);
    CHECK(placed.contains({10, 25.5, 31}));
    CHECK(placed.factor({10, 25.5, 31}) == Approx(11.5).epsilon(1e-12));
    CHECK_FALSE(placed.contains({15.5, 20, 31}));
}

TEST_CASE("a volume interpolates a trilinear function exactly") {
    test::Random random(3);
    FactorGridParts parts;
    parts.frame = PlaneOfMotion({1, 2, 3}, 0.4);
    parts.x = {-1, 2, 4};
    parts.y = {0, 3, 3};
    parts.z = {5, 6, 5};
    const auto k = [](double x, double y, double z) { return 20 + x - 2 * y + 0.5 * z + x * y - 0.3 * x * y * z; };
    GridField factor{"factor", {}};
    for (std::size_t n = 0; n < 5 * 3 * 4; ++n) {  // x runs first, then y
        factor.values.push_back(k(parts.x.at(n % 4), parts.y.at(n / 4 % 3), parts.z.at(n / 12)));
    }
    parts.fields.push_back(factor);
    const FactorGrid grid(parts);
    for (int i = 0; i < 2000; ++i) {
        const double x = random.uniform(-1, 2);
        const double y = random.uniform(0, 3);
        const double z = random.uniform(5, 6);
        CHECK(grid.factor(parts.frame.to_world(x, y, z)) == Approx(k(x, y, z)).epsilon(1e-12));
    }
    CHECK_FALSE(grid.contains(parts.frame.to_world(0, 3.1, 5.5)));
}

TEST_CASE("nothing is extrapolated: outside a grid K is not a number") {
    const FactorGrid grid(two_by_two());
    for (const Vector3& outside : {Vector3{-1e-6, 0, 1},
                                   {1 + 1e-6, 0, 1},
                                   {0.5, 0, -1e-6},
                                   {0.5, 0, 2 + 1e-6},
                                   {not_a_number, 0, 1},
                                   {0.5, 0, not_a_number},
                                   {0.5, not_a_number, 1},
                                   {0.5, infinity, 1},
                                   {infinity, 0, 1}}) {
        CHECK_FALSE(grid.contains(outside));
        CHECK(std::isnan(grid.factor(outside)));
    }
    CHECK(grid.factor({1 + 1e-12, 0, 2 + 1e-12}) == 22);  // rounding of a position on the edge
}

TEST_CASE("layers hold at their lateral offsets only") {
    FactorGridParts parts = two_by_two();
    parts.lateral_offsets_m = {-0.25, 0.25};
    parts.fields[0].values = {1, 2, 21, 22, 5, 5, 5, 5};
    const FactorGrid grid(parts);
    CHECK(grid.layers() == 2);
    CHECK(grid.factor({0.5, -0.25, 0}) == 1.5);
    CHECK(grid.factor({0.5, 0.25, 0}) == 5);
    CHECK_FALSE(grid.contains({0.5, 0, 0}));
    CHECK_FALSE(grid.contains({0.5, 0.2502, 0}));
}

TEST_CASE("what is no grid is an error of its part") {
    using Change = void (*)(FactorGridParts&);
    const std::vector<std::pair<Change, std::string>> cases{
        {[](FactorGridParts& p) {
             p.x = GridAxis{1, 0, 2};
         },
         "x: runs from 1 to 0 m: expected the lower end first"},
        {[](FactorGridParts& p) {
             p.x = GridAxis{0, 1e7, 2};
         },
         "x: runs from 0 to 10000000 m: expected finite coordinates, at most 1e6 m"},
        {[](FactorGridParts& p) { p.z.high_m = not_a_number; },
         "z: runs from 0 to nan m: expected finite coordinates, at most 1e6 m"},
        {[](FactorGridParts& p) {
             p.y = GridAxis{1, 1, 1};
         },
         "y: of a planar grid is 0: expected the frame's origin in its plane"},
        {[](FactorGridParts& p) { p.fields[0].values[3] = not_a_number; },
         "factor: value 4 of 4 is nan: expected a finite factor from 0 to 100"},
        {[](FactorGridParts& p) { p.fields[0].values[1] = 100.1; },
         "factor: value 2 of 4 is 100.1: expected a finite factor from 0 to 100"},
        {[](FactorGridParts& p) { p.fields[0].values[0] = -0.1; },
         "factor: value 1 of 4 is -0.1: expected a finite factor from 0 to 100"},
        {[](FactorGridParts& p) { p.fields[0].values.pop_back(); }, "factor: has 3 values: expected 4, one per node"},
        {[](FactorGridParts& p) { p.fields[0].name = "ground"; }, "factor: is missing"},
        {[](FactorGridParts& p) { p.fields.push_back(p.fields[0]); }, "factor: occurs twice"},
        {[](FactorGridParts& p) {
             p.fields.push_back({"flyable", {0, 1, 0.5, 1}});
         },
         "flyable: value 3 of 4 is 0.5: expected 0 or 1"},
        {[](FactorGridParts& p) {
             p.fields.push_back({"speed", {0, 1, 0, 1}});
         },
         "fields: 'speed' is no field: expected factor, ground, ceiling or flyable"},
        {[](FactorGridParts& p) { p.lateral_offsets_m = {not_a_number}; },
         "lateral_offsets_m: expected finite distances, at most 1e6 m"},
        {[](FactorGridParts& p) { p.x.count = std::size_t{1} << 40U; },
         "the grid has more than 2^24 nodes: expected a larger step or a smaller extent"},
        {[](FactorGridParts& p) { p.x.count = p.z.count = std::size_t{1} << 14U; },
         "the grid has more than 2^24 nodes: expected a larger step or a smaller extent"},
        {[](FactorGridParts& p) {
             p.provenance = {{"a", "two\nlines"}};
         },
         "provenance: a: expected one line of text without blanks around it"},
        {[](FactorGridParts& p) {
             p.provenance = {{"a: b", "c"}};
         },
         "provenance: key 'a: b': expected a short name without ': ', line break or blanks around it that does not "
         "begin with frame_"},
    };
    for (const auto& [change, message] : cases) {
        FactorGridParts parts = two_by_two();
        change(parts);
        CHECK(error_of(parts) == message);
    }
    FactorGridParts twice = two_by_two();
    twice.lateral_offsets_m = {0.5, 0.5};
    twice.fields[0].values.resize(8, 1);
    CHECK(error_of(twice) == "lateral_offsets_m: expected rising distances, more than 2e-6 m apart");
    CHECK(error_of(two_by_two()) == "none");
}

TEST_CASE("one may fly where all corners of the cell are flagged") {
    FactorGridParts parts = two_by_two();
    parts.x = {0, 3, 4};
    parts.fields = {{"factor", std::vector<double>(8, 1)}, {"flyable", {1, 1, 1, 0, 1, 1, 1, 1}}};
    const FactorGrid grid(parts);
    CHECK(grid.is_flyable({0.1, 5, 0.1}));
    CHECK(grid.is_flyable({1.9, 0, 1.9}));
    CHECK_FALSE(grid.is_flyable({2.1, 0, 1.9}));
    CHECK_FALSE(grid.is_flyable({3.1, 0, 1}));
    CHECK_FALSE(grid.is_flyable({not_a_number, 0, 1}));
    parts.fields.pop_back();
    CHECK(FactorGrid(parts).is_flyable({2.1, 0, 1.9}));
    CHECK_FALSE(FactorGrid(parts).is_flyable({3.1, 0, 1}));
}

TEST_CASE("where one may fly between corners one may fly at every place between them") {
    test::Random random(31);
    int flyable = 0;
    for (int n = 0; n < 3000; ++n) {
        FactorGridParts parts = two_by_two();
        parts.frame = PlaneOfMotion({1, 2, 3}, random.uniform(-4, 4));
        parts.x = {0, 1, 6};
        parts.z = {0, 1, 5};
        if (n % 2 == 0) {
            parts.y = {0, 1, 4};
        } else {
            parts.lateral_offsets_m = {0.25, 0.5};
        }
        const std::size_t nodes = parts.x.count * parts.z.count * (n % 2 == 0 ? 4 : 2);
        parts.fields = {{"factor", std::vector<double>(nodes, 1)}, {"flyable", std::vector<double>(nodes, 1)}};
        parts.fields[1].values[static_cast<std::size_t>(random.integer(0, static_cast<int>(nodes) - 1))] = 0;
        const FactorGrid grid(parts);
        const double y = n % 2 == 0 ? random.uniform(0, 1) : 0.25 * random.integer(1, 2);
        const double x = random.uniform(0, 1);
        const double z = random.uniform(0, 1);
        const double side = random.uniform(0, 0.5);
        const auto at = [&](double s, double t) { return grid.frame().to_world(x + s * side, y, z + t * side); };
        const std::vector<Vector3> corners{at(0, 0), at(1, 0), at(0, 1), at(1, 1)};
        if (grid.is_flyable_between(corners)) {
            ++flyable;
            for (int i = 0; i < 20; ++i) {
                REQUIRE(grid.is_flyable(at(random.uniform(0, 1), random.uniform(0, 1))));
            }
        }
    }
    CHECK(flyable > 300);
    CHECK_FALSE(FactorGrid(two_by_two()).is_flyable_between({}));
}

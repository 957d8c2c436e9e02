#include <catch2/catch.hpp>
#include <cstddef>
#include <vector>

#include "../support/random.hpp"
#include "downwash/base/grid_contour.hpp"

using namespace downwash;

namespace {

using Sides = std::vector<std::vector<int>>;  // rows from below

std::vector<std::vector<GridEdge>> contour_of(const Sides& sides) {
    return grid_contour(sides.front().size(), sides.size(),
                        [&](std::size_t column, std::size_t row) { return sides[row][column]; });
}

bool is_same(const GridEdge& a, const GridEdge& b) {
    return a.column == b.column && a.row == b.row && a.is_upright == b.is_upright;
}

}  // namespace

TEST_CASE("a contour around one node is closed, one across the grid has two ends") {
    const auto around = contour_of({{-1, -1, -1}, {-1, 1, -1}, {-1, -1, -1}});
    REQUIRE(around.size() == 1);
    CHECK(around[0].size() == 5);
    CHECK(is_same(around[0].front(), around[0].back()));

    const auto across = contour_of({{-1, -1, -1}, {1, 1, 1}, {1, 1, 1}});
    REQUIRE(across.size() == 1);
    REQUIRE(across[0].size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(across[0][i].row == 0);
        CHECK(across[0][i].is_upright);
    }
    CHECK(contour_of({{1, 1}, {1, 1}}).empty());
    CHECK(contour_of({{-1, -1}, {0, 1}}).empty());
    CHECK(contour_of({{1}}).empty());
    const auto chess = contour_of({{1, -1}, {-1, 1}});  // two corners cut off
    REQUIRE(chess.size() == 2);
    CHECK(chess[0].size() == 2);
}

TEST_CASE("contours cross every edge between two sides once, unless a node on no side is near") {
    test::Random random(4);
    for (int grid = 0; grid < 200; ++grid) {
        Sides sides(7, std::vector<int>(9));
        for (auto& row : sides) {
            for (int& side : row) {
                side = random.integer(0, 9) == 0 ? 0 : random.integer(0, 1) * 2 - 1;
            }
        }
        // Cells without a side-less corner, counted by hand.
        const auto is_whole = [&](std::size_t column, std::size_t row) {
            return column < 8 && row < 6 && sides[row][column] * sides[row][column + 1] != 0 &&
                   sides[row + 1][column] * sides[row + 1][column + 1] != 0;
        };
        std::size_t expected = 0;
        for (std::size_t row = 0; row < 7; ++row) {
            for (std::size_t column = 0; column < 9; ++column) {
                if (column < 8 && sides[row][column] * sides[row][column + 1] < 0 &&
                    (is_whole(column, row) || (row > 0 && is_whole(column, row - 1)))) {
                    ++expected;
                }
                if (row < 6 && sides[row][column] * sides[row + 1][column] < 0 &&
                    (is_whole(column, row) || (column > 0 && is_whole(column - 1, row)))) {
                    ++expected;
                }
            }
        }
        std::size_t crossed = 0;
        for (const auto& line : contour_of(sides)) {
            const bool is_closed = line.size() > 2 && is_same(line.front(), line.back());
            crossed += line.size() - (is_closed ? 1 : 0);
            for (const auto& edge : line) {
                const int to = edge.is_upright ? sides[edge.row + 1][edge.column] : sides[edge.row][edge.column + 1];
                CHECK(sides[edge.row][edge.column] * to < 0);
            }
        }
        CHECK(crossed == expected);
    }
}

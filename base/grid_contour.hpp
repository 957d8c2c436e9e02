#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// An edge of a grid between the nodes (column, row) and (column + 1, row), or (column, row + 1) when it is upright.
struct GridEdge {
    std::size_t column, row;
    bool is_upright;
};

/// The lines that part the nodes of a grid into two sides, as the edges that they cross (marching squares). A cell with
/// a node on no side is not crossed. Where two sides meet like on a chess board, high nodes stay together.
/// @param side callable (column, row) -> below 0: low, above 0: high, 0: on no side
/// @return lines in a fixed order; a closed one ends with the edge that it began with
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::vector<GridEdge>> grid_contour(
    std::size_t columns, std::size_t rows, const std::function<int(std::size_t, std::size_t)>& side);

}  // namespace downwash

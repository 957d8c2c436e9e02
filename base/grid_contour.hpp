#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// An edge of a grid from the node (column, row) to (column + 1, row), or to (column, row + 1) if it is upright.
struct GridEdge {
    std::size_t column, row;
    bool is_upright;
};

/// The lines that separate the nodes of a grid into two sides, as the edges that they cross (marching squares). No line
/// crosses a cell that has a node on no side. Where two sides meet as on a chess board, high nodes stay connected.
/// @param side callable (column, row) -> below 0: low, above 0: high, 0: on no side
/// @return lines in a fixed order; a closed line ends with the edge that it begins with
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::vector<GridEdge>> grid_contour(
    std::size_t columns, std::size_t rows, const std::function<int(std::size_t, std::size_t)>& side);

}  // namespace downwash

#pragma once

// Private to aeromap.

#include <cstdint>
#include <cstring>
#include <vector>

#include "downwash/aeromap/map_view.hpp"

namespace downwash {

/// A block with the memory of its values.
struct OwnedBlock : MapBlock {
    OwnedBlock() : MapBlock{} {
        for (std::uint32_t cell = 0; cell < cell_count; ++cell) {
            cells[cell] = {0, 1, 1};
            flyability[cell] = CellFlyability::forbidden;
            sides[cell] = CellSides::below;
        }
    }
    OwnedBlock(const OwnedBlock&) = delete;
    OwnedBlock& operator=(const OwnedBlock&) = delete;

    /// Ends the filling: the values are those of look-ups from now on, and must not change.
    void seal() {
        values.shrink_to_fit();
        nodes = values.data();
        nodes_size = static_cast<std::uint32_t>(values.size());
    }

    std::vector<float> values;
};

/// Whether look-ups find the same in both.
[[nodiscard]] inline bool operator==(const MapBlock& a, const MapBlock& b) {
    return a.nodes_size == b.nodes_size && std::memcmp(a.cells, b.cells, sizeof a.cells) == 0 &&
           std::memcmp(a.flyability, b.flyability, sizeof a.flyability) == 0 &&
           std::memcmp(a.sides, b.sides, sizeof a.sides) == 0 &&
           std::memcmp(a.nodes, b.nodes, a.nodes_size * sizeof(float)) == 0;
}

}  // namespace downwash

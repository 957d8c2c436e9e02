#include "downwash/base/grid_contour.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace downwash {
namespace {

using Side = std::function<int(std::size_t, std::size_t)>;

constexpr std::size_t nothing = static_cast<std::size_t>(-1);

/// The crossed edges, each joined to one more in either of the two cells beside it.
class Chains {
 public:
    Chains(std::size_t columns, std::size_t rows)
        : columns_(columns), joined_(2 * columns * rows, {nothing, nothing}) {}

    void add_cell(std::size_t column, std::size_t row, const Side& side) {
        // Corners counterclockwise from the lower left; edge i leads from corner i to the next.
        const std::array<int, 4> corners = {side(column, row), side(column + 1, row), side(column + 1, row + 1),
                                            side(column, row + 1)};
        if (std::find(corners.begin(), corners.end(), 0) != corners.end()) {
            return;
        }
        const std::array<std::size_t, 4> edges = {id(column, row, false), id(column + 1, row, true),
                                                  id(column, row + 1, false), id(column, row, true)};
        std::array<std::size_t, 4> crossed{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            if ((corners[i] > 0) != (corners[(i + 1) % 4] > 0)) {
                crossed[count++] = edges[i];
            }
        }
        if (count == 4 && corners[0] > 0) {  // cut off corners 1 and 3
            join(edges[0], edges[1]);
            join(edges[2], edges[3]);
        } else if (count == 4) {  // cut off corners 0 and 2
            join(edges[3], edges[0]);
            join(edges[1], edges[2]);
        } else if (count == 2) {
            join(crossed[0], crossed[1]);
        }
    }

    /// Takes out every chain: first those with ends, then the closed ones.
    std::vector<std::vector<GridEdge>> lines() {
        std::vector<std::vector<GridEdge>> lines;
        for (const bool wants_end : {true, false}) {
            for (std::size_t edge = 0; edge < joined_.size(); ++edge) {
                const bool is_end = (joined_[edge][0] == nothing) != (joined_[edge][1] == nothing);
                if (wants_end ? is_end : joined_[edge][0] != nothing) {
                    lines.push_back(taken_from(edge));
                }
            }
        }
        return lines;
    }

 private:
    [[nodiscard]] std::size_t id(std::size_t column, std::size_t row, bool is_upright) const {
        return 2 * (row * columns_ + column) + (is_upright ? 1 : 0);
    }
    [[nodiscard]] GridEdge edge_of(std::size_t id) const { return {id / 2 % columns_, id / 2 / columns_, id % 2 == 1}; }

    void join(std::size_t a, std::size_t b) {
        joined_[a][joined_[a][0] == nothing ? 0 : 1] = b;
        joined_[b][joined_[b][0] == nothing ? 0 : 1] = a;
    }
    /// Cuts the link between two edges, seen from the first.
    void cut(std::size_t from, std::size_t to) {
        auto& links = joined_[from];
        if (links[0] == to) {
            links[0] = links[1];
        }
        links[1] = nothing;
    }

    std::vector<GridEdge> taken_from(std::size_t edge) {
        std::vector<GridEdge> line = {edge_of(edge)};
        for (std::size_t next = joined_[edge][0]; next != nothing; next = joined_[edge][0]) {
            cut(edge, next);
            cut(next, edge);
            edge = next;
            line.push_back(edge_of(edge));
        }
        return line;
    }

    std::size_t columns_;
    std::vector<std::array<std::size_t, 2>> joined_;
};

}  // namespace

std::vector<std::vector<GridEdge>> grid_contour(std::size_t columns, std::size_t rows, const Side& side) {
    Chains chains(columns, rows);
    for (std::size_t row = 0; row + 1 < rows; ++row) {
        for (std::size_t column = 0; column + 1 < columns; ++column) {
            chains.add_cell(column, row, side);
        }
    }
    return chains.lines();
}

}  // namespace downwash

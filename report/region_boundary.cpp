#include "downwash/report/region_boundary.hpp"

#include <array>
#include <map>
#include <utility>

#include "downwash/report/chains.hpp"

namespace downwash {
namespace {

class Grid {
 public:
    Grid(const std::function<bool(double, double)>& contains, const MapExtent& extent, std::size_t columns,
         std::size_t rows)
        : contains_(contains), extent_(extent), columns_(columns), rows_(rows), inside_((columns + 1) * (rows + 1)) {
        for (std::size_t node = 0; node < inside_.size(); ++node) {
            const PlanePoint p = point(node);
            inside_[node] = contains(p.x_m, p.z_m);
        }
    }

    [[nodiscard]] std::size_t node(std::size_t column, std::size_t row) const { return row * (columns_ + 1) + column; }
    [[nodiscard]] bool is_inside(std::size_t node) const { return inside_[node]; }

    [[nodiscard]] PlanePoint point(std::size_t node) const {
        const auto part = [](std::size_t i, std::size_t n) { return static_cast<double>(i) / static_cast<double>(n); };
        const double s = part(node % (columns_ + 1), columns_), t = part(node / (columns_ + 1), rows_);
        return {(1 - s) * extent_.x_low_m + s * extent_.x_high_m, (1 - t) * extent_.z_low_m + t * extent_.z_high_m};
    }

    /// Where between two nodes, one inside, the region ends.
    [[nodiscard]] PlanePoint crossing(std::size_t inside, std::size_t outside) const {
        constexpr int halvings = 10;
        PlanePoint in = point(inside), out = point(outside);
        for (int i = 0; i < halvings; ++i) {
            const PlanePoint middle{(in.x_m + out.x_m) / 2, (in.z_m + out.z_m) / 2};
            (contains_(middle.x_m, middle.z_m) ? in : out) = middle;
        }
        return {(in.x_m + out.x_m) / 2, (in.z_m + out.z_m) / 2};
    }

 private:
    const std::function<bool(double, double)>& contains_;
    MapExtent extent_;
    std::size_t columns_, rows_;
    std::vector<bool> inside_;
};

/// The side of a cell by the node inside and the node outside.
using Side = std::pair<std::size_t, std::size_t>;

/// From the side where the boundary enters a cell to the one where it leaves. A side has one cell on its left and one
/// on its right, so that no two begin at the same one.
using Steps = std::map<Side, Side>;

/// Adds what crosses one cell. Walking around it counter-clockwise, the boundary leaves where one goes into the region
/// and enters where one comes out of it. Two corners across, inside, are taken as apart.
void add_cell(const Grid& grid, const std::array<std::size_t, 4>& corners, Steps& steps) {
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t before = corners[(i + 3) % 4];
        if (!grid.is_inside(corners[i]) || grid.is_inside(before)) {
            continue;
        }
        std::size_t last = i;  // the last corner inside of this stretch
        while (grid.is_inside(corners[(last + 1) % 4])) {
            last = (last + 1) % 4;
        }
        steps.emplace(Side{corners[last], corners[(last + 1) % 4]}, Side{corners[i], before});
    }
}

}  // namespace

std::vector<std::vector<PlanePoint>> region_boundary(const std::function<bool(double, double)>& contains,
                                                     const MapExtent& extent, std::size_t columns, std::size_t rows) {
    const Grid grid(contains, extent, columns, rows);
    Steps steps;
    for (std::size_t k = 0; k < rows; ++k) {
        for (std::size_t i = 0; i < columns; ++i) {
            add_cell(grid, {grid.node(i, k), grid.node(i + 1, k), grid.node(i + 1, k + 1), grid.node(i, k + 1)}, steps);
        }
    }
    std::vector<std::vector<PlanePoint>> lines;
    for (const auto& sides : take_chains(steps)) {
        auto& line = lines.emplace_back();
        for (const auto& [inside, outside] : sides) {
            line.push_back(grid.crossing(inside, outside));
        }
    }
    return lines;
}

}  // namespace downwash

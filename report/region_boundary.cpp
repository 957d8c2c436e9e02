#include "downwash/report/region_boundary.hpp"

#include "downwash/base/grid_contour.hpp"

namespace downwash {
namespace {

class Grid {
 public:
    Grid(const std::function<bool(double, double)>& contains, const Bounds& extent, std::size_t columns,
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
    Bounds extent_;
    std::size_t columns_, rows_;
    std::vector<bool> inside_;
};

}  // namespace

std::vector<std::vector<PlanePoint>> region_boundary(const std::function<bool(double, double)>& contains,
                                                     const Bounds& extent, std::size_t columns, std::size_t rows) {
    const Grid grid(contains, extent, columns, rows);
    // Inside counts as the low side: two fields of a region that meet at a corner only are taken as apart.
    const auto side = [&grid](std::size_t column, std::size_t row) {
        return grid.is_inside(grid.node(column, row)) ? -1 : 1;
    };
    std::vector<std::vector<PlanePoint>> lines;
    for (const auto& edges : grid_contour(columns + 1, rows + 1, side)) {
        auto& line = lines.emplace_back();
        for (const GridEdge& edge : edges) {
            const std::size_t from = grid.node(edge.column, edge.row);
            const std::size_t to =
                edge.is_upright ? grid.node(edge.column, edge.row + 1) : grid.node(edge.column + 1, edge.row);
            line.push_back(grid.is_inside(from) ? grid.crossing(from, to) : grid.crossing(to, from));
        }
    }
    return lines;
}

}  // namespace downwash

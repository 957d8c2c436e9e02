#include "downwash/report/region_boundary.hpp"

#include <utility>

#include "downwash/base/grid_contour.hpp"

namespace downwash {

std::vector<Ring> region_boundary(const std::function<bool(double, double)>& contains, const Bounds& extent,
                                  std::size_t columns, std::size_t rows) {
    const auto point = [&](std::size_t column, std::size_t row) -> PlanePoint {
        const auto part = [](std::size_t i, std::size_t n) { return static_cast<double>(i) / static_cast<double>(n); };
        const double s = part(column, columns), t = part(row, rows);
        return {(1 - s) * extent.x_low_m + s * extent.x_high_m, (1 - t) * extent.z_low_m + t * extent.z_high_m};
    };
    std::vector<bool> inside;
    for (std::size_t row = 0; row <= rows; ++row) {
        for (std::size_t column = 0; column <= columns; ++column) {
            const PlanePoint p = point(column, row);
            inside.push_back(contains(p.x_m, p.z_m));
        }
    }
    const auto is_inside = [&](std::size_t column, std::size_t row) { return inside[row * (columns + 1) + column]; };
    const auto middle_of = [](const PlanePoint& a, const PlanePoint& b) {
        return PlanePoint{(a.x_m + b.x_m) / 2, (a.z_m + b.z_m) / 2};
    };
    // Inside counts as the low side: two parts of a region that meet only at a corner are separate.
    const auto side = [&](std::size_t column, std::size_t row) { return is_inside(column, row) ? -1 : 1; };
    std::vector<Ring> lines;
    for (const auto& edges : grid_contour(columns + 1, rows + 1, side)) {
        Ring& line = lines.emplace_back();
        for (const GridEdge& edge : edges) {
            PlanePoint in = point(edge.column, edge.row);
            PlanePoint out = point(edge.column + (edge.is_upright ? 0 : 1), edge.row + (edge.is_upright ? 1 : 0));
            if (!is_inside(edge.column, edge.row)) {
                std::swap(in, out);
            }
            constexpr int halvings = 10;
            for (int i = 0; i < halvings; ++i) {
                const PlanePoint middle = middle_of(in, out);
                (contains(middle.x_m, middle.z_m) ? in : out) = middle;
            }
            line.push_back(middle_of(in, out));
        }
    }
    return lines;
}

}  // namespace downwash

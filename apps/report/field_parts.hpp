#pragma once

// Private: not installed.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/report/field.hpp"
#include "downwash/report/legend.hpp"

namespace downwash {

/// The layout of a picture of a field, in pixels from its lower left corner.
struct FieldLayout {
    double left, right, bottom, top;  ///< edges of the axes
    double height;                    ///< height of the picture
    double legend_top;
    double room;  ///< available width for the axes
    double bar_bottom;

    [[nodiscard]] double width() const { return right - left; }
};

/// @throws InputError when the extent cannot be drawn to scale
void require_drawable(const Bounds& extent);

[[nodiscard]] DOWNWASH_EXPORT FieldLayout layout_of(const FieldFigure& figure, int picture_width_px,
                                                    const Legend& legend);

/// Values at regular points, row by row from the lower left, as positions on the colour bar.
struct FieldSamples {
    std::size_t columns = 0, rows = 0;
    double x_m = 0, z_m = 0;    ///< place of the first point
    double dx_m = 0, dz_m = 0;  ///< between points
    std::vector<float> places;  ///< NaN where the field is not defined

    /// The data source for gnuplot's plot that reads them from the script, or for splot.
    [[nodiscard]] std::string source(bool is_surface = false) const;
};

/// In the middles of columns x rows cells of the extent, or in the corners between them.
[[nodiscard]] FieldSamples sampled(const FieldFigure& figure, std::size_t columns, std::size_t rows, bool at_corners,
                                   int threads);

/// The dash of lines as after `with lines`; empty for solid ones.
[[nodiscard]] std::string_view dash_of(LineDash dash);

}  // namespace downwash

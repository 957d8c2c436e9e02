#pragma once

// Private: not installed.

#include <cstddef>
#include <string>
#include <vector>

#include "downwash/report/field_figure.hpp"

namespace downwash {

/// Values at regular points, row by row from the lower left, as places on the colour bar.
struct FieldSamples {
    std::size_t columns = 0, rows = 0;
    double x_m = 0, z_m = 0;    ///< of the first point
    double dx_m = 0, dz_m = 0;  ///< between points
    std::vector<float> places;  ///< NaN where the field is not defined

    /// What tells gnuplot's plot to read them from the script, and the same for splot.
    [[nodiscard]] std::string source() const;
    [[nodiscard]] std::string surface_source() const;
};

/// In the middles of columns x rows cells of the extent, or in the corners between them.
[[nodiscard]] FieldSamples sampled(const FieldFigure& figure, std::size_t columns, std::size_t rows, bool at_corners);

}  // namespace downwash

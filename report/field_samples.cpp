#include "downwash/report/field_samples.hpp"

#include <fmt/core.h>

namespace downwash {

std::string FieldSamples::source() const {
    return fmt::format("'-' binary array=({},{}) origin=({},{}) dx={} dy={} format='%float' using 1", columns, rows,
                       x_m, z_m, dx_m, dz_m);
}

std::string FieldSamples::surface_source() const {
    return fmt::format("'-' binary array=({},{}) origin=({},{},0) dx={} dy={} format='%float' using 1", columns, rows,
                       x_m, z_m, dx_m, dz_m);
}

FieldSamples sampled(const FieldFigure& figure, std::size_t columns, std::size_t rows, bool at_corners) {
    FieldSamples samples;
    const Bounds& extent = figure.extent;
    samples.dx_m = (extent.x_high_m - extent.x_low_m) / static_cast<double>(columns);
    samples.dz_m = (extent.z_high_m - extent.z_low_m) / static_cast<double>(rows);
    samples.columns = columns + (at_corners ? 1 : 0);
    samples.rows = rows + (at_corners ? 1 : 0);
    samples.x_m = extent.x_low_m + (at_corners ? 0 : samples.dx_m / 2);
    samples.z_m = extent.z_low_m + (at_corners ? 0 : samples.dz_m / 2);
    samples.places.reserve(samples.columns * samples.rows);
    for (std::size_t k = 0; k < samples.rows; ++k) {
        const double z_m = samples.z_m + static_cast<double>(k) * samples.dz_m;
        for (std::size_t i = 0; i < samples.columns; ++i) {
            const double x_m = samples.x_m + static_cast<double>(i) * samples.dx_m;
            samples.places.push_back(static_cast<float>(position_on(figure.scale, figure.value(x_m, z_m))));
        }
    }
    return samples;
}

}  // namespace downwash

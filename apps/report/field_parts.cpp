#include "downwash/report/field_parts.hpp"

#include <fmt/core.h>

#include <cmath>
#include <string>

#include "downwash/base/key_error.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/base/text.hpp"

namespace downwash {

void require_drawable(const Bounds& extent) {
    constexpr double max_ratio = 40;
    const double width_m = extent.x_high_m - extent.x_low_m;
    const double height_m = extent.z_high_m - extent.z_low_m;
    const std::string given = fmt::format("x from {} to {} and z from {} to {} m", to_text(extent.x_low_m),
                                          to_text(extent.x_high_m), to_text(extent.z_low_m), to_text(extent.z_high_m));
    if (!(width_m > 0 && height_m > 0 && std::isfinite(width_m) && std::isfinite(height_m))) {
        throw_input_error(given + " hold no area: expected finite numbers, the lower ones first", "extent");
    }
    if (width_m > max_ratio * height_m || height_m > max_ratio * width_m) {
        throw_input_error(
            fmt::format("{} cannot be drawn to scale: expected no side to be more than {} times as long as the other",
                        given, max_ratio),
            "extent");
    }
}

FieldLayout layout_of(const FieldFigure& figure, int picture_width_px, const Legend& legend) {
    constexpr double left_px = 80, right_px = 24, below_axes_px = 138;
    constexpr double max_height = 1.2;  // of the axes, in their widths
    const Bounds& extent = figure.extent;
    const double ratio = (extent.z_high_m - extent.z_low_m) / (extent.x_high_m - extent.x_low_m);
    const double room_px = picture_width_px - left_px - right_px;
    const double width_px = ratio > max_height ? room_px * max_height / ratio : room_px;
    const double above_axes_px = (figure.subtitle.empty() ? 40 : 62) + legend.height_px(room_px) + 6;
    FieldLayout layout{};
    layout.left = left_px + (room_px - width_px) / 2;
    layout.right = layout.left + width_px;
    layout.bottom = below_axes_px;
    layout.top = layout.bottom + width_px * ratio;
    layout.height = std::round(layout.top + above_axes_px);
    layout.legend_top = layout.top + legend.height_px(room_px) + 2;
    layout.bar_bottom = 56;
    layout.room = room_px;
    return layout;
}

std::string FieldSamples::source(bool is_surface) const {
    return fmt::format("'-' binary array=({},{}) origin=({},{}{}) dx={} dy={} format='%float' using 1", columns, rows,
                       x_m, z_m, is_surface ? ",0" : "", dx_m, dz_m);
}

FieldSamples sampled(const FieldFigure& figure, std::size_t columns, std::size_t rows, bool at_corners, int threads) {
    FieldSamples samples;
    const Bounds& extent = figure.extent;
    samples.dx_m = (extent.x_high_m - extent.x_low_m) / static_cast<double>(columns);
    samples.dz_m = (extent.z_high_m - extent.z_low_m) / static_cast<double>(rows);
    samples.columns = columns + (at_corners ? 1 : 0);
    samples.rows = rows + (at_corners ? 1 : 0);
    samples.x_m = extent.x_low_m + (at_corners ? 0 : samples.dx_m / 2);
    samples.z_m = extent.z_low_m + (at_corners ? 0 : samples.dz_m / 2);
    samples.places.resize(samples.columns * samples.rows);
    run_parallel(samples.rows, threads, [&](std::size_t k) {
        const double z_m = samples.z_m + static_cast<double>(k) * samples.dz_m;
        for (std::size_t i = 0; i < samples.columns; ++i) {
            const double x_m = samples.x_m + static_cast<double>(i) * samples.dx_m;
            samples.places[k * samples.columns + i] =
                static_cast<float>(position_on(figure.scale, figure.value(x_m, z_m)));
        }
    });
    return samples;
}

std::string_view dash_of(LineDash dash) {
    switch (dash) {
        case LineDash::solid:
            return "";
        case LineDash::dashed:
            return " dashtype (16,9)";
        case LineDash::dotted:
            return " dashtype (3,5)";
        case LineDash::dash_dotted:
            return " dashtype (24,6,3,6)";
    }
    return "";
}

}  // namespace downwash

#include "downwash/report/field_layout.hpp"

#include <fmt/core.h>

#include <cmath>
#include <string>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"

namespace downwash {

void require_drawable(const Bounds& extent) {
    constexpr double longest_ratio = 40;
    const double width_m = extent.x_high_m - extent.x_low_m;
    const double height_m = extent.z_high_m - extent.z_low_m;
    const std::string given = fmt::format("x from {} to {} and z from {} to {} m", to_text(extent.x_low_m),
                                          to_text(extent.x_high_m), to_text(extent.z_low_m), to_text(extent.z_high_m));
    if (!(width_m > 0 && height_m > 0 && std::isfinite(width_m) && std::isfinite(height_m))) {
        throw InputError({{"extent", given + " hold no area: expected finite numbers, the lower ones first"}});
    }
    if (width_m > longest_ratio * height_m || height_m > longest_ratio * width_m) {
        throw InputError({{"extent", fmt::format("{} cannot be drawn to scale: expected no side to be more than {} "
                                                 "times as long as the other",
                                                 given, longest_ratio)}});
    }
}

FieldLayout layout_of(const FieldFigure& figure, int picture_width_px, const Legend& legend) {
    constexpr double left_px = 80, right_px = 24, below_axes_px = 128;
    constexpr double tallest = 1.2;  // of the axes, in their widths
    const Bounds& extent = figure.extent;
    const double ratio = (extent.z_high_m - extent.z_low_m) / (extent.x_high_m - extent.x_low_m);
    const double room_px = picture_width_px - left_px - right_px;
    const double width_px = ratio > tallest ? room_px * tallest / ratio : room_px;
    const double above_axes_px = (figure.subtitle.empty() ? 40 : 62) + legend.height_px(room_px) + 6;
    FieldLayout layout{};
    layout.left = left_px + (room_px - width_px) / 2;
    layout.right = layout.left + width_px;
    layout.bottom = below_axes_px;
    layout.top = layout.bottom + width_px * ratio;
    layout.height = std::round(layout.top + above_axes_px);
    layout.legend_top = layout.top + legend.height_px(room_px) + 2;
    layout.bar_bottom = 48;
    layout.room = room_px;
    return layout;
}

}  // namespace downwash

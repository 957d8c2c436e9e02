#pragma once

// Private: not installed.

#include "downwash/report/field_figure.hpp"
#include "downwash/report/legend.hpp"

namespace downwash {

/// Where things of a picture of a field stand, in pixels from its lower left corner.
struct FieldLayout {
    double left, right, bottom, top;  ///< of the axes
    double height;                    ///< of the picture
    double legend_top;
    double room;  ///< how wide the axes may be
    double bar_bottom;

    [[nodiscard]] double width() const { return right - left; }
};

/// @throws InputError when what is shown cannot be drawn to scale
void require_drawable(const Bounds& extent);

[[nodiscard]] FieldLayout layout_of(const FieldFigure& figure, int picture_width_px, const Legend& legend);

}  // namespace downwash

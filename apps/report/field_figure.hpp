#pragma once

#include <functional>
#include <string>

#include "downwash/base/bounds.hpp"
#include "downwash/base/export.hpp"
#include "downwash/report/field.hpp"
#include "downwash/report/picture.hpp"

namespace downwash {

/// The minimum and maximum of a field and of `included`, taken over (steps + 1)^2 points of an extent, corners
/// included.
[[nodiscard]] DOWNWASH_EXPORT AxisRange value_range(const std::function<double(double x_m, double z_m)>& value,
                                                    const Bounds& extent, int steps, double included);

/// The picture as the bytes of a file. Equal figures give equal bytes. Text may be arbitrary: it is shown, never run.
/// @throws InputError when the extent or the width cannot be drawn  @throws PictureError when gnuplot cannot
[[nodiscard]] DOWNWASH_EXPORT std::string draw(const FieldFigure& figure, const PictureSettings& settings);

}  // namespace downwash

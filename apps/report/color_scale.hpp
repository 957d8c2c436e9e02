#pragma once

#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/report/picture.hpp"

namespace downwash {

/// Colours for the values of a field, in classes. Each class of values has one colour; all classes have the same width
/// on the colour bar.
struct ColorScale {
    std::string label;           ///< the quantity, with its unit
    std::vector<double> limits;  ///< limits of the classes, increasing; one more than there are colours
    std::vector<Color> colors;   ///< colours of the classes; at least two
    /// Names of the classes, shown at the colour bar instead of the limits. May be empty.
    std::vector<std::string> names;
    /// The value where nothing happens, such as a thrust ratio of 1. Labels cover its class only.
    std::optional<double> neutral = {};
};

/// The position of a value on the colour bar: i at limits[i], linear between them, clamped to the ends.
/// NaN for NaN.
[[nodiscard]] DOWNWASH_EXPORT double position_on(const ColorScale& scale, double value);

/// The scale of thrust ratios, finest at one: white near one, ever darker blues above, from yellow to brown below.
/// A value has the same colour on every such scale. All reach from 1 to 2; only values beyond add classes, those below
/// one a neutral class from 0.99 to 1.01.
/// @param range of all values of the problem, not only of the shown ones, so that a zoom changes nothing
[[nodiscard]] DOWNWASH_EXPORT ColorScale factor_scale(std::string label, const AxisRange& range);

/// Blue below zero and red above, finest at zero: limits at 1, 2 and 5 times powers of ten up to `reach`.
/// @pre reach > 0 and finite  @param classes on each side, from 2 to 8
[[nodiscard]] DOWNWASH_EXPORT ColorScale signed_scale(std::string label, double reach, int classes = 6);

/// One colour for each of the values 0, 1, 2... of a field of kinds. @pre as many names as colours, at least two
[[nodiscard]] DOWNWASH_EXPORT ColorScale scale_of_kinds(std::string label, std::vector<std::string> names,
                                                        std::vector<Color> colors);

}  // namespace downwash

#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/report/picture.hpp"

namespace downwash {

/// A point of a diagram, in the units of its axes.
struct DiagramPoint {
    double x = 0, y = 0;
};

/// A line through points; a point that is not finite interrupts it.
struct Curve {
    std::string name;
    std::vector<DiagramPoint> points;
    std::optional<AxisRange> known_range =
        {};  ///< known range of x, both ends may be infinite; the line is dotted outside
};

/// Points with or without error bars.
struct MeasuredPoints {
    std::string name;
    std::vector<DiagramPoint> points;
    std::vector<double> errors;  ///< half the length of each bar, in y; empty for none, else one for each point
};

/// A diagram of curves and measured points over one quantity. Eight colours repeat (Okabe and Ito 2008, legible to the
/// colour-blind); dashes distinguish curves of equal colour, and
/// let a curve show through one that lies over it.
struct CurveFigure {
    std::string title;
    std::string subtitle;
    std::string x_label, y_label;
    std::optional<AxisRange> x_range, y_range;  ///< empty: what the data need
    std::optional<double> level;                ///< a thin level line, for example at K = 1
    std::vector<Curve> curves;
    std::vector<MeasuredPoints> measurements;
    std::string dotted_name = "outside the known range";  ///< legend of the dotted lines
};

/// The picture as the bytes of a file: the figures one below the other, with axes of equal width, for example a fit
/// and its residuals. Each has a legend of its own; titles of all but the first may be empty. Equal figures give equal
/// bytes. Text may be arbitrary: it is shown, never run.
/// @throws InputError when there is no figure, nothing to draw in one, a range is empty, the numbers of points and
/// error bars differ, or the width is out of range  @throws PictureError when gnuplot cannot draw
[[nodiscard]] DOWNWASH_EXPORT std::string draw(std::span<const CurveFigure> figures, const PictureSettings& settings);

/// Draws one figure.
[[nodiscard]] inline std::string draw(const CurveFigure& figure, const PictureSettings& settings) {
    return draw(std::span(&figure, 1), settings);
}

}  // namespace downwash

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/base/export.hpp"
#include "downwash/report/color_scale.hpp"
#include "downwash/report/obstacle_outline.hpp"
#include "downwash/report/picture.hpp"

namespace downwash {

/// Lines over a field, for example a boundary or streamlines; one entry in the legend.
struct FigureLines {
    std::string name;  ///< empty: not in the legend
    std::vector<std::vector<PlanePoint>> pieces;
    Color color{};
    double width_px = 2;
    bool is_dashed = false;
    bool has_arrows = false;  ///< one in the middle of each piece, pointing along it
};

/// Points over a field; one entry in the legend.
struct FigurePoints {
    std::string name;  ///< empty: not in the legend
    std::vector<PlanePoint> points;
    Color color{};
};

/// A scalar field over the plane of motion: filled contours, obstacles to scale, and what else is to be seen there.
struct FieldFigure {
    std::string title;
    std::string subtitle;
    std::string x_label = "x [m]";
    std::string z_label = "z [m]";
    Bounds extent;  ///< what is shown; not empty, neither side 40 times as long as the other
    ColorScale scale;
    /// The field at (x, z); NaN where it is not defined. Called for some hundred thousand points of the extent.
    std::function<double(double x_m, double z_m)> value;
    std::string undefined_name = "not flyable";  ///< what it means in the legend that the field is not defined
    bool has_contour_lines = true;
    std::vector<ObstacleOutline> obstacles;
    std::vector<FigureLines> lines;
    std::vector<FigurePoints> points;
};

/// The picture as the bytes of a file. Equal figures give equal bytes. Text may hold anything: it is shown, never run.
/// @throws InputError when the extent or the width cannot be drawn  @throws PictureError when gnuplot cannot
[[nodiscard]] DOWNWASH_EXPORT std::string draw(const FieldFigure& figure, const PictureSettings& settings);

}  // namespace downwash

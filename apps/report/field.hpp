#pragma once

#include <functional>
#include <string>
#include <vector>

#include "downwash/base/bounds.hpp"
#include "downwash/report/color_scale.hpp"
#include "downwash/report/obstacle_outline.hpp"

namespace downwash {

/// How lines are broken. Obstacles beside the plane are dashed, too.
enum class LineDash { solid, dashed, dotted, dash_dotted };

/// Lines over a field, for example a boundary or streamlines, with one entry in the legend.
struct FigureLines {
    std::string name;  ///< empty: not in the legend
    std::vector<Ring> pieces;
    Color color{};
    double width_px = 2;
    LineDash dash = LineDash::solid;
    bool has_arrows = false;  ///< one in the middle of each piece, pointing along it
};

/// Points over a field, with one entry in the legend.
struct FigurePoints {
    std::string name;  ///< empty: not in the legend
    std::vector<PlanePoint> points;
    Color color{};
    std::vector<std::string> labels = {};  ///< one for each point, where there is room beside it; or none at all
};

/// A scalar field over the plane of motion: filled contours, obstacles to scale, and further lines and points.
struct FieldFigure {
    std::string title;
    std::string subtitle;
    std::string x_label = "x [m]";
    std::string z_label = "z [m]";
    Bounds extent;  ///< what is shown; not empty, neither side 40 times as long as the other
    ColorScale scale;
    /// The field at (x, z); NaN where it is not defined. Called for some million points of the extent, from
    /// several threads at a time if the settings allow them.
    std::function<double(double x_m, double z_m)> value;
    std::string undefined_name = "not flyable";  ///< legend of the area where the field is not defined
    bool has_contour_lines = true;
    std::vector<ObstacleOutline> obstacles;
    /// Whether obstacles and points are named, as far as there is room beside field, lines and points.
    bool has_names = true;
    std::vector<FigureLines> lines;
    std::vector<FigurePoints> points;
};

}  // namespace downwash

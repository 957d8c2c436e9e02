#pragma once

// Private: not installed.

#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/report/field_parts.hpp"
#include "downwash/report/gnuplot_script.hpp"
#include "downwash/report/label_placement.hpp"
#include "downwash/report/obstacle_outline.hpp"
#include "downwash/report/plot.hpp"

namespace downwash {

/// Outlines that look the same, such as those of girders left and right of the plane, become one with both names.
[[nodiscard]] std::vector<ObstacleOutline> merged_outlines(const std::vector<ObstacleOutline>& outlines);

/// An outline with only the corners that can be seen: of outlines with more than 20000 corners together, corners half a
/// pixel apart and the rings that are larger than that. @param px_per_m maximum scale of the picture
[[nodiscard]] std::vector<ObstacleOutline> thinned_outlines(std::vector<ObstacleOutline> outlines, double px_per_m);

/// The parts of outlines within an extent, without the outlines of which nothing can be seen there.
struct VisibleOutline {
    ObstacleOutline outline;  ///< the whole one
    std::vector<Ring> fill;   ///< its area within the extent
    std::vector<Ring> edges;  ///< its lines within the extent, not the extent's own border
};
[[nodiscard]] DOWNWASH_EXPORT std::vector<VisibleOutline> visible_outlines(std::vector<ObstacleOutline> outlines,
                                                                           const Bounds& extent);

/// Draws outlines: filled where they are cut, dashed where they are projected.
void add_obstacles(Plot& plot, const std::vector<VisibleOutline>& outlines);

/// Adds the data for add_obstacles().
void add_obstacle_data(GnuplotScript& script, const std::vector<VisibleOutline>& outlines);

/// The places of the names of obstacles and points: over no line or point of the figure, and where the scale has a
/// neutral value, over no other. A name's shape is its place among the outlines, then among the labels of points.
[[nodiscard]] DOWNWASH_EXPORT std::vector<PlacedLabel> placed_names(const FieldFigure& figure,
                                                                    const std::vector<VisibleOutline>& outlines,
                                                                    const FieldLayout& layout);

/// Adds the names of obstacles and points where there is room.
void add_obstacle_names(GnuplotScript& script, const FieldFigure& figure, const std::vector<VisibleOutline>& outlines,
                        const FieldLayout& layout);

}  // namespace downwash

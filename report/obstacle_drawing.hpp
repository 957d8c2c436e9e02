#pragma once

// Private: not installed.

#include <vector>

#include "downwash/report/field_layout.hpp"
#include "downwash/report/gnuplot_script.hpp"
#include "downwash/report/obstacle_outline.hpp"
#include "downwash/report/plot_elements.hpp"

namespace downwash {

/// Outlines that look the same, such as those of girders left and right of the plane, become one with both names.
[[nodiscard]] std::vector<ObstacleOutline> merged_outlines(const std::vector<ObstacleOutline>& outlines);

/// The same with no more corners than can be seen: of outlines with more than 20000 corners together, only those half a
/// pixel apart and the rings that are larger. @param px_per_m at most
[[nodiscard]] std::vector<ObstacleOutline> thinned_outlines(std::vector<ObstacleOutline> outlines, double px_per_m);

/// Draws outlines: filled where they are cut, dashed where they are projected.
void add_obstacles(Plot& plot, const std::vector<ObstacleOutline>& outlines);

/// The data that add_obstacles draws.
void add_obstacle_data(GnuplotScript& script, const std::vector<ObstacleOutline>& outlines);

/// Writes the names of obstacles where there is room.
void add_obstacle_names(GnuplotScript& script, const FieldFigure& figure, const std::vector<ObstacleOutline>& outlines,
                        const FieldLayout& layout);

}  // namespace downwash

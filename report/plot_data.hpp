#pragma once

// Private: not installed.

#include <string>
#include <vector>

#include "downwash/report/gnuplot_script.hpp"
#include "downwash/report/picture.hpp"

namespace downwash {

/// The corners of a polygon, or the points of a line.
using Ring = std::vector<PlanePoint>;

/// A line of text a point. @param is_closed the first point comes last again
[[nodiscard]] std::string points_text(const Ring& ring, bool is_closed);

/// The same of several, each ended by an empty line.
[[nodiscard]] std::string lines_text(const std::vector<Ring>& rings, bool is_closed);

/// Makes text the data block `name`, such as "$edge3".
void add_data(GnuplotScript& script, const std::string& name, const std::string& text);

}  // namespace downwash

#pragma once

// Private: not installed. Everything in the coordinates of the plane of motion.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "downwash/base/bounds.hpp"
#include "downwash/base/export.hpp"
#include "downwash/report/picture.hpp"

namespace downwash {

/// Something with a name, as far as it can be seen.
struct NamedShape {
    double name_width_m = 0;  ///< 0: it gets no name
    std::vector<Ring> fill;   ///< its area; empty: it has only lines
    std::vector<Ring> edges;  ///< its lines
};

/// Where names are put.
struct LabelGround {
    Bounds area;
    double px_per_m = 1;
    double height_m = 0;      ///< height of a name
    std::vector<Ring> taken;  ///< lines that no name may cover; a line back to its first point takes its inside, too
    /// What is behind a point: names stand on one background. Negative: none may stand here.
    std::function<int(const PlanePoint& at)> background;
};

/// The place of a name.
struct PlacedLabel {
    std::size_t shape = 0;
    Bounds box;
    bool is_inside = false;  ///< whether the label lies in its own area
    /// A line from the name to its shape, unless it stands right beside it.
    std::optional<std::pair<PlanePoint, PlanePoint>> leader;
};

/// Finds places for the names of shapes: inside the shape's area if there is room, else near it. A name covers no
/// shape, taken line, leader or other name; its leader crosses none of them but its own shape. A name without such a
/// place is left out.
[[nodiscard]] DOWNWASH_EXPORT std::vector<PlacedLabel> place_labels(const std::vector<NamedShape>& shapes,
                                                                    const LabelGround& ground);

}  // namespace downwash

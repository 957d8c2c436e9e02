#pragma once

// Private: not installed. Everything in pixels of the picture, y upwards.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

struct PixelPoint {
    double x = 0, y = 0;
};

struct PixelBox {
    double left = 0, right = 0, bottom = 0, top = 0;
    [[nodiscard]] bool holds(const PixelPoint& p) const {
        return p.x >= left && p.x <= right && p.y >= bottom && p.y <= top;
    }
    [[nodiscard]] bool meets(const PixelBox& other) const {
        return left < other.right && other.left < right && bottom < other.top && other.bottom < top;
    }
    [[nodiscard]] bool holds(const PixelBox& other) const {
        return left <= other.left && right >= other.right && bottom <= other.bottom && top >= other.top;
    }
    [[nodiscard]] PixelPoint middle() const { return {(left + right) / 2, (bottom + top) / 2}; }
};

/// The outline of something with a name.
struct NamedShape {
    std::string name;
    double width_px = 0;  ///< of the name
    bool is_filled = true;
    std::vector<std::vector<PixelPoint>> rings;
};

/// The place of a name.
struct PlacedLabel {
    std::size_t shape = 0;
    PixelBox box;
    bool is_inside = false;            ///< on its own filled shape
    bool needs_ground = false;         ///< the background is not plain
    std::optional<PixelPoint> leader;  ///< the end of a line from the name, if it is away from its shape
};

/// Finds places for the names of the shapes that are visible within `area`: inside the shape if there is room,
/// otherwise near it. A name never covers another name and, if possible, no other shape and only a background of one
/// colour.
/// @param color_at the number of the background's colour at a point
[[nodiscard]] DOWNWASH_EXPORT std::vector<PlacedLabel> place_labels(
    const std::vector<NamedShape>& shapes, const PixelBox& area, double height_px,
    const std::function<int(const PixelPoint&)>& color_at);

}  // namespace downwash

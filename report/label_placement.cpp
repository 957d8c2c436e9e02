#include "downwash/report/label_placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace downwash {
namespace {

using Ring = std::vector<PixelPoint>;

/// The part of a ring on one side of an upright or level line, by Sutherland and Hodgman 1974.
Ring clipped(const Ring& ring, const std::function<double(const PixelPoint&)>& inside) {
    Ring part;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const PixelPoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
        const double da = inside(a), db = inside(b);
        if (da >= 0) {
            part.push_back(a);
        }
        if ((da >= 0) != (db >= 0)) {
            const double s = da / (da - db);
            part.push_back({a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)});
        }
    }
    return part;
}

Ring clipped(Ring ring, const PixelBox& area) {
    ring = clipped(ring, [&](const PixelPoint& p) { return p.x - area.left; });
    ring = clipped(ring, [&](const PixelPoint& p) { return area.right - p.x; });
    ring = clipped(ring, [&](const PixelPoint& p) { return p.y - area.bottom; });
    return clipped(ring, [&](const PixelPoint& p) { return area.top - p.y; });
}

double area_of(const Ring& ring) {
    double twice = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const PixelPoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return std::abs(twice) / 2;
}

PixelBox box_of(const Ring& ring) {
    PixelBox box{ring[0].x, ring[0].x, ring[0].y, ring[0].y};
    for (const PixelPoint& p : ring) {
        box = {std::min(box.left, p.x), std::max(box.right, p.x), std::min(box.bottom, p.y), std::max(box.top, p.y)};
    }
    return box;
}

bool is_inside(const Ring& ring, const PixelPoint& p) {
    bool inside = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const PixelPoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
            inside = !inside;
        }
    }
    return inside;
}

/// The point of a ring nearest to p.
PixelPoint nearest_point(const Ring& ring, const PixelPoint& p) {
    PixelPoint nearest = ring[0];
    double min_distance = std::hypot(nearest.x - p.x, nearest.y - p.y);
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const PixelPoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
        const double dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
        const double along = squared > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0., 1.) : 0;
        const PixelPoint candidate{a.x + along * dx, a.y + along * dy};
        if (const double distance = std::hypot(candidate.x - p.x, candidate.y - p.y); distance < min_distance) {
            min_distance = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

PixelBox around(const PixelPoint& middle, double width, double height) {
    return {middle.x - width / 2, middle.x + width / 2, middle.y - height / 2, middle.y + height / 2};
}

/// Whether nine points of a box satisfy something.
template <class Predicate>
bool all_points(const PixelBox& box, Predicate holds) {
    for (const double s : {0., 0.5, 1.}) {
        for (const double t : {0., 0.5, 1.}) {
            if (!holds(PixelPoint{box.left + s * (box.right - box.left), box.bottom + t * (box.top - box.bottom)})) {
                return false;
            }
        }
    }
    return true;
}

bool has_point_in(const PixelBox& box, const Ring& ring) {
    return !all_points(box, [&](const PixelPoint& p) { return !is_inside(ring, p); });
}

class Placement {
 public:
    Placement(const std::vector<NamedShape>& shapes, const PixelBox& area, double height_px,
              const std::function<int(const PixelPoint&)>& color_at)
        : area_(area), height_px_(height_px), color_at_(color_at) {
        for (const NamedShape& shape : shapes) {
            Visible visible{shape.width_px, shape.is_filled, {}};
            double largest = 3;  // smaller parts are invisible
            for (const Ring& ring : shape.rings) {
                Ring part = clipped(ring, area);
                if (part.empty()) {
                    continue;
                }
                const PixelBox box = box_of(part);
                // Lines have no area, only a length.
                const double size = area_of(part) + std::hypot(box.right - box.left, box.top - box.bottom);
                if (size > largest) {
                    largest = size;
                    visible.main = part;
                }
                pieces_.push_back({visible_.size(), shape.is_filled, std::move(part)});
            }
            visible_.push_back(std::move(visible));
        }
    }

    std::vector<PlacedLabel> place() {
        // Names inside their shapes come first, so that names beside shapes can avoid them.
        for (const auto find : {&Placement::find_inside, &Placement::find_beside}) {
            for (std::size_t i = 0; i < visible_.size(); ++i) {
                const bool is_placed = std::any_of(labels_.begin(), labels_.end(),
                                                   [i](const PlacedLabel& label) { return label.shape == i; });
                if (!is_placed && !visible_[i].main.empty()) {
                    (this->*find)(i);
                }
            }
        }
        return std::move(labels_);
    }

 private:
    /// A shape that may be visible.
    struct Visible {
        double width_px;
        bool is_filled;
        Ring main;  ///< its largest part within the area; empty when nothing can be seen
    };
    /// A part of a shape within the area.
    struct Piece {
        std::size_t shape;
        bool is_filled;
        Ring ring;
    };

    [[nodiscard]] bool is_free(const PixelBox& box) const {
        return area_.holds(box) && std::none_of(labels_.begin(), labels_.end(),
                                                [&](const PlacedLabel& label) { return label.box.meets(box); });
    }

    /// Whether the background of a box is of one colour.
    [[nodiscard]] bool is_plain(const PixelBox& box) const {
        constexpr double step_px = 6;
        const int color = color_at_(box.middle());
        for (double y = box.bottom; y <= box.top; y += step_px) {
            for (double x = box.left; x <= box.right; x += step_px) {
                if (color_at_({x, y}) != color) {
                    return false;
                }
            }
        }
        return true;
    }

    /// Whether the outline of a shape passes through a box.
    [[nodiscard]] bool crosses_lines(const PixelBox& box) const {
        constexpr double step_px = 3;
        for (const auto& [shape, is_filled, ring] : pieces_) {
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const PixelPoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
                const double steps = std::ceil(std::hypot(b.x - a.x, b.y - a.y) / step_px);
                for (double k = 0; k < steps; ++k) {
                    if (box.holds(PixelPoint{a.x + k / steps * (b.x - a.x), a.y + k / steps * (b.y - a.y)})) {
                        return true;
                    }
                }
            }
        }
        return false;
    }

    /// Whether a box lies on no filled shape, its own included.
    [[nodiscard]] bool is_off_shapes(const PixelBox& box) const {
        return std::none_of(pieces_.begin(), pieces_.end(), [&](const Piece& piece) {
            return piece.is_filled && box_of(piece.ring).meets(box) &&
                   (has_point_in(box, piece.ring) || std::any_of(piece.ring.begin(), piece.ring.end(),
                                                                 [&](const PixelPoint& p) { return box.holds(p); }));
        });
    }

    void find_inside(std::size_t i) {
        constexpr double room = 4;
        const Visible& shape = visible_[i];
        const PixelBox bounds = box_of(shape.main);
        const PixelPoint middle = bounds.middle();
        const double inset = height_px_ / 2 + room;
        std::vector<double> heights{middle.y};
        if (!shape.is_filled) {
            // Names of outlines stay near the edge if possible: the inside may belong to other shapes.
            heights = {bounds.top - inset, bounds.bottom + inset};
            for (double y = bounds.top - 2 * inset; y > bounds.bottom + inset; y -= inset) {
                heights.push_back(y);
            }
        }
        for (const double y : heights) {
            for (const double x : {middle.x, (middle.x + bounds.left) / 2, (middle.x + bounds.right) / 2,
                                   bounds.left + shape.width_px / 2 + room, bounds.right - shape.width_px / 2 - room}) {
                const PixelBox box = around({x, y}, shape.width_px, height_px_);
                const bool fits = all_points(box, [&](const PixelPoint& p) { return is_inside(shape.main, p); });
                if (fits && is_free(box) &&
                    (shape.is_filled ? !covers_other(box, i) : is_off_shapes(box) && is_plain(box))) {
                    labels_.push_back({i, box, shape.is_filled, !shape.is_filled && crosses_lines(box), {}});
                    return;
                }
            }
        }
    }

    [[nodiscard]] bool covers_other(const PixelBox& box, std::size_t own) const {
        return std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece& piece) {
            return piece.shape != own && piece.is_filled && has_point_in(box, piece.ring);
        });
    }

    /// Whether a line from a name to its shape crosses other filled shapes or names.
    [[nodiscard]] bool crosses_other(const PixelPoint& from, const PixelPoint& to, std::size_t own) const {
        constexpr int steps = 32;
        for (int k = 0; k <= steps; ++k) {
            const double s = static_cast<double>(k) / steps;
            const PixelPoint p{from.x + s * (to.x - from.x), from.y + s * (to.y - from.y)};
            if (std::any_of(pieces_.begin(), pieces_.end(),
                            [&](const Piece& piece) {
                                return piece.shape != own && piece.is_filled && is_inside(piece.ring, p);
                            }) ||
                std::any_of(labels_.begin(), labels_.end(),
                            [&p](const PlacedLabel& label) { return label.box.holds(p); })) {
                return true;
            }
        }
        return false;
    }

    /// Middles of boxes around a shape, `gap` away from it, the best first.
    static std::vector<PixelPoint> places_around(const PixelBox& shape, double gap, double width, double height) {
        const double up = shape.top + gap + height / 2, down = shape.bottom - gap - height / 2;
        const double right = shape.right + gap + width / 2, left = shape.left - gap - width / 2;
        const auto [x, y] = shape.middle();
        std::vector<PixelPoint> places{{x, up},     {right, y}, {left, y},     {x, down},
                                       {right, up}, {left, up}, {right, down}, {left, down}};
        for (const double part : {0.25, 0.75, 0.125, 0.375, 0.625, 0.875, 0., 1.}) {
            const double low = shape.left + width / 2, high = std::max(low, shape.right - width / 2);
            const double along = std::clamp(shape.left + part * (shape.right - shape.left), low, high);
            places.push_back({along, up});
            places.push_back({along, down});
        }
        return places;
    }

    enum class Demand { plain_and_direct, off_shapes, free };

    [[nodiscard]] bool meets(Demand demand, const PixelBox& box, std::size_t i) const {
        if (!is_free(box)) {
            return false;
        }
        switch (demand) {
            case Demand::plain_and_direct:
                return is_off_shapes(box) && is_plain(box) &&
                       !crosses_other(box.middle(), nearest_point(visible_[i].main, box.middle()), i);
            case Demand::off_shapes:
                return is_off_shapes(box);
            case Demand::free:
                return true;
        }
        return true;
    }

    void find_beside(std::size_t i) {
        constexpr double nearest_px = 3;
        constexpr int distances = 12;
        const Visible& shape = visible_[i];
        const PixelBox bounds = box_of(shape.main);
        for (const Demand demand : {Demand::plain_and_direct, Demand::off_shapes, Demand::free}) {
            for (int k = 0; k < distances; ++k) {
                const double gap = nearest_px + k * height_px_ * 0.8;
                for (const PixelPoint& place : places_around(bounds, gap, shape.width_px, height_px_)) {
                    const PixelBox box = around(place, shape.width_px, height_px_);
                    if (meets(demand, box, i)) {
                        labels_.push_back({i, box, false, !is_plain(box) || crosses_lines(box), {}});
                        if (k > 0) {
                            labels_.back().leader = nearest_point(shape.main, place);
                        }
                        return;
                    }
                }
            }
        }
    }

    PixelBox area_;
    double height_px_;
    const std::function<int(const PixelPoint&)>& color_at_;
    std::vector<Visible> visible_;
    std::vector<Piece> pieces_;
    std::vector<PlacedLabel> labels_;
};

}  // namespace

std::vector<PlacedLabel> place_labels(const std::vector<NamedShape>& shapes, const PixelBox& area, double height_px,
                                      const std::function<int(const PixelPoint&)>& color_at) {
    return Placement(shapes, area, height_px, color_at).place();
}

}  // namespace downwash

#include "downwash/report/label_placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "downwash/report/planar_geometry.hpp"

namespace downwash {
namespace {

bool meet(const Bounds& a, const Bounds& b) {
    return a.x_low_m < b.x_high_m && b.x_low_m < a.x_high_m && a.z_low_m < b.z_high_m && b.z_low_m < a.z_high_m;
}

bool holds(const Bounds& outer, const Bounds& inner) {
    return outer.x_low_m <= inner.x_low_m && outer.x_high_m >= inner.x_high_m && outer.z_low_m <= inner.z_low_m &&
           outer.z_high_m >= inner.z_high_m;
}

PlanePoint middle_of(const Bounds& box) {
    return {(box.x_low_m + box.x_high_m) / 2, (box.z_low_m + box.z_high_m) / 2};
}

Bounds around(const PlanePoint& middle, double width_m, double height_m) {
    return {middle.x_m - width_m / 2, middle.x_m + width_m / 2, middle.z_m - height_m / 2, middle.z_m + height_m / 2};
}

/// Whether a point is in the area of rings; holes are rings, too.
bool is_inside(const std::vector<Ring>& rings, const PlanePoint& p) {
    bool inside = false;
    for (const Ring& ring : rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const PlanePoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
            if ((a.z_m > p.z_m) != (b.z_m > p.z_m) &&
                p.x_m < a.x_m + (p.z_m - a.z_m) / (b.z_m - a.z_m) * (b.x_m - a.x_m)) {
                inside = !inside;
            }
        }
    }
    return inside;
}

bool crosses(const Ring& line, bool is_closed, const Bounds& box) {
    return !clipped_line(line, is_closed, box).empty();
}

bool any_crosses(const std::vector<Ring>& lines, bool are_closed, const Bounds& box) {
    return std::any_of(lines.begin(), lines.end(), [&](const Ring& line) { return crosses(line, are_closed, box); });
}

/// Lines or rings with the box around them: most of what is drawn is far away.
struct Extended {
    const std::vector<Ring>* rings;
    Bounds bounds;

    [[nodiscard]] bool is_far_from(const Bounds& box) const {
        return rings->empty() || bounds.x_low_m > box.x_high_m || bounds.x_high_m < box.x_low_m ||
               bounds.z_low_m > box.z_high_m || bounds.z_high_m < box.z_low_m;
    }
};

bool covers_area(const Extended& fill, const Bounds& box) {
    return !fill.is_far_from(box) && (any_crosses(*fill.rings, true, box) || is_inside(*fill.rings, middle_of(box)));
}

bool is_loop(const Ring& line) {
    return line.size() > 3 && line.front().x_m == line.back().x_m && line.front().z_m == line.back().z_m;
}

bool covers_line(const Ring& line, const Bounds& box) {
    return crosses(line, false, box) || (is_loop(line) && is_inside({line}, middle_of(box)));
}

PlanePoint nearest_in(const Bounds& box, const PlanePoint& p) {
    return {std::clamp(p.x_m, box.x_low_m, box.x_high_m), std::clamp(p.z_m, box.z_low_m, box.z_high_m)};
}

/// The shortest line from a box to lines.
std::pair<PlanePoint, PlanePoint> shortest_line(const Bounds& box, const std::vector<Ring>& lines) {
    std::pair<PlanePoint, PlanePoint> shortest;
    double min_m = HUGE_VAL;
    const PlanePoint middle = middle_of(box);
    for (const Ring& line : lines) {
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            const PlanePoint &a = line[i], &b = line[i + 1];
            const double dx = b.x_m - a.x_m, dz = b.z_m - a.z_m, squared = dx * dx + dz * dz;
            const double along = ((middle.x_m - a.x_m) * dx + (middle.z_m - a.z_m) * dz) / (squared > 0 ? squared : 1);
            for (const double part : {0., std::clamp(along, 0., 1.), 1.}) {
                const PlanePoint to{a.x_m + part * dx, a.z_m + part * dz};
                const PlanePoint from = nearest_in(box, to);
                if (const double length_m = std::hypot(to.x_m - from.x_m, to.z_m - from.z_m); length_m < min_m) {
                    min_m = length_m;
                    shortest = {from, to};
                }
            }
        }
    }
    return shortest;
}

class Placement {
 public:
    Placement(const std::vector<NamedShape>& shapes, const LabelGround& ground) : shapes_(shapes), ground_(ground) {
        fills_.reserve(shapes.size());
        edges_.reserve(shapes.size());
        for (const NamedShape& shape : shapes) {
            fills_.push_back({&shape.fill, box_of(shape.fill)});
            edges_.push_back({&shape.edges, box_of(shape.edges)});
        }
    }

    std::vector<PlacedLabel> place() {
        // Names inside their shapes come first, so that names beside shapes can avoid them.
        for (const auto find : {&Placement::find_inside, &Placement::find_beside}) {
            for (std::size_t i = 0; i < shapes_.size(); ++i) {
                const bool is_placed = std::any_of(labels_.begin(), labels_.end(),
                                                   [i](const PlacedLabel& label) { return label.shape == i; });
                if (!is_placed && shapes_[i].name_width_m > 0 &&
                    !(shapes_[i].fill.empty() && shapes_[i].edges.empty())) {
                    (this->*find)(i);
                }
            }
        }
        return std::move(labels_);
    }

 private:
    [[nodiscard]] double pixels(double count) const { return count / ground_.px_per_m; }

    /// Whether no name, leader or taken line is in a box.
    [[nodiscard]] bool is_free(const Bounds& box) const {
        return holds(ground_.area, box) && is_free_of_names(box) &&
               std::none_of(ground_.taken.begin(), ground_.taken.end(),
                            [&](const Ring& line) { return covers_line(line, box); });
    }

    /// Whether a box is beside all shapes, on one background on which names may stand.
    [[nodiscard]] bool is_on_ground(const Bounds& box) const {
        const auto covers = [&box](const Extended& fill) { return covers_area(fill, box); };
        const auto crosses_box = [&box](const Extended& edges) {
            return !edges.is_far_from(box) && any_crosses(*edges.rings, false, box);
        };
        if (std::ranges::any_of(fills_, covers) || std::ranges::any_of(edges_, crosses_box)) {
            return false;
        }
        const double step_m = pixels(2);
        const int background = ground_.background(middle_of(box));
        const auto count = [step_m](double size_m) { return static_cast<int>(std::ceil(size_m / step_m)); };
        const int columns = count(box.x_high_m - box.x_low_m), rows = count(box.z_high_m - box.z_low_m);
        for (int k = 0; k <= rows && background >= 0; ++k) {
            for (int i = 0; i <= columns; ++i) {
                const PlanePoint at{box.x_low_m + (box.x_high_m - box.x_low_m) * i / columns,
                                    box.z_low_m + (box.z_high_m - box.z_low_m) * k / rows};
                if (ground_.background(at) != background) {
                    return false;
                }
            }
        }
        return background >= 0;
    }

    void find_inside(std::size_t i) {
        const NamedShape& shape = shapes_[i];
        const double width_m = shape.name_width_m + pixels(4);
        for (const Ring& part : shape.fill) {
            const Bounds bounds = box_of({part});
            const auto [x_m, z_m] = middle_of(bounds);
            for (const double at_m : {x_m, (x_m + bounds.x_low_m) / 2, (x_m + bounds.x_high_m) / 2,
                                      bounds.x_low_m + width_m / 2, bounds.x_high_m - width_m / 2}) {
                const Bounds box = around({at_m, z_m}, width_m, ground_.height_m);
                if (is_inside(shape.fill, middle_of(box)) && !any_crosses(shape.fill, true, box) && is_free(box) &&
                    !covers_others(box, i)) {
                    labels_.push_back({i, box, true, {}});
                    return;
                }
            }
        }
    }

    [[nodiscard]] bool covers_others(const Bounds& box, std::size_t own) const {
        for (std::size_t i = 0; i < shapes_.size(); ++i) {
            if (i != own && covers_area(fills_[i], box)) {
                return true;
            }
        }
        return false;
    }

    /// Whether a leader crosses a name, a taken line, or the area of another shape.
    [[nodiscard]] bool is_crossed(const std::pair<PlanePoint, PlanePoint>& leader, std::size_t own) const {
        constexpr int steps = 32;
        for (int k = 0; k < steps; ++k) {
            const auto at = [&](int step) {
                const double s = static_cast<double>(step) / steps;
                return PlanePoint{leader.first.x_m + s * (leader.second.x_m - leader.first.x_m),
                                  leader.first.z_m + s * (leader.second.z_m - leader.first.z_m)};
            };
            const PlanePoint a = at(k), b = at(k + 1);
            const Bounds piece{std::min(a.x_m, b.x_m) - pixels(1), std::max(a.x_m, b.x_m) + pixels(1),
                               std::min(a.z_m, b.z_m) - pixels(1), std::max(a.z_m, b.z_m) + pixels(1)};
            if (!is_free_of_names(piece) || any_crosses(ground_.taken, false, piece) || covers_others(piece, own)) {
                return true;
            }
        }
        return false;
    }

    /// Whether no name or leader is in a box.
    [[nodiscard]] bool is_free_of_names(const Bounds& box) const {
        return std::ranges::none_of(labels_, [&](const PlacedLabel& label) {
            return meet(label.box, box) ||
                   (label.leader && crosses({label.leader->first, label.leader->second}, false, box));
        });
    }

    /// Middles of boxes around a shape, `gap_m` away from it, the best first.
    static std::vector<PlanePoint> places_around(const Bounds& shape, double gap_m, double width_m, double height_m) {
        const double up = shape.z_high_m + gap_m + height_m / 2, down = shape.z_low_m - gap_m - height_m / 2;
        const double right = shape.x_high_m + gap_m + width_m / 2, left = shape.x_low_m - gap_m - width_m / 2;
        const auto [x, z] = middle_of(shape);
        std::vector<PlanePoint> places{{x, up},     {right, z}, {left, z},     {x, down},
                                       {right, up}, {left, up}, {right, down}, {left, down}};
        for (const double part : {0.25, 0.75, 0.125, 0.375, 0.625, 0.875, 0., 1.}) {
            const double low = shape.x_low_m + width_m / 2, high = std::max(low, shape.x_high_m - width_m / 2);
            const double along = std::clamp(shape.x_low_m + part * (shape.x_high_m - shape.x_low_m), low, high);
            places.push_back({along, up});
            places.push_back({along, down});
        }
        return places;
    }

    bool try_place(std::size_t i, const PlanePoint& middle) {
        const NamedShape& shape = shapes_[i];
        const Bounds box = around(middle, shape.name_width_m, ground_.height_m);
        if (!is_free(box)) {
            return false;
        }
        const auto line = shortest_line(box, shape.edges);
        const double length_m = std::hypot(line.second.x_m - line.first.x_m, line.second.z_m - line.first.z_m);
        const bool is_beside = length_m <= pixels(8);
        if ((!is_beside && is_crossed(line, i)) || !is_on_ground(box)) {
            return false;
        }
        PlacedLabel label{i, box, false, {}};
        if (!is_beside) {
            label.leader = line;
        }
        labels_.push_back(std::move(label));
        return true;
    }

    void find_beside(std::size_t i) {
        constexpr int distances = 7;
        const NamedShape& shape = shapes_[i];
        const Bounds bounds = box_of(shape.edges);
        for (int k = -1; k < distances; ++k) {
            // The first distance is within an outline, at its upper or lower edge.
            const double gap_m = k < 0 ? -ground_.height_m - pixels(3) : pixels(3) + k * ground_.height_m * 0.8;
            const auto places = places_around(bounds, gap_m, shape.name_width_m, ground_.height_m);
            if (std::any_of(places.begin(), places.end(), [&](const PlanePoint& at) { return try_place(i, at); })) {
                return;
            }
        }
    }

    const std::vector<NamedShape>& shapes_;
    const LabelGround& ground_;
    std::vector<Extended> fills_, edges_;  ///< of shapes_
    std::vector<PlacedLabel> labels_;
};

}  // namespace

std::vector<PlacedLabel> place_labels(const std::vector<NamedShape>& shapes, const LabelGround& ground) {
    return Placement(shapes, ground).place();
}

}  // namespace downwash

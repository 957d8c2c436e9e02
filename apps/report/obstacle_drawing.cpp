#include "downwash/report/obstacle_drawing.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "downwash/report/figure_colors.hpp"
#include "downwash/report/picture_text.hpp"
#include "downwash/report/planar_geometry.hpp"

namespace downwash {
namespace {

constexpr double label_height_px = 18;

/// All rings as one closed line. The connections between rings run there and back and enclose nothing, so that holes,
/// which run in the opposite sense, stay open.
std::string fill_text(const std::vector<Ring>& rings) {
    std::string text;
    std::string back;
    for (const Ring& ring : rings) {
        if (!ring.empty()) {
            text += points_text(ring, true);
            back.insert(0, points_text({ring[0]}, false));
        }
    }
    return text + back;
}

/// Calls visit(ring) for the rings and lines of an outline.
template <class Visit>
void for_each_ring(const ObstacleOutline& outline, const Visit& visit) {
    std::for_each(outline.rings.begin(), outline.rings.end(), visit);
    std::for_each(outline.lines.begin(), outline.lines.end(), visit);
}

/// A name as it is drawn.
std::string shown_name(const std::string& name) {
    constexpr std::size_t max_characters = 40;
    return picture_text(name, max_characters);
}

}  // namespace

std::vector<ObstacleOutline> merged_outlines(const std::vector<ObstacleOutline>& outlines) {
    std::vector<ObstacleOutline> merged;
    std::map<std::pair<bool, std::string>, std::size_t> seen;
    for (const ObstacleOutline& outline : outlines) {
        std::string corners;
        for_each_ring(outline, [&corners](const Ring& ring) {
            for (const PlanePoint& p : ring) {
                corners += fmt::format("{} {} ", std::lround(p.x_m * 1e4), std::lround(p.z_m * 1e4));
            }
        });
        const auto [place, is_new] = seen.emplace(std::pair(outline.is_cut, corners), merged.size());
        if (is_new) {
            merged.push_back(outline);
        } else {
            merged[place->second].name += ", " + outline.name;
        }
    }
    return merged;
}

std::vector<ObstacleOutline> thinned_outlines(std::vector<ObstacleOutline> outlines, double px_per_m) {
    constexpr std::size_t max_corners = 20'000;
    constexpr double min_px = 0.5;
    std::size_t corners = 0;
    for (const ObstacleOutline& outline : outlines) {
        for_each_ring(outline, [&corners](const Ring& ring) { corners += ring.size(); });
    }
    if (corners <= max_corners) {
        return outlines;
    }
    const double min_m = min_px / px_per_m;
    const auto thin = [min_m](std::vector<Ring>& rings, std::size_t min_corners) {
        for (Ring& ring : rings) {
            Ring kept;
            for (const PlanePoint& p : ring) {
                if (kept.empty() || std::hypot(p.x_m - kept.back().x_m, p.z_m - kept.back().z_m) >= min_m) {
                    kept.push_back(p);
                }
            }
            ring = std::move(kept);
        }
        std::erase_if(rings, [min_corners](const Ring& ring) { return ring.size() < min_corners; });
    };
    for (ObstacleOutline& outline : outlines) {
        thin(outline.rings, 3);
        thin(outline.lines, 2);
    }
    std::erase_if(outlines,
                  [](const ObstacleOutline& outline) { return outline.rings.empty() && outline.lines.empty(); });
    return outlines;
}

std::vector<VisibleOutline> visible_outlines(std::vector<ObstacleOutline> outlines, const Bounds& extent) {
    std::vector<VisibleOutline> all;
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        if (!outlines[i].beside.empty()) {
            ObstacleOutline beside{"", false, std::exchange(outlines[i].beside, {}), {}};
            outlines.push_back(std::move(beside));  // its name is that of the part that is cut
        }
        ObstacleOutline& outline = outlines[i];
        VisibleOutline visible;
        const auto add_edges = [&](const Ring& line, bool is_closed) {
            const std::vector<Ring> pieces = clipped_line(line, is_closed, extent);
            visible.edges.insert(visible.edges.end(), pieces.begin(), pieces.end());
        };
        for (const Ring& ring : outline.rings) {
            if (Ring part = clipped_ring(ring, extent); outline.is_cut && part.size() > 2) {
                visible.fill.push_back(std::move(part));
            }
            add_edges(ring, true);
        }
        for (const Ring& line : outline.lines) {
            add_edges(line, false);
        }
        if (!visible.fill.empty() || !visible.edges.empty()) {
            visible.outline = std::move(outline);
            all.push_back(std::move(visible));
        }
    }
    return all;
}

void add_obstacles(Plot& plot, const std::vector<VisibleOutline>& outlines) {
    bool has_cut = false, has_projected = false;
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        const ObstacleOutline& outline = outlines[i].outline;
        const std::string edge = fmt::format("$edge{}", i);
        if (!outline.is_cut) {
            plot.add_lines(edge, "dashtype (14,9) linewidth 1.3 linecolor rgb '#505050'",
                           std::exchange(has_projected, true) ? "" : "obstacle beside the plane, projected");
            continue;
        }
        if (!outlines[i].fill.empty()) {
            plot.add_fill(fmt::format("$fill{}", i),
                          fmt::format("fillstyle solid noborder fillcolor rgb {}", in_quotes(obstacle_color)),
                          std::exchange(has_cut, true) ? "" : "obstacle");
        }
        // An octree with many cubes is drawn as one shape.
        constexpr std::size_t max_outlined = 30;
        plot.add_lines(edge, outline.rings.size() <= max_outlined
                                 ? fmt::format("linewidth 1 linecolor rgb {}", in_quotes(outline_color))
                                 : fmt::format("linewidth 0.5 linecolor rgb {}", in_quotes(obstacle_color)));
    }
}

void add_obstacle_data(GnuplotScript& script, const std::vector<VisibleOutline>& outlines) {
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        add_data(script, fmt::format("$fill{}", i), fill_text(outlines[i].fill));
        add_data(script, fmt::format("$edge{}", i), lines_text(outlines[i].edges, false));
    }
}

namespace {

/// What is left free around a point of a figure: more where it has a label, which may have a leader to there.
Ring square_around(const PlanePoint& at, bool has_label, double px_per_m) {
    const double half_m = (has_label ? 14 : 8) / px_per_m;
    return {{at.x_m - half_m, at.z_m - half_m},
            {at.x_m + half_m, at.z_m - half_m},
            {at.x_m + half_m, at.z_m + half_m},
            {at.x_m - half_m, at.z_m + half_m},
            {at.x_m - half_m, at.z_m - half_m}};
}

/// Which outlines get a name: the largest, since every name is compared with every outline.
std::vector<bool> are_named(const std::vector<VisibleOutline>& outlines) {
    constexpr std::size_t most_names = 300;
    const auto size_m = [](const VisibleOutline& visible) {
        const Bounds box = box_of(visible.edges);
        return visible.edges.empty() ? 0 : std::hypot(box.x_high_m - box.x_low_m, box.z_high_m - box.z_low_m);
    };
    std::vector<std::pair<double, std::size_t>> by_size;
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        by_size.emplace_back(-size_m(outlines[i]), i);
    }
    std::sort(by_size.begin(), by_size.end());
    std::vector<bool> named(outlines.size(), false);
    for (std::size_t i = 0; i < std::min(most_names, by_size.size()); ++i) {
        named[by_size[i].second] = true;
    }
    return named;
}

/// The names of obstacles, then the labels of points: as placed_names() numbers them.
std::vector<std::string> names_of(const FieldFigure& figure, const std::vector<VisibleOutline>& outlines) {
    std::vector<std::string> names;
    names.reserve(outlines.size());
    for (const VisibleOutline& visible : outlines) {
        names.push_back(shown_name(visible.outline.name));
    }
    for (const FigurePoints& points : figure.points) {
        names.insert(names.end(), points.labels.begin(), points.labels.end());
    }
    return names;
}

}  // namespace

std::vector<PlacedLabel> placed_names(const FieldFigure& figure, const std::vector<VisibleOutline>& outlines,
                                      const FieldLayout& layout) {
    const Bounds& extent = figure.extent;
    const double px_per_m = layout.width() / (extent.x_high_m - extent.x_low_m);
    std::vector<NamedShape> shapes;
    const std::vector<bool> named = are_named(outlines);
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        const double name_width_px = text_width_px(shown_name(outlines[i].outline.name), font_px) + 6;
        const bool is_named = named[i] && !outlines[i].outline.name.empty();
        shapes.push_back({is_named ? name_width_px / px_per_m : 0, outlines[i].fill, outlines[i].edges});
    }
    for (const FigurePoints& points : figure.points) {
        for (std::size_t i = 0; i < points.labels.size(); ++i) {
            shapes.push_back({(text_width_px(points.labels[i], font_px) + 6) / px_per_m,
                              {},
                              {square_around(points.points[i], true, px_per_m)}});
        }
    }
    LabelGround ground;
    const double rim_m = 2 / px_per_m;
    ground.area = {extent.x_low_m + rim_m, extent.x_high_m - rim_m, extent.z_low_m + rim_m, extent.z_high_m - rim_m};
    ground.px_per_m = px_per_m;
    ground.height_m = label_height_px / px_per_m;
    for (const FigureLines& lines : figure.lines) {
        ground.taken.insert(ground.taken.end(), lines.pieces.begin(), lines.pieces.end());
    }
    for (const FigurePoints& points : figure.points) {
        for (const PlanePoint& point : points.points) {
            if (points.labels.empty()) {
                ground.taken.push_back(square_around(point, false, px_per_m));
            }
        }
    }
    const auto class_at = [&scale = figure.scale](double value) {
        const double place = position_on(scale, value);
        return std::isnan(place) ? -1 : std::min(static_cast<int>(place), static_cast<int>(scale.colors.size()) - 1);
    };
    ground.background = [&figure, class_at](const PlanePoint& at) {
        const int here = class_at(figure.value(at.x_m, at.z_m));
        return figure.scale.neutral && here != class_at(*figure.scale.neutral) ? -1 : here;
    };
    return place_labels(shapes, ground);
}

void add_obstacle_names(GnuplotScript& script, const FieldFigure& figure, const std::vector<VisibleOutline>& outlines,
                        const FieldLayout& layout) {
    const std::vector<std::string> names = names_of(figure, outlines);
    for (const PlacedLabel& label : placed_names(figure, outlines, layout)) {
        if (label.leader) {
            const auto& [from, to] = *label.leader;
            script.add("set arrow from {:.9g},{:.9g} to {:.9g},{:.9g} nohead front linecolor rgb {} linewidth 0.8",
                       from.x_m, from.z_m, to.x_m, to.z_m, in_quotes(outline_color));
        }
        script.add("set label {} at {:.9g},{:.9g} center front textcolor rgb {}", in_quotes(names[label.shape]),
                   (label.box.x_low_m + label.box.x_high_m) / 2, (label.box.z_low_m + label.box.z_high_m) / 2,
                   label.is_inside ? "'#ffffff'" : in_quotes(outline_color));
    }
}

}  // namespace downwash

#include "downwash/report/field_figure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "downwash/base/fault.hpp"
#include "downwash/base/text.hpp"
#include "downwash/report/field_samples.hpp"
#include "downwash/report/gnuplot_script.hpp"
#include "downwash/report/label_placement.hpp"
#include "downwash/report/legend.hpp"
#include "downwash/report/picture_text.hpp"
#include "downwash/report/plot_elements.hpp"
#include "downwash/report/region_boundary.hpp"

namespace downwash {
namespace {

constexpr double label_height_px = 18;
constexpr char hatch_color[] = "'#9a9a9a'";
constexpr char obstacle_color[] = "'#6e6e6e'";
constexpr char outline_color[] = "'#303030'";

// --- where things stand -------------------------------------------------------------------------------------------

/// Distances in pixels from the lower left corner of the picture.
struct Layout {
    double left, right, bottom, top;  ///< of the axes
    double height;                    ///< of the picture
    double legend_top;
    double room;  ///< how wide the axes may be
    double bar_bottom;

    [[nodiscard]] double width() const { return right - left; }
};

void require_drawable(const MapExtent& extent) {
    constexpr double longest_ratio = 40;
    const double width_m = extent.x_high_m - extent.x_low_m;
    const double height_m = extent.z_high_m - extent.z_low_m;
    const std::string given = fmt::format("x from {} to {} and z from {} to {} m", to_text(extent.x_low_m),
                                          to_text(extent.x_high_m), to_text(extent.z_low_m), to_text(extent.z_high_m));
    if (!(width_m > 0 && height_m > 0 && std::isfinite(width_m) && std::isfinite(height_m))) {
        throw InputError({{"extent", given + " hold no area: expected finite numbers, the lower ones first"}});
    }
    if (width_m > longest_ratio * height_m || height_m > longest_ratio * width_m) {
        throw InputError({{"extent", fmt::format("{} cannot be drawn to scale: expected no side to be more than {} "
                                                 "times as long as the other",
                                                 given, longest_ratio)}});
    }
}

Layout layout_of(const FieldFigure& figure, int picture_width_px, const Legend& legend) {
    constexpr double left_px = 80, right_px = 24, below_axes_px = 128;
    constexpr double tallest = 1.2;  // of the axes, in their widths
    const MapExtent& extent = figure.extent;
    const double ratio = (extent.z_high_m - extent.z_low_m) / (extent.x_high_m - extent.x_low_m);
    const double room_px = picture_width_px - left_px - right_px;
    const double width_px = ratio > tallest ? room_px * tallest / ratio : room_px;
    const double above_axes_px = (figure.subtitle.empty() ? 40 : 62) + legend.height_px(room_px) + 6;
    Layout layout{};
    layout.left = left_px + (room_px - width_px) / 2;
    layout.right = layout.left + width_px;
    layout.bottom = below_axes_px;
    layout.top = layout.bottom + width_px * ratio;
    layout.height = std::round(layout.top + above_axes_px);
    layout.legend_top = layout.top + legend.height_px(room_px) + 2;
    layout.bar_bottom = 48;
    layout.room = room_px;
    return layout;
}

// --- the field ----------------------------------------------------------------------------------------------------

/// So many points for each pixel of the axes, but no more than that in all.
FieldSamples sampled_for(const FieldFigure& figure, const Layout& layout, double points_per_px, std::size_t most_points,
                         bool at_corners) {
    const double height_px = layout.top - layout.bottom;
    const double points = layout.width() * height_px * points_per_px * points_per_px;
    const double scale = points_per_px * std::min(1., std::sqrt(static_cast<double>(most_points) / points));
    const auto count = [scale](double px) { return std::max<std::size_t>(2, std::lround(scale * px)); };
    return sampled(figure, count(layout.width()), count(height_px), at_corners);
}

bool is_undefined(float place) {
    return std::isnan(place);
}

/// Lines between the classes, as the data $contours.
void add_contours(GnuplotScript& script, const FieldFigure& figure, const FieldSamples& samples) {
    script.add("set contour base");
    script.add("unset surface");
    script.add(fmt::format("set cntrparam levels incremental 1,1,{}", figure.scale.colors.size() - 1));
    script.add("set table $contours");
    script.add("splot " + samples.surface_source());
    script.add_values(samples.places);
    script.add("unset table");
    script.add("unset contour");
}

void add_color_bar(GnuplotScript& script, const FieldFigure& figure, const Layout& layout) {
    const ColorScale& scale = figure.scale;
    const std::size_t classes = scale.colors.size();
    std::string palette;
    for (std::size_t i = 0; i < classes; ++i) {
        palette += fmt::format("{}{} {}", i == 0 ? "" : ", ", i, in_quotes(scale.colors[i]));
    }
    script.add(fmt::format("set palette defined ({}) maxcolors {}", palette, classes));
    script.add(fmt::format("set cbrange [0:{}]", classes));

    std::vector<std::string> texts;
    for (const double limit : scale.limits) {
        texts.push_back(to_text(std::abs(limit) < 1e-12 ? 0 : limit, 4));
    }
    const bool has_names = !scale.names.empty();
    double widest_px = 0;
    for (const std::string& text : has_names ? scale.names : texts) {
        widest_px = std::max(widest_px, text_width_px(text, font_px) + 8);
    }
    const auto every =
        static_cast<std::size_t>(std::max(1., std::ceil(widest_px * static_cast<double>(classes) / layout.width())));
    std::string tics;
    const auto add_tic = [&](std::string_view text, double place) {
        tics += fmt::format("{}{} {}", tics.empty() ? "" : ", ", in_quotes(text), place);
    };
    if (has_names) {
        for (std::size_t i = 0; i < classes; ++i) {
            add_tic(scale.names[i], static_cast<double>(i) + 0.5);
        }
    } else {
        for (std::size_t i = 0; i <= classes; i += every) {
            add_tic(texts[i], static_cast<double>(i));
        }
    }
    script.add(fmt::format("set cbtics ({}) scale 0.3 offset 0,0.4", tics));
    script.add(fmt::format("set colorbox horizontal user origin {},{} size {},{} border", script.screen_x(layout.left),
                           script.screen_y(layout.bar_bottom), script.screen_x(layout.width()), script.screen_y(14)));
    script.add_line_of_text(scale.label, (layout.left + layout.right) / 2, 13, 1, "'#000000'");
}

// --- obstacles ----------------------------------------------------------------------------------------------------

using Ring = std::vector<PlanePoint>;

std::string points_text(const Ring& ring, bool is_closed) {
    std::string text;
    for (const PlanePoint& point : ring) {
        text += fmt::format("{:.9g} {:.9g}\n", point.x_m, point.z_m);
    }
    if (is_closed && !ring.empty()) {
        text += fmt::format("{:.9g} {:.9g}\n", ring[0].x_m, ring[0].z_m);
    }
    return text;
}

/// All rings as one closed line. The ways between them are walked there and back and enclose nothing, so that holes,
/// which run the other way round, stay open.
std::string fill_text(const std::vector<Ring>& rings) {
    std::string text;
    std::string way_back;
    for (const Ring& ring : rings) {
        if (!ring.empty()) {
            text += points_text(ring, true);
            way_back.insert(0, points_text({ring[0]}, false));
        }
    }
    return text + way_back;
}

std::string lines_text(const std::vector<Ring>& rings, bool is_closed) {
    std::string text;
    for (const Ring& ring : rings) {
        text += points_text(ring, is_closed) + "\n";
    }
    return text;
}

void add_data(GnuplotScript& script, const std::string& name, const std::string& text) {
    script.add(name + " << END_OF_DATA\n" + text + "END_OF_DATA");
}

/// Outlines that look the same, such as those of girders left and right of the plane, become one with both names.
std::vector<ObstacleOutline> merged(const std::vector<ObstacleOutline>& outlines) {
    std::vector<ObstacleOutline> merged;
    std::map<std::pair<bool, std::string>, std::size_t> seen;
    for (const ObstacleOutline& outline : outlines) {
        std::string corners;
        for (const auto* rings : {&outline.rings, &outline.lines}) {
            for (const Ring& ring : *rings) {
                for (const PlanePoint& p : ring) {
                    corners += fmt::format("{} {} ", std::lround(p.x_m * 1e4), std::lround(p.z_m * 1e4));
                }
            }
        }
        const auto [place, is_new] = seen.emplace(std::pair(outline.is_cut, corners), merged.size());
        if (is_new) {
            merged.push_back(outline);
        } else {
            merged[place->second].name += ", " + outline.name;
        }
    }
    return merged;
}

/// A name as it is drawn.
std::string shown_name(const std::string& name) {
    constexpr std::size_t most_characters = 40;
    return picture_text(name, most_characters);
}

void add_names(GnuplotScript& script, const FieldFigure& figure, const std::vector<ObstacleOutline>& outlines,
               const Layout& layout) {
    const MapExtent& extent = figure.extent;
    const double px_per_m = layout.width() / (extent.x_high_m - extent.x_low_m);
    std::vector<NamedShape> shapes;
    for (const ObstacleOutline& outline : outlines) {
        NamedShape shape{outline.name, text_width_px(shown_name(outline.name), font_px) + 6, outline.is_cut, {}};
        for (const auto* rings : {&outline.rings, &outline.lines}) {
            for (const Ring& ring : *rings) {
                auto& pixels = shape.rings.emplace_back();
                for (const PlanePoint& p : ring) {
                    pixels.push_back({layout.left + (p.x_m - extent.x_low_m) * px_per_m,
                                      layout.bottom + (p.z_m - extent.z_low_m) * px_per_m});
                }
            }
        }
        shapes.push_back(std::move(shape));
    }
    const PixelBox area{layout.left + 2, layout.right - 2, layout.bottom + 2, layout.top - 2};
    // A name hides nothing where the field is of one colour.
    const auto color_at = [&](const PixelPoint& p) {
        const double place = position_on(figure.scale, figure.value(extent.x_low_m + (p.x - layout.left) / px_per_m,
                                                                    extent.z_low_m + (p.y - layout.bottom) / px_per_m));
        return std::isnan(place) ? -1 : static_cast<int>(place);
    };
    for (const PlacedLabel& label : place_labels(shapes, area, label_height_px, color_at)) {
        const PixelPoint middle = label.box.middle();
        const auto screen = [&](double x, double y) {
            return fmt::format("screen {:.6f},{:.6f}", script.screen_x(x), script.screen_y(y));
        };
        if (label.leader) {
            script.add(fmt::format("set arrow from {} to {} nohead front linecolor rgb {} linewidth 0.8",
                                   screen(std::clamp(label.leader->x, label.box.left, label.box.right),
                                          std::clamp(label.leader->y, label.box.bottom, label.box.top)),
                                   screen(label.leader->x, label.leader->y), outline_color));
        }
        if (label.needs_ground) {
            script.add(
                fmt::format("set object rectangle from {} to {} front fillcolor rgb '#ffffff' "
                            "fillstyle solid 0.85 noborder",
                            screen(label.box.left, label.box.bottom), screen(label.box.right, label.box.top)));
        }
        script.add(fmt::format("set label {} at {} center front textcolor rgb {}",
                               in_quotes(shown_name(shapes[label.shape].name)), screen(middle.x, middle.y),
                               label.is_inside ? "'#ffffff'" : outline_color));
    }
}

void add_arrows(GnuplotScript& script, const FigureLines& lines, const MapExtent& extent) {
    const auto is_shown = [&](const PlanePoint& p) {
        return p.x_m > extent.x_low_m && p.x_m < extent.x_high_m && p.z_m > extent.z_low_m && p.z_m < extent.z_high_m;
    };
    for (const Ring& piece : lines.pieces) {
        if (piece.size() < 2) {
            continue;
        }
        const PlanePoint& from = piece[piece.size() / 2 - 1];
        const PlanePoint& to = piece[piece.size() / 2];
        if (is_shown(from) && is_shown(to)) {
            script.add(
                fmt::format("set arrow from {:.9g},{:.9g} to {:.9g},{:.9g} front size screen 0.009,20 fixed filled "
                            "linecolor rgb {} linewidth {}",
                            from.x_m, from.z_m, to.x_m, to.z_m, in_quotes(lines.color), lines.width_px));
        }
    }
}

// --- the whole ----------------------------------------------------------------------------------------------------

void add_outlines(Plot& plot, const std::vector<ObstacleOutline>& outlines) {
    bool has_cut = false, has_projected = false;
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        const ObstacleOutline& outline = outlines[i];
        const std::string edge = fmt::format("$edge{}", i);
        if (!outline.is_cut) {
            plot.add_lines(edge, "dashtype (14,9) linewidth 1.3 linecolor rgb '#505050'",
                           std::exchange(has_projected, true) ? "" : "obstacle beside the plane, projected");
            continue;
        }
        if (!outline.rings.empty()) {
            plot.add_fill(fmt::format("$fill{}", i),
                          fmt::format("fillstyle solid noborder fillcolor rgb {}", obstacle_color),
                          std::exchange(has_cut, true) ? "" : "obstacle");
        }
        // The many cubes of an octree are shown as one.
        constexpr std::size_t most_outlined = 30;
        plot.add_lines(edge, outline.rings.size() <= most_outlined
                                 ? fmt::format("linewidth 1 linecolor rgb {}", outline_color)
                                 : fmt::format("linewidth 0.5 linecolor rgb {}", obstacle_color));
    }
}

void add_marks(Plot& plot, const FieldFigure& figure) {
    for (std::size_t i = 0; i < figure.lines.size(); ++i) {
        const FigureLines& lines = figure.lines[i];
        plot.add_lines(fmt::format("$line{}", i),
                       fmt::format("linewidth {}{} linecolor rgb {}", lines.width_px,
                                   lines.is_dashed ? " dashtype (16,9)" : "", in_quotes(lines.color)),
                       lines.name);
    }
    for (std::size_t i = 0; i < figure.points.size(); ++i) {
        plot.add_points(fmt::format("$point{}", i),
                        fmt::format("pointtype 7 pointsize 0.9 linecolor rgb {}", in_quotes(figure.points[i].color)),
                        figure.points[i].name);
    }
}

void add_overlay_data(GnuplotScript& script, const FieldFigure& figure, const std::vector<ObstacleOutline>& outlines) {
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        add_data(script, fmt::format("$fill{}", i), fill_text(outlines[i].rings));
        add_data(script, fmt::format("$edge{}", i),
                 lines_text(outlines[i].rings, true) + lines_text(outlines[i].lines, false));
    }
    for (std::size_t i = 0; i < figure.lines.size(); ++i) {
        add_data(script, fmt::format("$line{}", i), lines_text(figure.lines[i].pieces, false));
        if (figure.lines[i].has_arrows) {
            add_arrows(script, figure.lines[i], figure.extent);
        }
    }
    for (std::size_t i = 0; i < figure.points.size(); ++i) {
        add_data(script, fmt::format("$point{}", i), points_text(figure.points[i].points, false));
    }
}

/// The line around where the field is not defined, as the data $boundary.
void add_boundary(GnuplotScript& script, const FieldFigure& figure, const Layout& layout) {
    constexpr double px_per_cell = 2;
    const auto cells = [](double px) { return std::max<std::size_t>(1, std::lround(px / px_per_cell)); };
    const auto is_undefined_at = [&](double x_m, double z_m) { return std::isnan(figure.value(x_m, z_m)); };
    add_data(script, "$boundary",
             lines_text(region_boundary(is_undefined_at, figure.extent, cells(layout.width()),
                                        cells(layout.top - layout.bottom)),
                        false));
}

void add_axes(GnuplotScript& script, const FieldFigure& figure, const Layout& layout) {
    const MapExtent& extent = figure.extent;
    script.set_axes(layout.left, layout.right, layout.bottom, layout.top);
    script.add(fmt::format("set xrange [{}:{}]", extent.x_low_m, extent.x_high_m));
    script.add(fmt::format("set yrange [{}:{}]", extent.z_low_m, extent.z_high_m));
    script.add(fmt::format("set xlabel {} offset 0,0.3", in_quotes(figure.x_label)));
    script.add(fmt::format("set ylabel {} offset 0.8,0", in_quotes(figure.z_label)));
}

}  // namespace

std::string draw(const FieldFigure& figure, const PictureSettings& settings) {
    require_drawable(figure.extent);
    const std::vector<ObstacleOutline> outlines = merged(figure.obstacles);

    // The legend decides the layout, and the layout how finely the field is sampled: whether it is defined everywhere,
    // which the legend says, is found out beforehand.
    const FieldSamples glance = sampled(figure, 300, 300, false);
    const bool has_undefined = std::any_of(glance.places.begin(), glance.places.end(), is_undefined);
    const bool has_field = !std::all_of(glance.places.begin(), glance.places.end(), is_undefined);
    Legend legend;
    Plot plot(legend), overlay(legend);
    if (has_undefined) {
        plot.add_fill("$all",
                      fmt::format("fillstyle pattern 5 border linecolor rgb {0} fillcolor rgb {0}", hatch_color),
                      figure.undefined_name);
    }
    add_outlines(overlay, outlines);
    add_marks(overlay, figure);

    const Layout layout = layout_of(figure, settings.width_px, legend);
    GnuplotScript script(settings, layout.height);
    const double middle_px = settings.width_px / 2.;
    script.set_titles(figure.title, figure.subtitle, middle_px, layout.height);
    legend.place(script, middle_px, layout.legend_top, layout.room);
    add_axes(script, figure, layout);
    add_color_bar(script, figure, layout);
    add_names(script, figure, outlines, layout);
    add_overlay_data(script, figure, outlines);
    const MapExtent& extent = figure.extent;
    add_data(script, "$all",
             points_text({{extent.x_low_m, extent.z_low_m},
                          {extent.x_high_m, extent.z_low_m},
                          {extent.x_high_m, extent.z_high_m},
                          {extent.x_low_m, extent.z_high_m}},
                         true));
    FieldSamples image;
    if (has_field) {
        constexpr std::size_t most_image_points = 1'500'000, most_contour_points = 300'000;
        const double points_per_px = settings.format == PictureFormat::svg ? 2 : 1;
        image = sampled_for(figure, layout, points_per_px, most_image_points, false);
        plot.add(image.source() + " with image");
        if (figure.has_contour_lines) {
            add_contours(script, figure, sampled_for(figure, layout, 0.5, most_contour_points, true));
            plot.add_lines("$contours", "linewidth 0.5 linecolor rgb '#404040'");
        }
        if (has_undefined) {
            add_boundary(script, figure, layout);
            plot.add_lines("$boundary", "linewidth 1.2 linecolor rgb '#707070'");
        }
    }
    script.add("plot " + plot.elements() + (overlay.elements().empty() ? "" : ", ") + overlay.elements());
    if (has_field) {
        script.add_values(image.places);
    }
    return script.draw();
}

}  // namespace downwash
